"""A stop with friction: a level that pushes a point back, and holds it until friction is overcome."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf


def held(q, data, f):
    """Return push, friction and change of the slip."""
    stiffness, friction, level, start, slip = data
    push = stiffness * f.positive(level - q[0][1])
    trial = stiffness * (q[0][0] - start - slip)
    over = f.positive(trial - friction * push) - f.positive(-trial - friction * push)
    return push, trial - over, over / stiffness


def force(q, v, data, f):
    push, pulled, _ = held(q, data, f)
    return pulled, -push


def remembered(q, v, data, f):
    return (data[4] + held(q, data, f)[2],)


NAMES = ("stiffness", "friction", "level", "start")
STOP = bf.Connection("own_stop", 1, 2, NAMES, memory=("slip",), force=force, remember=remembered)


@dataclass(frozen=True)
class OwnStop(bf.PartAtPoints):
    point: bf.Point
    level: float
    stiffness: float
    friction: float
    conservative = False
    connection = STOP

    @property
    def points(self):
        return (self.point,)

    def data(self, reference):
        return self.stiffness, self.friction, self.level, float(reference[0, 0])


def test_a_rod_on_it_sticks_until_it_is_pulled_with_the_limit():
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 1000.0))
    ends = [OwnStop(point, 0.0, 1e6, 0.4) for point in (rod.start, rod.end)]
    pull = bf.PointForce(rod.end, (10.0, 0.0), amplitude=lambda time: min(time, 6.0))
    moved = bf.simulate(bf.Model([rod], [], [bf.Gravity((0, -10.0)), pull], connectors=ends), 6.0, step=0.01)
    slid = moved.displacement(rod.end)[:, 0]
    before = np.searchsorted(moved.time, 3.5)  # the limit of 0.4 m g = 40 N is reached at 4 s
    assert np.abs(slid[:before]).max() < 1e-4
    assert slid[-1] == pytest.approx(2.0**3 / 6.0, rel=1e-3)  # m x'' = 10 t - 40, with 10 kg
