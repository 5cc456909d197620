"""Results files that commands read, and the Python file of user-defined classes in them."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from beamfem.io.own_parts import NotImportedError
    from beamfem.results.solution import Solution

OwnCode = Annotated[
    Path | None,
    typer.Option(
        "--code", help="A Python file (.py) that defines parts of the model; it is run first.", show_default=False
    ),
]


def loaded(results: Path, code: Path | None) -> "Solution":
    """Return the solution of a results file after running the Python file that defines parts of its model, if given.

    No other file is run, whatever the results file names. Raises InputError.
    """
    from beamfem.cli.modelfile.code import run_file
    from beamfem.errors import InputError
    from beamfem.io.own_parts import NotImportedError
    from beamfem.io.results import load

    if code is not None:
        run_file(code)
    try:
        return load(results)
    except InputError as error:
        missing = error.__cause__
        if isinstance(missing, NotImportedError):
            raise InputError(f"{results} cannot be loaded: {_told(missing, code)}") from error
        raise


def _told(missing: "NotImportedError", code: Path | None) -> str:
    """Return which class is missing and how the command finds it."""
    kind, module = missing.kind, missing.module
    if module == "__main__":
        return (
            f"the file holds a {kind} of the script that saved it, which commands cannot read; move {kind} to a Python "
            "file that the script imports, save the results again and give that file with --code"
        )
    if code is not None and code.stem == module:
        return f"the file holds a {kind}, and {code} has no dataclass of this name"
    beside = "" if code is None else f", which {code} does not import"
    file = f"{module}.py" if module.isidentifier() else "FILE.py, a file that imports it"
    return f"the file holds a {kind} of the module {module}{beside}; name the Python file to run: --code {file}"
