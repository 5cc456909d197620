"""Stress over the sections, and their layers, at points of a beam."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.reference import curvature, sections_at
from beamfem.section.distribution import Distribution, distribution, layers_of

# indices of points (n,), consecutive over all groups, and the distribution of forces at them
_Group = tuple[np.ndarray, Distribution]


@dataclass(frozen=True, eq=False)
class Distributions:
    """Distribution of section forces over the height, at points (n,) of a beam.

    groups: one for all points of a prismatic beam, otherwise one per point; layers: lower and upper y (n, layers, 2)
    [m], from the bottom up. If a section has fewer layers than others, the missing ones have no thickness and lie on
    its upper face.
    """

    groups: tuple[_Group, ...]
    layers: np.ndarray

    def normal_stress(self, layer: int | None, y: np.ndarray, normal: np.ndarray, moment: np.ndarray) -> np.ndarray:
        """Return the stress along the beam [Pa] (steps, n, heights) due to N [N] and M [N m] (steps, n).

        y (n, heights) [m]; layer: the layer that y belongs to, None for the one at the axis.
        """
        return self._stress(
            layer, y, lambda own, at, y, here: own.normal_stress(at, y, normal[:, here, None], moment[:, here, None])
        )

    def shear_stress(self, layer: int | None, y: np.ndarray, shear: np.ndarray) -> np.ndarray:
        """Return the shear stress [Pa] (steps, n, heights) due to V (steps, n) [N]; y, layer: see `normal_stress`."""
        return self._stress(layer, y, lambda own, at, y, here: own.shear_stress(at, y, shear[:, here, None]))

    def _stress(self, layer: int | None, y: np.ndarray, of: Callable[..., np.ndarray]) -> np.ndarray:
        parts = []
        for points, dist in self.groups:
            at = dist.layer_at(0.0) if layer is None else min(layer, len(dist.layers) - 1)
            parts.append(of(dist, at, y[points], points))
        return np.concatenate(parts, axis=1)

    @property
    def number(self) -> np.ndarray:
        """Number of layers at each point (n,)."""
        result = np.empty(len(self.layers), dtype=int)
        for points, dist in self.groups:
            result[points] = len(dist.layers)
        return result


def distributions(grid: Grid, element: np.ndarray, xi: np.ndarray) -> Distributions:
    """Return the distribution of section forces over the height at points (element, xi) of a beam."""
    bend, material = curvature(grid, element, xi)[:, None], grid.beam.material
    sections = sections_at(grid, element, xi)
    groups = [
        (where, distribution(section, material, bend[where]))
        for section, where in zip(sections, np.array_split(np.arange(len(element)), len(sections)), strict=True)
    ]
    return Distributions(tuple(groups), layers(grid, element, xi))


def layers(grid: Grid, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Return lower and upper y (n, layers, 2) [m] of the layers at points (element, xi); see `Distributions`."""
    layer_lists = [layers_of(section, grid.beam.material) for section in sections_at(grid, element, xi)]
    result = np.empty((len(layer_lists), max(map(len, layer_lists)), 2))
    for point, at in enumerate(layer_lists):
        result[point, : len(at)] = at
        result[point, len(at) :] = at[-1][1]
    return np.broadcast_to(result, (len(element), *result.shape[1:]))
