"""Drag along a beam: a user's part given by its dissipation function, at all nodes."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf


def dissipated(q, v, data, f):
    """Return c |v|^3 / 3, of which the force is c |v| v."""
    ((x, y),) = v
    return data[0] * f.sqrt(x * x + y * y + 1e-12) ** 3 / 3


DRAG = bf.Connection("own_drag", 1, 2, ("coefficient",), dissipation=dissipated)


@dataclass(frozen=True)
class AtNode(bf.PartAtPoints):
    points: tuple[bf.Point, ...]
    coefficient: float
    connection = DRAG

    def data(self, reference):
        return (self.coefficient,)


@dataclass(frozen=True)
class Fluid(bf.PartAlongBeam):
    beam: bf.Beam
    coefficient: float  # [kg/m^2]

    def at_nodes(self, points, lengths):
        return tuple(AtNode((p,), self.coefficient * w) for p, w in zip(points, lengths.tolist(), strict=True))


def test_a_falling_rod_slows_down_as_its_closed_form():
    """m v' = m g - c v^2 per length: v = u tanh(g t / u), u^2 = m g / c."""
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(2e9, 0.3, 1000.0))
    fluid = Fluid(rod, 3.0)
    falling = bf.simulate(bf.Model([rod], loads=[bf.Gravity((0, -9.81))], connectors=[fluid]), 1.0, step=0.01)
    speed = np.sqrt(0.4 * 9.81 / 3.0)
    assert falling.velocity(rod.end)[-1, 1] == pytest.approx(-speed * np.tanh(9.81 / speed), rel=1e-4)
