"""Properties, and functions of an object, that are computed once for each object, or once for all that are alike."""

import functools
from collections.abc import Callable
from typing import Any, Self, TypeVar, overload

_Value = TypeVar("_Value", covariant=True)
_Owner = TypeVar("_Owner")
_Found = TypeVar("_Found")


class cached_property(functools.cached_property[_Value]):
    """`functools.cached_property` without the lock of Python 3.11, which takes longer than many of the properties.

    Where two threads compute a value at once, both get the same one.
    """

    @overload
    def __get__(self, instance: None, owner: type[Any] | None = None) -> Self: ...

    @overload
    def __get__(self, instance: object, owner: type[Any] | None = None) -> _Value: ...

    def __get__(self, instance: object | None, owner: type[Any] | None = None) -> Self | _Value:
        if instance is None:
            return self
        value: _Value = instance.__dict__.setdefault(str(self.attrname), self.func(instance))
        return value


def kept_with(function: Callable[[_Owner], _Found]) -> Callable[[_Owner], _Found]:
    """Return a function of one object that keeps its value with the object, under its name with an underscore."""
    name = f"_{function.__name__.lstrip('_')}"

    @functools.wraps(function)
    def kept(owner: _Owner) -> _Found:
        values: dict[str, _Found] = vars(owner)
        if name not in values:
            values[name] = function(owner)
        return values[name]

    return kept
