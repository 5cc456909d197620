"""What comes with beamfem: a model file to start from, examples, and studies: files with a function `main`."""

import ast
import importlib.util
import shutil
import sys
from collections.abc import Callable
from contextlib import nullcontext, redirect_stdout
from dataclasses import dataclass
from inspect import Parameter, Signature, getdoc, signature
from pathlib import Path
from pprint import pprint
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer

from beamfem.atomic_write import whole
from beamfem.cli.report import AsJson, Quiet, reported
from beamfem.errors import FileError, InputError
from beamfem.validation import nearest

_PACKAGE = Path(__file__).parents[1]


def new(
    model: Annotated[Path, typer.Argument(help="The model file to write (.toml).")],
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write a commented model file that runs unchanged, as a starting point."""
    with reported(as_json, quiet) as show:
        if model.suffix.lower() != ".toml":
            right = f"; {model.with_suffix('.toml')} would be right" if model.name else ""
            raise InputError(f"a model file ends in .toml, got {model}{right}")
        if model.exists():
            raise FileError(f"{model} already exists; give another name, or remove it first")
        with whole(model) as partial:
            shutil.copyfile(Path(__file__).with_name("template.toml"), partial)
        show({"written": [model]}, f"wrote {model}; solve it with: beamfem run {model}")


def examples(
    folder: Annotated[Path | None, typer.Argument(help="Where to copy them; without it they are listed.")] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """List the examples, or copy all of them, with the meshes that they read, into a folder."""
    with reported(as_json, quiet) as show:
        source = shipped("examples")
        if source is None:
            raise InputError("this installation of beamfem came without its examples; they are in its sources")
        if folder is None:
            files = sorted((*source.glob("*.py"), *source.glob("*.toml")))
            listed = [(file.name, file.read_text(encoding="utf-8").split("\n")[0].strip('#" ')) for file in files]
            width = max(len(name) for name, _ in listed)
            text = "\n".join(f"{name:{width}s}  {title}" for name, title in listed)
            show([{"name": name, "title": title} for name, title in listed], text)
            return
        written = []
        for copied in filter(None, (source, shipped("meshes"))):
            target = folder / copied.name
            if target.exists():
                raise FileError(f"{target} is there already; give another folder, or remove it first")
            shutil.copytree(copied, target, ignore=shutil.ignore_patterns("__pycache__", "out"))
            written += sorted(path for path in target.rglob("*") if path.is_file())
        run = folder / "examples" / "cantilever.py"
        show({"written": written}, f"wrote {len(written)} files; run one with: python {run}")


def shipped(name: str) -> Path | None:
    """Return the folder "studies", "examples" or "meshes": of the wheel in the package, of the sources beside it."""
    places = (_PACKAGE / "shipped" / name, _PACKAGE.parent / name)
    return next((folder for folder in places if folder.is_dir()), None)


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
            "shipped with beamfem."
        ),
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """List the studies, or run one with its own options: `beamfem study NAME --help` shows them."""
    as_json, quiet = as_json or "--json" in context.args, quiet or "--quiet" in context.args
    with reported(as_json, quiet) as show:
        local = Path("studies")
        folder = folder or (local if local.is_dir() else shipped("studies") or local)
        studies = find_studies(folder)
        if name is None:
            width = max(len(item.name) for item in studies)
            show(studies, "\n".join(f"{item.name:{width}s}  {item.title}" for item in studies))
            return
        found = _named(name, studies, folder)
        with redirect_stdout(sys.stderr) if as_json or quiet else nullcontext():
            words = [word for word in context.args if word not in ("--json", "--quiet")]
            with _command(_main_of(found, folder), found.title).make_context(f"beamfem study {name}", words) as own:
                result = own.command.invoke(own)
        if as_json or result is not None:
            show({"result": result}, lambda: pprint(result) if isinstance(result, dict | list) else print(result))


def find_studies(folder: Path) -> list[Study]:
    """Return the files with a function main in a folder and its sub-folders. Raises InputError if there are none."""
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
            title = (ast.get_docstring(tree) or "").split("\n")[0]
            studies.append(Study(file.relative_to(folder).with_suffix("").as_posix(), title, file))
    if not studies:
        raise InputError(f"no file in {folder} has a function main, which makes a study: {right}")
    return studies


def _named(name: str, studies: list[Study], folder: Path) -> Study:
    wanted = name.removesuffix(".py")
    names, short = [item.name for item in studies], [item.file.stem for item in studies]
    matches = [item for item in studies if wanted in (item.name, item.file.stem)]
    if len(matches) > 1 and wanted not in names:
        raise InputError(f"{name!r} may be {' or '.join(item.name for item in matches)}; give it with its folder")
    if not matches:
        raise InputError(f"there is no study {name!r} in {folder}; {nearest(name, names, short)}")
    return min(matches, key=lambda item: item.name != wanted)


def _main_of(item: Study, folder: Path) -> Callable[..., Any]:
    """Import a study and return its main."""
    # studies share code: in their own folder, and from the parent of the folder of all studies
    for path in (str(folder.resolve().parent), str(item.file.parent.resolve())):
        if path not in sys.path:
            sys.path.insert(0, path)
    spec: Any = importlib.util.spec_from_file_location(item.file.stem, item.file)
    module: Any = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # under its own name, so that its functions can be pickled for other processes
    spec.loader.exec_module(module)
    return module.main


def _command(main: Callable[..., Any], title: str) -> Any:
    """Return a command whose options are the parameters of a function; values of a tuple are separated by commas."""
    hints, options = get_type_hints(main), []
    for name, parameter in signature(main).parameters.items():
        hint: Any = hints[name]
        option = typer.Option()
        if get_origin(hint) is tuple:
            hint, option = Any, typer.Option(parser=_list_of(get_args(hint)[0]), metavar="LIST")
        elif hint not in (int, float, str, bool, Path):
            continue
        options.append(parameter.replace(kind=Parameter.KEYWORD_ONLY, annotation=Annotated[hint, option]))

    def run(**values: Any) -> Any:
        return main(**values)

    run.__signature__ = Signature(options)  # type: ignore[attr-defined]
    run.__annotations__ = {option.name: option.annotation for option in options}
    app = typer.Typer(add_completion=False, rich_markup_mode=None)
    described = (getdoc(main) or "").partition("Parameters\n----------\n")[2].replace("\n\n", "\n\n\b\n")
    app.command(help=f"{title}\n\n\b\n{described}")(run)
    return typer.main.get_command(app)


def _list_of(each: Callable[[str], Any]) -> Callable[[Any], tuple[Any, ...]]:
    """Return what reads a list on the command line; a default is a tuple already."""
    return lambda text: text if isinstance(text, tuple) else tuple(map(each, text.split(",")))
