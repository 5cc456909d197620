"""Displacements of a solution from the reference, by which loads do work and springs store it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import inertia_points, length_points, reference_axis, reference_position
from beamfem.model.beam import Beam, Point
from beamfem.results.axis_points import AxisPoints
from beamfem.results.solution import Solution


@dataclass(frozen=True, eq=False)
class Displacements:
    """The rows of a solution, with the members that the work of loads and the energy of supports need.

    first: integral of the position over the mass of each beam (steps, 2) [kg m].
    """

    solution: Solution
    first: Sequence[np.ndarray]

    def __len__(self) -> int:
        return len(self.solution)

    @property
    def first_moments(self) -> Iterator[np.ndarray]:
        """Integral of the displacement over the mass of each beam (steps, 2) [kg m]."""
        for mesh, first in zip(self.solution.model.meshes, self.first, strict=True):
            yield first - _reference_moment(mesh)

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point (steps, 2) [m]."""
        return self.solution.displacement(point)

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section at a point (steps,) [rad]."""
        return self.solution.rotation(point)

    def along(self, beam: Beam) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return displacements (steps, n, 2) [m] at points along a beam, and their weights and arc lengths (n,) [m]."""
        element, xi, weight = length_points(mesh := self.solution.model.mesh_of(beam.start))
        points = AxisPoints(mesh, element, xi)
        return points.positions(self.solution.p)[0] - points.reference, weight, points.arc_length


def _reference_moment(mesh: BeamMesh) -> np.ndarray:
    """Return the integral of the reference position over the mass (2,) [kg m]."""
    element, xi, inertia = inertia_points(mesh)
    return np.asarray(
        inertia[:, 0] @ reference_position(mesh, element, xi) + inertia[:, 1] @ reference_axis(mesh, element, xi).d
    )
