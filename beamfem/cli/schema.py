"""Tables of model files, read by the type hints of what they describe.

The parameters of a class or function are the keys of its table; pydantic checks their values. Points, beams and named
parts are found by name in the `Names` of the file, the context of pydantic.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, is_dataclass
from difflib import get_close_matches
from functools import partial
from inspect import signature
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import numpy as np
from pydantic import BaseModel, ConfigDict, PlainValidator, ValidationError, create_model

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.parts.rigid_body import RigidBody
from beamfem.validation import nearest, require_known
from beamfem.validation import shown as in_python

Kinds = Mapping[str, Callable[..., Any]]

_NUMBER = r"\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\s*"
_POINT = re.compile(rf"(?P<beam>.+?)\.(?:(?P<end>start|end)|at\((?P<fraction>{_NUMBER})\))")
_OF_BODY = re.compile(rf"(?P<body>.+?)\.at\((?P<x>{_NUMBER}),(?P<y>{_NUMBER})\)")
_RULES = {
    "float_type": "a number",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "string_type": "a text",
    "list_type": "an array",
    "dict_type": "tables with a name, each headed [{}.NAME]",
}


class KeyFault(ValueError):
    """A wrong value in a table, with its path below the table that is read."""

    def __init__(self, message: str, *path: str | int) -> None:
        super().__init__(message)
        self.path = path


@contextmanager
def fault_at(*path: str | int, table: Iterable[str] = ()) -> Iterator[None]:
    """Raise an error inside as the KeyFault of the value at a path; in a table, of the key that it names first."""
    try:
        yield
    except KeyFault as fault:
        raise KeyFault(str(fault), *path, *fault.path) from fault
    except InputError as error:
        named = [(match.start(), key) for key in table if (match := re.search(rf"\b{re.escape(key)}\b", str(error)))]
        raise KeyFault(str(error), *path, *[key for _, key in sorted(named)[:1]]) from error


@dataclass
class Names:
    """Parts of a model file by section and name; types: readers of values for pydantic, by type hint."""

    types: Mapping[Any, Any]
    parts: dict[str, dict[str, Any]] = field(default_factory=lambda: defaultdict(dict))
    schemas: dict[Callable[..., Any], type[BaseModel]] = field(default_factory=dict)

    def beam(self, name: Any) -> Beam:
        """Return the beam of a name. Raises InputError."""
        require_known(f"there is no beam {name!r}", name, beams := self.parts["beams"])
        return beams[name]

    def point(self, text: Any) -> Point:
        """Return the point NAME.start, NAME.end or NAME.at(fraction), or BODY.at(x, y). Raises InputError.

        Interfaces of a floating body are points of the body.
        """
        bodies = {name: body for name, body in self.parts["bodies"].items() if isinstance(body, RigidBody)}
        if isinstance(text, str) and (match := _OF_BODY.fullmatch(text)):
            name, at = match["body"], (float(match["x"]), float(match["y"]))
            require_known(f"there is no body {name!r} with points at (x, y)", name, bodies)
            return self.parts["points"].setdefault(f"{name} {at}", bodies[name].at(*at))  # one point for each place
        prefix, beams = str(text).partition(".")[0], self.parts["beams"]
        if prefix in bodies and prefix not in beams:
            raise InputError(f'must be a point of a body such as "{prefix}.at(0, 0.1)", got {shown(text)}')
        match = _POINT.fullmatch(text) if isinstance(text, str) else None
        if match is None:
            name = prefix if prefix in beams else next(iter(beams), "NAME")
            raise InputError(
                f'must be a point such as "{name}.start", "{name}.end" or "{name}.at(0.5)", got {shown(text)}'
            )
        fraction = float(match["fraction"] or match["end"] == "end")
        own = self.parts["interfaces"].get(match["beam"])
        if own is None:
            return Point(self.beam(match["beam"]), fraction)
        if fraction not in own:
            raise InputError(
                f"the beam {match['beam']!r} is part of a floating body, which has points at interfaces only"
            )
        return own[fraction]


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


def build(make: Callable[..., Any], table: Any, names: Names, **given: Any) -> Any:
    """Return what `make` makes of the keys of a table, and of arguments that are no keys. Raises KeyFault."""
    require_table(table)
    schema = names.schemas.get(make)
    if schema is None:
        fields: Any = {
            key: (_type(hint, names.types), item) for key, (hint, item) in keys_of(make).items() if key not in given
        }
        config = ConfigDict(extra="forbid", strict=True, arbitrary_types_allowed=True)
        schema = names.schemas[make] = create_model("Table", __config__=config, **fields)
    try:
        read = schema.model_validate(table, context=names)
    except ValidationError as error:
        raise _fault(error, schema) from None
    with fault_at(table=table):
        return make(**given, **{key: getattr(read, key) for key in schema.model_fields if key in read.model_fields_set})


@dataclass(frozen=True, eq=False)
class Keyed:
    """A function with the types and defaults of its keys."""

    make: Callable[..., Any]
    keys: dict[str, tuple[Any, Any]]

    def __call__(self, **values: Any) -> Any:
        return self.make(**values)


def keys_of(make: Callable[..., Any]) -> dict[str, tuple[Any, Any]]:
    """Return the types and defaults of the parameters of a class or function; ... where there is no default."""
    if isinstance(make, Keyed):
        return make.keys
    hints, parameters = get_type_hints(make, include_extras=True), signature(make).parameters.items()
    return {key: (hints.get(key, Any), ... if item.default is item.empty else item.default) for key, item in parameters}


def _type(hint: Any, types: Mapping[Any, Any]) -> Any:
    """Return the type with which pydantic checks a value in a model file."""
    if get_origin(hint) is Annotated:
        return hint
    union = get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)
    options = [option for option in union if option not in (NoneType, np.ndarray)]
    for known in filter(types.__contains__, (hint, *reversed(options))):
        return types[known]
    described: Any = next(filter(is_dataclass, options), None)
    if described is not None:
        return reader(partial(build, described))
    origins = [get_origin(option) or option for option in options]
    if Callable in origins:
        return types["number" if float in origins else "vector" if tuple in origins else "function"]
    if origins[0] is tuple and Ellipsis not in get_args(options[0]):
        return Any  # the library checks vectors
    return list[_type(get_args(options[0])[0], types)] if origins[0] in (tuple, list, Sequence) else options[0]  # type: ignore[misc]


def reader(read: Callable[[Any, Any], Any]) -> Any:
    """Return a type whose values a function reads, with the `Names` of the file."""
    return Annotated[Any, PlainValidator(lambda value, info: read(value, info.context))]


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
        known = names.parts[section]
        if value in known or value in short:
            return known[value] if value in known else kinds[value]()
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
    return [key for key, (_, default) in keys_of(make).items() if default is ...]


def in_braces(kind: str, make: Callable[..., Any]) -> str:
    return f'{{ kind = "{kind}"{"".join(f", {name} = ..." for name in _needed(make))} }}'


def _fault(error: ValidationError, schema: type[BaseModel]) -> KeyFault:
    """Return the first error that pydantic found."""
    first = min(error.errors(), key=lambda item: {"extra_forbidden": 0, "missing": 2}.get(item["type"], 1))
    path, given = first["loc"], first["input"]
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, KeyFault | InputError):
        return KeyFault(str(cause), *path, *getattr(cause, "path", ()))
    if first["type"] == "missing":
        needed = [name for name, info in schema.model_fields.items() if info.is_required()]
        return KeyFault(f"the key {path[-1]} is missing; needed are {', '.join(needed)}", *path[:-1])
    if first["type"] == "extra_forbidden":
        return KeyFault(f"unknown key; {nearest(path[-1], schema.model_fields)}", *path)
    rule, hint = _RULES.get(first["type"], first["msg"]).replace("{}", str(path[-1])), ""
    if first["type"] == "literal_error":
        rule = first["ctx"]["expected"].replace("'", '"')
        near = get_close_matches(str(given), re.findall(r'"(.*?)"', rule), 1)
        hint = f"; did you mean {near[0]}?" if near else ""
    return KeyFault(f"must be {rule}, got {shown(given)}{hint}", *path)


def shown(value: Any) -> str:
    """Return a value as written in the file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'the text "{value}"'
    if isinstance(value, dict):
        return "a table"
    return f"the array {in_python(value)}" if isinstance(value, list) else in_python(value)
