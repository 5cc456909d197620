"""Residual and tangent of a system in a state: the only place where solvers meet the kernels."""

import numpy as np
from scipy.sparse import csc_array

from beamfem.analysis.tangent import BandTangent, SparseTangent, Tangent
from beamfem.kernels.assemble import assemble
from beamfem.kernels.loads import assemble_point_loads
from beamfem.kernels.springs import assemble_springs
from beamfem.kernels.stress import predict_stress
from beamfem.model.blocks import workspace
from beamfem.model.system import System

STATICS = (1.0, 0.0, 0.0)
INERTIA = (0.0, 0.0, 1.0)
_EMPTY = np.empty(0)
_NO_STRESS = np.empty((0, 0, 0))


def residual(system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float) -> np.ndarray:
    """Return inertia + elastic - external generalized forces (n,) [N, N m]; at held coordinates, the reactions."""
    result = np.zeros(len(p))
    body, values = system.body(time), system.point_values(time)
    for i, (block, loads, work) in enumerate(zip(system.blocks, system.point_loads, system.workspaces(), strict=True)):
        layout = system.layouts[i]
        assemble(system.forms[i], block, layout, work, p, v, a, body, np.ones(3), _NO_STRESS, result, _EMPTY)
        assemble_point_loads(block, loads, layout, work, values[i], 1.0, result, _EMPTY)
    assemble_springs(system.springs, p, 1.0, result, _EMPTY)
    return result


def element_residual(
    system: System, block: int, element: int, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float
) -> np.ndarray:
    """Return inertia + elastic - body forces (n,) [N, N m] of one element of a block, without loads at points."""
    whole = system.blocks[block]
    nodes = whole.node[element]
    part = whole._replace(
        node=np.arange(len(nodes))[None],
        **{name: getattr(whole, name)[element : element + 1] for name in ("kind", "beam")},
        **{name: getattr(whole, name)[nodes] for name in ("carrier", "frame", "dof", "home")},
    )
    result = np.zeros(len(p))
    work = workspace(part)
    form, layout, body = system.forms[block], system.layouts[block], system.body(time)
    assemble(form, part, layout, work, p, v, a, body, np.ones(3), _NO_STRESS, result, _EMPTY)
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

    stresses: resultants for the geometric part of the tangent, of each block (ne, nq, ns).
    """
    unknowns = system.unknowns
    unknown, pattern = len(unknowns.dofs), unknowns.pattern
    width = 2 * system.layouts[0].half_width + 1
    matrix = np.zeros(unknown * width) if pattern is None else np.zeros(len(pattern.data))
    result = np.zeros(len(p))
    body, values, weights = system.body(time), system.point_values(time), np.array(coefficients)
    for i, (block, loads, work) in enumerate(zip(system.blocks, system.point_loads, system.workspaces(), strict=True)):
        layout = system.layouts[i]
        geometric = _NO_STRESS if stresses is None else stresses[i]
        assemble(system.forms[i], block, layout, work, p, v, a, body, weights, geometric, result, matrix)
        assemble_point_loads(block, loads, layout, work, values[i], coefficients[0], result, matrix)
    assemble_springs(system.springs, p, coefficients[0], result, matrix)
    if pattern is None:
        return result, BandTangent(matrix.reshape(unknown, width))
    return result, SparseTangent(csc_array((matrix, pattern.indices, pattern.indptr), shape=pattern.shape))


def predicted_stresses(system: System, p: np.ndarray, step: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the stress resultants after a linearised step (n,) from p, of each block (ne, nq, ns)."""
    result = []
    for form, block, work in zip(system.forms, system.blocks, system.workspaces(), strict=True):
        stress = np.empty((block.node.shape[0], block.jacobian.shape[1], block.stiffness.shape[2]))
        predict_stress(form, block, work, p, step, stress)
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
