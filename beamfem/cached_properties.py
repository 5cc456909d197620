"""Properties that are computed once for each object."""

import functools
from typing import Any, Self, TypeVar, overload

_Value = TypeVar("_Value", covariant=True)


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
