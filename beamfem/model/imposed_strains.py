"""Imposed strains of a beam: actuation and heat, as strains of its stress-free state."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.coordinates import ShearFree
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.model.load import Amplitude, ImposedStrain
from beamfem.section.thermal import expands_evenly, thermal_strain

Along = float | Callable[[float], float]


@dataclass(frozen=True)
class Actuation(ImposedStrain):
    """Imposed curvature [1/m], stretch [-] and shear [-] of the stress-free state: muscles, growth, swelling.

    Each is a number or a function of the arc length [m] from the start; elements end at its `kinks` (declared, or jumps
    that are found). Resultants follow from the difference, s = C (eps - eps0 - amplitude * actuation); a positive
    curvature turns the beam to the left from start to end. Raises InputError.
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
        super().__post_init__()
        require_followed(self)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return stretch, shear, curvature [1/m] and thickness stretch (n, 4) where nothing hinders them."""
        found = [self.values_of(name, arc_length) for name in ("stretch", "shear", "curvature")]
        return np.column_stack([*found, np.zeros(len(arc_length))])


@dataclass(frozen=True)
class Temperature(ImposedStrain):
    """Temperature: a change [K] on the axis of a beam, and a gradient [K/m] over the section, towards +y.

    Both are numbers or functions of the arc length [m] from the start, as in `Actuation`. An unconstrained section of
    one material stretches by alpha * change and bends by -alpha * gradient, with its `thermal_expansion` alpha; layers
    balance each other. The thickness does not expand at nodes that keep it constant. Raises InputError.
    """

    along: ClassVar[tuple[str, ...]] = ("change", "gradient")
    units: ClassVar[tuple[str, ...]] = ("K", "K/m")

    beam: Beam
    change: Along
    gradient: Along = 0.0
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
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
        require_followed(self)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return stretch, shear, curvature [1/m] and thickness stretch (n, 4) where nothing hinders them."""
        beam, heat = self.beam, self.heat(arc_length)
        if beam.prismatic:
            unit = thermal_strain(beam.section_at(0.0), beam.material)[None]
        else:
            unit = np.array([thermal_strain(beam.section_at(s), beam.material) for s in arc_length.tolist()])
        stretch, curvature, thickness = (unit @ heat[:, :, None])[:, :, 0].T
        return np.column_stack([stretch, np.zeros(len(arc_length)), curvature, thickness])

    def heat(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the change of temperature [K] and its gradient [K/m] (n, 2) at arc lengths (n,) [m]."""
        return np.column_stack([self.values_of(name, arc_length) for name in self.along])


def _places(beam: Beam) -> np.ndarray:
    """Arc lengths (3,) [m] at which values that depend on the place are checked."""
    return np.array([0.0, 0.5, 1.0]) * beam.curve.length


def require_followed(load: ImposedStrain) -> None:
    """Raise InputError if the nodes cannot take the imposed strains."""
    coordinates, name = load.beam.element.coordinates, load.beam.element.name
    if not isinstance(coordinates, ShearFree):
        return
    stretch, shear, *_ = load.free_strain(_places(load.beam)).T
    if shear.any():
        raise InputError(f"{type(load).__name__}: nodes of {name} do not shear; take another element")
    if stretch.any() and not coordinates.stretchable:
        raise InputError(f"{type(load).__name__}: nodes of {name} do not stretch; let them")
