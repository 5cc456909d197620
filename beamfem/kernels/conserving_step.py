"""The balance of a step that conserves energy and momenta, and its derivative by the state at the end.

All nodal vectors are linear in z: coordinates p, unit vectors u = (cos t, sin t) of angles t, and s u with stretches s.
With its constant mass M, rates w = dz/dp p', N = dz/dp in the mean of z, and all else in the mean of both states,

    2 / h N' m = 0 with m = M (dz / h - w),    N' (M dw / h + forces) + turning = 0.

m keeps |u| = 1 and (s u) x u = 0, whose multipliers l follow from it: m is the sum of l times the gradients in the mean
of z. So that their rates vanish too, `turning` is N' times the sum of l times the gradients in the mean of w (Gonzalez
1999); energy and momenta of p and p' are then conserved.
"""

from typing import Annotated

from beamfem.kernels.compiler.value_types import signature_of
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.nodes import cosine_sine
from beamfem.kernels.pointers import at, room
from beamfem.kernels.records import Reals, Record, Slots, Table, Wholes, calls

BETWEEN = signature_of("rrrrdr")  # start and end (6,) of r', d and the third vector, stiffness, reference, weight, out


class Strained(Record):
    """The quadrature points of a block of elements, which depend on `size` numbers of z each."""

    elements: int
    points: int
    size: int
    measures: int
    numbers: Annotated[Wholes, "elements", "size"]
    gather: Annotated[Reals, "elements", "points", 6, "size"]
    weight: Annotated[Reals, "elements", "points"]
    stiffness: Annotated[Reals, "elements", "points", "measures", "measures"]
    reference: Annotated[Reals, "elements", "points", "measures"]
    places: Annotated[Wholes, "elements", "size", "size"]  # in the entries of matrices of z
    moved: Annotated[Reals, "size"]
    between = calls(BETWEEN)  # fills the forces (6,) and their derivative (6, 6) by the end


class Conserving(Record):
    """A model in two states, z and w at the start and at the end, and their means."""

    time_step: float
    size: int  # of z
    coordinates: int  # of p, the first numbers of z
    angle_count: int
    stretch_count: int
    linear: Annotated[Wholes, "coordinates"]  # whether z is p, else it is zero
    angles: Annotated[Wholes, "angle_count"]
    stretches: Annotated[Wholes, "stretch_count"]
    angle_of: Annotated[Wholes, "stretch_count"]  # number of the angle of a stretch
    equations: Annotated[Wholes, "size", 2]  # of the two coordinates on which z depends, -1 for none
    unknown: int
    rows: Wholes  # (size + 1,): first entry of each row of matrices of z
    entries: int
    columns: Annotated[Wholes, "entries"]
    mass: Annotated[Reals, "entries"]
    ground: Annotated[Reals, "entries"]  # stiffness of foundations
    stiffness: Annotated[Reals, "entries"]
    places: Annotated[Wholes, "entries", 2, 2]  # in `matrix`, -1 for none
    angle_places: Annotated[Wholes, "angle_count"]
    stretch_places: Annotated[Wholes, "stretch_count", 2]  # of (t, s) and (s, t)
    below: Annotated[Wholes, "unknown"]  # entries of a column by p in the first equations, before those in the others
    by_rates: int  # entries by p, before those by p'
    filled: int
    matrix: Annotated[Reals, "filled"]
    left: Annotated[Reals, 2, "unknown"]
    p: Annotated[Reals, "coordinates"]
    v: Annotated[Reals, "coordinates"]
    loads: Reals  # (steps or 1, size)
    load: Reals  # (size,): in this step
    vectors: Annotated[Reals, 3, "size"]  # z: at the start, at the end, mean
    rates: Annotated[Reals, 3, "size"]  # w
    lost: Annotated[Reals, "size"]  # m
    force: Annotated[Reals, "size"]
    slopes: Annotated[Reals, 4, "size", 2]  # dz/dp in the mean and at the end, its rate at the end; turning by m
    sizes: Annotated[Slots, 5]  # of the matrix for LAPACK, and its status
    exchanged: Slots  # (2 unknown,)
    right: Annotated[Reals, "unknown", 2]
    group_count: int
    groups: Table[Strained]
    dgbsv = calls(signature_of("ssssrssrss"))
    place_vectors = calls("conserving_step:place_vectors")
    balance = calls("conserving_step:balance")
    correct = calls("conserving_step:correct_band")
    add_strained = calls("conserving_step:add_strained")
    add_entries = calls("conserving_step:add_entries")
    add_turning = calls("conserving_step:add_turning")


