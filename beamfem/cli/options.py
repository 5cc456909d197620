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

from beamfem.cli.elements import element_from_text
from beamfem.element.element import Element
from beamfem.errors import InputError

_PLAIN = (int, float, str, bool, Path)
_SEQUENCES = (tuple, list, collections.abc.Sequence, collections.abc.Iterable)
_ITEMS: dict[type, Callable[[str], Any]] = {int: int, float: float, str: str, Element: element_from_text}


def command_of(
    function: Callable[..., Any], run: Callable[[dict[str, Any]], None], extra: dict[str, inspect.Parameter]
) -> Callable[..., None]:
    """Return a command with an option for every parameter of a function.

    run: called with the arguments; extra: further parameters by the name of their option, left out if the function has
    a parameter of that name. Raises InputError for a parameter without default that cannot be given as text.
    """
    hints = typing.get_type_hints(function)
    own = inspect.signature(function).parameters
    options = []
    for name, parameter in own.items():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        option = _option(name, parameter, hints.get(name), _help(function, name))
        if option is not None:
            options.append(option)
        elif parameter.default is parameter.empty:
            raise InputError(f"{name} of {function.__name__} has no default and cannot be given as text")
    taken = [option.name for option in options]
    options += [parameter for name, parameter in extra.items() if name not in taken]

    def command(**arguments: Any) -> None:
        run(arguments)

    command.__doc__ = escape(inspect.getdoc(function) or "")
    command.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    command.__annotations__ = {option.name: option.annotation for option in options}
    return command


def _option(name: str, parameter: inspect.Parameter, hint: Any, words: str) -> inspect.Parameter | None:
    """Return the parameter of the command, None if its values cannot be given as text."""
    kind, default = _kind(hint, parameter.default), parameter.default
    required = default is parameter.empty
    names = [f"--{name.replace('_', '-')}", *([f"--{name}"] if "_" in name else [])]
    if kind is bool:
        names = [f"--{name.replace('_', '-')}/--no-{name.replace('_', '-')}"]
    item = _item(hint, default)
    if item is not None:
        metavar = f"{item.__name__.upper()},..."
        info = typer.Option(
            *names, help=words, metavar=metavar, parser=_list_of(item, name), show_default=_shown(default)
        )
        kind = list
    elif kind is Element:
        info = typer.Option(
            *names, help=words, metavar="ELEMENT", parser=_parsed(Element, name), show_default=_shown(default)
        )
    elif (
        kind in _PLAIN
        or (isinstance(kind, type) and issubclass(kind, Enum))
        or typing.get_origin(kind) is typing.Literal
    ):
        info = typer.Option(*names, help=words)
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
        found = type(default[0])
        return found if found in _ITEMS and all(type(value) is found for value in default) else None
    if typing.get_origin(kind) not in _SEQUENCES:
        return None
    parts = {part for part in typing.get_args(kind) if part is not Ellipsis}
    return parts.pop() if len(parts) == 1 and parts <= set(_ITEMS) else None


def _list_of(item: type, name: str) -> Callable[[Any], Any]:
    read = _parsed(item, name)

    def parse(text: Any) -> Any:
        return tuple(read(part.strip()) for part in text.split(",")) if isinstance(text, str) else text

    return parse


def _parsed(kind: type, name: str) -> Callable[[Any], Any]:
    def parse(text: Any) -> Any:
        if not isinstance(text, str):
            return text
        try:
            return _ITEMS[kind](text)
        except InputError as error:
            raise typer.BadParameter(str(error)) from None
        except ValueError:
            raise typer.BadParameter(f"{text!r} is not a valid {kind.__name__}") from None

    return parse


def _shown(default: Any) -> str | bool:
    """Return a default as it would be typed."""
    if isinstance(default, tuple | list):
        return ",".join(getattr(value, "name", None) or str(value) for value in default)
    return getattr(default, "name", False) if isinstance(default, Element) else False


def _help(function: Callable[..., Any], name: str) -> str:
    """Return the description of a parameter in the docstring: from `name:` to the next semicolon or full stop."""
    text = " ".join((inspect.getdoc(function) or "").split())
    found = re.search(
        rf"(?<![\w.])`*{re.escape(name)}`*(\s*\[[^\]]*\])?(\s*\([^)]*\))?:\s*([^;]+?)(?=;|\.\s|\.?$)", text
    )
    # rich reads the help of an option as markup twice, so that escaping does not save brackets
    return f"{found[3]}{found[1] or ''}".translate(str.maketrans("[]", "()")) if found else ""
