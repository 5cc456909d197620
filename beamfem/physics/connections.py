"""Energies and conditions of parts at points, each written once: forces and tangents are derived from them.

A connection has m points with coordinates q: x, y and, if it depends on rotations, the angle from the reference. Its
forces, with the sign of internal forces, are those of Lagrange's equations, d/dt dT/dv - dT/dq + dV/dq + dR/dv +
(dg/dq)' l, with its kinetic energy T(q, v), potential V(q), dissipation function R(q, v), and conditions g(q) = 0 with
their multipliers l, and forces given directly; `connection_source` derives them. Conditions whose value is prescribed
as a function of time are g(q) = u, with u as a further coordinate, which a support could move: its reaction is -l.
"""

from collections.abc import Callable
from functools import cache, partial
from typing import Any, NamedTuple

Number = Any  # a float, a complex number or a symbol
Vector = tuple[Number, ...]  # coordinates of a point
Function = Callable[..., Number]


class Functions(NamedTuple):
    """Square root, cosine, sine, and max(x, 0), for numbers or symbols."""

    sqrt: Function
    cos: Function
    sin: Function
    positive: Function


class Connection(NamedTuple):
    """Definition of a part at points by its energies, or by C functions.

    Parameters
    ----------
    name : str
        Name of the part in messages.
    points : int
        Number m of its points.
    coordinates : int
        Number of coordinates of a point: 2, x and y [m], 3, with the rotation [rad], or 1, any of them.
    data : tuple of str
        Names of the numbers that a part has, see `PartAtPoints.data`.
    kinetic : callable, optional
        Kinetic energy T(q, v, data, f) [J]; q and v are lists with the coordinates of each point and their rates, and f
        has sqrt, cos, sin and positive, which is max(x, 0).
    potential : callable, optional
        Potential V(q, data, gravity, f) [J].
    dissipation : callable, optional
        Dissipation function R(q, v, data, f) [W], half the power that is dissipated where it is quadratic in v.
    conditions : callable, optional
        Conditions g(q, data, f), a tuple of k numbers that are zero.
    multipliers : int, default 0
        Number k of conditions.
    memory : tuple of str, default ()
        Names of its history variables, zero at the start; they follow the numbers in the data of all functions.
    force : callable, optional
        Resisting forces f(q, v, data, f) without an energy, such as friction: a tuple with one for each coordinate.
        Multipliers follow the history variables in data, here and in `remember`.
    remember : callable, optional
        History variables after an accepted step, h(q, v, data, f), a tuple in the order of `memory`.
    compiled : (int, int) or (int, int, int), optional
        Addresses of C functions used instead of derived code: force(q, v, a, own, turned, data, gravity, out) and
        tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out). The weights ck, cv, ca are doubles, everything
        else pointers to doubles. own: multipliers and prescribed values; turned: cosine and sine of each rotation; out:
        resisting forces, conditions and reactions, or ck df/dq + cv df/dv + ca df/da row by row. For parts that slide
        over elements, a third function h(q, data, xi, out) defines the place xi by h = 0; it writes h, -dh/dxi, a
        number that is least on the element where the place is, and a scale of dh/dxi. Force and tangent then receive
        xi in `turned`.
    prescribed : int, default 0
        Number of conditions (the first ones) of the form g(q) = u, with the values u of `PartAtPoints.prescribed`.
    one_sided : bool, default False
        Whether its conditions are g(q) <= 0, see `Contribution`.
    amplitudes : int, default 0
        Number of additional coordinates [m] that belong to the part itself; they are the last item of q and v.
    """

    name: str
    points: int
    coordinates: int
    data: tuple[str, ...]
    kinetic: Function | None = None
    potential: Function | None = None
    dissipation: Function | None = None
    conditions: Callable[..., tuple[Number, ...]] | None = None
    multipliers: int = 0
    memory: tuple[str, ...] = ()
    force: Callable[..., tuple[Number, ...]] | None = None
    remember: Callable[..., tuple[Number, ...]] | None = None
    compiled: tuple[int, ...] | None = None
    prescribed: int = 0
    one_sided: bool = False
    amplitudes: int = 0

    @property
    def size(self) -> int:
        """Number of all coordinates."""
        return self.points * self.coordinates + self.amplitudes

    def split(self, values: Any) -> list[Any]:
        """Return values (size,) of all coordinates by point, and then those of the amplitudes if there are any."""
        ends = [self.coordinates * (point + 1) for point in range(self.points)]
        rows = [tuple(values[end - self.coordinates : end]) for end in ends]
        return [*rows, tuple(values[ends[-1] : self.size])] if self.amplitudes else rows


