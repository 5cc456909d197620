"""Forces at stations of elements, each written once: on the position r and on the vector g that turns with the section.

They are connections of two points, r and g. Their data are a force [N] and a moment [N m] that depend on time, and four
constants. A moment M does the virtual work M (g x delta g) / |g|^2.
"""

from beamfem.physics.connections import CONNECTIONS, Connection, Functions, Number, Vector


def _acting(force: Vector, moment: Number, g: Vector) -> tuple[Number, ...]:
    """Return the resisting forces on r and g for a force and a moment that act from outside."""
    turning = moment / (g[0] * g[0] + g[1] * g[1])
    return -force[0], -force[1], turning * g[1], -turning * g[0]


def _dead(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    return _acting(data[:2], data[2], q[1])


def _turned(q: list[Vector], data: Vector, length: Number) -> tuple[Number, ...]:
    """Return the forces for a force turned from the unit vector data[3:5] to g / length."""
    (gx, gy), (fx, fy), (ux, uy) = q[1], data[:2], data[3:5]
    c, s = (gx * ux + gy * uy) / length, (gy * ux - gx * uy) / length
    return _acting((c * fx - s * fy, s * fx + c * fy), data[2], q[1])


def _following(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    return _turned(q, data, f.sqrt(q[1][0] * q[1][0] + q[1][1] * q[1][1]))


def _stretching(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    return _turned(q, data, 1)


def _grounded(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return (kx (x - x0)^2 + ky (y - y0)^2) / 2."""
    x, y = q[0][0] - data[5], q[0][1] - data[6]
    return (data[3] * x * x + data[4] * y * y) / 2


_LOAD = ("fx", "fy", "moment")
DEAD, FOLLOWING, STRETCHING, GROUNDED = range(4)  # following: with the section; stretching: also proportional to |g|
STATIONS = (
    Connection("dead", 2, 2, _LOAD, force=_dead),
    Connection("following", 2, 2, (*_LOAD, "ux", "uy"), force=_following),
    Connection("stretching", 2, 2, (*_LOAD, "ux", "uy"), force=_stretching),
    Connection("grounded", 2, 2, (*_LOAD, "kx", "ky", "x", "y"), None, _grounded),
)
GENERATED = (*CONNECTIONS, *STATIONS)
