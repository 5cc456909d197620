"""Energies of an elastic body in a floating frame of reference, that of its first interface.

Its points are r = r1 + R(theta1) (X + Phi q). The deformation q consists of the displacements (u, v, phi) of the other
interfaces relative to the first one, in the axes of the frame, and of amplitudes of modes. With the velocity v of r1 in
these axes, the rate w of theta1, and e x the rotation by a right angle, the energies of this field are exactly

    T = m v.v / 2 + v.(D q' + w e x d) + w^2 J / 2 + w (b + C q).q' + q' A q' / 2,
    V = q K q / 2 - g.(m (r1 - X1) + R d - m c),    d = m c + D q,    J = J0 + 2 h.q + q A q.

Source: Shabana 2013, Dynamics of Multibody Systems, 4th ed., chapter 5.
"""

from collections.abc import Sequence
from functools import cache, partial

from beamfem.physics.connections import Connection, Functions, Number, Vector

_Row = Sequence[Number]


@cache
def floating_frame(interfaces: int, modes: int, damped: bool) -> Connection:
    """Return the definition of a body with m interfaces and amplitudes of modes (k,), n = 3 (m - 1) + k.

    Its data are the mass, m c (2,), J0, positions of the interfaces (m, 2), D (2, n), h and b (n,), the lower triangles
    of A, K and, if it is damped, of the damping matrix, and that of C without the diagonal.
    """
    n = 3 * (interfaces - 1) + modes
    count = 4 + 2 * interfaces + 4 * n + (2 + damped) * n * (n + 1) // 2 + n * (n - 1) // 2
    return Connection(
        f"floating_frame_{interfaces}_{modes}{'_damped' * damped}",
        points=interfaces,
        coordinates=3,
        data=tuple(f"number {i}" for i in range(count)),
        kinetic=partial(_kinetic, interfaces, damped),
        potential=partial(_potential, interfaces),
        dissipation=partial(_dissipation, interfaces) if damped else None,
        amplitudes=modes,
    )


class _Data:
    """Data of a body, and its deformation q (n,)."""

    def __init__(self, interfaces: int, q: list[Vector], data: Vector, f: Functions) -> None:
        self.rest, self.points = list(data), q[:interfaces]
        (self.mass,), self.moment, (self.inertia,) = self.row(1), self.row(2), self.row(1)
        self.places = [self.row(2) for _ in self.points]
        self.c, self.s = f.cos(q[0][2]), f.sin(q[0][2])
        self.arms = [self.local(self.points[0], point) for point in self.points[1:]]
        self.q: list[Number] = []
        for point, (x, y), place in zip(self.points[1:], self.arms, self.places[1:], strict=True):
            first_x, first_y = self.places[0]
            self.q += [x - (place[0] - first_x), y - (place[1] - first_y), point[2] - q[0][2]]
        self.q += [amplitude for amplitudes in q[interfaces:] for amplitude in amplitudes]
        self.d = [[first, *self.row(len(self.q))] for first in self.moment]
        self.h, self.b = self.row(len(self.q)), self.row(len(self.q))
        self.mass_matrix, self.stiffness = self.triangle(), self.triangle()

    def row(self, count: int) -> list[Number]:
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def triangle(self) -> list[list[Number]]:
        """Return the next symmetric matrix (n, n)."""
        n, lower = len(self.q), [self.row(i + 1) for i in range(len(self.q))]
        return [[lower[max(i, j)][min(i, j)] for j in range(n)] for i in range(n)]

    def skew(self) -> list[list[Number]]:
        """Return the next skew matrix (n, n)."""
        n, lower = len(self.q), [self.row(i) for i in range(len(self.q))]
        return [[0.0 if i == j else lower[i][j] if j < i else -lower[j][i] for j in range(n)] for i in range(n)]

    def local(self, one: Vector, other: Vector) -> Vector:
        """Return the vector from one point to another one in the axes of the frame."""
        x, y = other[0] - one[0], other[1] - one[1]
        return self.c * x + self.s * y, self.c * y - self.s * x

    def rates(self, interfaces: int, v: list[Vector]) -> list[Number]:
        """Return q' (n,)."""
        spin, result = v[0][2], list[Number]()
        for rate, (x, y) in zip(v[1:interfaces], self.arms, strict=True):
            along, across = self.local(v[0], rate)
            result += [along + spin * y, across - spin * x, rate[2] - spin]
        return result + [rate for rates in v[interfaces:] for rate in rates]


def _dot(one: _Row, other: _Row) -> Number:
    return sum((a * b for a, b in zip(one, other, strict=True)), 0.0)


def _product(one: _Row, matrix: Sequence[_Row], other: _Row) -> Number:
    return _dot(one, [_dot(row, other) for row in matrix])


def _kinetic(interfaces: int, damped: bool, q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    body, spin = _Data(interfaces, q, data, f), v[0][2]
    if damped:
        body.triangle()
    rates, (along, across) = body.rates(interfaces, v), body.local((0.0, 0.0), v[0])
    (x, y), (dx, dy) = ([_dot(row, values) for row in body.d] for values in ([1.0, *body.q], [0.0, *rates]))
    inertia = body.inertia + 2.0 * _dot(body.h, body.q) + _product(body.q, body.mass_matrix, body.q)
    moved = body.mass * (along * along + across * across) / 2 + along * (dx - spin * y) + across * (dy + spin * x)
    turned = spin * (_dot(body.b, rates) + _product(rates, body.skew(), body.q)) + spin * spin * inertia / 2
    return moved + turned + _product(rates, body.mass_matrix, rates) / 2


def _potential(interfaces: int, q: list[Vector], data: Vector, gravity: Vector, f: Functions) -> Number:
    body = _Data(interfaces, q, data, f)
    (x, y), (first_x, first_y) = (_dot(row, [1.0, *body.q]) for row in body.d), body.places[0]
    fallen_x = body.mass * (q[0][0] - first_x) + body.c * x - body.s * y - body.moment[0]
    fallen_y = body.mass * (q[0][1] - first_y) + body.s * x + body.c * y - body.moment[1]
    stored = _product(body.q, body.stiffness, body.q) / 2
    return stored - gravity[0] * fallen_x - gravity[1] * fallen_y


def _dissipation(interfaces: int, q: list[Vector], v: list[Vector], data: Vector, f: Functions) -> Number:
    """Return q' C_d q' / 2."""
    body = _Data(interfaces, q, data, f)
    rates = body.rates(interfaces, v)
    return _product(rates, body.triangle(), rates) / 2
