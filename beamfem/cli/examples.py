"""`beamfem examples`: scripts and model files to copy."""

import ast
import shutil
from pathlib import Path
from typing import Annotated

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, reported

_COPIED = ("examples", "meshes")  # one of the examples reads a mesh


def examples(
    folder: Annotated[
        Path | None, typer.Argument(help="Where to copy them; without it they are listed.", show_default=False)
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """List the examples, or copy all of them, with the meshes that they read, into a folder."""
    with reported(as_json, quiet):
        from beamfem.cli.shipped import shipped
        from beamfem.errors import InputError

        source = shipped("examples")
        if source is None:
            raise InputError("this installation of beamfem came without its examples; they are in its sources")
        files = sorted((*source.glob("*.py"), *source.glob("*.toml")))
        if folder is None:
            listed = {file.name: _title(file) for file in files}
            if as_json:
                print_json([{"name": name, "title": title} for name, title in listed.items()])
            elif not quiet:
                width = max(map(len, listed))
                print("\n".join(f"{name:{width}s}  {title}" for name, title in listed.items()))
            return
        written = [path for name in _COPIED for path in _copied(name, folder)]
        if as_json:
            print_json({"written": written})
        elif not quiet:
            print(f"wrote {len(written)} files; run one with: python {folder / 'examples' / 'cantilever.py'}")


def _copied(name: str, folder: Path) -> list[Path]:
    """Copy the files of a folder into one of the same name. Raises FileError if it is there already."""
    from beamfem.cli.shipped import shipped
    from beamfem.errors import FileError

    source, target = shipped(name), folder / name
    if source is None:
        return []
    if target.exists():
        raise FileError(f"{target} is there already; give another folder, or remove it first")
    shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__", "out"))
    return sorted(path for path in target.rglob("*") if path.is_file())


def _title(file: Path) -> str:
    """Return what a script or a model file says first."""
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".toml":
        return text.split("\n")[0].removeprefix("#").strip()
    return (ast.get_docstring(ast.parse(text)) or "").split("\n")[0]
