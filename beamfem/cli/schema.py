"""Tables of model files, read by the type hints of what they describe.

The parameters of a class or function are the keys of its table; pydantic checks their values. Points, beams and named
parts are found by name in the `Names` of the file, the context of pydantic.
"""

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass
from difflib import get_close_matches
from types import NoneType, UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from pydantic import BaseModel, ConfigDict, PlainValidator, Strict, ValidationError, ValidationInfo, create_model

from beamfem.errors import BeamfemError, InputError
from beamfem.model.beam import Beam, Point
from beamfem.validation import nearest, require_known
from beamfem.validation import shown as in_python

Kinds = Mapping[str, Callable[..., Any]]
Made = TypeVar("Made")

_POINT = re.compile(
    r"(?P<beam>.+?)\.(?:(?P<end>start|end)|at\(\s*(?P<fraction>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*\))"
)
_NO_KEYS = ("self", "model", "asked", "path")  # parameters that are no keys
_RULES = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "bool_type": "true or false",
    "string_type": "a text",
    "list_type": "an array",
}


class KeyFault(ValueError):
    """A wrong value in a table, with its path below the table that is read."""

    def __init__(self, message: str, *path: str | int) -> None:
        super().__init__(message)
        self.message, self.path = message, path

    @classmethod
    def of(cls, error: "KeyFault | BeamfemError", *path: str | int) -> "KeyFault":
        """Return an error as that of the key at a path."""
        return cls(str(error), *path, *(error.path if isinstance(error, KeyFault) else ()))


@dataclass
class Names:
    """Parts of a model file by name; types: readers of values for pydantic, by type hint."""

    types: Mapping[Any, Any]
    parts: dict[str, dict[str, Any]] = field(default_factory=dict)  # by section: materials, sections ...
    beams: dict[str, Beam] = field(default_factory=dict)
    schemas: dict[Callable[..., Any], type[BaseModel]] = field(default_factory=dict)

    def beam(self, name: Any) -> Beam:
        """Return the beam of a name. Raises InputError."""
        require_known(f"there is no beam {name!r}", name, self.beams)
        return self.beams[name]

    def point(self, text: Any) -> Point:
        """Return the point NAME.start, NAME.end or NAME.at(fraction). Raises InputError."""
        match = _POINT.fullmatch(text) if isinstance(text, str) else None
        if match is None:
            prefix = str(text).partition(".")[0]
            name = prefix if prefix in self.beams else next(iter(self.beams), "NAME")
            such = f'"{name}.start", "{name}.end" or "{name}.at(0.5)"'
            raise InputError(f"must be a point such as {such}, got {shown(text)}")
        require_known(f"there is no beam {match['beam']!r}", match["beam"], self.beams)
        fraction = float(match["fraction"]) if match["fraction"] else float(match["end"] == "end")
        return Point(self.beams[match["beam"]], fraction)

    def points(self, places: Any) -> list[Point]:
        """Return the points of a list, or a list of one point. Raises InputError."""
        return [self.point(place) for place in (places if isinstance(places, list) else [places])]


def part(kinds: Kinds, table: Any, names: Names, default: str | None = None) -> Any:
    """Return the part that a table describes by its `kind`. Raises KeyFault."""
    require_table(table)
    kind = table.get("kind", default or (next(iter(kinds)) if len(kinds) == 1 else None))
    if kind is None:
        raise KeyFault(f"the key kind is missing; it is one of {', '.join(kinds)}")
    if not isinstance(kind, str):
        raise KeyFault(f"must be a text, got {shown(kind)}", "kind")
    if kind not in kinds:
        raise KeyFault(f"there is no kind {kind!r}; {nearest(kind, kinds)}", "kind")
    return build(kinds[kind], {key: value for key, value in table.items() if key != "kind"}, names)


def build(make: Callable[..., Made], table: Any, names: Names) -> Made:
    """Return what `make` makes of the keys of a table. Raises KeyFault."""
    require_table(table)
    schema = names.schemas.get(make) or names.schemas.setdefault(make, _schema(make, names.types))
    try:
        given = schema.model_validate(table, context=names)
    except ValidationError as error:
        raise _fault(error, schema) from None
    try:
        return make(**{key: getattr(given, key) for key in schema.model_fields if key in given.model_fields_set})
    except InputError as error:
        raise KeyFault.of(error, *named_first(str(error), table)) from None


def named_first(message: str, table: Mapping[str, Any]) -> list[str]:
    """Return the key of a table that a message names first, in a list that is empty if there is none."""
    places = {key: match.start() for key in table if (match := re.search(rf"\b{re.escape(key)}\b", message))}
    return sorted(places, key=lambda key: places[key])[:1]


def _schema(make: Callable[..., Any], types: Mapping[Any, Any]) -> type[BaseModel]:
    """Return a pydantic model whose fields are the parameters of a class or function."""
    hints = get_type_hints(make, include_extras=True)
    parameters = {key: item for key, item in inspect.signature(make).parameters.items() if key not in _NO_KEYS}
    fields: Any = {
        key: (_type(hints.get(key, item.annotation), types), ... if item.default is item.empty else item.default)
        for key, item in parameters.items()
    }
    return create_model("Table", __config__=ConfigDict(extra="forbid", arbitrary_types_allowed=True), **fields)


