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
    """Return mode . K mode of the tangent K in the state p (n,) for a change (n,) of the coordinates.

    K = sum B^T C B over the quadrature points, and what stresses, springs and loads add.
    """
    rest, material, weak = np.zeros(len(p)), 0.0, []
    for form, block, work in zip(system.forms, system.blocks, system.workspaces(), strict=True):
        classes, points, measures, _ = block.stiffness.shape
        unit = np.ascontiguousarray(np.broadcast_to(np.eye(measures), (classes, points, measures, measures)))
        plain = block._replace(stiffness=unit)
        ends = np.empty((2, len(block.kind), points, measures))
        for strain, step in zip(ends, (rest, mode), strict=True):
            predict_stress(form, plain, work, p, step, strain)
        strain = ends[1] - ends[0]
        stiffness, weight = block.stiffness[block.kind], block.weight[block.kind]
        material += float(np.einsum("eq,eqi,eqij,eqj->", weight, strain, stiffness, strain))
        weak.append(block._replace(stiffness=np.zeros_like(block.stiffness)))
    stresses = predicted_stresses(system, p, rest)
    other = linearise(system, p, rest, rest, load_factor, STATICS, stresses, tuple(weak))[1].sparse(UNTURNED)
    free = mode[system.free_dofs]
    return material + float(free @ (other @ free))
