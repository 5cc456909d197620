"""`beamfem study`: list the studies of a folder and run one, with the parameters of its `main` as options."""

import ast
import importlib.util
import inspect
import sys
import typing
from collections.abc import Callable
from contextlib import nullcontext, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from pprint import pprint
from typing import Annotated, Any

import typer

from beamfem.cli.bundled_examples import shipped
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
        local = Path("studies")
        folder = folder or (local if local.is_dir() else shipped("studies") or local)
        studies = find_studies(folder)
        if name is None:
            if as_json:
                print_json(studies)
            else:
                width = max(len(item.name) for item in studies)
                print("\n".join(f"{item.name:{width}s}  {item.title}" for item in studies))
            return
        command = _command(_main_of(found := _named(name, studies, folder), folder), found.title)
        as_json, quiet = as_json or "--json" in context.args, quiet or "--quiet" in context.args
    with reported(as_json, quiet), redirect_stdout(sys.stderr) if as_json or quiet else nullcontext():
        words = [word for word in context.args if word not in ("--json", "--quiet")]
        with command.make_context(f"beamfem study {name}", words) as own:
            result = command.invoke(own)
    if as_json:
        print_json({"result": result})
    elif result is not None and not quiet:
        pprint(result) if isinstance(result, dict | list) else print(result)


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


def _main_of(item: Study, folder: Path) -> Callable[..., Any]:
    """Import a study and return its main.

    Studies share code: the folder of the study and the parent of the folder of all studies are put on the path.
    """
    for path in (str(folder.resolve().parent), str(item.file.parent.resolve())):
        if path not in sys.path:
            sys.path.insert(0, path)
    name = item.file.stem
    module = sys.modules.get(name)
    if module is None or Path(getattr(module, "__file__", None) or "").resolve() != item.file.resolve():
        spec = importlib.util.spec_from_file_location(name, item.file)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        # under its own name, so that its functions can be pickled for other processes
        sys.modules[name] = module
        spec.loader.exec_module(module)
    main: Callable[..., Any] = module.main
    return main


def _command(main: Callable[..., Any], title: str) -> Any:
    """Return a command whose options are the parameters of a function; values of a tuple are separated by commas."""
    hints, parameters = typing.get_type_hints(main), inspect.signature(main).parameters

    def run(**values: Any) -> Any:
        return main(**values)

    options = {}
    for name, parameter in parameters.items():
        hint = hints[name]
        if typing.get_origin(hint) is tuple:
            listed = typer.Option(parser=_list_of(typing.get_args(hint)[0]), metavar="LIST")
            options[name] = parameter.replace(annotation=Annotated[Any, listed])
        elif hint in (int, float, str, bool, Path):
            options[name] = parameter.replace(annotation=Annotated[hint, typer.Option()])
    keyword = inspect.Parameter.KEYWORD_ONLY
    run.__signature__ = inspect.Signature([item.replace(kind=keyword) for item in options.values()])  # type: ignore[attr-defined]
    run.__annotations__ = {name: item.annotation for name, item in options.items()}
    app = typer.Typer(add_completion=False, rich_markup_mode=None)
    described = (inspect.getdoc(main) or "").partition("Parameters\n----------\n")[2].replace("\n\n", "\n\n\b\n")
    app.command(help=f"{title}\n\n\b\n{described}")(run)
    return typer.main.get_command(app)


def _list_of(each: Callable[[str], Any]) -> Callable[[Any], tuple[Any, ...]]:
    """Return what reads a list on the command line; a default is a tuple already."""

    def separated(text: Any) -> tuple[Any, ...]:
        return text if isinstance(text, tuple) else tuple(each(part) for part in text.split(","))

    return separated
