"""What a model was made of: objects of a user's own classes, and whether they have changed since."""

from collections.abc import Callable, Collection, Hashable, Iterator
from dataclasses import fields, is_dataclass
from functools import cached_property, lru_cache
from types import BuiltinFunctionType, FunctionType, MethodType, ModuleType
from typing import TYPE_CHECKING, Any, Literal, get_args, get_origin

import numpy as np

from beamfem.alike import lasting, of_package
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.validation import shown

if TYPE_CHECKING:
    from beamfem.model.model import Model

_BY_IDENTITY = (FunctionType, BuiltinFunctionType, MethodType, ModuleType, type, Beam, Point)
Content = dict[str, Hashable]
MadeOf = tuple[tuple[str, Any, Content], ...]


def made_of(model: "Model") -> MadeOf:
    """Return what a model consists of and may change: its place, the object, and the content of its attributes.

    Parts of the package do not change, and what connectors say is asked in every state.
    """
    kinds = set(map(type, (*model.supports, *model.loads, *model.joints)))
    for beam in model.beams:
        element = beam.element
        parts = beam.section, beam.material, beam.curve, element.field, element.coordinates, element.forces
        kinds.update(map(type, parts))
    changing = {kind for kind in kinds if not is_plain(kind)}
    if not changing:
        return ()
    known: dict[int, tuple[str, Any]] = {}
    for name, items in _parts(model):
        known.update((id(item), (name, item)) for item in items if type(item) in changing)
    return tuple((name, item, _attributes(item)) for name, item in known.values() if not _lasts(item))


def require_unchanged(model: "Model") -> None:
    """Raise InputError if an object that a model was made of has changed since: its tables are those of before."""
    for name, item, before in model.made_of:
        now = _attributes(item)
        for attribute, value in before.items():
            if now.get(attribute) != value:
                raise InputError(
                    f"{attribute} of {shown(item)}, the {name}, has changed since the model was made, which keeps what "
                    "it was made of; make a new Model. What an object counts or caches may change in attributes whose "
                    "names begin with an underscore"
                )


def _parts(model: "Model") -> Iterator[tuple[str, Collection[Any]]]:
    beams, elements = model.beams, {id(beam.element): beam.element for beam in model.beams}.values()
    yield "section of a beam", [beam.section for beam in beams]
    yield "material of a beam", [beam.material for beam in beams]
    yield "curve of a beam", [beam.curve for beam in beams]
    yield "field of an element", [element.field for element in elements]
    yield "coordinates of an element", [element.coordinates for element in elements]
    yield "forces of an element", [element.forces for element in elements]
    yield "support of the model", model.supports
    yield "load of the model", model.loads
    yield "joint of the model", model.joints


@lru_cache(maxsize=256)
def is_plain(kind: type) -> bool:
    """Return whether a class of the package holds numbers, text, places on beams and functions only."""
    if not (kind is type(None) or (of_package(kind) and is_dataclass(kind))):
        return False
    return all(_plain_annotation(own.type) for own in fields(kind)) if is_dataclass(kind) else True


def _plain_annotation(annotation: Any) -> bool:
    parts = get_args(annotation)
    if get_origin(annotation) is Literal:
        return True
    if get_origin(annotation) is Callable:
        return True
    if parts:
        return all(_plain_annotation(part) for part in parts if part is not ...)
    return annotation in (float, int, str, bool, type(None), Beam, Point)


def _lasts(item: Any) -> bool:
    return isinstance(item, _BY_IDENTITY) or lasting(item)


def _attributes(item: Any) -> Content:
    """Return the content of the public attributes of an object; those that are computed when asked for are left out."""
    kind = type(item)
    return {
        name: _content(value, ())
        for name, value in getattr(item, "__dict__", {}).items()
        if not name.startswith("_") and not isinstance(getattr(kind, name, None), cached_property)
    }


def _content(value: Any, within: tuple[int, ...]) -> Hashable:
    """Return numbers, text and arrays by value, what holds them by what it holds, and all else by its identity."""
    if isinstance(value, float | int | str | bytes | None):
        return value
    if id(value) in within or isinstance(value, _BY_IDENTITY):
        return id(value)
    within = (*within, id(value))
    if isinstance(value, np.ndarray | np.generic):
        return value.tobytes() if value.dtype != object else tuple(_content(part, within) for part in value.flat)
    if isinstance(value, tuple | list):
        return tuple(_content(part, within) for part in value)
    if isinstance(value, dict):
        return tuple((_content(key, within), _content(part, within)) for key, part in value.items())
    if not hasattr(value, "__dict__"):
        return id(value)
    return id(value), *(
        (name, _content(part, within)) for name, part in vars(value).items() if not name.startswith("_")
    )
