"""Energies and conditions of parts at points, each written once: forces and tangents are derived from them.

A connection has m points with coordinates q: x, y and, if it depends on rotations, the angle from the reference. Its
forces, with the sign of internal forces, are those of Lagrange's equations, d/dt dT/dv - dT/dq + dV/dq + dR/dv +
(dg/dq)' l, with its kinetic energy T(q, v), potential V(q), dissipation function R(q, v), and conditions g(q) = 0 with
their multipliers l, and forces given directly; `connection_source` derives them. Conditions whose value is prescribed
as a function of time are g(q) = u, with u as a further coordinate, which a support could move: its reaction is -l.
"""

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import Any, NamedTuple

Number = Any  # a float, a complex number or a symbol
Vector = tuple[Number, ...]  # coordinates of a point
Function = Callable[..., Number]


class Functions(NamedTuple):
    """Square root, cosine, sine, and max(x, 0), for numbers or symbols; of symbols also the rate, dx/dt for q' = v."""

    sqrt: Function
    cos: Function
    sin: Function
    positive: Function
    rate: Any = None


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
        Dissipation function R(q, v, data, f) [W], half the power that is dissipated where it is quadratic in v;
        f.rate(x) is the rate of a function x of q.
    conditions : callable, optional
        Conditions g(q, data, f), a tuple of k numbers that are zero.
    multipliers : int, default 0
        Number k of conditions.
    memory : tuple of str, default ()
        Names of its history variables, zero at the start; they follow the numbers in the data of all functions.
    force : callable, optional
        Resisting forces f(q, v, data, f) without an energy, such as friction: a tuple with one for each coordinate.
        Multipliers follow the history variables in data, here and in `remember`.
    along : callable, optional
        Length or angle u(q, data, f) along which `force` acts; it then returns one number F, and resists with F du/dq.
        Of parts with history, that whose reversal changes their law.
    stored : callable, optional
        Energy E(q, data, f) [J] that `force` stores, such as that of the spring with which friction sticks.
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
    force: Function | None = None
    remember: Callable[..., tuple[Number, ...]] | None = None
    compiled: tuple[int, ...] | None = None
    prescribed: int = 0
    one_sided: bool = False
    amplitudes: int = 0
    along: Function | None = None
    stored: Function | None = None

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


