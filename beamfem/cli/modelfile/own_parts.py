"""Parts of a model file made by user-defined classes, whose parameters are keys, read by their types."""

import inspect
import typing
from collections.abc import Callable, Mapping
from types import UnionType
from typing import Any

from beamfem.cli.modelfile.table import Kinds, Reader, Table, build, build_kind
from beamfem.errors import InputError

Types = Mapping[Any, Reader]  # readers of values by the type of the parameter; Callable: functions of one number


def build_own_or_kind(table: Table, kinds: Kinds, readers: Mapping[str, Reader], types: Types) -> Any:
    """Return the part of a table with a user-defined `class`, or with a `kind`. Raises ModelFileError."""
    return build_own(table, types) if "class" in table.values else build_kind(table, kinds, readers)


def build_own(table: Table, types: Types) -> Any:
    """Return the object that the class of a table makes of its other keys. Raises ModelFileError."""
    if "class" not in table.values:
        raise table.error("the key class is missing: the name of a class in the file that `code` names")
    name = table.text("class")
    maker = own_code(table, "class")
    try:
        signature, hints = inspect.signature(maker), _hints(maker)
    except (TypeError, ValueError, NameError) as error:
        raise table.error(f"the parameters of {name} cannot be read: {error}", "class") from None
    named = [
        parameter
        for parameter in signature.parameters.values()
        if parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
    ]

    def made(**given: Any) -> Any:
        try:
            return maker(**given)
        except InputError:
            raise
        except Exception as error:
            raise InputError(f"{name} cannot be made: {type(error).__name__}: {error}") from error

    made.__signature__ = signature.replace(parameters=named)  # type: ignore[attr-defined]
    made.__annotations__ = hints
    readers = {parameter.name: reader for parameter in named if (reader := _reader(hints.get(parameter.name), types))}
    rest = Table(table.source, table.path, {key: value for key, value in table.values.items() if key != "class"})
    return build(rest, made, readers)


def own_code(table: Table, key: str) -> Callable[..., Any]:
    """Return the user-defined class or function that a key names. Raises ModelFileError."""
    name, code = table.text(key), table.source.code
    if code is None:
        raise table.error(
            f'"{name}" is Python of your own: name its file, beside this one, at the top: code = "FILE.py"', key
        )
    try:
        return code.named(name)
    except InputError as error:
        raise table.error(str(error), key) from None


def _hints(maker: Callable[..., Any]) -> dict[str, Any]:
    return typing.get_type_hints(maker.__init__ if isinstance(maker, type) else maker)  # type: ignore[misc]


def _reader(hint: Any, types: Types) -> Reader | None:
    """Return the reader of values of a type, or None if they are taken unchanged."""
    if reader := typed_reader(hint, types):
        return reader
    return _tuple if any(part is tuple or typing.get_origin(part) is tuple for part in _union(hint)) else None


def typed_reader(hint: Any, types: Types) -> Reader | None:
    """Return the reader of a type or of one of the types of a union, or None if there is none."""
    if hint in types:
        return types[hint]
    parts = _union(hint)
    if Callable in types and any(_is_function(part) for part in parts):
        return types[Callable]
    for part in parts:
        if part in types:
            return types[part]
        items = {item for item in typing.get_args(part) if item is not Ellipsis}
        if len(items) == 1 and items <= set(types):
            return _list_of(types[items.pop()])
    return None


def _union(hint: Any) -> tuple[Any, ...]:
    return typing.get_args(hint) if typing.get_origin(hint) in (typing.Union, UnionType) else (hint,)


def _is_function(hint: Any) -> bool:
    return hint is Callable or typing.get_origin(hint) is Callable


def _list_of(reader: Reader) -> Reader:
    def read(table: Table, key: str) -> tuple[Any, ...]:
        return tuple(reader(item, place) for item, place in table.items(key))

    return read


def _tuple(table: Table, key: str) -> Any:
    """Return arrays as tuples, as needed by dataclasses that are compared by value."""

    def tuples(value: Any) -> Any:
        return tuple(map(tuples, value)) if isinstance(value, list) else value

    return tuples(table.values[key])
