"""A spring with a force between two states, which depends on the start of the step and conserves energy exactly.

f = 2 (V1 - V0) / (l1^2 - l0^2) (d0 + d1) / 2 for the potential V of the length l = |d| (Gonzalez 1996).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest

import beamfem as bf


@dataclass(frozen=True)
class SpringBetweenStates:
    """A spring from a point to a place on the ground; it remembers where the point was as the step began."""

    point: bf.Point
    ground: tuple[float, float]
    stiffness: float
    unknowns, conservative, rotations = 0, True, False

    @cached_property
    def points(self):
        return (self.point,)

    @cached_property
    def length(self):
        return float(np.hypot(*(self.point.reference - self.ground)))

    @property
    def memory(self):
        return tuple(self.point.reference)

    def remember(self, at):
        return at.q[0, :2]

    def force(self, at):
        """Return the force at the mean of two states, at which `EnergyMomentum` asks for it; at rest both are one."""
        mean, before = at.q[0, :2] - self.ground, at.memory - self.ground
        after = 2.0 * mean - before
        both = np.sqrt(before @ before) + np.sqrt(after @ after)
        fx, fy = self.stiffness * (both - 2.0 * self.length) / both * mean
        return np.array([fx, fy, 0.0])

    def energy(self, at):
        arm = at.q[0, :2] - self.ground
        return 0.0, 0.5 * self.stiffness * (np.sqrt(arm @ arm) - self.length) ** 2


@pytest.mark.parametrize("between", [True, False])
def test_it_conserves_energy_at_large_steps_where_the_force_of_the_mean_state_does_not(between):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.ANCF(), bf.Rectangle(0.02, 0.02), bf.Material(2e9, 0.3, 1000.0))
    spring = SpringBetweenStates(beam.end, (1.0, 0.5), 40.0) if between else bf.SpringDamper(beam.end, (1.0, 0.5), 40.0)
    spin = bf.RigidVelocity(angular=20.0, about=(0.5, 0.0))
    moved = bf.simulate(bf.Model([beam], connectors=[spring]), 1.0, 0.01, bf.EnergyMomentum(), velocity=spin)
    drift = np.ptp(moved.energy().total) / moved.energy().total[0]
    assert drift < 1e-12 if between else drift > 1e-3
