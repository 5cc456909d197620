"""Displacements of a solution from the reference, by which loads do work and springs store it."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import inertia_points, length_points, reference_axis, reference_position
from beamfem.model.beam import Beam, Point
from beamfem.results import postprocess
from beamfem.results.full_turns import rotations
from beamfem.results.solution import Solution

_Found = TypeVar("_Found")


class Displacements:
    """The rows of a solution, with the members that the work of loads and the energy of supports need.

    first: integral of the position over the mass of each beam (steps, 2) [kg m]. What was asked along a beam is kept
    until another one is asked for, since that of all beams may be larger than the solution.
    """

    def __init__(self, solution: Solution, first: Sequence[np.ndarray]) -> None:
        self.solution, self._first = solution, first
        self._beam: Beam | None = None
        self._kept: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(self.solution)

    @property
    def first_moments(self) -> Iterator[np.ndarray]:
        """Integral of the displacement over the mass of each beam (steps, 2) [kg m]."""
        for mesh, first in zip(self.solution.model.meshes, self._first, strict=True):
            yield first - _reference_moment(mesh)

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point (steps, 2) [m]."""
        return self.solution.displacement(point)

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section at a point (steps,) [rad], evaluated once for all loads of its beam."""

        def evaluated() -> dict[float, np.ndarray]:
            points = self._loaded[id(point.beam)]
            found = rotations(self.solution, points).T
            return {own.fraction: angle for own, angle in zip(points, found, strict=True)}

        return self._once(point.beam, "rotation", evaluated)[point.fraction]

    def along(self, beam: Beam) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return displacements (steps, n, 2) [m] at points along a beam, and their weights and arc lengths (n,) [m]."""

        def evaluated() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
            mesh = self.solution.model.mesh_of(beam.start)
            element, xi, weight = length_points(mesh)
            now = postprocess.axis(mesh, postprocess.nodal_vectors(mesh, self.solution.p), element, xi).r
            return now - reference_position(mesh, element, xi), weight, mesh.arc_length(element, xi)

        return self._once(beam, "along", evaluated)

    def _once(self, beam: Beam, name: str, evaluated: Callable[[], _Found]) -> _Found:
        if self._beam is not beam:
            self._beam, self._kept = beam, {}
        if name not in self._kept:
            self._kept[name] = evaluated()
        found: _Found = self._kept[name]
        return found

    @cached_property
    def _loaded(self) -> dict[int, list[Point]]:
        """The loaded points of each beam."""
        result = defaultdict[int, list[Point]](list)
        for load in self.solution.model.point_loads:
            result[id(load.point.beam)].append(load.point)
        return result


def _reference_moment(mesh: BeamMesh) -> np.ndarray:
    """Return the integral of the reference position over the mass (2,) [kg m]."""
    element, xi, inertia = inertia_points(mesh)
    return np.asarray(
        inertia[:, 0] @ reference_position(mesh, element, xi) + inertia[:, 1] @ reference_axis(mesh, element, xi).d
    )
