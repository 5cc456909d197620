"""Forces and tangents of parts at points, added to the residual and the matrix of a model."""

from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.nodes import cosine_sine
from beamfem.kernels.pointers import at, caller, reals, room, wholes

# ------------------------------------------------------------------ table of the parts of one kind
COUNT = 0
COORDINATES = 1  # of all points of a part
PER_POINT = 2
MULTIPLIERS = 3
NUMBERS = 4  # address (count, n): numbers of coordinates and multipliers
DATA = 5  # address (count, numbers of data)
DATA_SIZE = 6
PLACES = 7  # address (count, n, n): positions of the entries in the matrix, -1 where there is none
FORCE = 8
TANGENT_PASS = 9
FIELDS = 10

MOST = 8  # coordinates or multipliers of a part
_ENTRIES = MOST * MOST

_force, _tangent = caller("rrrrrrrr"), caller("rrrrrrrdddr")


@inlined
def _gather(count, numbers, values, to):
    for i in range(count):
        to[i] = values[numbers[i]]


@inlined
def _clear(count, to):
    for i in range(count):
        to[i] = 0.0


@routine("iii")
def add_connections(kinds, tables, system):
    """Add the forces of all parts at points to the residual and, if needed, their tangents to the matrix."""
    s = wholes(system)
    p, residual, matrix, gravity = (
        reals(s[r.COORDINATES_P]),
        reals(s[r.RESIDUAL]),
        reals(s[r.MATRIX]),
        reals(s[r.BODY]),  # of the first beam: gravity acts on all mass
    )
    factors = reals(s[r.FACTORS])
    q, v, a, own, turned, out = room(MOST), room(MOST), room(MOST), room(MOST), room(MOST), room(_ENTRIES)
    for kind in range(kinds):
        table = at(wholes(tables), kind * FIELDS)
        size, multipliers, per_point = table[COORDINATES], table[MULTIPLIERS], table[PER_POINT]
        whole = size + multipliers
        for part in range(table[COUNT]):
            numbers, data = (
                at(wholes(table[NUMBERS]), part * whole),
                at(reals(table[DATA]), part * table[DATA_SIZE]),
            )
            _gather(size, numbers, p, q)
            _gather(multipliers, at(numbers, size), p, own)
            _clear(size, v)
            _clear(size, a)
            if s[r.RATED] != 0:
                _gather(size, numbers, reals(s[r.COORDINATES_V]), v)
            if s[r.MOVING] != 0:
                _gather(size, numbers, reals(s[r.COORDINATES_A]), a)
            if per_point == 3:
                for point in range(size // 3):
                    turned[2 * point], turned[2 * point + 1] = cosine_sine(q[3 * point + 2])
            _force(table[FORCE], q, v, a, own, turned, data, gravity, out)
            for i in range(whole):
                residual[numbers[i]] += out[i]
            if s[r.TANGENT] != 0:
                ck, cv, ca = factors[r.WEIGHT_P], factors[r.WEIGHT_V], factors[r.WEIGHT_A]
                _tangent(table[TANGENT_PASS], q, v, a, own, turned, data, gravity, ck, cv, ca, out)
                places = at(wholes(table[PLACES]), part * whole * whole)
                for i in range(whole * whole):
                    if places[i] >= 0:
                        matrix[places[i]] += out[i]
