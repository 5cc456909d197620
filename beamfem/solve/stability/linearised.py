"""Critical load factors of linear buckling analysis: the geometric stiffness of the linear solution grows."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array, eye_array

from beamfem.equations.bound_connector import Connector
from beamfem.equations.differences import differentiated
from beamfem.equations.equations import STATICS, linearise_at_rest, load_change, predicted_stresses, residual_at_rest
from beamfem.equations.stress_resultants import resultants, strain_group
from beamfem.equations.system import System
from beamfem.errors import ConvergenceError, InputError
from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS
from beamfem.linalg.eigenpairs import dominant_pairs, first_vector
from beamfem.linalg.lapack import eigh, qr
from beamfem.linalg.tangent import UNROTATED, Factorised
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes, weak_stiffness
from beamfem.solve.modes.pencil import is_symmetric
from beamfem.solve.start.functions_of_time import functions_of_time

_WIDTH = 1e-4  # of the load factor: loads with amplitudes are differentiated over it
_NO_SLOPE = 1e-6  # of the change of the loads further on: a smaller slope is an error of the difference
_ROUND_OFF = 1e-10  # of the largest stiffness of a connector


def size_of(system: System) -> float:
    """Return twice the largest distance [m] of a node from the centre of all beams, the length of a straight one.

    `System.extent` is no measure of results: it is the length of the longest beam, and halves are shorter.
    """
    chains = [mesh.position for mesh in system.model.meshes]
    steps = np.concatenate([np.diff(chain, axis=0) for chain in chains])
    middles = np.concatenate([0.5 * (chain[1:] + chain[:-1]) for chain in chains])
    lengths = np.hypot(*steps.T)
    centre = lengths @ middles / lengths.sum()
    return 2.0 * float(np.hypot(*(np.concatenate(chains) - centre).T).max())


def largest_displacement(system: System, change: np.ndarray) -> float:
    """Return the largest displacement [m] of a node by a change (n,)."""
    places = np.concatenate([block.dof[:, :2] for block in system.blocks])
    return float(np.hypot(*change[places.T]).max())


def largest_movement(system: System, change: np.ndarray) -> float:
    """Return the largest component of a change (n,): displacements in sizes of the model, gradients, angles [rad]."""
    padded = np.append(change, 0.0)
    largest = largest_displacement(system, change) / size_of(system)
    for block in system.blocks:
        plain = np.isin(block.node_kind, (GRADIENTS, ROTATED_GRADIENTS))
        rotations, gradients = block.dof[~plain, 2:], block.dof[plain, 2:].reshape(-1, 2)
        moved = np.hypot(*padded[gradients].T), np.abs(padded[rotations])
        largest = max(largest, *(float(values.max(initial=0.0)) for values in moved))
    return largest


@dataclass(frozen=True, eq=False)
class LinearSolution:
    """The linear solution about a state.

    stiffness: K0 (unknown, unknown), the tangent of the state, and its factors; slope (n,): displacements per unit of
    the load factor; geometric: K_sigma (unknown, unknown) of their stress resultants, with the load stiffness; strain:
    their largest strain, as the root of its mean square over a section.
    """

    stiffness: csr_array
    factors: Factorised
    slope: np.ndarray
    geometric: csr_array
    strain: float


def linear_solution(system: System, p: np.ndarray, load_factor: float) -> LinearSolution | None:
    """Return the linear solution about the state p (n,) for a growing load factor; None if no load has a slope there.

    K_sigma is the second derivative of strains and work of the loads, with the stress resultants of the linear solution
    alone: derivatives of the stiffness along the displacements, of size G A and E A, are no part of it.
    """
    zeros, free, prescribed = np.zeros(len(p)), system.free_dofs, system.prescribed_dofs
    differences = _differences(system, load_factor)
    rate = sum(weight * load_change(system, p, load_factor, at) for at, weight in differences)
    if _negligible(system, p, load_factor, np.asarray(rate)):
        return None
    tangent = linearise_at_rest(system, p, load_factor)[1]
    factors = tangent.factorised(system.rotated)
    slope, before = np.zeros(len(p)), system.prescribed_values(load_factor)
    slope[free] = factors.solve(-np.asarray(rate)[free])
    slope[prescribed] = sum(weight * (system.prescribed_values(at) - before) for at, weight in differences)
    stresses = predicted_stresses(system, p, zeros, load_factor)
    unchanged = weak_stiffness(system, p, load_factor, stresses)
    geometric = _of_connectors(system, p, load_factor, slope)
    for at, weight in differences:
        stresses = predicted_stresses(system, p, (at - load_factor) * slope, at)
        geometric = geometric + weight * (weak_stiffness(system, p, at, stresses) - unchanged)
    strain = _largest_strain(system, p, load_factor, slope, differences)
    return LinearSolution(tangent.sparse(UNROTATED), factors, slope, csr_array(geometric), strain)


def _differences(system: System, load_factor: float) -> list[tuple[float, float]]:
    """Return load factors and weights: the derivative by the load factor is the sum of weighted changes up to them.

    The difference is forward, since amplitudes may have a kink at the start, and of second order. Where everything is
    linear in the load factor it is wide: in a narrow one the round-off of stiff springs hides the geometric stiffness.
    """
    size = max(1.0, abs(load_factor))
    if not functions_of_time(system) and not system.connectors.follow_time:
        return [(load_factor + size, 1.0 / size)]
    width = _WIDTH * size
    return [(load_factor + width, 2.0 / width), (load_factor + 2.0 * width, -0.5 / width)]


def _negligible(system: System, p: np.ndarray, load_factor: float, rate: np.ndarray) -> bool:
    """Return whether forces (n,) per load factor vanish beside their mean over the next load factor."""
    if not functions_of_time(system):
        return False
    size, further = float(np.max(np.abs(rate) * system.scale)), load_change(system, p, load_factor, load_factor + 1.0)
    return size <= _NO_SLOPE * float(np.max(np.abs(further) * system.scale))


def _largest_strain(
    system: System, p: np.ndarray, load_factor: float, slope: np.ndarray, differences: list[tuple[float, float]]
) -> float:
    """Return the largest root mean square strain of a section, sqrt(eps . C eps / E A), for displacements (n,)."""
    largest = 0.0
    for block in system.blocks:
        plain, stiffness = strain_group(block, len(p)), block.stiffness[block.kind]
        steps = [(0.0, load_factor, -sum(weight for _, weight in differences))]
        steps += [(at - load_factor, at, weight) for at, weight in differences]
        strains = [
            weight * resultants(plain, p, [by * slope], system.loads.imposing(at))[0] for by, at, weight in steps
        ]
        strain = np.sum(strains, axis=0)
        square = np.einsum("eqi,eqij,eqj->eq", strain, stiffness, strain) / stiffness[..., 0, 0].max(axis=1)[:, None]
        largest = max(largest, float(square.max(initial=0.0)))
    return float(np.sqrt(largest))


def _of_connectors(system: System, p: np.ndarray, load_factor: float, slope: np.ndarray) -> csr_array:
    """Return the geometric stiffness (unknown, unknown) of the connectors for displacements (n,)."""
    count, connectors, zeros = len(system.free_dofs), system.connectors, np.zeros(len(p))
    result, gravity = csr_array((count, count)), connectors.gravity(load_factor)
    for item in connectors.items:

        def stiffness(q: np.ndarray, item: Connector = item) -> np.ndarray:
            return item.tangent((q, zeros, zeros), load_factor, gravity, STATICS)

        force = item.force(item.at((p, zeros, zeros), load_factor, gravity)).real
        unstrained, straining = _projections(item, stiffness(p), force[: len(item.dofs)])
        step = np.zeros(len(p))
        step[item.dofs], step[item.own] = straining @ slope[item.dofs], slope[item.own]
        moved = differentiated(system, stiffness, p, step)[: len(item.dofs), : len(item.dofs)]
        rate = unstrained.T @ moved @ unstrained
        number = system.unknowns.free[item.dofs]
        row, column = (each.ravel() for each in np.meshgrid(number, number, indexing="ij"))
        known = (row >= 0) & (column >= 0)
        entries = rate.ravel()[known], (row[known], column[known])
        result = result + csr_array(coo_array(entries, shape=result.shape))
    return result


def _projections(item: Connector, stiffness: np.ndarray, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return projections (d, d) onto the motions that do not strain a connector, and onto those that change its force.

    stiffness (d + k, d + k), force (d,): of the connector. In unstrained motions, which satisfy its conditions, its
    tangent changes by its force alone. In others it may also change by its stiffness, which turns with it; its force is
    small beside that. Where it has no force, unstrained motions leave it without one, and their size would hide the
    elongation of a stiff spring. Of a connector that has a force the two cannot be told apart.
    """
    units, count, whole = item.units, len(item.dofs), np.eye(len(item.dofs))
    conditions, stiffness = stiffness[count:, :count], stiffness[:count, :count]
    if len(conditions):
        q, r = qr((conditions * units).T, mode="full")[:2]
        rank = np.count_nonzero(np.abs(np.diagonal(r)) > _ROUND_OFF * np.abs(r).max())
        basis = q[:, rank:]
        return units[:, None] * (basis @ basis.T) / units, whole
    if np.any(np.abs(force * units) > _ROUND_OFF * np.max(np.abs(units[:, None] * stiffness * units))):
        return whole, whole
    values, vectors = eigh(units[:, None] * (0.5 * (stiffness + stiffness.T)) * units)
    basis = vectors[:, np.abs(values) <= _ROUND_OFF * np.max(np.abs(values))]
    unstrained = units[:, None] * (basis @ basis.T) / units
    return unstrained, whole - unstrained


