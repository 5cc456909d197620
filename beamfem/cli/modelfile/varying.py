"""Sections of a model file that vary along a beam: their numbers may be functions of the arc length."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any

from beamfem.model.time_functions import kinks_of


@dataclass(frozen=True)
class Varying:
    """A section, or a layer, as a function of arc length [m], made of numbers and functions. Raises InputError."""

    make: Callable[..., Any]
    given: Mapping[str, Any]

    def __post_init__(self) -> None:
        self(0.0)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Arc lengths [m] of the kinks of all functions."""
        return _kinks(self.given.values())

    def __call__(self, arc_length: float) -> Any:
        return self.make(**{key: _at(value, arc_length) for key, value in self.given.items()})


@dataclass(frozen=True)
class VaryingList:
    """Layers, some of which vary along the beam."""

    items: Sequence[Any]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Arc lengths [m] of the kinks of all of them."""
        return _kinks(self.items)

    def __call__(self, arc_length: float) -> list[Any]:
        return [_at(item, arc_length) for item in self.items]


def varying(make: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that makes a section of numbers, or one that varies along the beam if functions are given."""

    @wraps(make)
    def made(**given: Any) -> Any:
        return Varying(make, given) if any(callable(value) for value in given.values()) else make(**given)

    return made


def _at(value: Any, arc_length: float) -> Any:
    return value(arc_length) if callable(value) else value


def _kinks(values: Iterable[Any]) -> tuple[float, ...]:
    return tuple(sorted({kink for value in values for kink in kinks_of(value)}))
