"""Nodal vectors that rotate with their section, in runs that compiled code rotates one after the other."""

import numpy as np


def runs_of(pairs: np.ndarray) -> np.ndarray:
    """Return runs (runs, 5) of vectors: equation numbers of x and y, node, step, and how many vectors.

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
