"""The stiffness of modes, free of the round-off of an assembled tangent.

Entries of the tangent are as large as E A / l times squared slopes; for a soft mode of a slender beam their sum is so
much smaller that it is lost in their round-off. Computing the strains of the mode first, and then their energy, avoids
this. Likewise, stresses of a state carry the round-off of its positions, unless the correction that would balance them,
which is too small to be added to the positions, is added to their strains.
"""

import numpy as np
from scipy.sparse import csr_array

from beamfem.assembly.equations import STATICS, linearise, predicted_stresses
from beamfem.assembly.stress_resultants import free_group, resultants
from beamfem.assembly.system import System
from beamfem.linalg.tangent import UNROTATED


def stiffness_of_modes(
    system: System, p: np.ndarray, load_factor: float, modes: np.ndarray, correction: np.ndarray | None = None
) -> np.ndarray:
    """Return the symmetric part (m, m) of modes K modes^T for changes (m, n) of the coordinates.

    K: tangent in the state p (n,), sum B^T C B over the quadrature points plus the contributions of stresses, springs
    and loads; correction (n,): the remaining correction of the state.
    """
    zeros, count = np.zeros(len(p)), len(modes)
    result = np.zeros((count, count))
    imposing = system.imposing(load_factor)
    for block in system.blocks:
        classes, points, measures, _ = block.stiffness.shape
        unit = np.broadcast_to(np.eye(measures), (classes, points, measures, measures))
        plain = free_group(block.resisting(unit), len(p))
        before, *after = resultants(plain, p, [zeros, *modes], imposing)
        strains = (np.array(after) - before).reshape(count, *before.shape)
        stressed = np.einsum("eq,eqij,meqj->meqi", block.weight[block.kind], block.linearised(before, p), strains)
        result += stressed.reshape(count, -1) @ strains.reshape(count, -1).T
    stresses = stresses_of(system, p, zeros if correction is None else correction, load_factor)
    free = modes[:, system.free_dofs]
    result += free @ (weak_stiffness(system, p, load_factor, stresses) @ free.T)
    return np.asarray(0.5 * (result + result.T))


def stresses_of(system: System, p: np.ndarray, correction: np.ndarray, load_factor: float) -> tuple[np.ndarray, ...]:
    """Return the stress resultants of a state in each block (ne, nq, ns); in the reference only imposed ones."""
    if np.array_equal(p, system.reference) and not system.imposing(load_factor).any():
        return tuple(np.zeros_like(stresses) for stresses in system.assembler().stresses)
    return predicted_stresses(system, p, correction, load_factor)


def weak_stiffness(system: System, p: np.ndarray, load_factor: float, stresses: tuple[np.ndarray, ...]) -> csr_array:
    """Return the tangent (unknown, unknown) without sum B^T C B: the contributions of stresses, springs and loads."""
    zeros = np.zeros(len(p))
    weak = system.without_stiffness
    return linearise(system, p, zeros, zeros, load_factor, STATICS, stresses, weak)[1].sparse(UNROTATED)
