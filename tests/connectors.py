"""Connectors as users write them, each a dataclass of its own beside the package."""

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
