"""Imposed strains of a beam, as strains of its stress-free state: the base class."""

from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

import numpy as np

from beamfem.element.coordinates import ShearFree
from beamfem.errors import InputError
from beamfem.model.along_beam import AlongBeam, check_along, ends_and_middle, require_names, values_along
from beamfem.model.beam import require_beam
from beamfem.model.load_base import Load
from beamfem.model.load_shapes import LoadShape, Strains
from beamfem.model.state_protocols import Placed
from beamfem.validation import called, convert, finite, squared

Along = float | Callable[[float], float]


class ImposedStrain(AlongBeam, Load):
    """Strains of the stress-free state of a beam; each field named in `along` is a number or a function.

    along: names of the fields that may be functions of the arc length [m] from the start; units: their units.
    """

    units: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        require_names(self)
        convert(self, squared(finite), *(name for name in self.along if not callable(getattr(self, name))))
        check_along(self)
        super().__post_init__()

    @abstractmethod
    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the strains (n, 4) of the unconstrained beam at arc lengths (n,) [m].

        They are stretch [-], shear [-], curvature [1/m] and thickness stretch [-].
        """

    def heat(self, arc_length: np.ndarray) -> np.ndarray:
        """Return temperature on the axis [K] and its gradient over the section [K/m] (n, 2); zero unless overridden.

        Each layer of a section expands with its own coefficient.
        """
        return np.zeros((len(arc_length), 2))

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        value, what = getattr(self, name), f"{name} of {type(self).__name__}"
        if not callable(value):
            return np.full(len(arc_length), value)
        return np.array([finite(f"{what} at arc length {s:g}", called(what, value, s)) for s in arc_length.tolist()])

    @property
    def conservative(self) -> bool:
        return True

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        values: dict[str, tuple[float | None, str]] = {}
        for name, unit in zip(self.along, self.units, strict=True):
            value = getattr(self, name)
            if callable(value):
                values[name] = None, unit
            elif value:
                values[name] = weight * value, unit
        return (Strains(self.beam, type(self).__name__.lower(), values),)

    def require_valid(self) -> None:
        super().require_valid()
        kind = type(self).__name__
        require_beam(kind, getattr(self, "beam", None))
        check_along(self)
        if len(self.units) != len(self.along):
            raise InputError(f"units of {kind} must name a unit for each name of along, {self.along}, got {self.units}")
        at = ends_and_middle(self.beam)
        free_strain_of(self, at)
        heat_of(self, at)
        require_followed(self)


def require_followed(load: ImposedStrain) -> None:
    """Raise InputError if the nodal coordinates cannot represent the imposed strains."""
    coordinates, name = load.beam.element.coordinates, load.beam.element.name
    if not isinstance(coordinates, ShearFree):
        return
    stretch, shear, *_ = load.free_strain(ends_and_middle(load.beam)).T
    if shear.any():
        raise InputError(f"{type(load).__name__}: nodes of {name} do not shear; take another element")
    if stretch.any() and not coordinates.stretchable:
        raise InputError(f"{type(load).__name__}: nodes of {name} do not stretch; let them")


def free_strain_of(load: ImposedStrain, arc_length: np.ndarray) -> np.ndarray:
    """Return the free strains (n, 4) of a load at arc lengths (n,) [m]. Raises InputError for any other result."""
    return values_along(load, "free_strain", load.free_strain, arc_length, 4)


def heat_of(load: ImposedStrain, arc_length: np.ndarray) -> np.ndarray:
    """Return temperature [K] and gradient [K/m] (n, 2) of a load. Raises InputError for any other result."""
    return values_along(load, "heat", load.heat, arc_length, 2)
