"""Distribution of normal force, shear force and moment over the height of a section."""

from dataclasses import dataclass

import numpy as np

from beamfem.material import Material
from beamfem.section.law import SectionLaw
from beamfem.section.outline import MomentsOutline, Part
from beamfem.section.protocol import CrossSection, HasParts

_SAME = 1e-12  # fraction of the height within which a point counts as on a face


@dataclass(frozen=True, eq=False)
class Distribution:
    """Stress over a section, whose fibres at y have 1 - curvature y times the length of the axis in the reference.

    layers: lower and upper y [m] of each part, from the bottom up; curvature [1/m]: that of the reference, > 0 towards
    +y, broadcast with the arguments of the methods; flexibility: stretch of the axis and change of curvature [1/m] due
    to N and M, [[a, c], [c, b]] as a [1/N], c [1/(N m)], b [1/(N m^2)].

    Plane sections: sigma = E (e - k y) / (1 - curvature y), Winkler's hyperbola, which is linear on a straight beam.
    The shear stress balances the change of sigma along the beam, N' = curvature V and M' = -V (Jourawski): on a
    straight beam V Q / (I b). Resultants are exactly N, V and M. Source: Timoshenko, Strength of Materials II, chapter
    2.
    """

    layers: tuple[tuple[float, float], ...]
    parts: tuple[Part, ...]
    curvature: np.ndarray
    flexibility: tuple[np.ndarray, np.ndarray, np.ndarray]

    def layer_at(self, y: float) -> int:
        """Return the layer at a height [m]: between two layers the upper one, beyond the faces the nearest."""
        return int(np.clip(np.searchsorted([low for low, _ in self.layers], y, side="right") - 1, 0, None))

    def normal_stress(self, layer: int, y: np.ndarray, normal: np.ndarray, moment: np.ndarray) -> np.ndarray:
        """Return the stress along the beam [Pa] at heights y [m] of a layer due to N [N] and M [N m] about the axis.

        It is nan if only the stiffness of the section is known, off the axis if its height is unknown, and where it
        reaches the centre of curvature.
        """
        y = np.asarray(y, dtype=float)
        if not self.parts:
            return _nothing(y, normal, moment, self.curvature)
        part = self.parts[layer]
        stretch, bend = self._strain(normal, moment)
        length = 1.0 - self.curvature * y
        result = part.modulus * (stretch - bend * y) / np.where(length > 0.0, length, np.nan)
        return np.asarray(result if part.outline.known else np.where(y == 0.0, result, np.nan))

    def shear_stress(self, layer: int, y: np.ndarray, shear: np.ndarray) -> np.ndarray:
        """Return the shear stress [Pa] at heights y [m] of a layer due to V [N], averaged over the width there.

        It is 0 at the faces, and nan if the width of the section is unknown.
        """
        y = np.asarray(y, dtype=float)
        if not self.parts:
            return _nothing(y, shear, self.curvature)
        part = self.parts[layer]
        at = np.clip(y, part.outline.low, part.outline.high)
        area, first = part.outline.below(at)
        area, first = part.modulus * area, part.modulus * first
        for lower in self.parts[:layer]:
            whole = lower.outline.below(np.asarray(lower.outline.high))
            area, first = area + lower.modulus * whole[0], first + lower.modulus * whole[1]
        shear = np.asarray(shear, dtype=float)
        stretch, bend = self._strain(self.curvature * shear, -shear)
        low, high = self.layers[0][0], self.layers[-1][1]
        near = _SAME * (high - low)
        free = ((at <= low + near) | (at >= high - near)) & part.outline.known
        width = np.where(free, 1.0, part.outline.width(at))
        length = 1.0 - self.curvature * at
        flow = (bend * first - stretch * area) / np.where(length > 0.0, length, np.nan) ** 2
        return np.asarray(np.where(free & np.isfinite(stretch), 0.0, flow / width))

    def _strain(self, normal: np.ndarray, moment: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the stretch of the axis and the change of curvature [1/m]."""
        axial, coupling, bending = self.flexibility
        return axial * normal + coupling * moment, coupling * normal + bending * moment


def distribution(section: CrossSection, material: Material | None, curvature: float | np.ndarray) -> Distribution:
    """Return how a section distributes N, V and M for a curvature [1/m] of the reference, > 0 towards +y.

    It is computed from the `parts` of a section, or else from the moments of its material; a section that is known by
    its stiffness only, or has a section law, has no stress. Raises InputError if a material is needed and missing.
    """
    bend = np.asarray(curvature, dtype=float)
    parts, layers = _parts(section, material), layers_of(section, material)
    if not parts:
        nothing = np.full(bend.shape, np.nan)
        return Distribution(layers, (), bend, (nothing, nothing, nothing))
    reach = np.maximum(bend * layers[0][0], bend * layers[-1][1])
    # a section that reaches the centre of curvature has fibres of length zero
    flexibility = _flexibility(
        parts, np.where(reach < 1.0, bend, np.nan), np.max(reach, where=reach < 1.0, initial=0.0)
    )
    return Distribution(layers, parts, bend, flexibility)


def layers_of(section: CrossSection, material: Material | None) -> tuple[tuple[float, float], ...]:
    """Return lower and upper y [m] of each part of a section, from the bottom up."""
    if isinstance(section, HasParts):
        return tuple((part.outline.low, part.outline.high) for part in section.parts(material))
    low, high = section.bounds
    return ((float(low), float(high)),)


def _parts(section: CrossSection, material: Material | None) -> tuple[Part, ...]:
    if isinstance(section, SectionLaw):
        return ()  # the distribution of its resultants over the height is unknown
    if isinstance(section, HasParts):
        return section.parts(material)
    low, high = section.bounds
    materials = section.materials_at(np.array([low, high]), material)
    if len(materials) != 1:
        return ()  # moments alone do not determine where each of several materials is
    own_material, moments = section.moments(material)[0]
    return (Part(own_material.youngs_modulus, MomentsOutline(tuple(moments.tolist()), float(low), float(high))),)


def _flexibility(
    parts: tuple[Part, ...], curvature: np.ndarray, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Invert N = A e - S k, M = -S e + I k with the integrals A, S, I of E y^n / (1 - curvature y) over the section."""
    axial, first, bending = (np.zeros(curvature.shape) for _ in range(3))
    for part in parts:
        heights, weights = part.outline.quadrature(_points(reach))
        stiff = part.modulus * weights / (1.0 - curvature[..., None] * heights)
        axial, first, bending = (total + stiff @ heights**n for n, total in enumerate((axial, first, bending)))
    size = axial * bending - first**2
    return bending / size, first / size, axial / size


def _points(reach: float) -> int:
    """Return the number of points that integrate 1 / (1 - curvature y) to round-off; reach: largest |curvature y|."""
    if reach < 1e-3:
        return 12
    inverse = 1.0 / min(reach, 0.999)
    return max(12, int(20.0 / np.log(inverse + np.sqrt(inverse**2 - 1.0))))


def _nothing(*arrays: np.ndarray) -> np.ndarray:
    return np.full(np.broadcast_shapes(*(np.shape(array) for array in arrays)), np.nan)
