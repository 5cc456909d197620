"""Python as users write it beside a model file, and what a model file makes of it."""

OWN = """from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from connectors import RigidLink, SpringDamper
from integrators import Radau
from section_laws import RambergOsgood

import beamfem as bf


@dataclass(frozen=True)
class Several:
    points: tuple[bf.Point, ...]
    stiffness: float
    unknowns = 0
    conservative = True

    def force(self, at):
        return (self.stiffness * (at.q - at.reference)).ravel()

    def energy(self, at):
        return 0.0, 0.5 * self.stiffness * float(((at.q - at.reference) ** 2).sum())


@dataclass(frozen=True)
class Gust:
    strength: float
    course: Callable[[float], float] | None = None

    def __call__(self, time):
        return self.strength * (time**2 if self.course is None else self.course(time))


class Flow:
    def __call__(self, arc_length):
        return 0.0, -100.0 * arc_length


@dataclass(frozen=True)
class Taper:
    width: float

    def __call__(self, arc_length):
        return bf.Rectangle(self.width, 0.01 - 0.002 * arc_length)


def sandwich(face: bf.Material, core: bf.Material, sizes: tuple[float, float]):
    return bf.Layered([bf.Layer(face, sizes[0]), bf.Layer(core, sizes[1]), bf.Layer(face, sizes[0])], 0.01)


def spiral(u):
    return np.array([np.sin(u), 1.0 - np.cos(u)]).T * (1 + 0.1 * np.array([u, u]).T)


def hump(arc_length):
    return 0.01 if arc_length < 0.5 else 0.008


def spin(position):
    return -2.0 * position[1], 2.0 * position[0]


def bent(state):
    return bool(state.displacement(state.model.beams[0].end)[1] > 0.3)


def lost(point: Nowhere):
    return point


def broken(size: float):
    return 1 / 0
"""

CODE = 'code = "own.py"\n'
FLAT = 'section = { kind = "rectangle", width = 0.01, height = 0.01 }'
LINE = '{ kind = "line", start = [0, 0], end = [1, 0] }'

CONNECTORS = """
[connectors.strut]
class = "SpringDamper"
a = "arm.at(0.25)"
b = "arm.end"
stiffness = 1000.0
[connectors.bed]
class = "Several"
points = ["arm.at(0.5)", "arm.end"]
stiffness = 50
[[outputs]]
connector = "bed"
quantities = ["fx", "fy", "m"]
"""
