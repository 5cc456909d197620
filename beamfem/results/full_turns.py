"""Full turns of beams without nodal angles, whose coordinates do not hold them, in the rows of a solution."""

from dataclasses import dataclass

import numpy as np

from beamfem.model.model import Model
from beamfem.results import postprocess
from beamfem.results.axis_points import AxisPoints
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


def rotation(points: AxisPoints, solution: Solution, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Return the rotation of the section from the reference configuration (rows, points) [rad], full turns included."""
    p, numbers = solution.p[rows], solution.model.numbered.numbers_uncounted
    counted = [numbers[part] for part in points.mesh.parts if part in numbers]
    turned = start_rotations(solution)[:, counted][rows] if counted else None
    return postprocess.section_rotation(points.mesh, p, points.now(p), points.element, points.xi, turned)


@dataclass(frozen=True, eq=False)
class StationsOfRows:
    """Points (n,) of a beam in the rows of a solution."""

    solution: Solution
    points: AxisPoints

    @property
    def rotation(self) -> np.ndarray:
        """Rotations of the sections from the reference (steps, n) [rad]."""
        return rotation(self.points, self.solution)

    @property
    def slope(self) -> np.ndarray:
        """Derivatives r0' (steps, n, 2) [-]."""
        return self.points.now(self.solution.p).r_s
