"""Which motions of bodies supports leave free, with many bodies as with few."""

import numpy as np
import pytest

import beamfem as bf
import beamfem.solve.start.mechanisms
from beamfem.equations.system import System
from beamfem.solve.start.mechanisms import Conditions, bodies_of, mechanisms


@pytest.mark.parametrize("dense_up_to", [300, 3], ids=["dense", "sparse"])
@pytest.mark.parametrize("pinned", [(), (4,), (2, 7)])
def test_every_bar_that_is_pinned_only_may_turn_about_its_pin(monkeypatch, dense_up_to, pinned):
    monkeypatch.setattr(beamfem.solve.start.mechanisms, "_DENSE_BODIES", dense_up_to)
    section, material = bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0)
    bars = [bf.Beam(bf.Line((2 * i, 0), (2 * i + 1, 0)), 1, bf.CRBF(1), section, material) for i in range(12)]
    supports = [(bf.Pin if i in pinned else bf.Clamp)(bar.start) for i, bar in enumerate(bars)]
    system = System(bf.Model(bars, supports), static=True)
    conditions = Conditions(system, bodies_of(system.model), system.reference)
    motions = mechanisms(conditions)
    assert motions @ motions.T == pytest.approx(np.eye(len(pinned)), abs=1e-9)
    # a, b in lengths of the model and the turn about its centre: b = -turn x of the pin
    expected = np.zeros((len(pinned), 36))
    for row, i in zip(expected, pinned, strict=True):
        row[3 * i + 1 : 3 * i + 3] = -(2 * i - conditions.centre[0]) / conditions.extent, 1.0
        row /= np.linalg.norm(row)
    assert motions.T @ motions == pytest.approx(expected.T @ expected, abs=1e-8)
