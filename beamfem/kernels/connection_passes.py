"""Forces and tangents of parts at points, added to the residual and the matrix of a model."""

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import Parts, System
from beamfem.kernels.nodes import cosine_sine
from beamfem.kernels.pointers import at, room

MOST = 32  # coordinates of a part, or multipliers and prescribed values
MOST_DATA = 24  # numbers and history variables of a part with history
_ENTRIES = 2 * MOST * 2 * MOST
STEPS = 30  # of Newton's method for a place on an element, at most
SAME, LEAST = 1e-14, 0.1  # change of a place that is none, and slope relative to its scale below which it is the scale
_FAR = 1e30


@inlined
def _gather(count, numbers, values, to):
    for i in range(count):
        to[i] = values[numbers[i]]


@inlined
def _clear(count, to):
    for i in range(count):
        to[i] = 0.0


@inlined
def _data(parts, part, row, p, recalled):
    """Return the numbers of a part, followed by its history variables if it has any."""
    data = at(parts.data, row * parts.data_size)
    if parts.history_size > 0:
        for i in range(parts.data_size):
            recalled[i] = data[i]
        _gather(parts.history_size, at(parts.history, part * parts.history_size), p, at(recalled, parts.data_size))
        data = recalled
    return data


@inlined
def _turn(parts, q, turned):
    """Fill cosine and sine of the rotation of each point."""
    for point in range(parts.rotations):
        turned[2 * point], turned[2 * point + 1] = cosine_sine(q[3 * point + 2])


@routine()
def commit(parts: Parts, system: System) -> None:
    """Replace the history variables of the parts of a kind by those after an accepted step to p, p' and p''."""
    p, gravity, recalled, size, history = system.p, system.body, room(MOST_DATA), parts.coordinates, parts.history_size
    q, v, a, own, turned, out = room(MOST), room(MOST), room(MOST), room(MOST), room(MOST), room(MOST_DATA)
    for part in range(parts.count):
        numbers, data = at(parts.numbers, part * parts.unknowns), _data(parts, part, part, p, recalled)
        _gather(size, numbers, p, q)
        _gather(size, numbers, system.v, v)
        _gather(size, numbers, system.a, a)
        _gather(parts.multipliers, at(numbers, size), p, own)
        _turn(parts, q, turned)
        parts.remember(q, v, a, own, turned, data, gravity, out)
        places = at(parts.history, part * history)
        for i in range(history):
            p[places[i]] = out[i]


@inlined
def _closest(parts, part, p, q, place, out):
    """Return the row of a part that is on the element with the closest place, among those at the nearest node."""
    first, vectors, nearest, found, least = part * parts.alternatives, parts.position_step, _FAR, 0, _FAR
    nodes, root = (parts.coordinates - 2) // (2 * vectors), 0.0
    for choice in range(2 * parts.alternatives):  # the first time for the nearest node
        row, own = first + choice % parts.alternatives, _FAR
        numbers = at(parts.numbers, row * parts.unknowns)
        for node in range(nodes):
            number = 2 + 2 * vectors * node
            x, y = p[numbers[number]] - p[numbers[0]], p[numbers[number + 1]] - p[numbers[1]]
            own = min(own, x * x + y * y)
        if choice < parts.alternatives:
            nearest = min(nearest, own)
        elif own <= nearest:
            low = -_FAR if row == first else 0.0
            high = _FAR if row == first + parts.alternatives - 1 else 1.0
            _gather(parts.coordinates, numbers, p, q)
            xi, last, steps = 0.5, _FAR, 0
            while steps < STEPS and abs(xi - last) > SAME:
                parts.root(q, at(parts.data, row * parts.data_size), xi, out)
                slope = out[1] if out[1] > LEAST * out[3] else out[3]
                last, xi, steps = xi, min(max(xi + out[0] / slope, low), high), steps + 1
            if out[2] < least:
                found, least, root = row, out[2], xi
    place[0] = root
    return found


@routine()
def add_parts(parts: Parts, system: System) -> None:
    """Add the forces of the parts of a kind to the residual and, if needed, their tangents to the matrix."""
    p, residual, matrix = system.p, system.residual, system.matrix
    gravity = system.body  # of the first beam: gravity acts on all mass
    recalled = room(MOST_DATA)
    q, v, a, own, turned, out = room(MOST), room(MOST), room(MOST), room(MOST), room(MOST), room(_ENTRIES)
    size, unknowns = parts.coordinates, parts.unknowns
    for part in range(parts.count):
        row = part
        if parts.position_step > 0:
            row = _closest(parts, part, p, q, turned, out)
        numbers, data = at(parts.numbers, row * unknowns), _data(parts, part, row, p, recalled)
        _gather(size, numbers, p, q)
        _gather(parts.multipliers, at(numbers, size), p, own)
        _clear(size, v)
        _clear(size, a)
        if system.rated != 0:
            _gather(size, numbers, system.v, v)
        if system.moving != 0:
            _gather(size, numbers, system.a, a)
        _turn(parts, q, turned)
        parts.force(q, v, a, own, turned, data, gravity, out)
        for i in range(unknowns):
            residual[numbers[i]] += out[i]
        if system.tangent != 0:
            ck, cv, ca = system.weight_p, system.weight_v, system.weight_a
            parts.tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out)
            places = at(parts.places, row * unknowns * unknowns)
            for i in range(unknowns * unknowns):
                if places[i] >= 0:
                    matrix[places[i]] += out[i]
