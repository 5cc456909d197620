"""`beamfem new`: a model file as a starting point."""

from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, reported


def new(
    model: Annotated[Path, typer.Argument(help="The model file to write (.toml).", show_default=False)],
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write a commented model file that runs unchanged, as a starting point."""
    with reported(as_json, quiet):
        from beamfem.errors import FileError, InputError
        from beamfem.files import whole

        if model.suffix.lower() != ".toml":
            right = f"; {model.with_suffix('.toml')} would be right" if model.name else ""
            raise InputError(f"a model file ends in .toml, got {model}{right}")
        if model.exists():
            raise FileError(f"{model} already exists; give another name, or remove it first")
        with whole(model) as partial:
            partial.write_text((files("beamfem.cli") / "template.toml").read_text(encoding="utf-8"), encoding="utf-8")
        if as_json:
            print_json({"written": [model]})
        elif not quiet:
            print(f"wrote {model}; solve it with: beamfem run {model}")
