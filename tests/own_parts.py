"""Loads, supports and a joint as users write them, each a dataclass of its own beside the package."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf


@dataclass(frozen=True)
class Traction(bf.LineLoad):
    """A force [N/m] along the deformed axis, per deformed length."""

    beam: bf.Beam
    size: float
    amplitude: object = None
    scale: bool = True
    axes = "axis"
    uniform = True

    def forces(self, arc_length):
        return np.tile([self.size, 0.0], (len(arc_length), 1))


@dataclass(frozen=True)
class HalfWave(bf.LineLoad):
    """A force [N/m] in y, as a half wave over the beam."""

    beam: bf.Beam
    size: float
    axes = "plane"

    def forces(self, arc_length):
        wave = np.sin(np.pi * arc_length / self.beam.curve.length)
        return np.column_stack([np.zeros_like(wave), self.size * wave])


@dataclass(frozen=True)
class Bracket(bf.PointLoad):
    """A weight [N] at a distance [m] from the axis."""

    point: bf.Point
    weight: float
    arm: float

    @property
    def value(self):
        return 0.0, -self.weight, -self.weight * self.arm


@dataclass(frozen=True)
class Growth(bf.ImposedStrain):
    """A stretch that a beam grows by."""

    beam: bf.Beam
    ratio: object
    along = ("ratio",)
    units = ("",)

    def free_strain(self, arc_length):
        found = np.zeros((len(arc_length), 4))
        found[:, 0] = self.values_of("ratio", arc_length)
        return found


@dataclass(frozen=True)
class Guide(bf.PointSupport):
    """Slides in y against a spring [N/m]; does not rotate."""

    point: bf.Point
    stiffness: float

    def prescribed(self):
        return {"ux": 0.0, "rotation": 0.0}

    def springs(self):
        return {"uy": self.stiffness}


@dataclass(frozen=True)
class Weld(bf.Joint):
    """Joins two beams as one."""

    a: bf.Point
    b: bf.Point
    keeps_angle = True
