"""Residual and tangent of a system in a state: the only place where solvers meet the kernels."""

import numpy as np

from beamfem.analysis.tangent import Tangent
from beamfem.kernels.assemble import assemble
from beamfem.kernels.loads import assemble_point_loads
from beamfem.kernels.stress import predict_stress
from beamfem.model.system import System

STATICS = (1.0, 0.0, 0.0)
INERTIA = (0.0, 0.0, 1.0)
_EMPTY = np.empty(0)
_NO_STRESS = np.empty((0, 0, 0))


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


def load_slope(system: System, p: np.ndarray, load_factor: float, width: float = 1e-6) -> np.ndarray:
    """Return the change of the residual (n,) [N, N m] with the load factor, prescribed motions included.

    A central difference of the given width, exact to round-off where loads are proportional to the load factor.
    """
    rest = np.zeros(len(p))
    held, slopes = system.held_dofs, []
    for side in (1.0, -1.0):
        at = load_factor + side * width
        moved = p.copy()
        moved[held] += system.held_values(at) - system.held_values(load_factor)
        slopes.append(side * residual(system, moved, rest, rest, at))
    return np.asarray(sum(slopes) / (2.0 * width))


def coordinate_scale(system: System) -> np.ndarray:
    """Return what a coordinate's change is measured by (n,): the longest beam for positions [m], 1 for the rest."""
    scale = np.ones(system.model.size)
    longest = max(beam.curve.length for beam in system.model.beams)
    for mesh in system.model.meshes:
        labels = mesh.beam.element.coordinates.labels(mesh.beam.element.field.vectors)
        table = scale[mesh.first_dof : mesh.first_dof + mesh.size].reshape(mesh.nodes, -1)
        table[:, [i for i, label in enumerate(labels) if label.startswith("r^")]] = longest
    return scale
