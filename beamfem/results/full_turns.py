"""Full turns of beams without nodal angles, whose coordinates do not hold them, in the rows of a solution."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.fields import Axis
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results import postprocess
from beamfem.results.nodal import axis_at
from beamfem.results.solution import Solution


def first_turns(model: Model, p: np.ndarray, near: np.ndarray) -> np.ndarray:
    """Return the rotation of each such beam at its start (m,) [rad] in a state p (n,), within half a turn of `near`."""
    meshes = model.numbered.uncounted
    nodal = [postprocess.nodal_rotations(mesh, p[None], near[i : i + 1]) for i, mesh in enumerate(meshes)]
    return np.array([rotations[0, 0] for rotations in nodal])


def start_rotations(solution: Solution) -> np.ndarray:
    """Return the rotation of each such beam at its start (steps, m) [rad], full turns included.

    As counted by the solve from step to step; else continued from row to row, the first of them within half a turn.
    """
    return solution.computed(_continued) if solution.turned is None else solution.turned


def _continued(solution: Solution) -> np.ndarray:
    """Return the rotations of `start_rotations` from row to row."""
    return continued_rotations(solution.model, solution.p)


def continued_rotations(model: Model, p: np.ndarray) -> np.ndarray:
    """Return the start rotations (steps, m) [rad] of such beams, continued from state to state p (steps, n)."""
    parts = [postprocess.nodal_rotations(mesh, p)[:, :1] for mesh in model.numbered.uncounted]
    return np.concatenate([np.empty((len(p), 0)), *parts], axis=1)


def turned_of(solution: Solution, mesh: BeamMesh) -> np.ndarray | None:
    """Return the start rotation (steps, beams) [rad] of each beam of a mesh; None if coordinates hold full turns."""
    indices = [solution.model.numbered.numbers_uncounted.get(part) for part in mesh.parts]
    counted = [index for index in indices if index is not None]
    return start_rotations(solution)[:, counted] if counted else None


def rotations(solution: Solution, points: Sequence[Point]) -> np.ndarray:
    """Return the rotations (steps, points) [rad] of sections of one beam, full turns included."""
    mesh = solution.model.mesh_of(points[0])
    element, xi = (np.array(each) for each in zip(*(mesh.locate(point.fraction) for point in points), strict=True))
    now = axis_at(mesh, solution.p, element, xi)
    return postprocess.section_rotation(mesh, solution.p, now, element, xi, turned_of(solution, mesh))


@dataclass(frozen=True, eq=False)
class StationsOfRows:
    """Points (n,) of a beam, given by element and xi, in the rows of a solution."""

    solution: Solution
    mesh: BeamMesh
    element: np.ndarray
    xi: np.ndarray

    @property
    def rotation(self) -> np.ndarray:
        """Rotations of the sections from the reference (steps, n) [rad]."""
        turned = turned_of(self.solution, self.mesh)
        return postprocess.section_rotation(self.mesh, self.solution.p, self._now, self.element, self.xi, turned)

    @property
    def slope(self) -> np.ndarray:
        """Derivatives r0' (steps, n, 2) [-]."""
        return self._now.r_s

    @cached_property
    def _now(self) -> Axis:
        return axis_at(self.mesh, self.solution.p, self.element, self.xi)