_CHANGE = 1e-3  # of the stiffness: effect of loads whose symmetry is judged
_NONE = 1e-10  # of the effect of the loads on the stiffness: smaller fractions of it are round-off
_INDEPENDENT = 1e-8
_SPARE = 2  # shapes found beyond those asked for
_STRAIN = 0.2  # of the linear solution, which means nothing beyond
_MOVEMENT = 0.3  # of the model, likewise; more than strains alone would move it


def linearised_loads(
    system: System, p: np.ndarray, load_factor: float, linear: LinearSolution, count: int
) -> np.ndarray:
    """Return the `count` lowest critical lambda (m,) above a load factor, K0 phi = -(lambda - lambda0) K_sigma phi.

    linear: the linear solution about the stable state p (n,). m < count if loads soften the model in fewer directions.
    Raises InputError if loads are not conservative.
    """
    effect = _effect(system, linear)
    if effect == 0.0:
        return np.empty(0)
    if not is_symmetric(system, csr_array(linear.stiffness + _CHANGE / effect * linear.geometric)):
        raise InputError(
            "some load follows the beam, so that its work depends on the motion: such loads can make a structure "
            "flutter before its tangent is singular",
            remedy="Look at the growth that solve_modes finds about a state",
        )
    multipliers = len(system.connectors.multipliers)
    shapes = _softened(linear.geometric, linear.factors, multipliers, count, _NONE * effect)
    modes = np.zeros((shapes.shape[1], len(p)))
    modes[:, system.free_dofs] = shapes.T
    correction = np.zeros_like(p)
    unbalanced = residual_at_rest(system, p, load_factor)[system.free_dofs]
    correction[system.free_dofs] = -linear.factors.solve(unbalanced)
    softening = -shapes.T @ (linear.geometric @ shapes)
    stiffness = stiffness_of_modes(system, p, load_factor, modes, correction)
    rates = eigh(0.5 * (softening + softening.T), stiffness, eigvals_only=True)[::-1]
    return np.asarray(load_factor + 1.0 / rates[rates > _NONE * effect][:count])