@routine()
def place_vectors(own: Conserving, state: int) -> None:
    """Fill z and w of a state, 0 at the start or 1 at the end, from p and p'."""
    p, v, n = own.p, own.v, own.coordinates
    z, w = at(own.vectors, state * own.size), at(own.rates, state * own.size)
    for i in range(n):
        z[i], w[i] = own.linear[i] * p[i], own.linear[i] * v[i]
    for k in range(own.angle_count):
        c, s = cosine_sine(p[own.angles[k]])
        rate, u = v[own.angles[k]], n + 2 * k
        z[u], z[u + 1], w[u], w[u + 1] = c, s, -rate * s, rate * c
    for j in range(own.stretch_count):
        u, y = n + 2 * own.angle_of[j], n + 2 * (own.angle_count + j)
        stretch, rate = p[own.stretches[j]], v[own.stretches[j]]
        for axis in range(2):
            z[y + axis], w[y + axis] = stretch * z[u + axis], rate * z[u + axis] + stretch * w[u + axis]


@inlined
def _spread(own, z, linear, to):
    """Fill dz/dp in z; of w it is the rate of dz/dp, with zero where z is linear."""
    n = own.coordinates
    for i in range(n):
        to[2 * i], to[2 * i + 1] = linear, 0.0
    for k in range(own.angle_count):
        u = n + 2 * k
        to[2 * u], to[2 * u + 1], to[2 * u + 2], to[2 * u + 3] = -z[u + 1], 0.0, z[u], 0.0
    for j in range(own.stretch_count):
        u, y = n + 2 * own.angle_of[j], n + 2 * (own.angle_count + j)
        to[2 * y], to[2 * y + 1], to[2 * y + 2], to[2 * y + 3] = -z[y + 1], z[u], z[y], z[u + 1]


@routine()
def add_strained(group: Strained, own: Conserving) -> None:
    """Add the forces of elements between both states, and their derivative by z at the end."""
    size, count, force, entries = group.size, group.measures, own.force, own.stiffness
    start, end, out, moved = room(6), room(6), room(42), group.moved
    z0, z1 = own.vectors, at(own.vectors, own.size)
    for element in range(group.elements):
        numbers, places = at(group.numbers, element * size), at(group.places, element * size * size)
        for point in range(group.points):
            number = element * group.points + point
            gather = at(group.gather, number * 6 * size)
            for row in range(6):
                a, b, weights = 0.0, 0.0, at(gather, row * size)
                for i in range(size):
                    a += weights[i] * z0[numbers[i]]
                    b += weights[i] * z1[numbers[i]]
                start[row], end[row] = a, b
            stiffness, reference = at(group.stiffness, number * count * count), at(group.reference, number * count)
            group.between(start, end, stiffness, reference, group.weight[number], out)
            for row in range(6):
                weights, slope = at(gather, row * size), at(out, 6 + 6 * row)
                for j in range(size):
                    total = 0.0
                    for column in range(6):
                        total += slope[column] * gather[column * size + j]
                    moved[j] = total
                for i in range(size):
                    weight = weights[i]
                    if weight != 0.0:
                        force[numbers[i]] += weight * out[row]
                        to = at(places, i * size)
                        for j in range(size):
                            entries[to[j]] += weight * moved[j]


@inlined
def _add(own, place, column, by_p, by_v, by_p_below, by_v_below):
    """Add the four derivatives of both equations by a coordinate and its rate."""
    matrix, below = own.matrix, place + own.below[column]
    matrix[place] += by_p
    matrix[below] += by_p_below
    matrix[own.by_rates + place] += by_v
    matrix[own.by_rates + below] += by_v_below


