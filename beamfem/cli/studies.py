"""`beamfem study`: list the studies of a folder and run one, with the parameters of its `main` as options."""

import argparse
import ast
import importlib.util
import inspect
import re
import sys
import typing
from collections.abc import Callable, Iterable, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Annotated, Any

import typer

from beamfem.cli.examples import shipped
from beamfem.cli.report import AsJson, Quiet, plain, print_json, reported


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
        chosen = _named(name, studies, folder)
        main = _main_of(chosen, folder)
        values = vars(_parser(main, f"beamfem study {name}", chosen.title).parse_args(context.args))
        as_json, quiet = values.pop("_json") or as_json, values.pop("_quiet") or quiet
    with reported(as_json, quiet):
        if not (as_json or quiet):
            _show(main(**values))
            return
        with redirect_stdout(sys.stderr):
            result = main(**values)
        if as_json:
            print_json({"result": result})


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


def _parser(main: Callable[..., Any], program: str, title: str) -> argparse.ArgumentParser:
    """Return a parser of options with the names of the parameters of a function that can be given as text."""
    parser = argparse.ArgumentParser(program, description=title, allow_abbrev=False)
    hints = typing.get_type_hints(main)
    for name, parameter in inspect.signature(main).parameters.items():
        read = _reader(hints.get(name))
        required = parameter.default is parameter.empty
        if read is None and not required:
            continue
        default = "" if required or parameter.default is None else f" (default: {_text(parameter.default)})"
        parser.add_argument(
            f"--{name.replace('_', '-')}",
            dest=name,
            required=required,
            default=None if required else parameter.default,
            help=(_described(main, name) + default).replace("%", "%%"),
            **({"action": argparse.BooleanOptionalAction} if read is bool else {"type": read, "metavar": ""}),
        )
    for name, words in (("json", "Print the result as JSON on stdout."), ("quiet", "Print errors only.")):
        parser.add_argument(f"--{name}", dest=f"_{name}", action="store_true", help=words)
    return parser


def _reader(hint: Any) -> Callable[[str], Any] | None:
    """Return what reads a value of a type from text, None if there is no text for it."""
    options = [option for option in typing.get_args(hint) if option is not NoneType]
    if typing.get_origin(hint) in (tuple, list, Sequence, Iterable):
        item = _reader(options[0])
        return item and (lambda text: tuple(item(part.strip()) for part in text.split(",")))
    if typing.get_origin(hint) is typing.Literal:
        return str
    if options:
        return _reader(options[0]) if len(options) == 1 else None
    from beamfem.element.element import Element

    return _element if hint is Element else hint if hint in (int, float, str, bool, Path) else None


def _element(text: str) -> Any:
    """Return the element of a text such as "ANCFCRBF" or "CRBF(4)"."""
    from beamfem.element import presets
    from beamfem.errors import InputError
    from beamfem.validation import nearest

    name, _, order = text.strip().rstrip(")").partition("(")
    known = ("ANCF", "ANCFCRBF", "BilinearANCF", "BilinearCRBF", "CRBF", "ShearRigid")
    if name not in known:
        raise argparse.ArgumentTypeError(f"there is no element {name!r}; {nearest(name, known)}")
    try:
        return getattr(presets, name)(*([int(order)] if order else []))
    except (InputError, TypeError, ValueError) as error:
        raise argparse.ArgumentTypeError(f"{text}: {error}; CRBF needs its order, such as CRBF(4)") from None


def _text(default: Any) -> str:
    items = default if isinstance(default, tuple | list) else (default,)
    return ",".join(getattr(item, "name", str(item)) for item in items)


def _described(main: Callable[..., Any], name: str) -> str:
    """Return the description of a parameter in the numpydoc section "Parameters" of a docstring."""
    found = re.search(rf"^{name}(?:, \w+)* :.*\n((?:[ ]+.*\n?)+)", inspect.getdoc(main) or "", re.MULTILINE)
    return " ".join(found[1].split()) if found else ""


def _show(result: Any) -> None:
    """Print what a study returned."""
    if result is None:
        return
    if isinstance(result, str) or (type(result).__str__ is not object.__str__ and not isinstance(result, dict | list)):
        print(result)
    elif is_dataclass(result) or isinstance(result, dict):
        print("\n".join(f"{key}: {_line(value)}" for key, value in plain(result).items()))
    else:
        print("\n".join(_line(value) for value in plain(result)))


def _line(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.8g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_line(item)}" for key, item in value.items())
    return " ".join(_line(item) for item in value) if isinstance(value, list) else str(value)
