"""`beamfem new` and `beamfem examples`: model files and scripts to start from."""

import ast
import shutil
from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, reported

_PACKAGE = Path(__file__).parents[1]


def new(
    model: Annotated[Path, typer.Argument(help="The model file to write (.toml).", show_default=False)],
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write a commented model file that runs unchanged, as a starting point."""
    with reported(as_json, quiet):
        from beamfem.atomic_write import whole
        from beamfem.errors import FileError, InputError

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


def examples(
    folder: Annotated[
        Path | None, typer.Argument(help="Where to copy them; without it they are listed.", show_default=False)
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """List the examples, or copy all of them, with the meshes that they read, into a folder."""
    with reported(as_json, quiet):
        from beamfem.errors import FileError, InputError

        source = shipped("examples")
        if source is None:
            raise InputError("this installation of beamfem came without its examples; they are in its sources")
        if folder is None:
            listed = {file.name: _title(file) for file in sorted((*source.glob("*.py"), *source.glob("*.toml")))}
            if as_json:
                print_json([{"name": name, "title": title} for name, title in listed.items()])
            elif not quiet:
                width = max(map(len, listed))
                print("\n".join(f"{name:{width}s}  {title}" for name, title in listed.items()))
            return
        written = []
        for copied in filter(None, (source, shipped("meshes"))):
            target = folder / copied.name
            if target.exists():
                raise FileError(f"{target} is there already; give another folder, or remove it first")
            shutil.copytree(copied, target, ignore=shutil.ignore_patterns("__pycache__", "out"))
            written += sorted(path for path in target.rglob("*") if path.is_file())
        if as_json:
            print_json({"written": written})
        elif not quiet:
            print(f"wrote {len(written)} files; run one with: python {folder / 'examples' / 'cantilever.py'}")


def shipped(name: str) -> Path | None:
    """Return the folder "studies", "examples" or "meshes" that comes with beamfem, None if it came without.

    In the wheel it is in a folder of the package, in the sources beside it.
    """
    places = (_PACKAGE / "shipped" / name, _PACKAGE.parent / name)
    return next((folder for folder in places if folder.is_dir()), None)


def _title(file: Path) -> str:
    """Return the first line of a script's docstring or of a model file."""
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".toml":
        return text.split("\n")[0].removeprefix("#").strip()
    return (ast.get_docstring(ast.parse(text)) or "").split("\n")[0]
