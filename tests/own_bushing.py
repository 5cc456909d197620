"""A bushing written by hand beside the package, to compare with `bf.Bushing`."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf


@dataclass(frozen=True)
class Mount:
    """Springs and dampers along axes that turn with a, and between the rotations: stiffness and damping (3,)."""

    a: bf.Point
    b: bf.Point
    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float] = (0.0, 0.0, 0.0)
    unknowns, conservative = 0, True

    @property
    def points(self):
        return self.a, self.b

    def apart(self, at):
        """The axes of a, the place of b in them, and the elongations."""
        c, s = np.cos(at.q[0, 2]), np.sin(at.q[0, 2])
        axes = np.array([[c, s], [-s, c]])
        place = axes @ (at.q[1, :2] - at.q[0, :2])
        return axes, place, np.append(place - (at.reference[1] - at.reference[0])[:2], at.q[1, 2] - at.q[0, 2])

    def force(self, at):
        axes, place, elongation = self.apart(at)
        turned = np.array([place[1], -place[0]])
        rate = np.append(axes @ (at.v[1, :2] - at.v[0, :2]) + at.v[0, 2] * turned, at.v[1, 2] - at.v[0, 2])
        force = np.array(self.stiffness) * elongation + np.array(self.damping) * rate
        pull, moment = axes.T @ force[:2], force[2]
        return np.array([*-pull, force[:2] @ turned - moment, *pull, moment])

    def energy(self, at):
        return 0.0, 0.5 * np.array(self.stiffness) @ self.apart(at)[2] ** 2