@routine()
def add_entries(own: Conserving) -> None:
    """Add the products of matrices of z with dz/dp to the matrix."""
    h, size = own.time_step, own.size
    mean, end, rate, by_lost = own.slopes, at(own.slopes, 2 * size), at(own.slopes, 4 * size), at(own.slopes, 6 * size)
    for row in range(size):
        for entry in range(own.rows[row], own.rows[row + 1]):
            column, m, k = own.columns[entry], own.mass[entry], own.stiffness[entry]
            for b in range(2):
                slope = end[2 * column + b]
                lost, pushed = m * (slope / h - 0.5 * rate[2 * column + b]), m * rate[2 * column + b] / h + k * slope
                lost_by_v, pushed_by_v = -0.5 * m * slope, m * slope / h
                for a in range(2):
                    place = own.places[4 * entry + 2 * a + b]
                    if place >= 0:
                        n, t = mean[2 * row + a], by_lost[2 * row + a]
                        factor = 2.0 / h * n
                        below, below_by_v = n * pushed + t * lost, n * pushed_by_v + t * lost_by_v
                        number = own.equations[2 * column + b]
                        _add(own, place, number, factor * lost, factor * lost_by_v, below, below_by_v)


@inlined
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


@inlined
def _across(a, b):
    """Return the cross product a x b."""
    return a[0] * b[1] - a[1] * b[0]


@routine()
def add_turning(own: Conserving) -> None:
    """Add `turning` to the second equations, and the derivatives by p and p' that each angle and stretch has alone.

    As an angle changes, the means of its vectors change by half of those at the end, turned by a right angle.
    """
    n, size, unknown, h = own.coordinates, own.size, own.unknown, own.time_step
    left, by_lost = at(own.left, unknown), at(own.slopes, 6 * size)
    for k in range(own.angle_count):
        i = n + 2 * k
        number, place = own.equations[2 * i], own.angle_places[k]
        m, force, u, w = at(own.lost, i), at(own.force, i), at(own.vectors, 2 * size + i), at(own.rates, 2 * size + i)
        u1, w1 = at(own.vectors, size + i), at(own.rates, size + i)
        square, turn = _dot(u, u), _across(u, w)
        multiplier = _dot(u, m) / square
        by_lost[2 * i], by_lost[2 * i + 2] = u[0] * turn / square, u[1] * turn / square
        if number >= 0:
            left[number] += multiplier * turn
            slope = (0.5 * _across(u1, m) + multiplier * _across(u, u1)) / square
            below = -0.5 * _dot(u1, force) + slope * turn + 0.5 * multiplier * (_dot(u, w1) - _dot(u1, w))
            _add(own, place, number, -_dot(u1, m) / h, 0.0, below, 0.5 * multiplier * _dot(u, u1))
    for j in range(own.stretch_count):
        i, o = n + 2 * (own.angle_count + j), n + 2 * own.angle_of[j]
        number, other, places = own.equations[2 * i], own.equations[2 * i + 1], at(own.stretch_places, 2 * j)
        m, force, y, wy = at(own.lost, i), at(own.force, i), at(own.vectors, 2 * size + i), at(own.rates, 2 * size + i)
        u, w = at(own.vectors, 2 * size + o), at(own.rates, 2 * size + o)
        u1, w1 = at(own.vectors, size + o), at(own.rates, size + o)
        y1, wy1 = at(own.vectors, size + i), at(own.rates, size + i)
        square, turn = _dot(u, u), _across(u, w)
        multiplier, skew = -_across(u, m) / square, -_across(u, y) / square
        twist = _dot(u, wy) - _dot(y, w) - skew * turn
        for a in range(2):
            of_turn = twist if a == 0 else turn
            by_lost[2 * i + a], by_lost[2 * i + 2 + a] = of_turn * u[1] / square, -of_turn * u[0] / square
        apart = _across(u, u1) / square
        slope = 0.5 * _dot(u1, m) / square + multiplier * apart
        turn_slope, turn_rate = 0.5 * (_dot(u, w1) - _dot(u1, w)), 0.5 * _dot(u, u1)
        skew_slope = 0.5 * (_dot(u1, y) - _dot(u, y1)) / square + skew * apart
        twist_slope = 0.5 * (_across(u1, wy) - _across(u, wy1) - _across(y1, w) + _across(y, w1))
        twist_slope -= skew_slope * turn + skew * turn_slope
        twist_rate = 0.5 * (_across(y, u1) - _across(u, y1)) - skew * turn_rate
        if number >= 0:
            left[number] += multiplier * twist
            below = -0.5 * _dot(y1, force) + slope * twist + multiplier * twist_slope
            _add(own, own.angle_places[own.angle_of[j]], number, -_dot(y1, m) / h, 0.0, below, multiplier * twist_rate)
        if other >= 0:
            left[other] += multiplier * turn
        if number >= 0 and other >= 0:
            twist_slope = 0.5 * (_dot(u, w1) - _dot(u1, w) + apart * turn)
            below = 0.5 * _across(u1, force) + multiplier * twist_slope
            _add(own, places[0], other, _across(u1, m) / h, 0.0, below, multiplier * turn_rate)
            below = 0.5 * _across(u1, force) + slope * turn + multiplier * turn_slope
            _add(own, places[1], number, _across(u1, m) / h, 0.0, below, multiplier * turn_rate)


