"""Displacements of a solution from the reference, by which loads do work."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import Beam, Point
from beamfem.model.mesh import BeamMesh
from beamfem.model.reference import inertia_points, length_points, reference_axis, reference_position
from beamfem.once import cached_property
from beamfem.results import postprocess
from beamfem.results.turns import rotations

if TYPE_CHECKING:
    from beamfem.results.solution import Solution


class Displacements:
    """The rows of a solution, with the members that the work of loads needs.

    first: integral of the position over the mass of each beam (steps, 2) [kg m].
    """

    def __init__(self, solution: "Solution", first: Sequence[np.ndarray]) -> None:
        self.solution, self._first = solution, first
        self._along: dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        self._rotations: dict[int, dict[float, np.ndarray]] = {}

    def __len__(self) -> int:
        return len(self.solution)

    @cached_property
    def first_moments(self) -> list[np.ndarray]:
        """Integral of the displacement over the mass of each beam (steps, 2) [kg m]."""
        pairs = zip(self.solution.model.meshes, self._first, strict=True)
        return [first - _reference_moment(mesh) for mesh, first in pairs]

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point (steps, 2) [m]."""
        return self.solution.displacement(point)

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section at a point (steps,) [rad], evaluated once for all loads of its beam."""
        if id(point.beam) not in self._rotations:
            loaded = (load.place for load in self.solution.model.loads)
            points = [own for own in loaded if isinstance(own, Point) and own.beam is point.beam]
            fractions = [own.fraction for own in points]
            self._rotations[id(point.beam)] = dict(zip(fractions, rotations(self.solution, points).T, strict=True))
        return self._rotations[id(point.beam)][point.fraction]

    def along(self, beam: Beam) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return displacements (steps, n, 2) [m] at points along a beam, and their weights and arc lengths (n,) [m]."""
        if id(beam) not in self._along:
            mesh = self.solution.model.mesh_of(beam.start)
            element, xi, weight = length_points(mesh)
            now = postprocess.axis(mesh, postprocess.nodal_vectors(mesh, self.solution.p), element, xi).r
            moved = now - reference_position(mesh, element, xi)
            self._along[id(beam)] = moved, weight, mesh.arc_length(element, xi)
        return self._along[id(beam)]


def _reference_moment(mesh: BeamMesh) -> np.ndarray:
    """Return the integral of the reference position over the mass (2,) [kg m]."""
    element, xi, inertia = inertia_points(mesh)
    return np.asarray(
        inertia[:, 0] @ reference_position(mesh, element, xi) + inertia[:, 1] @ reference_axis(mesh, element, xi).d
    )