def _mass_kinetic(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    ((x, y),) = v
    return data[0] * (x * x + y * y) / 2


def _mass_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return - m g . (r - r0)."""
    mass, x, y = data
    return -mass * (gravity[0] * (q[0][0] - x) + gravity[1] * (q[0][1] - y))


def _arm(angle: Number, offset: Vector, f: Functions) -> Vector:
    """Return the offset of a centre of mass, which turns with its section."""
    c, s = f.cos(angle), f.sin(angle)
    return c * offset[0] - s * offset[1], s * offset[0] + c * offset[1]


def _body_kinetic(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return m |r' + w x c|^2 / 2 + J w^2 / 2, with c the offset of the centre of mass."""
    (vx, vy, rate), (cx, cy) = v[0], _arm(q[0][2], data[2:4], f)
    x, y = vx - rate * cy, vy + rate * cx
    return data[0] * (x * x + y * y) / 2 + data[1] * rate * rate / 2


def _body_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    mass, _, along, across, x, y = data
    cx, cy = _arm(q[0][2], (along, across), f)
    return -mass * (gravity[0] * (q[0][0] - x + cx - along) + gravity[1] * (q[0][1] - y + cy - across))


def _length(q: list[Vector], f: Functions) -> Number:
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return f.sqrt(x * x + y * y)


def _spring_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k (l - l0)^2 / 2."""
    elongation = _length(q, f) - data[2]
    return data[0] * elongation * elongation / 2


def _spring_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return c (dl/dt)^2 / 2."""
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    rate = (x * (v[1][0] - v[0][0]) + y * (v[1][1] - v[0][1])) / _length(q, f)
    return data[1] * rate * rate / 2


def _to_ground(q: list[Vector], data: Vector) -> list[Vector]:
    return [q[0], data[3:5]]


def _grounded_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    return _spring_potential(_to_ground(q, data), data, gravity, f)


def _grounded_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    return _spring_dissipation(_to_ground(q, data), [v[0], (0, 0)], data, f)


def _coordinate_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k (q - q0)^2 / 2."""
    change = q[0][0] - data[1]
    return data[0] * change * change / 2


def _torsion_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k (tb - ta)^2 / 2."""
    turn = q[1][2] - q[0][2]
    return data[0] * turn * turn / 2


def _torsion_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    rate = v[1][2] - v[0][2]
    return data[1] * rate * rate / 2


def _link_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return (l^2 - l0^2) / (2 l0): the multiplier is the tension, and no square root is needed."""
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return ((x * x + y * y - data[0] * data[0]) / (2 * data[0]),)


def _cable_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k max(l - l0, 0)^2 / 2."""
    elongation = f.positive(_length(q, f) - data[1])
    return data[0] * elongation * elongation / 2


def _grounded_cable_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    return _cable_potential([q[0], data[2:4]], data, gravity, f)


def _in_frame(q: list[Vector], f: Functions) -> Vector:
    """Return r_b - r_a along and across axes that turn with a."""
    c, s = f.cos(q[0][2]), f.sin(q[0][2])
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return c * x + s * y, c * y - s * x


def _bushing_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return (kx u^2 + ky v^2 + kt (tb - ta)^2) / 2, with the displacement (u, v) in axes that turn with a."""
    (u, v), turn = _in_frame(q, f), q[1][2] - q[0][2]
    u, v = u - data[6], v - data[7]
    return (data[0] * u * u + data[1] * v * v + data[2] * turn * turn) / 2


def _rates_in_frame(q: list[Vector], v: list[Vector], f: Functions) -> Vector:
    """Return the rates of `_in_frame`."""
    c, s = f.cos(q[0][2]), f.sin(q[0][2])
    (along, across), turning = _in_frame(q, f), v[0][2]
    x, y = v[1][0] - v[0][0], v[1][1] - v[0][1]
    return c * x + s * y + turning * across, c * y - s * x - turning * along


def _bushing_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    (u, w), rate = _rates_in_frame(q, v, f), v[1][2] - v[0][2]
    return (data[3] * u * u + data[4] * w * w + data[5] * rate * rate) / 2


def _slider_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return the displacement of b across an axis that turns with a, and its rotation relative to a."""
    along, across = _in_frame(q, f)
    return data[0] * along + data[1] * across - data[2], q[1][2] - q[0][2]


def _slider_slip(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, Number]:
    """Return the friction along the axis, which is at most `friction` |N|, and the change of the slip."""
    along, across = _in_frame(q, f)
    trial = data[4] * (data[1] * along - data[0] * across - data[5] - data[7])
    over = _clipped(trial, data[3] * (f.positive(data[9]) + f.positive(-data[9])) + data[6], f)
    return trial - over, over / data[4]


def _slider_friction(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return the friction on a and b along the axis, and its moment about a."""
    x, y = _arm(q[0][2], (data[1], -data[0]), f)
    friction = _slider_slip(q, data, f)[0]
    moment = x * (q[1][1] - q[0][1]) - y * (q[1][0] - q[0][0])
    return -friction * x, -friction * y, friction * moment, friction * x, friction * y, 0


def _slider_remember(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    friction, slipped = _slider_slip(q, data, f)
    return data[7] + slipped, data[8] + friction * slipped


def _weld_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return the displacement of b in axes that turn with a, and its rotation relative to a."""
    along, across = _in_frame(q, f)
    return along - data[0], across - data[1], q[1][2] - q[0][2]


def _gear_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    return (q[1][2] - data[0] * q[0][2],)


def _penetration(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return max(-gap, 0), with the gap to a wall through the place data[3:5] with the normal data[5:7]."""
    return f.positive((data[3] - q[0][0]) * data[5] + (data[4] - q[0][1]) * data[6])


def _stop_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k max(-gap, 0)^2 / 2."""
    depth = _penetration(q, data, f)
    return data[0] * depth * depth / 2


def _stop_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return k c max(-gap, 0) (dgap/dt)^2 / 2 (Hunt and Crossley 1975)."""
    rate = v[0][0] * data[5] + v[0][1] * data[6]
    return data[0] * data[1] * _penetration(q, data, f) * rate * rate / 2


def _stop_slip(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, Number]:
    """Return the friction along the wall, which is at most `friction` k max(-gap, 0), and the change of the slip."""
    stiffness, limit = data[0], data[2] * data[0] * _penetration(q, data, f)
    along = (q[0][1] - data[8]) * data[5] - (q[0][0] - data[7]) * data[6]
    trial = stiffness * (along - data[9])
    over = _clipped(trial, limit, f)
    return trial - over, over / stiffness


def _stop_force(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    friction = _stop_slip(q, data, f)[0]
    return -data[6] * friction, data[5] * friction


def _stop_remember(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    friction, slipped = _stop_slip(q, data, f)
    return data[9] + slipped, data[10] + friction * slipped


def _motor_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    return (q[1][2] - q[0][2],)


def _clipped(trial: Number, limit: Number, f: Functions) -> Number:
    """Return what of a trial force is beyond a limit."""
    return f.positive(trial - limit) - f.positive(-trial - limit)


def _friction_slip(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, Number]:
    """Return the moment on b, which is at most data[1], and the change of the slip."""
    trial = data[0] * (q[1][2] - q[0][2] - data[2])
    over = _clipped(trial, data[1], f)
    return trial - over, over / data[0]


def _friction_force(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    moment = _friction_slip(q, data, f)[0]
    return 0, 0, -moment, 0, 0, moment


def _friction_remember(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    moment, slipped = _friction_slip(q, data, f)
    return data[2] + slipped, data[3] + moment * slipped


def _turn(q: list[Vector], data: Vector, f: Functions) -> Number:
    return q[1][2] - q[0][2]


def _turning(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    return v[1][2] - v[0][2]


def _slide(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return r_b - r_a along an axis that turns with a."""
    along, across = _in_frame(q, f)
    return data[5] * along + data[6] * across


def _sliding(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    along, across = _rates_in_frame(q, v, f)
    return data[5] * along + data[6] * across


def _excess(measure: Function, q: list[Vector], data: Vector, f: Functions) -> tuple[Number, Number]:
    """Return by how much a measure is below its lower and above its upper limit."""
    at = measure(q, data, f)
    return f.positive(data[0] - at), f.positive(at - data[1])


def _limits_potential(measure: Function, q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k d^2 / 2 on both sides."""
    low, high = _excess(measure, q, data, f)
    return data[2] * (low * low + high * high) / 2


def _limits_dissipation(
    measure: Function, rate_of: Function, q: list[Vector], v: list[Vector], data: Vector, f: Functions
) -> Number:
    """Return k c d (dd/dt)^2 / 2 (Hunt and Crossley 1975)."""
    rate, (low, high) = rate_of(q, v, data, f), _excess(measure, q, data, f)
    return data[2] * data[3] * (low + high) * rate * rate / 2


def _rebound(stiffness: Number, square: Number, depth: Number, deepest: Number, f: Functions) -> Number:
    """Return the energy of a spring that is steeper below its deepest state, so that e^2 of its work is given back.

    Loads: F = k d; below the deepest state: F = k / e^2 (d - (1 - e^2) d_deepest) (Walton and Braun 1986).
    """
    steep, back, beyond = stiffness / square, f.positive(depth - (1 - square) * deepest), f.positive(depth - deepest)
    return (steep * back * back - (steep - stiffness) * beyond * beyond) / 2


def _deepest(stiffness: Number, square: Number, depth: Number, deepest: Number, f: Functions) -> tuple[Number, Number]:
    """Return the new deepest state, zero without contact, and the energy that is lost."""
    beyond = f.positive(depth - deepest)
    lost = stiffness * (1 - square) * beyond * (2 * deepest + beyond) / 2
    return (deepest + beyond) * depth / (depth + _LEAST), lost


def _limits_rebound(
    measure: Function, first: int, q: list[Vector], data: Vector, gravity: Vector, f: Functions
) -> Number:
    depths = zip(_excess(measure, q, data, f), data[first : first + 2], strict=True)
    return sum(_rebound(data[2], data[4], depth, deepest, f) for depth, deepest in depths)


def _limits_remember(
    measure: Function, first: int, q: list[Vector], v: list[Vector], data: Vector, f: Functions
) -> tuple[Number, ...]:
    depths = zip(_excess(measure, q, data, f), data[first : first + 2], strict=True)
    (low, lost), (high, other) = (_deepest(data[2], data[4], depth, deepest, f) for depth, deepest in depths)
    return low, high, data[first + 2] + lost + other


def _stop_rebound(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    return _rebound(data[0], data[9], _penetration(q, data, f), data[10], f)


def _stop_deepest(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    deepest, lost = _deepest(data[0], data[9], _penetration(q, data, f), data[10], f)
    return deepest, data[11] + lost


_LEAST = 1e-300  # [m^2/s^2], so that the derivative of |v| v is zero at rest; also a depth that is none


def _drag_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return c |v|^3 / 3."""
    ((x, y),) = v
    square = x * x + y * y + _LEAST
    return data[0] * square * f.sqrt(square) / 3


MASS = Connection("mass", 1, 2, ("mass", "x", "y"), _mass_kinetic, _mass_potential)
BODY = Connection("body", 1, 3, ("mass", "inertia", "along", "across", "x", "y"), _body_kinetic, _body_potential)
_SPRING = ("stiffness", "damping", "length")
SPRING = Connection("spring", 2, 2, _SPRING, None, _spring_potential, _spring_dissipation)
GROUNDED_SPRING = Connection(
    "grounded_spring", 1, 2, (*_SPRING, "x", "y"), None, _grounded_potential, _grounded_dissipation
)
COORDINATE_SPRING = Connection("coordinate_spring", 1, 1, ("stiffness", "rest"), None, _coordinate_potential)
TORSION_SPRING = Connection(
    "torsion_spring", 2, 3, ("stiffness", "damping"), None, _torsion_potential, _torsion_dissipation
)
LINK = Connection("link", 2, 2, ("length",), None, None, None, _link_conditions, 1)
DRAG = Connection("drag", 1, 2, ("coefficient",), None, None, _drag_dissipation)
CABLE = Connection("cable", 2, 2, ("stiffness", "length"), None, _cable_potential)
GROUNDED_CABLE = Connection("grounded_cable", 1, 2, ("stiffness", "length", "x", "y"), None, _grounded_cable_potential)
_BUSHING = ("kx", "ky", "kt", "cx", "cy", "ct", "x", "y")
BUSHING = Connection("bushing", 2, 3, _BUSHING, None, _bushing_potential, _bushing_dissipation)
SLIDER = Connection("slider", 2, 3, ("nx", "ny", "offset"), None, None, None, _slider_conditions, 2)
ROUGH_SLIDER = SLIDER._replace(
    name="rough_slider",
    data=(*SLIDER.data, "friction", "stiffness", "along", "least"),
    memory=("slip", "dissipated"),
    force=_slider_friction,
    remember=_slider_remember,
)
WELD = Connection("weld", 2, 3, ("x", "y"), None, None, None, _weld_conditions, 3)
GEAR = Connection("gear", 2, 3, ("ratio",), None, None, None, _gear_conditions, 1)
MOTOR = Connection("motor", 2, 3, (), None, None, None, _motor_conditions, 1, prescribed=1)
_SLIP = "slip", "dissipated"
_STOP = ("stiffness", "damping", "friction", "x", "y", "nx", "ny", "x0", "y0")
STOP = Connection("stop", 1, 2, _STOP, None, _stop_potential, _stop_dissipation)
ROUGH_STOP = STOP._replace(name="rough_stop", memory=_SLIP, force=_stop_force, remember=_stop_remember)
HINGE_FRICTION = Connection(
    "hinge_friction", 2, 3, ("stiffness", "torque"), memory=_SLIP, force=_friction_force, remember=_friction_remember
)
BOUNCING_STOP = Connection(
    "bouncing_stop",
    1,
    2,
    (*_STOP, "rebound"),
    None,
    _stop_rebound,
    memory=("deepest", "dissipated"),
    remember=_stop_deepest,
)


def _limits(name: str, measure: Function, rate_of: Function, further: tuple[str, ...]) -> tuple[Connection, Connection]:
    """Return the definitions of end stops of a measure, with damping and with a coefficient of restitution."""
    data = ("low", "high", "stiffness", "damping", "rebound", *further)
    potential, dissipation = partial(_limits_potential, measure), partial(_limits_dissipation, measure, rate_of)
    bouncing = Connection(
        f"bouncing_{name}",
        2,
        3,
        data,
        None,
        partial(_limits_rebound, measure, len(data)),
        memory=("low_deepest", "high_deepest", "dissipated"),
        remember=partial(_limits_remember, measure, len(data)),
    )
    return Connection(name, 2, 3, data, None, potential, dissipation), bouncing


HINGE_STOP, BOUNCING_HINGE_STOP = _limits("hinge_stop", _turn, _turning, ())
SLIDER_STOP, BOUNCING_SLIDER_STOP = _limits("slider_stop", _slide, _sliding, ("ax", "ay"))


@cache
def spring_with_law(law: Function, grounded: bool) -> Connection:
    """Return the definition of a spring whose force is law(elongation, f), with the data of the linear one."""
    force = partial(_law_force, law, grounded)
    return (GROUNDED_SPRING if grounded else SPRING)._replace(name="spring_with_law", potential=None, force=force)


def _law_force(
    law: Function, grounded: bool, q: list[Vector], v: list[Vector], data: Vector, f: Functions
) -> tuple[Number, ...]:
    ends = _to_ground(q, data) if grounded else q
    length = _length(ends, f)
    pull = law(length - data[2], f) / length
    x, y = pull * (ends[1][0] - ends[0][0]), pull * (ends[1][1] - ends[0][1])
    return (-x, -y) if grounded else (-x, -y, x, y)


_SPRINGS = SPRING, GROUNDED_SPRING, COORDINATE_SPRING, TORSION_SPRING, CABLE, GROUNDED_CABLE, BUSHING
_JOINTS = LINK, SLIDER, ROUGH_SLIDER, WELD, GEAR, MOTOR
_STOPS = STOP, ROUGH_STOP, BOUNCING_STOP, HINGE_STOP, BOUNCING_HINGE_STOP, SLIDER_STOP, BOUNCING_SLIDER_STOP
CONNECTIONS = MASS, BODY, *_SPRINGS, *_JOINTS, DRAG, *_STOPS, HINGE_FRICTION
