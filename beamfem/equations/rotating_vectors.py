"""Nodal vectors that rotate with their section, in runs that compiled code rotates one after the other."""

import numpy as np

from beamfem.equations.element_group import storage_order, stored
from beamfem.equations.system import System
from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH

_GRADIENTS = (GRADIENTS, ROTATED_GRADIENTS)
# kinds of nodes that have r, r_x and r_y themselves as coordinates
_ROTATING = ((*_GRADIENTS, ROTATION, STRETCH, SHEAR_RIGID), (*_GRADIENTS, ROTATION), _GRADIENTS)


def rotating_vectors(system: System) -> np.ndarray:
    """Return equation numbers of x and y, node and number of each nodal vector that is a coordinate (np, 4).

    A tangent that is kept for several steps is rotated with the sections in these components. Nodes are numbered
    consecutively over all blocks, in storage order. Vectors with a prescribed component or an inclined roller are
    left out.
    """
    tables, first, free = [], 0, system.unknowns.free
    for numbered in system.blocks:
        block = stored(numbered, storage_order(numbered.node, len(numbered.node_kind)))
        vectors = block.scale.shape[1] // block.node.shape[1]
        for slot in range(vectors):
            rotating = _ROTATING[0 if slot == 0 else 2 if slot == vectors - 1 else 1]
            nodes = np.flatnonzero(np.isin(block.node_kind, rotating))
            x, y = (free[block.dof[nodes, 2 * slot + axis]] if len(nodes) else nodes for axis in (0, 1))
            mask = (x >= 0) & (y >= 0)
            tables.append(np.column_stack([x, y, first + nodes, np.full(len(nodes), slot)])[mask])
        first += len(block.dof)
    pairs = np.concatenate(tables)
    _, once = np.unique(pairs[:, 0], return_index=True)
    return np.ascontiguousarray(pairs[once[~np.isin(pairs[once, 0], system.rotated[0])]])


def runs_of(pairs: np.ndarray) -> np.ndarray:
    """Return runs (runs, pair fields) of vectors, see `kernels.model_record.PAIR_X`.

    pairs (np, 4): equation numbers of x and y, node and number of the nodal vector of each. From one vector of a run to
    the next, the node increases by one, and the equation numbers increase by the step.
    """
    own = pairs[np.lexsort((pairs[:, 2], pairs[:, 3]))]
    step = np.diff(own, axis=0)
    goes_on = (step[:, 0] == step[:, 1]) & (step[:, 2] == 1) & (step[:, 3] == 0)
    joined = goes_on.copy()
    joined[1:] &= ~goes_on[:-1] | (step[1:, 0] == step[:-1, 0])
    first = np.flatnonzero(np.append(True, ~joined))[: len(own)]
    count = np.diff(np.append(first, len(own)))
    steps = np.append(step[:, 0], 0)[first]
    return np.ascontiguousarray(np.column_stack([own[first, :3], steps, count]))
