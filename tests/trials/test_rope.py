"""A rope of given length over two points: from a beam over two pulleys to another beam, without friction."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf


def longer(q, data, f):
    """Return by how much the rope a - pulley - pulley - b is longer than it may be."""
    ax, ay, bx, by, rest = data
    ends = (q[0][0] - ax, q[0][1] - ay), (q[1][0] - bx, q[1][1] - by)
    return (sum(f.sqrt(x * x + y * y) for x, y in ends) - rest,)


ROPE = bf.Connection("own_rope", 2, 2, ("ax", "ay", "bx", "by", "rest"), conditions=longer, multipliers=1)


@dataclass(frozen=True)
class Rope(bf.PartAtPoints):
    a: bf.Point
    b: bf.Point
    pulleys: tuple[tuple[float, float], tuple[float, float]]
    length: float
    connection = ROPE

    @property
    def points(self):
        return self.a, self.b

    def data(self, reference):
        (ax, ay), (bx, by) = self.pulleys
        return ax, ay, bx, by, self.length - float(np.hypot(bx - ax, by - ay))


def test_a_rope_pulls_both_ends_alike_and_keeps_its_length():
    shape, steel = bf.Rectangle(0.02, 0.01), bf.Material(2e11, 0.3, 7800.0)
    left = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), shape, steel)
    right = bf.Beam(bf.Line((4, 0), (3, 0)), 4, bf.CRBF(3), shape, steel)
    pulleys = ((1.2, 2.0), (2.7, 2.0))
    length = float(np.hypot(0.2, 2.0) + 1.5 + np.hypot(0.3, 2.0))
    rope = Rope(left.end, right.end, pulleys, length)
    clamps, load = [bf.Clamp(left.start), bf.Clamp(right.start)], bf.PointForce(left.end, (0.0, -300.0))
    pulled = bf.solve_static(bf.Model([left, right], clamps, [load], connectors=[rope]))
    ends = [pulled.position(beam.end)[-1] - place for beam, place in ((left, pulleys[0]), (right, pulleys[1]))]
    assert sum(np.hypot(*end) for end in ends) + 1.5 == pytest.approx(length, rel=1e-10)
    tension = pulled.multipliers(rope)[-1, 0]
    forces = pulled.connector_force(rope)[-1, :, :2]
    for force, end in zip(forces, ends, strict=True):
        np.testing.assert_allclose(force, -tension * end / np.hypot(*end), rtol=1e-8)
    assert tension > 100.0
    assert pulled.displacement(left.end)[-1, 1] < -0.01 < 0.01 < pulled.displacement(right.end)[-1, 1]