def linear_reach(system: System, linear: LinearSolution, linearised: np.ndarray) -> float:
    """Return the load factor up to which linear analysis counts: the last critical one (m,), or one that moves it far.

    Raises InputError if strains are too large before any of them. The path is then straight, so that linear analysis is
    right; otherwise only the path itself shows what is critical.
    """
    moved, strained = _reaches(system, linear)
    if strained < moved and not len(linearised):
        raise InputError(
            "no positive load factor is critical as the loading path starts: the loads stiffen the model. If they "
            "soften it later, trace_equilibrium finds it"
        )
    if strained < moved and linearised[0] > strained:
        raise InputError(
            f"no load is critical at strains below {_STRAIN:.0%}, up to which linear analysis counts: its lowest "
            f"critical load strains the model by {linear.strain * linearised[0]:.0%}. trace_equilibrium finds critical "
            "points on the path itself, whatever its strains"
        )
    return min(float(linearised[-1]) if len(linearised) else np.inf, moved)


def _reaches(system: System, linear: LinearSolution) -> tuple[float, float]:
    """Return by how much loads may grow until displacements, and strains, are too large for linear analysis."""
    with np.errstate(divide="ignore"):
        moved = _MOVEMENT / np.float64(largest_movement(system, linear.slope))
        return float(moved), float(_STRAIN / np.float64(linear.strain))


def critical_growth(system: System, p: np.ndarray, load_factor: float) -> float:
    """Return by how much loads may grow from a stable state p (n,) until linear analysis finds them critical.

    Infinite if none is found as far as linear analysis counts, or if loads are not conservative.
    """
    linear = linear_solution(system, p, load_factor)
    if linear is None:
        return np.inf
    try:
        growth = linearised_loads(system, p, load_factor, linear, 1) - load_factor
    except (InputError, ConvergenceError):
        return np.inf
    return float(min(growth[growth < min(_reaches(system, linear))], default=np.inf))


def _effect(system: System, linear: LinearSolution) -> float:
    """Return the size of K0^-1 K_sigma, the largest fraction of the stiffness that a load factor of 1 changes."""
    scale = system.scale[system.free_dofs]
    x = first_vector(len(scale)) * scale
    sizes = []
    for _ in range(2):
        x = linear.factors.solve(linear.geometric @ x)
        sizes.append(float(np.linalg.norm(x / scale)))
    return sizes[1] / sizes[0] if sizes[0] > 0.0 else 0.0


def _softened(geometric: csr_array, factors: Factorised, multipliers: int, count: int, none: float) -> np.ndarray:
    """Return a basis (unknown, m) of the shapes that lose the largest fraction of their stiffness per unit load.

    Multipliers, the last of the unknowns, are zero in it; none: fraction that is round-off. The inverse of the tangent
    times -K_sigma is not symmetric, but it contains no sums of large terms that cancel.
    """
    n = geometric.shape[0]

    def lost(x: np.ndarray) -> np.ndarray:
        result = -factors.solve(geometric @ x)
        result[n - multipliers :] = 0.0
        return result

    x = dominant_pairs(lost, csr_array(eye_array(n)), count + _SPARE, "LR", none)[1][:, : count + _SPARE + 1]
    # close eigenvalues may appear as a complex pair, whose real and imaginary parts span their shapes
    parts = np.column_stack([x.real, x.imag])
    basis, triangle, _ = qr(parts, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(triangle))
    return np.asarray(basis[:, sizes > _INDEPENDENT * sizes[0]])
