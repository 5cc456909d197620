"""A body as a connector whose centre of mass is not at its point, with forces that resist its velocity."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf


@dataclass(frozen=True)
class Eccentric:
    """A mass [kg] at a distance [m] from a point, which turns with it; drag c v^3 and a damper c v [N] along y."""

    point: bf.Point
    mass: float
    distance: float
    drag: float = 0.0
    damper: float = 0.0
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return (self.point,)

    def _arm(self, at):
        turn = at.q[0, 2] - at.reference[0, 2]
        return self.distance * np.array([np.cos(turn), np.sin(turn)])

    def force(self, at):
        (c, s), rate = self._arm(at), at.v[0, 2]
        x = self.mass * (at.a[0, 0] - s * at.a[0, 2] - c * rate**2 - at.gravity[0])
        y = self.mass * (at.a[0, 1] + c * at.a[0, 2] - s * rate**2 - at.gravity[1])
        return np.array([x, y + self.drag * at.v[0, 1] ** 3 + self.damper * at.v[0, 1], c * y - s * x])

    def energy(self, at):
        (c, s), (vx, vy, rate) = self._arm(at), at.v[0]
        fallen = at.gravity @ (at.q[0, :2] - at.reference[0, :2] + np.array([c, s]))
        return 0.5 * self.mass * ((vx - s * rate) ** 2 + (vy + c * rate) ** 2), -self.mass * fallen
