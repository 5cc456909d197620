"""What bends and stretches a beam from inside: actuation and heat, as strains of its state without stress."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.coordinates import ShearFree
from beamfem.errors import InputError
from beamfem.model.beam import Beam, require_beam
from beamfem.model.load import Amplitude, check_along, check_common
from beamfem.model.shapes import LoadShape, Placed, Strains
from beamfem.section.thermal import expands_evenly, thermal_strain
from beamfem.validation import called, convert, finite, squared

Along = float | Callable[[float], float]


@dataclass(frozen=True)
class Actuation:
    """Curvature [1/m], stretch [-] and shear [-] that a beam takes where nothing hinders it: muscles, growth, swelling.

    Each is a number or a function of the arc length [m] from the start, at whose `kinks` (declared, or jumps that are
    found) elements end. Resultants are those of the strains less these, s = C (eps - eps0 - amplitude * actuation); a
    positive curvature turns the beam to the left on its way from start to end. Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("curvature", "stretch", "shear")
    units: ClassVar[tuple[str, ...]] = ("1/m", "", "")

    beam: Beam
    curvature: Along = 0.0
    stretch: Along = 0.0
    shear: Along = 0.0
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        _check(self)
        _require_followed(self)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return curvature, stretch or shear at arc lengths (n,) [m]. Raises InputError where a function gives none."""
        return _along(self, name, arc_length)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state."""
        return (_strains(self, weight),)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return stretch, shear, curvature [1/m] and thickness stretch (n, 4) where nothing hinders them."""
        found = [self.values_of(name, arc_length) for name in ("stretch", "shear", "curvature")]
        return np.column_stack([*found, np.zeros(len(arc_length))])


@dataclass(frozen=True)
class Temperature:
    """Heat: a change of temperature [K] on the axis of a beam and its gradient [K/m] over the section, towards +y.

    Both are numbers or functions of the arc length [m] from the start, as in `Actuation`. A free section of one
    material stretches by alpha * change and bends by -alpha * gradient, alpha its `thermal_expansion`; layers as they
    balance each other. What its nodes keep at its thickness does not expand there. Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("change", "gradient")
    units: ClassVar[tuple[str, ...]] = ("K", "K/m")

    beam: Beam
    change: Along
    gradient: Along = 0.0
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        _check(self)
        beam = self.beam
        sections = [beam.section_at(s) for s in _places(beam).tolist()]
        if not any(thermal_strain(section, beam.material).any() for section in sections):
            raise InputError(
                "Temperature changes nothing: give a material of its beam a coefficient of thermal expansion, "
                "Material(..., thermal_expansion=1.2e-5)"
            )
        evenly = all(expands_evenly(section, beam.material) for section in sections)
        if not evenly and (beam.element.forces.fills_body or beam.law is not None):
            raise InputError(
                "Temperature of layers that expand differently needs Structural() or ElasticLine() forces and a linear "
                f"section, got {beam.element.forces.name} forces"
            )
        _require_followed(self)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return change or gradient at arc lengths (n,) [m]. Raises InputError where a function gives none."""
        return _along(self, name, arc_length)

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return what it looks like, times a weight, in a state."""
        return (_strains(self, weight),)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return stretch, shear, curvature [1/m] and thickness stretch (n, 4) where nothing hinders them."""
        beam, heat = self.beam, np.column_stack([self.values_of(name, arc_length) for name in self.along])
        if beam.prismatic:
            unit = thermal_strain(beam.section_at(0.0), beam.material)[None]
        else:
            unit = np.array([thermal_strain(beam.section_at(s), beam.material) for s in arc_length.tolist()])
        stretch, curvature, thickness = (unit @ heat[:, :, None])[:, :, 0].T
        return np.column_stack([stretch, np.zeros(len(arc_length)), curvature, thickness])


def _check(load: Actuation | Temperature) -> None:
    require_beam(type(load).__name__, load.beam)
    constant = [name for name in load.along if not callable(getattr(load, name))]
    convert(load, squared(finite), *constant)
    check_along(load)
    check_common(load)


def _places(beam: Beam) -> np.ndarray:
    """Arc lengths (3,) [m] at which what depends on the place is looked at."""
    return np.array([0.0, 0.5, 1.0]) * beam.curve.length


def _require_followed(load: Actuation | Temperature) -> None:
    """Raise InputError where nodes cannot take what they are given."""
    coordinates, name = load.beam.element.coordinates, load.beam.element.name
    if not isinstance(coordinates, ShearFree):
        return
    stretch, shear, *_ = load.free_strain(_places(load.beam)).T
    if shear.any():
        raise InputError(f"{type(load).__name__}: nodes of {name} do not shear; take another element")
    if stretch.any() and not coordinates.stretchable:
        raise InputError(f"{type(load).__name__}: nodes of {name} do not stretch; let them")


def _along(load: Actuation | Temperature, name: str, arc_length: np.ndarray) -> np.ndarray:
    given, what = getattr(load, name), f"{name} of {type(load).__name__}"
    if not callable(given):
        return np.full(len(arc_length), given)
    return np.array([finite(f"{what} at arc length {s:g} m", called(what, given, s)) for s in arc_length.tolist()])


def _strains(load: Actuation | Temperature, weight: float) -> Strains:
    values: dict[str, tuple[float | None, str]] = {}
    for name, unit in zip(load.along, load.units, strict=True):
        value = getattr(load, name)
        if callable(value):
            values[name] = None, unit
        elif value:
            values[name] = weight * value, unit
    return Strains(load.beam, type(load).__name__.lower(), values)
