"""Sections of a model file that vary along a beam: their numbers may be functions of the arc length."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any

from beamfem.model.time_functions import kinks_of
from beamfem.section.protocol import CrossSection


@dataclass(frozen=True)
class Varying:
    """A section of each arc length [m]: made of numbers, and of functions that give them. Raises InputError."""

    make: Callable[..., CrossSection]
    given: Mapping[str, Any]

    def __post_init__(self) -> None:
        self(0.0)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Arc lengths [m] of the kinks of all functions."""
        return tuple(sorted({kink for value in self.given.values() for kink in kinks_of(value)}))

    def __call__(self, arc_length: float) -> CrossSection:
        return self.make(**{key: value(arc_length) if callable(value) else value for key, value in self.given.items()})


def varying(make: Callable[..., CrossSection]) -> Callable[..., CrossSection | Varying]:
    """Return what makes a section of numbers, and of functions one that varies along the beam."""

    @wraps(make)
    def made(**given: Any) -> CrossSection | Varying:
        return Varying(make, given) if any(callable(value) for value in given.values()) else make(**given)

    return made
