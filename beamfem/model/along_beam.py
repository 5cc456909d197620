"""Common part of loads along beams: values that may be functions of the arc length."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, Protocol

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.model.jumps import find_jumps
from beamfem.validation import called, function_of_one, number_table, shown


class _Varying(Protocol):
    @property
    def along(self) -> tuple[str, ...]: ...


class AlongBeam(ABC):
    """A load along a beam; `along`: names of the fields that may be functions of the arc length [m] from the start."""

    along: ClassVar[tuple[str, ...]] = ()
    units: ClassVar[tuple[str, ...]] = ()  # of these fields, if stated

    beam: Beam

    @property
    def place(self) -> Beam:
        """The beam."""
        return self.beam

    @cached_property
    def kinks_along(self) -> dict[str, tuple[float, ...]]:
        """Arc lengths (nj,) [m] at which each function of the arc length jumps, or declares kinks."""
        return {name: _kinks_along(self, name) for name in functions_along(self)}

    @abstractmethod
    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values (n, ...) of the field `name` at arc lengths (n,) [m].

        Raises InputError if a function does not return finite numbers.
        """


def functions_along(load: _Varying) -> dict[str, Callable[[float], Any]]:
    """Return the fields of a load that are functions of the arc length, none for a load at a point or on all mass."""
    fields = {name: getattr(load, name) for name in load.along}
    return {name: value for name, value in fields.items() if callable(value)}


def _kinks_along(load: AlongBeam, name: str) -> tuple[float, ...]:
    beam = load.beam

    def numbers(arc_length: float) -> np.ndarray:
        return load.values_of(name, np.array([arc_length])).ravel()

    return find_jumps(f"{name} of {type(load).__name__}", getattr(load, name), numbers, beam.curve.length, beam.samples)


def jumps_along(load: AlongBeam) -> tuple[float, ...]:
    """Return the arc lengths [m] at which a load, or the section of its beam, jumps or has a declared kink."""
    return (*load.beam.jumps, *(kink for group in load.kinks_along.values() for kink in group))


def require_names(load: AlongBeam) -> None:
    """Raise InputError unless `along` is a tuple of names of the load's fields."""
    kind = type(load).__name__
    if not isinstance(load.along, tuple):
        raise InputError(f'along of {kind} must be a tuple of names, such as ("size",), got {shown(load.along)}')
    for name in load.along:
        if not isinstance(name, str) or not hasattr(load, name):
            raise InputError(f"along of {kind} names {shown(name)}, which is none of its fields")


def check_along(load: AlongBeam) -> None:
    """Raise InputError for invalid functions of the arc length."""
    kind = type(load).__name__
    require_names(load)
    for name, function in functions_along(load).items():
        function_of_one(f"{name} of {kind}", function, "arc length")
        load.values_of(name, ends_and_middle(load.beam))


def ends_and_middle(beam: Beam) -> np.ndarray:
    """Return the arc lengths (3,) [m] at which values that vary along a beam are checked."""
    return np.array([0.0, 0.5, 1.0]) * beam.curve.length


def values_along(
    load: object, member: str, function: Callable[[np.ndarray], np.ndarray], arc_length: np.ndarray, columns: int
) -> np.ndarray:
    """Return the values (n, columns) of a member of a load at arc lengths (n,) [m]. Raises InputError for others."""
    what = f"{member} of {type(load).__name__}"
    table = number_table(what, called(what, function, arc_length), columns)
    if len(table) != len(arc_length):
        raise InputError(
            f"{what} must have a row for each of the {len(arc_length)} requested arc lengths, got {len(table)} rows"
        )
    return table
