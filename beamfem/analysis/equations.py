"""Residual and tangent of a system in a state: the only place where solvers meet the kernels."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solve_banded

from beamfem.kernels.assemble import assemble
from beamfem.kernels.band import factor, solve
from beamfem.kernels.loads import assemble_point_loads
from beamfem.kernels.stress import predict_stress
from beamfem.kernels.turned import hold_normals, turn_back
from beamfem.model.system import System

STATICS = (1.0, 0.0, 0.0)
INERTIA = (0.0, 0.0, 1.0)
_EMPTY = np.empty(0)
_NO_STRESS = np.empty((0, 0, 0))
_SMALLEST_PIVOT = 1e-13


@dataclass(frozen=True)
class Tangent:
    """A band matrix of the unknown coordinates, rows of 2 w + 1 entries."""

    rows: np.ndarray

    def solve(self, right: np.ndarray, turned: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Return x with A x = right and no change along the normals of inclined rollers.

        turned: numbers (nt,) and normals (nt, 2) of those. Pivots only where the plain factorisation meets a tiny
        pivot. Raises LinAlgError.
        """
        rows, right = self.rows.copy(), right.copy()
        hold_normals(rows, right, *turned)
        x = Tangent(rows)._solve(right)
        turn_back(x, *turned)
        return x

    def _solve(self, right: np.ndarray) -> np.ndarray:
        lu = self.rows.copy()
        if factor(lu) > _SMALLEST_PIVOT:
            x = right.copy()
            solve(lu, x)
            if np.isfinite(x).all():
                return x
        return self._solve_pivoted(right)

    def _solve_pivoted(self, right: np.ndarray) -> np.ndarray:
        n, width = self.rows.shape
        half = width // 2
        diagonals = np.zeros((width, n))
        for offset in range(-half, half + 1):
            size = max(n - abs(offset), 0)
            first = max(-offset, 0)
            diagonals[half - offset, first + offset : first + offset + size] = self.rows[
                first : first + size, half + offset
            ]
        x = solve_banded((half, half), diagonals, right)
        if not np.isfinite(x).all():
            raise LinAlgError("the tangent is singular")
        return np.asarray(x)


def residual(system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float) -> np.ndarray:
    """Return inertia + elastic - external generalized forces (n,) [N, N m]; at held coordinates, the reactions."""
    result = np.zeros(len(p))
    values = system.point_values(time)
    for block, loads, forces in zip(system.blocks, system.point_loads, values, strict=True):
        assemble(block, system.layout, p, v, a, system.body(time), np.ones(3), _NO_STRESS, result, _EMPTY)
        assemble_point_loads(block, loads, system.layout, p, forces, 1.0, result, _EMPTY)
    return result


def linearise(
    system: System,
    p: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    time: float,
    coefficients: tuple[float, float, float],
    stresses: tuple[np.ndarray, ...] | None = None,
) -> tuple[np.ndarray, Tangent]:
    """Return residual (n,) and tangent; `coefficients` weigh p, p' and p'' (`STATICS`, `INERTIA`).

    stresses: stress resultants for the geometric part of the tangent, of each block (ne, nq, ns).
    """
    layout = system.layout
    unknown = len(system.free_dofs)
    width = 2 * layout.half_width + 1
    result, matrix = np.zeros(len(p)), np.zeros(unknown * width)
    body, values, weights = system.body(time), system.point_values(time), np.array(coefficients)
    for i, (block, loads) in enumerate(zip(system.blocks, system.point_loads, strict=True)):
        geometric = _NO_STRESS if stresses is None else stresses[i]
        assemble(block, layout, p, v, a, body, weights, geometric, result, matrix)
        assemble_point_loads(block, loads, layout, p, values[i], coefficients[0], result, matrix)
    return result, Tangent(matrix.reshape(unknown, width))


def predicted_stresses(system: System, p: np.ndarray, step: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the stress resultants after a linearised step (n,) from p, of each block (ne, nq, ns)."""
    result = []
    for block in system.blocks:
        stress = np.empty((block.frame.shape[0], block.jacobian.shape[1], block.stiffness.shape[2]))
        predict_stress(block, p, step, stress)
        result.append(stress)
    return tuple(result)


def coordinate_scale(system: System) -> np.ndarray:
    """Return what a coordinate's change is measured by (n,): the longest beam for positions [m], 1 for the rest."""
    scale = np.ones(system.model.size)
    longest = max(beam.curve.length for beam in system.model.beams)
    for mesh in system.model.meshes:
        labels = mesh.beam.element.coordinates.labels(mesh.beam.element.field.vectors)
        table = scale[mesh.first_dof : mesh.first_dof + mesh.size].reshape(mesh.nodes, -1)
        table[:, [i for i, label in enumerate(labels) if label.startswith("r^")]] = longest
    return scale
