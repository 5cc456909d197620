"""Connectors as users write them, each a dataclass of its own beside the package, and models with them."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf


@dataclass(frozen=True)
class Anchor:
    """Springs [N/m, N/m, N m/rad] from a point to where it is in the reference."""

    point: bf.Point
    stiffness: tuple[float, float, float]
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        return (np.array(self.stiffness) * (at.q - at.reference)).ravel()

    def energy(self, at):
        return 0.0, 0.5 * float((np.array(self.stiffness) * (at.q - at.reference) ** 2).sum())


@dataclass(frozen=True)
class SpringDamper:
    """A straight spring [N/m] and damper [N s/m] between two points, free of force at its reference length."""

    a: bf.Point
    b: bf.Point
    stiffness: float = 0.0
    damping: float = 0.0
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return self.a, self.b

    def force(self, at):
        along = at.q[1, :2] - at.q[0, :2]
        length = np.sqrt(along @ along)
        rate = along @ (at.v[1, :2] - at.v[0, :2]) / length
        pull = (self.stiffness * (length - self._rest(at)) + self.damping * rate) * along / length
        nothing = 0.0 * pull[:1]
        return np.concatenate([-pull, nothing, pull, nothing])

    def energy(self, at):
        along = at.q[1, :2] - at.q[0, :2]
        return 0.0, 0.5 * self.stiffness * float(np.sqrt(along @ along) - self._rest(at)) ** 2

    @staticmethod
    def _rest(at):
        return np.linalg.norm(at.reference[1, :2] - at.reference[0, :2])


@dataclass(frozen=True)
class RigidLink:
    """Two points keep their distance; the multiplier is the force [N] that pulls them together."""

    a: bf.Point
    b: bf.Point
    unknowns = 1
    conservative = True

    @property
    def points(self):
        return self.a, self.b

    def force(self, at):
        along, before = (q[1, :2] - q[0, :2] for q in (at.q, at.reference))
        length = np.sqrt(before @ before)
        pull = at.own * along / length
        condition = (along @ along - length**2) / (2.0 * length)
        return np.concatenate([-pull, [0.0], pull, [0.0], [condition]])

    def energy(self, at):
        return 0.0, 0.0


@dataclass(frozen=True)
class PointMass:
    """A mass [kg] that gravity acts on."""

    point: bf.Point
    mass: float
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        x, y = self.mass * (at.a[0, :2] - at.gravity)
        return np.array([x, y, 0.0 * x])

    def energy(self, at):
        fallen = (at.q[0, :2] - at.reference[0, :2]) @ at.gravity
        return 0.5 * self.mass * (at.v[0, :2] @ at.v[0, :2]), -self.mass * float(fallen)


@dataclass(frozen=True)
class Barrier:
    """A smooth wall: a point is pushed back with stiffness * width * exp(-(y - level) / width) [N]."""

    point: bf.Point
    level: float
    stiffness: float
    width: float
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        push = self.stiffness * self.width * np.exp(-(at.q[0, 1] - self.level) / self.width)
        return np.array([0.0 * push, -push, 0.0 * push])

    def energy(self, at):
        gap = float(at.q[0, 1]) - self.level
        return 0.0, self.stiffness * self.width**2 * float(np.exp(-gap / self.width))


@dataclass(frozen=True)
class Rest:
    """A rough floor: it pushes a point back with a stiffness [N/m], and holds it there up to friction times the push.

    It remembers where along the floor the point would be free of force [m], from its reference.
    """

    point: bf.Point
    level: float
    stiffness: float
    friction: float
    memory = (0.0,)
    unknowns = 0
    conservative = False

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        push, held = self._forces(at)
        return np.array([held, -push, 0.0 * push])

    def remember(self, at):
        return [at.q[0, 0] - at.reference[0, 0] - self._forces(at)[1] / self.stiffness]

    def energy(self, at):
        push, held = self._forces(at)
        return 0.0, 0.5 * float(np.real(push**2 + held**2)) / self.stiffness

    def _forces(self, at):
        gap = at.q[0, 1] - self.level
        push = -self.stiffness * gap if gap.real < 0.0 else 0.0 * gap
        held = self.stiffness * (at.q[0, 0] - at.reference[0, 0] - at.memory[0])
        most = self.friction * push
        # where it slid before, a step begins as if it stuck: Newton's method goes to and fro between sliding both ways
        return push, held if abs(held.real) <= (1.0 + 1e-9) * most.real else most * np.sign(held.real)


SECTION, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
BENDING, AREA = 2e11 * 1e-8 / 12, 1e-4
KINDS = [bf.ANCF(), bf.CRBF(3), bf.BilinearCRBF(bf.Structural(), "reduced")]


def beam(element=KINDS[1], start=(0.0, 0.0), end=(1.0, 0.0), elements=4, density=7800.0):
    material = bf.Material(2e11, 0.3, density)
    return bf.Beam(bf.Line(start, end), elements, element, SECTION, material)


def cantilever(own, loads, connectors=(), supports=()):
    return bf.Model([own], [bf.Clamp(own.start), *supports], loads, connectors=connectors)


def turned_by(turn):
    """Return the function that turns a vector about the origin."""
    c, s = np.cos(turn), np.sin(turn)
    return lambda x, y: (c * x - s * y, s * x + c * y)


def portal(turn=0.0):
    """A column clamped at its foot and one on a pin, which a rigid link between the heads holds."""
    place = turned_by(turn)
    left, right = beam(start=place(0, 0), end=place(0, 1)), beam(start=place(2, 0), end=place(2, 1))
    link = RigidLink(left.end, right.end)
    loads = [bf.PointForce(right.end, place(0.5 * BENDING, 0.0))]
    return left, right, bf.Model([left, right], [bf.Clamp(left.start), bf.Pin(right.start)], loads, connectors=[link])


def crossbar(link, turn=0.0):
    """A parallelogram that falls: two beams on pins, whose free ends a link keeps apart."""
    place = turned_by(turn)
    one = beam(bf.CRBF(2), place(0, 0), place(1, 0), elements=3)
    two = beam(bf.CRBF(2), place(0, 0.5), place(1, 0.5), elements=3)
    parts = [link(one.end, two.end), PointMass(two.end, 0.3)]
    pins = [bf.Pin(one.start), bf.Pin(two.start)]
    return two, bf.Model([one, two], pins, [bf.Gravity(place(0.0, -9.81))], connectors=parts)