def _type(hint: Any, types: Mapping[Any, Any]) -> Any:
    """Return the type with which pydantic checks a value in a model file."""
    if get_origin(hint) is Annotated:
        return hint
    if hint is inspect.Parameter.empty:
        return Any
    if hint in types:
        return types[hint]
    union = get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)
    options = [option for option in union if option not in (NoneType, np.ndarray)]
    for option in reversed(options):
        if option in types:
            return types[option]
    described: Any = next(filter(is_dataclass, options), None)
    if described is not None:
        return reader(lambda value, names: build(described, value, names))
    origins = [get_origin(option) or option for option in options]
    if Callable in origins:
        return types["number" if float in origins else "vector" if tuple in origins else "function"]
    hint = options[0]
    if get_origin(hint) is tuple and Ellipsis not in get_args(hint):
        return Any  # the library checks vectors
    if get_origin(hint) in (tuple, list, Sequence):
        return list[_type(get_args(hint)[0], types)]  # type: ignore[misc]
    return Annotated[hint, Strict()] if hint in (float, int, bool, str) else hint


def with_keys(make: Callable[..., Any], sources: Sequence[Callable[..., Any]], **hints: Any) -> Callable[..., Any]:
    """Return a function whose keys are the parameters of others.

    hints: types of further keys, None for parameters that are left out.
    """
    key_only = inspect.Parameter.KEYWORD_ONLY

    def made(**keys: Any) -> Any:
        return make(keys)

    found = {key: item for source in sources for key, item in inspect.signature(source).parameters.items()}
    own = {key: inspect.Parameter(key, key_only, default=None) for key in hints}
    kept = {key: item for key, item in (found | own).items() if hints.get(key, make) is not None}
    types = {key: hint for source in sources for key, hint in get_type_hints(source).items()} | hints
    parameters = [item.replace(kind=key_only) for item in kept.values()]
    made.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    made.__annotations__ = {key: types.get(key, item.annotation) for key, item in kept.items()}
    return made


def reader(read: Callable[[Any, Names], Any]) -> Any:
    """Return a type whose values a function reads."""

    def validate(value: Any, info: ValidationInfo) -> Any:
        names: Any = info.context
        return read(value, names)

    return Annotated[Any, PlainValidator(validate)]


def named(section: str, kinds: Kinds) -> Callable[[Any, Names], Any]:
    """Return what reads a part: its name in a section of the file, a table, or a kind that needs no other key."""
    single = section.removesuffix("s")
    article = "an" if single[0] in "aeiou" else "a"
    short = [kind for kind, make in kinds.items() if not _needed(make)]

    def read(value: Any, names: Names) -> Any:
        if isinstance(value, dict):
            return part(kinds, value, names)
        if not isinstance(value, str):
            raise InputError(f"must be the name of {article} {single}, or a table, got {shown(value)}")
        known = names.parts.get(section, {})
        if value in known:
            return known[value]
        if value in short:
            return part(kinds, {"kind": value}, names)
        if value in kinds:
            raise InputError(f"the kind {value!r} needs further keys: {in_braces(value, kinds[value])}")
        listed = [*known, *short]
        hint = nearest(value, listed) if listed else f"the file has none; they are headed [{section}.NAME]"
        raise InputError(f"there is no {single} {value!r}; {hint}")

    return read


def require_table(value: Any) -> None:
    """Raise KeyFault for a value that is no table."""
    if not isinstance(value, dict):
        raise KeyFault(f"must be a table, got {shown(value)}")


def _needed(make: Callable[..., Any]) -> list[str]:
    parameters = inspect.signature(make).parameters.values()
    return [item.name for item in parameters if item.default is item.empty and item.name not in _NO_KEYS]


def in_braces(kind: str, make: Callable[..., Any]) -> str:
    return f'{{ kind = "{kind}"{"".join(f", {name} = ..." for name in _needed(make))} }}'


def _fault(error: ValidationError, schema: type[BaseModel]) -> KeyFault:
    """Return the first error that pydantic found."""
    first = min(error.errors(), key=lambda item: item["type"] == "missing")
    path, given = first["loc"], first["input"]
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, KeyFault | InputError):
        return KeyFault.of(cause, *path)
    if first["type"] == "missing":
        needed = [name for name, info in schema.model_fields.items() if info.is_required()]
        return KeyFault(f"the key {path[-1]} is missing; needed are {', '.join(needed)}", *path[:-1])
    if first["type"] == "extra_forbidden":
        return KeyFault(f"unknown key; {nearest(path[-1], schema.model_fields)}", *path)
    if first["type"] == "literal_error":
        rule = first["ctx"]["expected"].replace("'", '"')
        near = get_close_matches(str(given), re.findall(r'"(.*?)"', rule), 1)
        hint = f"; did you mean {near[0]}?" if near else ""
        return KeyFault(f"must be {rule}, got {shown(given)}{hint}", *path)
    return KeyFault(f"must be {_RULES.get(first['type'], first['msg'])}, got {shown(given)}", *path)


def shown(value: Any) -> str:
    """Return a value as written in the file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'the text "{value}"'
    if isinstance(value, dict):
        return "a table"
    return f"the array {in_python(value)}" if isinstance(value, list) else in_python(value)
