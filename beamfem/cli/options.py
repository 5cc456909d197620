"""Parameters of a function as options of a command."""

import collections.abc
import inspect
import re
import types
import typing
from collections.abc import Callable
from enum import Enum
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from beamfem.cli.elements import element_from_text, text_of_element
from beamfem.element.element import Element
from beamfem.errors import InputError

_PLAIN = (int, float, str, bool, Path)
_SEQUENCES = (tuple, list, collections.abc.Sequence, collections.abc.Iterable)
_ITEMS: dict[type, Callable[[str], Any]] = {int: int, float: float, str: str, Element: element_from_text}
_SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)
_UNIT = re.compile(r"\[(?!-\])([^\]]*)\]")  # none for numbers, [-]


class _Typed(str):
    """A default as it would be typed, and its value."""

    value: Any


def with_hyphens(word: str) -> str:
    """Return an option as it is listed, with hyphens; it may be given with underscores too. Values stay as they are."""
    name, sign, value = word.partition("=")
    return f"{name.replace('_', '-')}{sign}{value}" if word.startswith("--") else word


def command_of(
    function: Callable[..., Any], run: Callable[[dict[str, Any]], None], extra: dict[str, inspect.Parameter]
) -> Callable[..., None]:
    """Return a command with an option for every parameter of a function, described by its docstring.

    run: called with the arguments; extra: further parameters by the name of their option, left out if the function has
    a parameter of that name. Raises InputError for a parameter without default that cannot be given as text.
    """
    hints = typing.get_type_hints(function)
    parameters = inspect.signature(function).parameters
    options = []
    for name, parameter in parameters.items():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        option = _option(name, parameter, hints.get(name), _help(function, name))
        if option is not None:
            options.append(option)
        elif parameter.default is parameter.empty:
            raise InputError(f"{name} of {function.__name__} has no default and cannot be given as text")
    option_names = [option.name for option in options]
    options += [parameter for name, parameter in extra.items() if name not in option_names]

    def command(**arguments: Any) -> None:
        run(arguments)

    command.__doc__ = escape(_sections(function)[""])
    command.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    command.__annotations__ = {option.name: option.annotation for option in options}
    return command


def _option(name: str, parameter: inspect.Parameter, hint: Any, words: str) -> inspect.Parameter | None:
    """Return the parameter of the command, None if its values cannot be given as text."""
    kind, default = _kind(hint, parameter.default), parameter.default
    required = default is parameter.empty
    names = with_hyphens(f"--{name}/--no-{name}" if kind is bool else f"--{name}")
    item = _item(hint, default)
    if item is not None:
        info = typer.Option(names, help=words, metavar=f"<{item.__name__.lower()},...>", parser=_list_of(item))
        kind, default = list, _typed(default)
    elif kind is Element:
        info = typer.Option(names, help=words, metavar="<element>", parser=_parsed(Element))
        default = _typed(default)
    elif (
        kind in _PLAIN
        or (isinstance(kind, type) and issubclass(kind, Enum))
        or typing.get_origin(kind) is typing.Literal
    ):
        info = typer.Option(names, help=words)
    else:
        return None
    annotation: Any = kind if required or default is not None else kind | None
    default = inspect.Parameter.empty if required else default
    return inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[annotation, info]
    )


def _kind(hint: Any, default: Any) -> Any:
    """Return the type of a parameter without None; without an annotation, the type of its default."""
    if hint is None:
        return None if default is inspect.Parameter.empty or default is None else type(default)
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        parts = [part for part in typing.get_args(hint) if part is not type(None)]
        return parts[0] if len(parts) == 1 else None
    return hint


def _item(hint: Any, default: Any) -> Any:
    """Return the type of the items of a list, None if the parameter is not a list."""
    kind = _kind(hint, default)
    if kind in (tuple, list) and isinstance(default, tuple | list) and default:
        item_type = type(default[0])
        return item_type if item_type in _ITEMS and all(type(value) is item_type for value in default) else None
    if typing.get_origin(kind) not in _SEQUENCES:
        return None
    parts = {part for part in typing.get_args(kind) if part is not Ellipsis}
    return parts.pop() if len(parts) == 1 and parts <= set(_ITEMS) else None


def _list_of(item: type) -> Callable[[Any], Any]:
    read = _parsed(item)

    def parse(text: Any) -> Any:
        return text.value if isinstance(text, _Typed) else tuple(read(part.strip()) for part in text.split(","))

    return parse


def _parsed(kind: type) -> Callable[[Any], Any]:
    def parse(text: Any) -> Any:
        if isinstance(text, _Typed):
            return text.value
        try:
            return _ITEMS[kind](text)
        except InputError as error:
            raise typer.BadParameter(str(error)) from None
        except ValueError:
            raise typer.BadParameter(f"{text!r} is not a valid {kind.__name__}") from None

    return parse


def _typed(default: Any) -> Any:
    """Return a default as it would be typed, None and no default as they are."""
    if default is None or default is inspect.Parameter.empty:
        return default
    values = default if isinstance(default, tuple | list) else (default,)
    text = _Typed(",".join(text_of_element(value) if isinstance(value, Element) else str(value) for value in values))
    text.value = default
    return text


def _sections(function: Callable[..., Any]) -> dict[str, str]:
    """Return the sections of a docstring by their titles, what comes before them by ""."""
    first, *rest = _SECTION.split(inspect.getdoc(function) or "")
    return {"": first.strip(), **dict(zip(rest[::2], rest[1::2], strict=True))}


def _help(function: Callable[..., Any], name: str) -> str:
    """Return the description of a parameter in a docstring, as a sentence with its unit.

    It is taken from the section "Parameters", or else from `name:` in the text to the next semicolon or full stop.
    """
    sections = _sections(function)
    names = rf"(?:[\w, *]+, )?{re.escape(name)}(?:, [\w, *]+)?"
    listed = re.search(rf"^{names}( : .*)?\n((?:[ ]+.*\n?)+)", sections.get("Parameters", ""), re.MULTILINE)
    if listed is not None:
        kind, words = listed[1] or "", " ".join(listed[2].split()).rstrip(".")
    else:
        short = rf"(?<![\w.])`*{re.escape(name)}`*(\s*\[[^\]]*\])?(\s*\([^)]*\))?:\s*([^;]+?)(?=;|\.\s|\.?$)"
        match = re.search(short, " ".join(sections[""].split()))
        if match is None:
            return ""
        kind, words = match[1] or "", match[3]
    unit = _UNIT.search(kind)
    if unit is not None:  # rich reads the help of an option as markup twice, so that escaping does not save brackets
        first, *more = re.split(r"(?=[;,])", words, maxsplit=1)
        words = "".join([f"{first} ({unit[1]})", *more])
    return f"{words[:1].upper()}{words[1:]}.".translate(str.maketrans("[]", "()"))
