"""The stiffness of a mode, free of the round-off of an assembled tangent.

Entries of the tangent are as large as E A / l times squared slopes; of a soft mode of a slender beam their sum is so
much smaller that it drowns in their round-off. Strains of the mode first, then their energy, lose nothing.
"""

import numpy as np

from beamfem.analysis.equations import STATICS, linearise, predicted_stresses
from beamfem.analysis.pencil import UNTURNED
from beamfem.kernels.stress import predict_stress
from beamfem.model.system import System


def mode_stiffness(system: System, p: np.ndarray, load_factor: float, mode: np.ndarray) -> float:
    """Return mode . K mode of the tangent K in the state p (n,) for a change (n,) of the coordinates."""
    return float(stiffness_of_modes(system, p, load_factor, mode[None])[0, 0])


def stiffness_of_modes(system: System, p: np.ndarray, load_factor: float, modes: np.ndarray) -> np.ndarray:
    """Return the symmetric part (k, k) of modes K modes^T for changes (k, n) of the coordinates.

    K = sum B^T C B over the quadrature points, and what stresses, springs and loads add.
    """
    rest, material, weak = np.zeros(len(p)), np.zeros((len(modes), len(modes))), []
    for form, block, work in zip(system.forms, system.blocks, system.workspaces(), strict=True):
        classes, points, measures, _ = block.stiffness.shape
        unit = np.ascontiguousarray(np.broadcast_to(np.eye(measures), (classes, points, measures, measures)))
        plain = block._replace(stiffness=unit)
        strains = np.empty((len(modes) + 1, len(block.kind), points, measures))
        for strain, step in zip(strains, (rest, *modes), strict=True):
            predict_stress(form, plain, work, p, np.ascontiguousarray(step), strain)
        changes = strains[1:] - strains[0]
        stiffness, weight = block.stiffness[block.kind], block.weight[block.kind]
        material += np.einsum("eq,aeqi,eqij,beqj->ab", weight, changes, stiffness, changes)
        weak.append(block._replace(stiffness=np.zeros_like(block.stiffness)))
    stresses = predicted_stresses(system, p, rest)
    other = linearise(system, p, rest, rest, load_factor, STATICS, stresses, tuple(weak))[1].sparse(UNTURNED)
    free = modes[:, system.free_dofs]
    result = material + free @ (other @ free.T)
    return np.asarray(0.5 * (result + result.T))
