"""The linear solution about a state: displacements per unit of the load factor, and their geometric stiffness."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.assembly.connector import Connector
from beamfem.assembly.differences import differentiated
from beamfem.assembly.equations import STATICS, linearise, load_change, predicted_stresses
from beamfem.assembly.stress_resultants import free_group, resultants
from beamfem.assembly.system import System
from beamfem.linalg.lapack import eigh
from beamfem.linalg.tangent import UNROTATED, Factorised
from beamfem.solve.modes.mode_stiffness import weak_stiffness
from beamfem.solve.start.functions_of_time import functions_of_time

_WIDTH = 1e-4  # of the load factor: loads with amplitudes are differentiated over it
_NO_SLOPE = 1e-6  # of the change of the loads further on: a smaller slope is an error of the difference
_ROUND_OFF = 1e-10  # of the largest stiffness of a connector


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
    tangent = linearise(system, p, zeros, zeros, load_factor, STATICS)[1]
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

    The difference is forward, since amplitudes may have a kink at the start, and of second order.
    """
    size = max(1.0, abs(load_factor))
    if not functions_of_time(system) and not system.connectors.items:
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
        classes, points, measures, _ = block.stiffness.shape
        unit = np.broadcast_to(np.eye(measures), (classes, points, measures, measures))
        plain, stiffness = free_group(block.resisting(unit), len(p)), block.stiffness[block.kind]
        steps = [(0.0, load_factor, -sum(weight for _, weight in differences))]
        steps += [(at - load_factor, at, weight) for at, weight in differences]
        strains = [weight * resultants(plain, p, [by * slope], system.imposing(at))[0] for by, at, weight in steps]
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
        unstrained = _unstrained(item, stiffness(p), force)
        rate = unstrained.T @ differentiated(system, stiffness, p, slope) @ unstrained
        number = system.unknowns.free[item.all]
        row, column = (each.ravel() for each in np.meshgrid(number, number, indexing="ij"))
        known = (row >= 0) & (column >= 0)
        entries = rate.ravel()[known], (row[known], column[known])
        result = result + csr_array(coo_array(entries, shape=result.shape))
    return result


def _unstrained(item: Connector, stiffness: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Return the projection (d, d) onto the motions that do not strain a connector, all of them if it has a force.

    In these motions its tangent changes by its force alone. In others it may also change by its stiffness, which turns
    with it; its force is small beside that. Of a connector that already has a force the two cannot be told apart.
    """
    units = item.units
    if np.any(np.abs(force * units) > _ROUND_OFF * np.max(np.abs(units[:, None] * stiffness * units))):
        return np.eye(len(units))
    values, vectors = eigh(units[:, None] * (0.5 * (stiffness + stiffness.T)) * units)
    basis = vectors[:, np.abs(values) <= _ROUND_OFF * np.max(np.abs(values))]
    return units[:, None] * (basis @ basis.T) / units
