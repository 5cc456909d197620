"""Sections of fibres, each with a stress-strain law."""

from dataclasses import dataclass
from typing import cast

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.quadrature import gauss_between
from beamfem.section.fibre_laws import FibreLaw, FibreLawWithHistory
from beamfem.section.outline import RectangleOutline, StripOutline, TubeOutline
from beamfem.section.protocol import Inertia, Rigidity
from beamfem.section.section_shapes import ShapedSection
from beamfem.validation import fulfils, number_below, shown

_MOST = 1000  # points over the height
_RADII = 2  # circles of fibres in the wall of a tube


@dataclass(frozen=True)
class FibreSection:
    """A section of fibres, see `Fibres`."""

    shape: ShapedSection
    law: FibreLaw | FibreLawWithHistory
    points: int

    @cached_property
    def fibres(self) -> tuple[np.ndarray, np.ndarray]:
        """Heights [m] and areas [m^2] of the fibres (f,)."""
        assert self.shape.outline is not None
        return _fibres_of(self.shape.outline, self.points)

    @property
    def shear_factor(self) -> float:
        """Shear correction factor of the shape [-]."""
        return self.shape.shear_factor

    @property
    def bounds(self) -> tuple[float, float]:
        """Heights y [m] of the lower and the upper face."""
        return self.shape.bounds

    def rigidity(self, material: Material | None) -> Rigidity:
        """Return the stiffness [N], [N], [N m^2] at zero strain, of the fibres as they are."""
        modulus, (heights, areas) = self.law.material.youngs_modulus, self.fibres
        return Rigidity(modulus * float(areas.sum()), self._shear, modulus * float(areas @ heights**2))

    def inertia(self, material: Material | None) -> Inertia:
        """Return mass per length [kg/m] and rotary inertia [kg m] of the shape."""
        return self.shape.inertia(self.law.material)

    def moments(self, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return the area moments of the shape."""
        return self.shape.moments(self.law.material)

    def materials_at(self, y: np.ndarray, material: Material | None) -> list[tuple[Material, np.ndarray]]:
        """Return where at heights y [m] the material is."""
        return self.shape.materials_at(y, self.law.material)

    def strips(self, material: Material | None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return the quadrature rule of the shape."""
        return self.shape.strips(self.law.material)

    @cached_property
    def _shear(self) -> float:
        return self.shear_factor * self.law.material.shear_modulus * self.shape.area

    def _strains(self, strain: np.ndarray) -> np.ndarray:
        """Return the strains (n, f) of the fibres."""
        return strain[:, :1] - strain[:, 2:] * self.fibres[0]

    def _forces(self, strain: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return N [N], Q [N] and M [N m] (n, 3) of stresses (n, f)."""
        heights, areas = self.fibres
        shear = self._shear * strain[:, 1]
        return np.stack([stress @ areas, shear, -stress @ (areas * heights)], axis=-1)

    def _energy(self, strain: np.ndarray, density: np.ndarray) -> np.ndarray:
        """Return the energy per length (n,) [J/m], with that of shear, of energies per volume (n, f)."""
        return density @ self.fibres[1] + 0.5 * self._shear * strain[:, 1] ** 2


@dataclass(frozen=True)
class ElasticFibreSection(FibreSection):
    """Fibres without history, a `SectionLaw`."""

    law: FibreLaw

    def resultants(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return N [N], Q [N] and M [N m] (n, 3) for strains (n, 3)."""
        return self._forces(strain, self.law.stress(self._strains(strain)))

    def energy(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return the strain energy per length (n,) [J/m]."""
        return self._energy(strain, self.law.energy(self._strains(strain)))


@dataclass(frozen=True)
class RememberingFibreSection(FibreSection):
    """Fibres with history, a `RememberingLaw`."""

    law: FibreLawWithHistory

    @property
    def memory(self) -> tuple[float, ...]:
        """History variables of all fibres."""
        return tuple(self.law.memory) * len(self.fibres[0])

    def _history(self, history: np.ndarray) -> np.ndarray:
        return history.reshape(len(history), len(self.fibres[0]), -1)

    def resultants(self, strain: np.ndarray, material: Material | None, history: np.ndarray, dt: float) -> np.ndarray:
        """Return N [N], Q [N] and M [N m] (n, 3) for strains (n, 3)."""
        return self._forces(strain, self.law.stress(self._strains(strain), self._history(history), dt))

    def remember(self, strain: np.ndarray, material: Material | None, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the history variables after an accepted step."""
        return self.law.remember(self._strains(strain), self._history(history), dt).reshape(history.shape)

    def energy(self, strain: np.ndarray, material: Material | None, history: np.ndarray) -> np.ndarray:
        """Return the stored and the dissipated energy per length (n, 2) [J/m]."""
        stored, dissipated = self.law.energy(self._strains(strain), self._history(history))
        return np.stack([self._energy(strain, stored), dissipated @ self.fibres[1]], axis=-1)


def Fibres(
    shape: ShapedSection, law: FibreLaw | FibreLawWithHistory, points: int = 20
) -> ElasticFibreSection | RememberingFibreSection:
    """Return a section whose normal force and moment are sums over fibres, each with the stress of a law at its strain.

    N = sum A_i s(e_i), M = - sum A_i y_i s(e_i), with e_i = stretch - y_i curvature; shear stays elastic. A beam with
    this section needs no material, but `Structural` forces. Raises InputError for a shape without outline, an object
    that is no law, or less than 2 points.

    Parameters
    ----------
    shape : Rectangle, Circle, Tube, Polygon or Profile
        Shape of the section.
    law : ElasticPlastic, RambergOsgood, Maxwell, or one of your own
        The law of all fibres, see `FibreLaw` and `FibreLawWithHistory`.
    points : int, default 20
        Number of fibres over the height, at the points of Gauss's rule; of a tube, twice as
        many along its wall.

    Examples
    --------
    >>> mild = bf.ElasticPlastic(2.1e11, yield_stress=2.5e8, poisson_ratio=0.3, density=7850.0)
    >>> bar = bf.Fibres(bf.Rectangle(0.01, 0.01), mild, points=40)
    """
    if not isinstance(shape, ShapedSection) or shape.outline is None:
        raise InputError(f"shape of Fibres must be a Rectangle, Circle, Tube, Polygon or Profile, got {shown(shape)}")
    number = number_below("points of Fibres", points, _MOST + 1, 2)
    if fulfils(law, FibreLawWithHistory):
        return RememberingFibreSection(shape, cast(FibreLawWithHistory, law), number)
    if fulfils(law, FibreLaw):
        return ElasticFibreSection(shape, cast(FibreLaw, law), number)
    raise InputError(f"law of Fibres must be a law such as ElasticPlastic(...), got {shown(law)}")


def _fibres_of(
    outline: RectangleOutline | TubeOutline | tuple[StripOutline, ...], points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return heights [m] and positive areas [m^2] of the fibres of an outline."""
    if isinstance(outline, tuple):
        share = points / (outline[-1].high - outline[0].low)
        counts = [max(2, round(share * (strip.high - strip.low))) for strip in outline]
        rules = [gauss_between(strip.low, strip.high, count) for strip, count in zip(outline, counts, strict=True)]
        heights, weights = (np.concatenate(values) for values in zip(*rules, strict=True))
        widths = [strip.width(at) for strip, (at, _) in zip(outline, rules, strict=True)]
        return heights, weights * np.concatenate(widths)
    if isinstance(outline, RectangleOutline):
        return outline.quadrature(points)
    if outline.inner == 0.0:  # Gauss's rule for the weight sqrt(R^2 - y^2), of Chebyshev's second kind
        angles = np.pi * np.arange(points, 0, -1) / (points + 1)
        return outline.outer * np.cos(angles), 2.0 * np.pi / (points + 1) * (outline.outer * np.sin(angles)) ** 2
    radii, weights = gauss_between(outline.inner, outline.outer, _RADII)
    angles = np.pi * ((np.arange(points) + 0.5) / points - 0.5)  # of the right half; equal weights are best on a circle
    areas = np.outer(2.0 * np.pi / points * weights * radii, np.ones(points))
    return np.outer(radii, np.sin(angles)).ravel(), areas.ravel()
