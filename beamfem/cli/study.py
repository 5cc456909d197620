"""`beamfem study`: list the studies of a folder and run one."""

import ast
import importlib.util
import inspect
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, reported


@dataclass(frozen=True)
class Study:
    """A study as a file: its name, with its sub-folder if it is in one, and the first line of its docstring."""

    name: str
    title: str
    file: Path


def study(
    context: typer.Context,
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="The study to run; without it, all are listed.")
    ] = None,
    folder: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the studies, given before NAME. By default the folder `studies` here, otherwise the one "
            "shipped with beamfem.",
            show_default=False,
        ),
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """List the studies, or run one with its own options: `beamfem study NAME --help` shows them."""
    with reported(as_json, quiet):
        folder = _folder() if folder is None else folder
        studies = find_studies(folder)
        if name is None:
            if as_json:
                print_json([{"name": item.name, "title": item.title, "file": item.file} for item in studies])
            else:
                width = max(len(item.name) for item in studies)
                print("\n".join(f"{item.name:{width}s}  {item.title}" for item in studies))
            return
        chosen = _named(name, studies, folder)
        _run(chosen, name, _main_of(chosen, folder), context.args, as_json, quiet)


def _folder() -> Path:
    """Return the folder of studies here, else that which comes with beamfem."""
    from beamfem.cli.shipped import shipped

    local = Path("studies")
    return local if local.is_dir() else shipped("studies") or local


def find_studies(folder: Path) -> list[Study]:
    """Return the files with a function main in a folder and its sub-folders. Raises InputError if there are none."""
    from beamfem.errors import InputError

    right = "give the folder of the studies with --folder, or start beamfem where it is"
    if not folder.is_dir():
        raise InputError(f"there is no folder {folder} here ({Path.cwd()}): {right}")
    studies = []
    for file in sorted(folder.rglob("*.py")):
        try:
            tree = ast.parse(file.read_bytes())
        except SyntaxError:
            continue
        if any(isinstance(node, ast.FunctionDef) and node.name == "main" for node in tree.body):
            title = (ast.get_docstring(tree) or "").strip().split("\n")[0]
            studies.append(Study(file.relative_to(folder).with_suffix("").as_posix(), title, file))
    if not studies:
        raise InputError(f"no file in {folder} has a function main, which makes a study: {right}")
    return studies


def _named(name: str, studies: list[Study], folder: Path) -> Study:
    from beamfem.errors import InputError
    from beamfem.validation import nearest

    wanted = name.removesuffix(".py")
    matches = [item for item in studies if wanted in (item.name, item.file.stem)]
    if len(matches) > 1 and not any(item.name == wanted for item in matches):
        raise InputError(f"{name!r} may be {' or '.join(item.name for item in matches)}; give it with its folder")
    if not matches:
        names, short = [item.name for item in studies], [item.file.stem for item in studies]
        raise InputError(f"there is no study {name!r} in {folder}; {nearest(name, names, short)}")
    return min(matches, key=lambda item: item.name != wanted)


def _main_of(item: Study, folder: Path) -> Any:
    """Import a study and return its main.

    Studies share code: the folder of the study and the parent of the folder of all studies are put on the path.
    """
    for path in (str(folder.resolve().parent), str(item.file.parent.resolve())):
        if path not in sys.path:
            sys.path.insert(0, path)
    return _imported(item).main


def _imported(item: Study) -> ModuleType:
    name = item.file.stem
    loaded = sys.modules.get(name)
    if loaded is not None and Path(getattr(loaded, "__file__", None) or "").resolve() == item.file.resolve():
        return loaded
    spec = importlib.util.spec_from_file_location(name, item.file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    # under its own name, so that its functions can be pickled for other processes
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _run(item: Study, name: str, main: Any, arguments: list[str], as_json: bool, quiet: bool) -> None:
    """Run a study with its options; name: as it was given."""
    from rich.markup import escape

    from beamfem.cli.flags import Command
    from beamfem.cli.options import command_of, with_hyphens

    def call(values: dict[str, Any]) -> None:
        json_too, quiet_too = values.pop("_json", False) or as_json, values.pop("_quiet", False) or quiet
        with reported(json_too, quiet_too):
            _show(_called(main, values, json_too or quiet_too), json_too, quiet_too)

    extra = {
        word: inspect.Parameter(f"_{word}", inspect.Parameter.KEYWORD_ONLY, default=False, annotation=kind)
        for word, kind in (("json", AsJson), ("quiet", Quiet))
    }
    command = command_of(main, call, extra)
    if item.title:  # what `main` returns is for callers in Python
        command.__doc__ = escape(item.title)
    app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    app.command(cls=Command, context_settings={"help_option_names": ["-h", "--help"]})(command)
    app([with_hyphens(word) for word in arguments], prog_name=f"beamfem study {name}")


def _called(main: Any, values: dict[str, Any], silent: bool) -> Any:
    """Return what a study returns; silent: its output goes to stderr instead of stdout."""
    from contextlib import redirect_stdout

    if not silent:
        return main(**values)
    with redirect_stdout(sys.stderr):
        return main(**values)


def _show(result: Any, as_json: bool, quiet: bool) -> None:
    """Print what a study returned."""
    from dataclasses import is_dataclass

    from beamfem.cli.plain import plain

    if as_json:
        print_json({"result": result})
    elif result is None or quiet:
        return
    elif isinstance(result, str) or (
        type(result).__str__ is not object.__str__ and not isinstance(result, dict | list)
    ):
        print(result)
    elif is_dataclass(result) or isinstance(result, dict):
        for key, value in plain(result).items():
            print(f"{key}: {_line(value)}")
    else:
        for value in plain(result):
            print(_line(value))


def _line(value: Any) -> str:
    """Return a value as one line."""
    if isinstance(value, float):
        return f"{value:.8g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_line(item)}" for key, item in value.items())
    return " ".join(_line(item) for item in value) if isinstance(value, list) else str(value)
