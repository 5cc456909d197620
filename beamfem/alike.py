"""Which sections, materials and parts of elements are alike, in one model and from one model to the next."""

from collections.abc import Hashable, Iterator
from dataclasses import fields, is_dataclass
from functools import lru_cache
from typing import Any

_PLAIN = (float, int, str, type(None))


def by_value(item: object) -> Hashable:
    """Return the item itself, or its identity if comparing it by value does not tell all of it.

    So it is for what has no hash, and for classes that add to a dataclass without being one: two of them are equal by
    what their base knows.
    """
    try:
        hash(item)
    except TypeError:
        return id(item)
    return item if all(_tells_all(type(part)) for part in _parts(item)) else id(item)  # type: ignore[arg-type]


def whole(item: object) -> Hashable:
    """Return the same of what consists of numbers and text only, in less time."""
    return item if _tells_all(type(item)) else id(item)  # type: ignore[arg-type]


def equal(one: object, other: object) -> bool:
    """Return whether two items are equal, with all that they have besides what they are compared by."""
    if one is other or by_value(one) == by_value(other):
        return True
    attributes, other_attributes = getattr(one, "__dict__", None), getattr(other, "__dict__", None)
    return type(one) is type(other) and attributes is not None and bool(attributes) and attributes == other_attributes


def lasting(*items: object) -> bool:
    """Return whether all of these are of the package: what is the user's own may change from one model to the next."""
    for item in items:
        kind: Any = type(item)
        if kind in _PLAIN:
            continue
        if kind is not tuple and not of_package(kind):
            return False
        parts = item if isinstance(item, tuple) else [getattr(item, name) for name in _compared(kind)]
        if parts and not lasting(*parts):
            return False
    return True


def _parts(item: object) -> Iterator[Any]:
    """Return an item and all that it is compared by, but for numbers and text."""
    seen: set[int] = set()
    waiting: list[Any] = [item]
    while waiting:
        part = waiting.pop()
        if isinstance(part, tuple):
            waiting += part
        elif type(part) not in _PLAIN and id(part) not in seen:
            seen.add(id(part))
            yield part
            waiting += [getattr(part, name) for name in _compared(type(part))]  # type: ignore[arg-type]


@lru_cache(maxsize=256)
def _compared(kind: type) -> tuple[str, ...]:
    """Return the names of the fields that a class is compared by, but for those that the package sees to be numbers."""
    if not is_dataclass(kind):
        return ()
    numbers = (float, float | None, tuple[float, float]) if of_package(kind) else ()
    return tuple(field.name for field in fields(kind) if field.compare and field.type not in numbers)


@lru_cache(maxsize=256)
def _tells_all(kind: type) -> bool:
    return kind.__hash__ is not None and (not is_dataclass(kind) or "__eq__" in vars(kind))


@lru_cache(maxsize=256)
def of_package(kind: type) -> bool:
    """Return whether a class is of the package."""
    return kind.__module__.startswith("beamfem.")
