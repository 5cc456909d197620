"""An indicator of coarse meshes: how far elements turn, and how their moments jump, in a state."""

import numpy as np

from beamfem.kernels.compiling import routine
from beamfem.kernels.neighbouring_nodes import normal
from beamfem.kernels.pointers import at, reals, wholes

NUMBERS, FACTORS, ELEMENT, WEIGHTS = 4, 9, 3, 5  # of a pair, and of an element
TINY = 1e-300


@routine("nr", "d")
def coarseness(table, q):
    """Return how coarse the elements are for a state q (n,): larger than 1 if displacements may be off by 1 %.

    The angle a between the directors of neighbouring nodes changes by da from the reference. An element has the sum of
    the largest of |a| and |da|, now and in the reference; its end moments, linear in da; and the part of its moments of
    the highest degree that it can represent.

    table: number of elements, addresses of whole (elements, ELEMENT), weights (elements, WEIGHTS), numbers
    (pairs, NUMBERS) and factors (pairs, FACTORS). whole: number of pairs of neighbouring nodes, whether the element
    continues the one before, order. weights: inverse of a critical sum of angles; weight of its power; of jumps of
    moments; of the highest part; of a moment in an element on its own. numbers: angle and -1, or x and y of r_y, at
    both nodes. factors: inverse of both r_y in the reference as complex numbers; then for da its weight in the moments
    at the start and the end, in the energy by its square, and in the highest part; and a in the reference.
    """
    elements = table[0]
    whole, weights = wholes(table[1]), reals(table[2])
    numbers, factors = wholes(table[3]), reals(table[4])
    energy, jumps, highest, turned = 0.0, 0.0, 0.0, 0.0
    before, weight_before = 0.0, 0.0
    k = 0
    for e in range(elements):
        own, w = at(whole, e * ELEMENT), at(weights, e * WEIGHTS)
        start, end, part, turn = 0.0, 0.0, 0.0, 0.0
        for _ in range(own[0]):
            n, f = at(numbers, k * NUMBERS), at(factors, k * FACTORS)
            if n[1] < 0 and n[3] < 0:
                angle = q[n[2]] - q[n[0]]
            else:
                x1, y1 = normal(q, n, f)
                x2, y2 = normal(q, at(n, 2), at(f, 2))
                along, across = x1 * x2 + y1 * y2, x1 * y2 - y1 * x2
                # the arctangent to 0.005
                t = across / (along + (along * along + across * across) ** 0.5 + TINY)
                if abs(t) <= 1.0:
                    angle = 2.0 * t / (1.0 + 0.28 * t * t)
                else:
                    angle = np.pi * t / abs(t) - 2.0 * t / (t * t + 0.28)
            start, end = start + f[4] * angle, end + f[5] * angle
            energy += f[6] * angle * angle
            part += f[7] * angle
            turn += max(abs(angle), abs(f[8]), abs(angle + f[8]))
            k += 1
        if own[1] > 0:
            jump = start - before
            jumps += jump * jump * (w[2] + weight_before)
        jumps += start * start * w[4]
        before, weight_before = end, w[2]
        highest += part * part * w[3]
        power, ratio = 1.0, turn * w[0]
        for _ in range(2 * own[2]):
            power = power * ratio
        turned += power * w[1]
    if energy > 0.0:
        turned += (jumps + highest) / energy
    return turned
