"""Stretches and angles between neighbouring nodes of elements, compared with bounds."""

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.nodes import cosine_sine
from beamfem.kernels.pointers import at, reals, wholes

LOCKED, STRAINED = 1, 2
NUMBERS, FACTORS = 8, 10  # of a pair


@inlined
def normal(q, numbers, turn):
    """Return the unit normal of a section: of an angle, or turned from r_y.

    numbers: of the angle and -1, or of x and y of r_y; turn: the inverse of r_y in the reference as a complex number.
    """
    i, j = numbers[0], numbers[1]
    if j < 0:
        x, y = cosine_sine(q[i])
    else:
        x, y = q[i] * turn[0] - q[j] * turn[1], q[i] * turn[1] + q[j] * turn[0]
    return x, y


@routine("nrii", "i")
def exceeds(table, p, rows, times):
    """Return LOCKED if weighted angles between neighbouring nodes exceed 1, plus STRAINED if those for strains do.

    table: size of a state, number of pairs, STRAINED if that is known already, addresses of numbers and of factors;
    p (rows, size): the states. numbers (pairs, NUMBERS): of the coordinates x1, y1, x2, y2 of the nodes, then
    for each its angle and -1, or x and y of its r_y. factors (pairs, FACTORS): inverse of the chord and of both r_y in
    the reference, as complex numbers; for locking, a factor of the angle, multiplied by `times`, and a constant; for
    strains, factors of the stretch and the angle.
    """
    size, pairs, strained = table[0], table[1], table[2]
    numbers, factors = wholes(table[3]), reals(table[4])
    locked = 0
    for row in range(rows):
        q = at(p, row * size)
        for k in range(pairs):
            own, f = at(numbers, k * NUMBERS), at(factors, k * FACTORS)
            dx, dy = q[own[2]] - q[own[0]], q[own[3]] - q[own[1]]
            along, across = dx * f[0] - dy * f[1], dx * f[1] + dy * f[0]
            for end in range(2):
                x, y = normal(q, at(own, 4 + 2 * end), at(f, 2 + 2 * end))
                stretch, angle = abs(along * x + across * y - 1.0), abs(across * x - along * y)
                if times * angle * f[6] + f[7] > 1.0:
                    locked = LOCKED
                if stretch * f[8] + angle * f[9] > 1.0:
                    strained = STRAINED
    return locked + strained
