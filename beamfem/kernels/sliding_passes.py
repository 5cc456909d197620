"""Force and tangent of a point that slides on an element of a beam, at the closest place of its axis.

With r(xi) = sum N_i(xi) r_i, prolonged beyond the ends by its tangents, the closest place is the root of
h = (r_b - r) . r' = 0, and the condition g = (r_b - r) . n - distance, with the unit normal n of r'. The gradient of g
is w_i n with r_b - r = sum w_i q_i, and dn = - t (n . dr') / |r'|.

q: the position r_b and then the vectors r_i (m, 2); data: m, the coefficients (m, m) of the powers of xi - 1/2 in
each N_i, and the distance. Signatures are those of `kernels.model_record.Parts`.
"""

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.pointers import room

MOST = 15  # vectors


@inlined
def _place(q, data, xi, shape, slope, at):
    """Fill N_i and N_i' of the vectors, and r_b - r, r' and r'' (6,)."""
    count, inside = int(data[0]), min(max(xi, 0.0), 1.0)
    beyond, middle = xi - inside, inside - 0.5
    at[0], at[1] = q[0], q[1]
    for i in range(2, 6):
        at[i] = 0.0
    for i in range(count):
        value, first, second = 0.0, 0.0, 0.0
        for j in range(count):
            second = second * middle + 2.0 * first
            first = first * middle + value
            value = value * middle + data[count * i + count - j]
        shape[i], slope[i] = value + beyond * first, first
        if beyond != 0.0:
            second = 0.0
        x, y = q[2 + 2 * i], q[3 + 2 * i]
        at[0], at[1] = at[0] - shape[i] * x, at[1] - shape[i] * y
        at[2], at[3] = at[2] + first * x, at[3] + first * y
        at[4], at[5] = at[4] + second * x, at[5] + second * y


@routine("rrdr")
def sliding_root(q, data, xi, out):
    """Fill h, -dh/dxi, |r_b - r|^2 and |r'|^2 (4,)."""
    shape, slope, place = room(MOST), room(MOST), room(6)
    _place(q, data, xi, shape, slope, place)
    size = place[2] * place[2] + place[3] * place[3]
    out[0] = place[0] * place[2] + place[1] * place[3]
    out[1] = size - place[0] * place[4] - place[1] * place[5]
    out[2], out[3] = place[0] * place[0] + place[1] * place[1], size


@routine("rrrrrrrr")
def sliding_force(q, v, a, own, turned, data, gravity, out):
    """Fill the forces (2 m + 2,) and the condition; turned: xi."""
    shape, slope, place = room(MOST), room(MOST), room(6)
    _place(q, data, turned[0], shape, slope, place)
    count, length = int(data[0]), (place[2] * place[2] + place[3] * place[3]) ** 0.5
    x, y = -place[3] / length, place[2] / length
    out[0], out[1] = own[0] * x, own[0] * y
    for i in range(count):
        out[2 + 2 * i], out[3 + 2 * i] = -shape[i] * own[0] * x, -shape[i] * own[0] * y
    out[2 + 2 * count] = place[0] * x + place[1] * y - data[count * count + 1]


@routine("rrrrrrrdddr")
def sliding_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    """Fill the derivative of forces and condition by q and the multiplier, row by row; turned: xi."""
    shape, slope, place = room(MOST), room(MOST), room(6)
    _place(q, data, turned[0], shape, slope, place)
    count, length = int(data[0]), (place[2] * place[2] + place[3] * place[3]) ** 0.5
    tx, ty = place[2] / length, place[3] / length
    x, y = -ty, tx
    distance, bend = place[0] * x + place[1] * y, place[4] * x + place[5] * y
    curved, size = length * length - distance * bend, 2 * count + 3
    for row in range(count + 1):
        own_shape = 1.0 if row == 0 else -shape[row - 1]
        own_slope = 0.0 if row == 0 else slope[row - 1]
        for column in range(count + 1):
            other_shape = 1.0 if column == 0 else -shape[column - 1]
            other_slope = 0.0 if column == 0 else slope[column - 1]
            for i in range(2):
                for j in range(2):
                    own_n, other_n = x if i == 0 else y, x if j == 0 else y
                    own_t, other_t = tx if i == 0 else ty, tx if j == 0 else ty
                    rate = (length * other_t * other_shape + distance * other_n * other_slope) / curved
                    across = (other_n * other_slope + bend * rate) / length
                    stiffness = own_n * own_slope * rate + own_t * own_shape * across
                    out[(2 * row + i) * size + 2 * column + j] = -ck * own[0] * stiffness
        for i in range(2):
            gradient = ck * own_shape * (x if i == 0 else y)
            out[(2 * row + i) * size + size - 1] = out[(size - 1) * size + 2 * row + i] = gradient
    out[size * size - 1] = 0.0
