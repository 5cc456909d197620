"""Size of a model and of a change of its coordinates, independent of its orientation in the plane and its division."""

import numpy as np

from beamfem.assembly.system import System
from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS


def size_of(system: System) -> float:
    """Return twice the largest distance [m] of a node from the centre of all beams, the length of a straight one.

    `System.extent` is no measure of results: it is the length of the longest beam, and halves are shorter.
    """
    chains = [mesh.position for mesh in system.model.meshes]
    steps, middles = (np.concatenate([of(chain) for chain in chains]) for of in (_steps, _middles))
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


def _steps(chain: np.ndarray) -> np.ndarray:
    return np.diff(chain, axis=0)


def _middles(chain: np.ndarray) -> np.ndarray:
    return 0.5 * (chain[1:] + chain[:-1])