def _length(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return the distance of two points, or of one point from the place on the ground at the end of data."""
    end = q[1] if len(q) == 2 else data[-2:]
    x, y = end[0] - q[0][0], end[1] - q[0][1]
    return f.sqrt(x * x + y * y)


def _spring_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k (l - l0)^2 / 2."""
    elongation = _length(q, data, f) - data[2]
    return data[0] * elongation * elongation / 2


def _spring_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return c (dl/dt)^2 / 2."""
    rate = f.rate(_length(q, data, f))
    return data[1] * rate * rate / 2


def _coordinate_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k (q - q0)^2 / 2."""
    change = q[0][0] - data[1]
    return data[0] * change * change / 2


def _turn(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return tb - ta."""
    return q[1][2] - q[0][2]


def _torsion_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k (tb - ta)^2 / 2."""
    turn = _turn(q, data, f)
    return data[0] * turn * turn / 2


def _torsion_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    rate = f.rate(_turn(q, data, f))
    return data[1] * rate * rate / 2


def _link_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return (l^2 - l0^2) / (2 l0): the multiplier is the tension, and no square root is needed."""
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return ((x * x + y * y - data[0] * data[0]) / (2 * data[0]),)


def _cable_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return k max(l - l0, 0)^2 / 2."""
    elongation = f.positive(_length(q, data, f) - data[1])
    return data[0] * elongation * elongation / 2


def _in_frame(q: list[Vector], f: Functions) -> Vector:
    """Return r_b - r_a along and across axes that turn with a."""
    c, s = f.cos(q[0][2]), f.sin(q[0][2])
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return c * x + s * y, c * y - s * x


def _bushed(q: list[Vector], data: Vector, f: Functions) -> Vector:
    """Return the displacement in axes that turn with a, and tb - ta."""
    along, across = _in_frame(q, f)
    return along - data[6], across - data[7], _turn(q, data, f)


def _bushing_potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    """Return (kx u^2 + ky v^2 + kt (tb - ta)^2) / 2, with the displacement (u, v) in axes that turn with a."""
    return sum(k * u * u for k, u in zip(data[:3], _bushed(q, data, f), strict=True)) / 2


def _bushing_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    rates = map(f.rate, _bushed(q, data, f))
    return sum(c * rate * rate for c, rate in zip(data[3:6], rates, strict=True)) / 2


def _slider_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return the displacement of b across an axis that turns with a, and its rotation relative to a."""
    along, across = _in_frame(q, f)
    return data[0] * along + data[1] * across - data[2], _turn(q, data, f)


def _weld_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    """Return the displacement of b in axes that turn with a, and its rotation relative to a."""
    along, across = _in_frame(q, f)
    return along - data[0], across - data[1], _turn(q, data, f)


def _gear_conditions(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
    return (q[1][2] - data[0] * q[0][2],)


def _slide(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return r_b - r_a along an axis that turns with a."""
    along, across = _in_frame(q, f)
    return data[5] * along + data[6] * across


def _slid(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return the displacement of b along the axis of a slider from the reference."""
    along, across = _in_frame(q, f)
    return data[1] * along - data[0] * across - data[5]


def _slider_limit(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return friction |N|; the multiplier N follows the history variables."""
    return data[3] * (f.positive(data[11]) + f.positive(-data[11])) + data[6]


def _penetration(q: list[Vector], data: Vector, f: Functions) -> Number:
    """Return -gap, with the gap to a wall through the place data[4:6] with the normal data[6:8]."""
    return (data[4] - q[0][0]) * data[6] + (data[5] - q[0][1]) * data[7]


def _along_wall(q: list[Vector], data: Vector, f: Functions) -> Number:
    return (q[0][1] - data[9]) * data[6] - (q[0][0] - data[8]) * data[7]


def _stop_limit(q: list[Vector], data: Vector, f: Functions) -> Number:
    return data[3] * data[0] * f.positive(_penetration(q, data, f))


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
    # by a hair deeper, so that small motions about the state after a step are on the way back, whatever round-off is
    deeper = beyond + _HAIR * depth * beyond / (beyond + _LEAST)
    return (deepest + deeper) * depth / (depth + _LEAST), lost


_HAIR = 1e-10  # of a force or a depth
_LEAST = 1e-300  # [m^2/s^2], so that |v| has a derivative at rest; also a depth that is none


def _drag_dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return c |v|^3 / 3, whose second derivative is zero at rest to the last digit: drag does not damp there."""
    ((x, y),) = v
    square = x * x + y * y
    return data[0] * square * (f.sqrt(square + _LEAST) - sqrt(_LEAST)) / 3


def _grounded(definition: Connection) -> Connection:
    """Return the definition of a part whose second point is a place on the ground; see `_length`."""
    name, data = f"grounded_{definition.name}", (*definition.data, "x", "y")
    return definition._replace(name=name, points=1, data=data)


def _with_friction(
    part: Connection, further: tuple[str, ...], measure: Function, limit: Function, memory: tuple[str, ...] = ()
) -> Connection:
    """Return the definition of a part with friction along a measure, at most a limit, that sticks with a stiffness.

    memory: names of a limit that varies, and of the force; the mean of the limit while it slips dissipates.
    """
    names = *part.data, *further
    stiffness, slip = names.index("stiffness"), len(names)

    def slipping(q: list[Vector], data: Vector, f: Functions) -> tuple[Number, Number]:
        """Return the friction, and the change of the slip."""
        trial, most = data[stiffness] * (measure(q, data, f) - data[slip]), limit(q, data, f)
        over = f.positive(trial - most) - f.positive(-trial - most)
        # by a hair more, so that small motions about the state after a step stick, whatever round-off is
        back = _HAIR * most * over / (f.positive(over) + f.positive(-over) + _LEAST)
        return trial - over, (over + back) / data[stiffness]

    def remember(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> tuple[Number, ...]:
        force, slipped = slipping(q, data, f)
        most, way = limit(q, data, f), f.positive(slipped) + f.positive(-slipped)
        onset = most
        if memory:  # where force and limit, each linear in the step, meet
            before, sign = data[slip + 2], slipped / (way + _LEAST)
            left = f.positive(before - sign * data[slip + 3])
            onset = before + left / (left + data[stiffness] * way + _LEAST) * (most - before)
        lost = (onset + most) / 2 * way
        return (data[slip] + slipped, data[slip + 1] + lost, most, force)[: 2 + len(memory)]

    def stored(q: list[Vector], data: Vector, f: Functions) -> Number:
        stretch = measure(q, data, f) - data[slip]
        return data[stiffness] * stretch * stretch / 2

    return part._replace(
        name=part.name if "friction" in part.name else f"rough_{part.name}",
        data=names,
        memory=("slip", "dissipated", *memory),
        force=lambda q, v, data, f: slipping(q, data, f)[0],
        remember=remember,
        along=measure,
        stored=stored,
    )


def _barrier(
    name: str, points: int, coordinates: int, further: tuple[str, ...], measure: Function, deepest: tuple[str, ...]
) -> tuple[Connection, Connection]:
    """Return stiff one-sided springs with damping (Hunt and Crossley 1975), and with a coefficient of restitution.

    They act at the depth of a measure below and above its limits, or above zero if there is one history variable.
    """
    names = "stiffness", "damping", "rebound", *further

    def depths(q: list[Vector], data: Vector, f: Functions) -> Vector:
        at = measure(q, data, f)
        return (f.positive(at),) if len(deepest) == 1 else (f.positive(data[3] - at), f.positive(at - data[4]))

    def potential(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
        return data[0] * sum(depth * depth for depth in depths(q, data, f)) / 2

    def dissipation(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
        rate = f.rate(measure(q, data, f))
        return data[0] * data[1] * sum(depths(q, data, f)) * rate * rate / 2

    def rebound(q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
        sides = zip(depths(q, data, f), data[len(names) :], strict=False)
        return sum(_rebound(data[0], data[2], *side, f) for side in sides)

    def remember(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Vector:
        *before, dissipated = data[len(names) : len(names) + len(deepest) + 1]
        sides = [_deepest(data[0], data[2], *side, f) for side in zip(depths(q, data, f), before, strict=True)]
        return *(depth for depth, _ in sides), dissipated + sum(lost for _, lost in sides)

    damped = Connection(name, points, coordinates, names, None, potential, dissipation)
    memory = *deepest, "dissipated"
    bouncing = Connection(
        f"bouncing_{name}", points, coordinates, names, None, rebound, memory=memory, remember=remember, along=measure
    )
    return damped, bouncing


MASS = Connection("mass", 1, 2, ("mass", "x", "y"), _mass_kinetic, _mass_potential)
BODY = Connection("body", 1, 3, ("mass", "inertia", "along", "across", "x", "y"), _body_kinetic, _body_potential)
_SPRING = ("stiffness", "damping", "length")
SPRING = Connection("spring", 2, 2, _SPRING, None, _spring_potential, _spring_dissipation)
GROUNDED_SPRING = _grounded(SPRING)
COORDINATE_SPRING = Connection("coordinate_spring", 1, 1, ("stiffness", "rest"), None, _coordinate_potential)
TORSION_SPRING = Connection(
    "torsion_spring", 2, 3, ("stiffness", "damping"), None, _torsion_potential, _torsion_dissipation
)
LINK = Connection("link", 2, 2, ("distance",), None, None, None, _link_conditions, 1)
DRAG = Connection("drag", 1, 2, ("coefficient",), None, None, _drag_dissipation)
CABLE = Connection("cable", 2, 2, ("stiffness", "length"), None, _cable_potential)
GROUNDED_CABLE = _grounded(CABLE)
_BUSHING = ("kx", "ky", "kt", "cx", "cy", "ct", "x", "y")
BUSHING = Connection("bushing", 2, 3, _BUSHING, None, _bushing_potential, _bushing_dissipation)
SLIDER = Connection("slider", 2, 3, ("nx", "ny", "offset"), None, None, None, _slider_conditions, 2)
_VARYING = "limit", "force"
ROUGH_SLIDER = _with_friction(SLIDER, ("friction", "stiffness", "start", "least"), _slid, _slider_limit, _VARYING)
WELD = Connection("weld", 2, 3, ("x", "y"), None, None, None, _weld_conditions, 3)
GEAR = Connection("gear", 2, 3, ("ratio",), None, None, None, _gear_conditions, 1)
MOTOR = Connection("motor", 2, 3, (), None, None, None, lambda q, data, f: (_turn(q, data, f),), 1, prescribed=1)
_STOP = ("friction", "x", "y", "nx", "ny", "x0", "y0")
STOP, BOUNCING_STOP = _barrier("stop", 1, 2, _STOP, _penetration, ("deepest",))
ROUGH_STOP = _with_friction(STOP, (), _along_wall, _stop_limit, _VARYING)
HINGE_FRICTION = _with_friction(
    Connection("hinge_friction", 2, 3, ("stiffness", "torque")), (), _turn, lambda q, data, f: data[1]
)
_SIDES = ("low_deepest", "high_deepest")
HINGE_STOP, BOUNCING_HINGE_STOP = _barrier("hinge_stop", 2, 3, ("low", "high"), _turn, _SIDES)
# they depend on rotations alone, so that x and y are not coupled
TURNING = TORSION_SPRING, GEAR, MOTOR, HINGE_FRICTION, HINGE_STOP, BOUNCING_HINGE_STOP
SLIDER_STOP, BOUNCING_SLIDER_STOP = _barrier("slider_stop", 2, 3, ("low", "high", "ax", "ay"), _slide, _SIDES)


@cache
def spring_with_law(law: Function, grounded: bool) -> Connection:
    """Return the definition of a spring whose force is law(elongation, f), with the data of the linear one."""

    def force(q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
        return law(_length(q, data, f) - data[2], f)

    spring = GROUNDED_SPRING if grounded else SPRING
    return spring._replace(name="spring_with_law", potential=None, force=force, along=_length)


CONNECTIONS = tuple(value for value in globals().values() if isinstance(value, Connection))
