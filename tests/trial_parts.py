"""A load, a support, a joint and a connector as a file of `beamfem/parts/` has them, see test_listed_parts.py."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from beamfem.model.beam import Beam, Point
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Amplitude, LineLoad
from beamfem.model.supports import PointSupport


@dataclass(frozen=True)
class SnowLoad(LineLoad):
    """A weight per length in x [N/m], which may vary along the beam."""

    along: ClassVar[tuple[str, ...]] = ("size",)
    axes = "plane"

    beam: Beam
    size: float | Callable[[float], float] = field(metadata={"unit": "N/m"})
    amplitude: Amplitude = None
    scale: bool = True

    @property
    def uniform(self):
        return not callable(self.size) and not self.beam.curve.corners

    def forces(self, arc_length):
        covered = np.abs(self.beam.curve.tangent(arc_length)[:, 0])
        size = [self.size(s) for s in arc_length.tolist()] if callable(self.size) else self.size
        return np.column_stack([np.zeros_like(covered), -np.asarray(size) * covered])


@dataclass(frozen=True)
class Slide(PointSupport):
    """Slides in y on a spring."""

    point: Point
    stiffness: float = field(metadata={"unit": "N/m"})

    def prescribed(self):
        return {"ux": 0.0, "rotation": 0.0}

    def springs(self):
        return {"uy": self.stiffness}


@dataclass(frozen=True)
class Weld(Joint):
    """Joins two points rigidly, by a seam of some thickness [m]."""

    keeps_angle: ClassVar[bool] = True

    a: Point
    b: Point
    thickness: float = field(default=0.005, metadata={"unit": "m"})


@dataclass(frozen=True)
class Buffer:
    """A spring in y from a point to the ground."""

    point: Point
    stiffness: float = field(metadata={"unit": "N/m"})
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        zero = 0.0 * at.q[0, 0]
        return np.array([zero, self.stiffness * (at.q[0, 1] - at.reference[0, 1]), zero])

    def energy(self, at):
        return 0.0, 0.5 * self.stiffness * float(at.q[0, 1] - at.reference[0, 1]) ** 2
