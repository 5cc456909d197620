"""A plastic section: a law of two resultants with history, perfectly plastic in bending."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.section.moments import StiffnessSection


@dataclass(frozen=True)
class Hinging(StiffnessSection):
    """Bends elastically up to a moment, then with linear kinematic hardening; it remembers its plastic curvature."""

    limit: float = 1.0  # [N m]
    hardening: float = 0.0  # [N m^2]
    memory = (0.0, 0.0)  # plastic curvature [1/m], dissipated energy per length [J/m]

    def _flow(self, strain, history):
        over = self.bending * (strain[:, 2] - history[:, 0]) - self.hardening * history[:, 0]
        sign = np.sign(over.real)
        yields = sign * over.real > self.limit * (1.0 + 1e-9)
        return np.where(yields, (over - sign * self.limit) / (self.bending + self.hardening), 0.0)

    def resultants(self, strain, material, history, dt):
        moment = self.bending * (strain[:, 2] - history[:, 0] - self._flow(strain, history))
        return np.stack([self.axial * strain[:, 0], self.shear * strain[:, 1], moment], axis=-1)

    def remember(self, strain, material, history, dt):
        flow = self._flow(strain, history)
        return history + np.stack([flow, self.limit * np.abs(flow)], axis=-1)

    def energy(self, strain, material, history):
        elastic = strain - history[:, :1] * np.array([0.0, 0.0, 1.0])
        stored = elastic**2 @ np.array([self.axial, self.shear, self.bending]) + self.hardening * history[:, 0] ** 2
        return np.stack([0.5 * stored, history[:, 1]], axis=-1)


def test_a_cantilever_yields_at_its_plastic_moment_and_keeps_a_turn():
    section = Hinging(1e7, 4e6, 1e3, 1.0, 1e-3, 0.0, limit=100.0, hardening=100.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), section)
    moment = bf.PointMoment(beam.end, 150.0, amplitude=lambda at: 1 - abs(2 * at - 1))
    bent = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [moment]), steps=20)
    turns = bent.rotation(beam.end)
    assert turns[5] == pytest.approx(75.0 / 1e3, rel=1e-6)
    assert turns[10] == pytest.approx(150.0 / 1e3 + 50.0 / 100.0, rel=1e-6)
    assert turns[-1] == pytest.approx(50.0 / 100.0, rel=1e-6)
    assert bent.energy().dissipated[-1] == pytest.approx(100.0 * 0.5, rel=1e-6)
