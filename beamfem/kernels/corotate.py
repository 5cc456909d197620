"""A kept tangent that turns with the sections: K(now) is near R K(kept) R^T, R turning the vectors of each node.

Exact where a body has turned as a whole; then a pendulum or a rotor needs no new tangent for its turning.
"""

import math

from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True)
def keep_directions(work, kept):
    """Store the vectors d (N, 2) of the nodes of all blocks."""
    row = 0
    for i in range(len(work)):
        e = work[i].nodes[0]
        last = e.shape[1] - 1
        for node in range(e.shape[0]):
            kept[row, 0], kept[row, 1] = e[node, last - 1], e[node, last]
            row += 1


@kernel(forceinline=True, fastmath=FAST)
def turns_since(work, kept, turns):
    """Fill cosine and sine (N, 2) of how far the nodes have turned since their vectors d were kept."""
    row = 0
    for i in range(len(work)):
        e = work[i].nodes[0]
        last = e.shape[1] - 1
        for node in range(e.shape[0]):
            x, y, x0, y0 = e[node, last - 1], e[node, last], kept[row, 0], kept[row, 1]
            c, s = x * x0 + y * y0, y * x0 - x * y0
            inverse = 1.0 / math.sqrt(c * c + s * s)
            turns[row, 0], turns[row, 1] = c * inverse, s * inverse
            row += 1


@kernel(forceinline=True, fastmath=FAST)
def turn(right, pairs, turns, sense):
    """Turn vectors in a right-hand side (n,) with their nodes, sense -1: back. pairs (np, 3): numbers of x, y, node."""
    for i in range(pairs.shape[0]):
        first, second, node = pairs[i, 0], pairs[i, 1], pairs[i, 2]
        c, s = turns[node, 0], sense * turns[node, 1]
        x, y = right[first], right[second]
        right[first], right[second] = c * x - s * y, s * x + c * y
