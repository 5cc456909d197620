"""Damping of section laws with history: how much more stiffly they resist a step than a sudden strain."""

import numpy as np
from scipy.sparse import bsr_array, csr_array

from beamfem.equations.strain_rates import strain_rates
from beamfem.equations.stress_resultants import resultants
from beamfem.equations.system import System
from beamfem.section.law import ConstitutiveLaw


def viscous_tangent(system: System, p: np.ndarray, v: np.ndarray, time: float, step: float) -> csr_array | None:
    """Return step^2 times the tangent (unknown, unknown) of viscous forces over a step [s] from p, p' (n,) at a time.

    For Kelvin and Voigt's law it is step D, with the damping matrix D. None if no section law with history is viscous.
    """
    total, imposing, unknown = None, system.loads.imposing(time), len(system.free_dofs)
    for (law, block), group in zip(system.history.laws, system.history.strains, strict=True):
        (strain,) = resultants(group, p, [step * v], imposing)
        past = p[block.history]
        elements, points, variables = past.shape
        acting = strain[:, :points, :3].reshape(-1, 3)
        stiffness = viscous_stiffness(law, acting, past.reshape(-1, variables), step)
        if not stiffness.any():
            continue
        measures = strain.shape[-1]
        entries = np.zeros((*strain.shape, measures))
        weight = block.weight[block.kind][:, :points, None, None]
        entries[:, :points, :3, :3] = step**2 * weight * stiffness.reshape(elements, points, 3, 3)
        entries = entries.reshape(-1, measures, measures)
        weights = bsr_array((entries, np.arange(len(entries)), np.arange(len(entries) + 1)))
        unit = np.broadcast_to(np.eye(measures), block.stiffness.shape)
        table = strain_rates(block.resisting(unit), system.unknowns.free)
        rates = table.at(p, imposing).rates
        slopes = csr_array((rates, (table.point, table.column)), shape=(strain.size, unknown))
        part = csr_array(slopes.T @ weights @ slopes)
        total = part if total is None else total + part
    return total


def viscous_stiffness(law: ConstitutiveLaw, strain: np.ndarray, history: np.ndarray, step: float) -> np.ndarray:
    """Return what a time step [s] adds to the tangent (n, 3, 3) of a law at strains (n, 3) and history (n, k).

    A law that relaxes is less stiff over a step than for a sudden strain. This is no damping, and is left out.
    """
    change = law.linearised(strain, history, step)[1] - law.linearised(strain, history)[1]
    if not change.any():
        return change
    # N and M have different units, in none of which their coupling may decide on its own
    sizes = np.sqrt(np.abs(np.diagonal(change, axis1=1, axis2=2)))
    sizes[sizes == 0.0] = 1.0
    units = sizes[:, :, None] * sizes[:, None, :]
    values, vectors = np.linalg.eigh(change / units)
    return units * ((vectors * np.maximum(values, 0.0)[:, None, :]) @ np.swapaxes(vectors, 1, 2))
