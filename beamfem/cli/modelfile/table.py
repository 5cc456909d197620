"""Tables of a model file: their keys are checked one by one and passed to the objects made from them."""

import inspect
import re
import typing
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beamfem.cli.modelfile.code import Code
from beamfem.cli.modelfile.errors import ModelFileError
from beamfem.cli.modelfile.lines import Path as KeyPath
from beamfem.errors import InputError
from beamfem.validation import nearest

Kinds = Mapping[str, Callable[..., Any]]
Reader = Callable[["Table", str], Any]  # takes a table and one of its keys


@dataclass(frozen=True)
class Source:
    """The file that is read, the line of each of its keys, and its Python code."""

    file: Path
    lines: Mapping[KeyPath, int]
    code: Code | None = None

    def error(self, path: KeyPath, message: str) -> ModelFileError:
        """Return the error of a key; for a missing key, with the line of the table that should contain it."""
        prefix = path
        while prefix and prefix not in self.lines:
            prefix = prefix[:-1]
        return ModelFileError(message, self.file, self.lines.get(prefix), written(path) or None)


@dataclass(frozen=True)
class Table:
    """A table with its place in the file."""

    source: Source
    path: KeyPath
    values: Mapping[Any, Any]

    def error(self, message: str, key: str | None = None) -> ModelFileError:
        """Return the error of the table, or of one of its keys."""
        return self.source.error(self.path if key is None else (*self.path, key), message)

    def refused(self, error: InputError) -> ModelFileError:
        """Return an error of the library as an error of the key that it names first, or of the table."""
        if isinstance(error, ModelFileError):
            return error
        named = {key: re.search(rf"\b{re.escape(key)}\b", str(error)) for key in self.values}
        places = {key: match.start() for key, match in named.items() if match}
        return self.error(str(error), min(places, key=lambda key: places[key]) if places else None)

    def table(self, key: str) -> "Table":
        """Return the table at a key. Raises ModelFileError for any other value."""
        return self.sub(self.values[key], key)

    def sub(self, value: Any, *path: str | int) -> "Table":
        """Return a value below this table as a Table. Raises ModelFileError if it is not a table."""
        if not isinstance(value, dict):
            headed = f", headed [{path[0]}]" if not self.path and len(path) == 1 else ""
            raise self.source.error((*self.path, *path), f"must be a table{headed}, got {shown(value)}")
        return Table(self.source, (*self.path, *path), value)

    def tables(self, key: str) -> list["Table"]:
        """Return the array of tables at a key, empty if there is none. Raises ModelFileError."""
        values = self.values.get(key, [])
        if not isinstance(values, list):
            raise self.error(f"must be an array of tables, each headed [[{key}]], got {shown(values)}", key)
        return [self.sub(value, key, i) for i, value in enumerate(values)]

    def items(self, key: str) -> list[tuple["Table", Any]]:
        """Return each item of the array at a key as a table and the key in it. Raises ModelFileError."""
        values = self.values[key]
        if not isinstance(values, list):
            raise self.error(f"must be an array, got {shown(values)}", key)
        return [(Table(self.source, (*self.path, key), {i: value}), i) for i, value in enumerate(values)]

    def named(self, key: str) -> dict[str, "Table"]:
        """Return the tables [key.name] by name. Raises ModelFileError."""
        if key not in self.values:
            return {}
        values = self.values[key]
        if not isinstance(values, dict):
            raise self.error(f"must be tables with a name, each headed [{key}.NAME], got {shown(values)}", key)
        subtable = self.table(key)
        return {name: subtable.table(name) for name in subtable.values}

    def text(self, key: str) -> str:
        """Return the text at a key. Raises ModelFileError for any other value."""
        value = self.values[key]
        if not isinstance(value, str):
            raise self.error(f"must be a text, got {shown(value)}", key)
        return value

    def require_known(self, names: Iterable[str]) -> None:
        """Raise ModelFileError for the first key that is not one of these names."""
        names = list(names)
        for key in self.values:
            if key not in names:
                raise self.error(f"unknown key; {nearest(key, names)}", key)


def build(table: Table, make: Callable[..., Any], readers: Mapping[str, Reader] | None = None) -> Any:
    """Return what `make` makes of a table; its parameters are the keys except `kind`.

    readers: readers of the values of some keys; the others are taken unchanged. Raises ModelFileError.
    """
    parameters = inspect.signature(make).parameters
    hints = typing.get_type_hints(make)
    table.require_known([*(["kind"] if "kind" in table.values else []), *parameters])
    arguments = {}
    for name, parameter in parameters.items():
        if name not in table.values:
            if parameter.default is parameter.empty:
                raise table.error(f"the key {name} is missing; needed are {_needed(parameters)}")
        elif readers and name in readers:
            arguments[name] = readers[name](table, name)
        else:
            arguments[name] = _plain(table, name, hints.get(name))
    try:
        return make(**arguments)
    except InputError as error:
        raise table.refused(error) from None


def build_kind(table: Table, kinds: Kinds, readers: Mapping[str, Reader], default: str | None = None) -> Any:
    """Return the part that a table describes by its `kind`, or by the default kind. Raises ModelFileError."""
    if "kind" not in table.values:
        if default is not None:
            return build(table, kinds[default], readers)
        raise table.error(f"the key kind is missing; it is one of {', '.join(kinds)}")
    kind = table.text("kind")
    if kind not in kinds:
        raise table.error(f"there is no kind {kind!r}; {nearest(kind, kinds)}", "kind")
    return build(table, kinds[kind], readers)


def in_braces(kind: str, make: Callable[..., Any]) -> str:
    """Return the table of a kind with the keys that it needs, as it is written in the place of a name."""
    needed = [each.name for each in inspect.signature(make).parameters.values() if each.default is each.empty]
    return f'{{ kind = "{kind}"{"".join(f", {name} = ..." for name in needed)} }}'


def shown(value: Any) -> str:
    """Return a value as written in the file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'the text "{value}"'
    if isinstance(value, dict):
        return "a table"
    return f"the array {value}" if isinstance(value, list) else str(value)


def _plain(table: Table, key: str, hint: Any) -> Any:
    """Return a value unchanged. Raises ModelFileError for a boolean in place of another type, and the reverse."""
    value = table.values[key]
    if hint in (float, int, float | None) and isinstance(value, bool | dict | list | str):
        raise table.error(f"must be a number, got {shown(value)}", key)
    if isinstance(value, bool) != (hint is bool):
        expected = "true or false" if hint is bool else "a number, an array or a text"
        raise table.error(f"must be {expected}, got {shown(value)}", key)
    return value


def _needed(parameters: Mapping[str, inspect.Parameter]) -> str:
    return ", ".join(name for name, parameter in parameters.items() if parameter.default is parameter.empty)


def written(path: KeyPath) -> str:
    """Return a path as text; items of an array are counted from 1."""
    text = ""
    for part in path:
        text += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if text else part
    return text