@routine()
def balance(own: Conserving) -> None:
    """Fill the left-hand sides of both equations, and their derivatives by p and p' at the end."""
    h, size, unknown = own.time_step, own.size, own.unknown
    z, w, left, matrix = own.vectors, own.rates, own.left, own.matrix
    for i in range(size):
        z[2 * size + i], w[2 * size + i] = 0.5 * (z[i] + z[size + i]), 0.5 * (w[i] + w[size + i])
    _spread(own, at(z, 2 * size), 1.0, own.slopes)
    _spread(own, at(z, size), 1.0, at(own.slopes, 2 * size))
    _spread(own, at(w, size), 0.0, at(own.slopes, 4 * size))
    for i in range(2 * unknown):
        left[i] = 0.0
    for i in range(own.filled):
        matrix[i] = 0.0
    for row in range(size):
        lost, force = 0.0, -own.load[row]
        for entry in range(own.rows[row], own.rows[row + 1]):
            i, m, k = own.columns[entry], own.mass[entry], own.ground[entry]
            lost += m * ((z[size + i] - z[i]) / h - w[2 * size + i])
            force += m * (w[size + i] - w[i]) / h + k * z[2 * size + i]
            own.stiffness[entry] = 0.5 * k
        own.lost[row], own.force[row] = lost, force
        for a in range(2):
            own.slopes[6 * size + 2 * row + a] = 0.0
    for number in range(own.group_count):
        own.add_strained(own.groups[number], own)
    for row in range(size):
        for a in range(2):
            number = own.equations[2 * row + a]
            if number >= 0:
                left[number] += 2.0 / h * own.slopes[2 * row + a] * own.lost[row]
                left[unknown + number] += own.slopes[2 * row + a] * own.force[row]
    own.add_turning(own)
    own.add_entries(own)


@routine()
def correct_band(own: Conserving) -> float:
    """Replace left-hand sides by the corrections (2, unknown) of p and p'; return 1, or 0 if the matrix is singular."""
    left, right, unknown, sizes = own.left, own.right, own.unknown, own.sizes
    for i in range(unknown):
        right[2 * i], right[2 * i + 1] = -left[i], -left[unknown + i]
    half, status = at(sizes, 1), at(sizes, 4)
    own.dgbsv(sizes, half, half, at(sizes, 2), own.matrix, at(sizes, 3), own.exchanged, right, sizes, status)
    for i in range(unknown):
        left[i], left[unknown + i] = right[2 * i + 1], right[2 * i]
    return 1.0 if status[0] == 0 else 0.0
