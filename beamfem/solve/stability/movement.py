"""Size of a change of the coordinates, independent of the orientation of the model in the plane."""

import numpy as np

from beamfem.assembly.system import System
from beamfem.kernels.block import GRADIENTS, TURNED_GRADIENTS


def largest_movement(system: System, change: np.ndarray) -> float:
    """Return the largest component of a change (n,): relative displacements, gradients, rotations [rad]."""
    scaled = np.append(change / system.scale, 0.0)
    largest = 0.0
    for block in system.blocks:
        plain = np.isin(block.node_kind, (GRADIENTS, TURNED_GRADIENTS))
        displacements, rotations = block.dof[:, :2], block.dof[~plain, 2:]
        gradients = block.dof[plain, 2:].reshape(-1, 2)
        moved = (np.hypot(*scaled[displacements].T), np.hypot(*scaled[gradients].T), np.abs(scaled[rotations]))
        largest = max(largest, *(float(values.max(initial=0.0)) for values in moved))
    return largest
