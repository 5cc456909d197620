"""Keys of sections, materials and parts of elements by value, so that equal ones are found within a model."""

from collections.abc import Hashable
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any


def by_value(item: object) -> Hashable:
    """Return an object as a key of itself: by value, if its class and those of its parts compare all that they hold.

    Unhashable objects, and subclasses that add attributes to a dataclass, are compared by identity.
    """
    try:
        hash(item)
    except TypeError:
        return id(item)
    return item if _compares_all(item) else id(item)


def equal(one: object, other: object) -> bool:
    """Return whether two objects are the same, have equal keys, or are of one class with equal attributes."""
    if one is other or by_value(one) == by_value(other):
        return True
    attributes, other_attributes = getattr(one, "__dict__", None), getattr(other, "__dict__", None)
    return type(one) is type(other) and attributes is not None and bool(attributes) and attributes == other_attributes


def _compares_all(item: Any) -> bool:
    """Return whether the class of a hashable object, and those of its parts, compare all that they hold."""
    kind: Any = type(item)
    if kind in (float, int, str, type(None)):
        return True
    if kind is tuple:
        return all(map(_compares_all, item))
    compared = _compared(kind)
    return compared is not None and all(_compares_all(getattr(item, name)) for name in compared)


@cache  # asked of every beam of a frame
def _compared(kind: type) -> tuple[str, ...] | None:
    """Return the names of the fields that a class is compared by, None if it adds to a dataclass without being one."""
    if not is_dataclass(kind):
        return ()
    return tuple(field.name for field in fields(kind) if field.compare) if "__eq__" in vars(kind) else None
