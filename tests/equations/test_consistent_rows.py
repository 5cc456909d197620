"""Rows of motions on the conditions of joints: positions, velocities and accelerations to round-off."""

from dataclasses import replace

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.equations import residual
from beamfem.equations.system import system_of
from beamfem.solve.motion.consistent_rows import finished_rows
from beamfem.solve.motion.constraints import _change_of_rates, _rates

STEEL, SQUARE = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.02, 0.02)
QUADRATIC = bf.CRBF(2)
BESIDE = bf.Layered([bf.Layer(STEEL, 0.02)], 0.02, axis=0.06)  # its axis lies above it


def flying(supports=(), element=QUADRATIC, section=SQUARE):
    """Three bars with a link, a slider and a gear between them, and a body beside the axis; it may fly freely."""
    one, two, three = (
        bf.Beam(bf.Line(a, b), 2, element, section, None if section is BESIDE else STEEL)
        for a, b in (((0, 0), (1, 0)), ((1.3, 0.2), (2, 0.4)), ((2.2, 0.3), (2.8, 0.1)))
    )
    joints = [
        bf.Link(one.end, two.start),
        bf.Slider(two.end, three.start, (1.0, 0.5)),
        bf.Gear(one.end, three.end, 1.0),
    ]
    held = [bf.Pin(one.start)] if supports else []
    body = bf.RigidBody(three.end, 3.0, 0.05, (0.2, 0.3))
    driven = [bf.Motor(one.start, speed=lambda t: 20.0 * t)] if supports else []
    return bf.Model([one, two, three], held, driven, joints, masses=[body])


@pytest.mark.parametrize("integrator", [bf.GeneralizedAlpha(), bf.Trapezoidal(), bf.Radau(2), bf.Bathe(), bf.Gauss(2)])
@pytest.mark.parametrize("driven", [False, True])
def test_positions_velocities_and_accelerations_satisfy_all_conditions(driven, integrator):
    model = flying([1] if driven else [])
    spin = None if driven else bf.RigidVelocity((0.3, -0.2), angular=4.0)
    motion = bf.simulate(model, 0.04, 2e-3, velocity=spin, integrator=integrator)
    system = system_of(model, static=False)
    assert np.abs(motion.v).max() > 0.3
    for p, v, a, time in zip(motion.p, motion.v, motion.a, motion.time, strict=True):
        gaps = system.connectors.conditions(p, v, time)[0]
        assert np.abs(gaps).max() < 1e-11
        assert np.abs(_rates(system, p, v, time)).max() < 1e-13 * np.abs(motion.v).max()
        turning = np.abs(_change_of_rates(system, p, v, a, time)).max()
        assert turning < 1e-10 * max(np.abs(motion.a).max(), 1.0)
        forces = residual(system, p, v, a, time)[system.free_dofs]
        assert np.abs(forces).max() < 1e-4 * np.abs(motion.a).max()  # what iterations leave


@pytest.mark.parametrize(
    "element", [QUADRATIC, bf.ANCFCRBF(bf.Structural()), bf.ANCF(bf.Structural()), bf.ShearRigid()]
)
@mostly_slow("section", [SQUARE, BESIDE], quick=(1,), ids=["centred", "beside the axis"])
def test_corrections_change_no_momentum_where_bodies_or_beams_are_beside_the_axis(element, section):
    """They are impulses of the joints, in a state turned by some rad, with which the inertia of some elements turns."""
    motion = bf.simulate(flying((), element, section), 0.2, 2e-3, velocity=bf.RigidVelocity((0.3, -0.2), angular=4.0))
    off = motion.v + 1e-3 * np.random.default_rng(0).standard_normal(motion.v.shape)
    off[:, -3 - 1 :] = 0.0  # of multipliers
    states = np.stack([motion.p, off, motion.a], axis=1)
    states = finished_rows(system_of(motion.model, static=False), motion.time.tolist(), states)
    assert np.abs(states[:, 1] - off).max() > 1e-4
    before, after = (replace(motion, v=v) for v in (off, states[:, 1].copy()))
    for name in ("linear_momentum", "angular_momentum"):
        np.testing.assert_allclose(getattr(after, name)(), getattr(before, name)(), rtol=1e-6, atol=1e-7)


def test_rows_between_steps_satisfy_conditions_too():
    model = flying()
    at = np.linspace(0.0, 0.02, 8)
    motion = bf.simulate(model, 0.02, 2e-3, velocity=bf.RigidVelocity(angular=4.0), save_at=at)
    system = system_of(model, static=False)
    for p, v, time in zip(motion.p, motion.v, motion.time, strict=True):
        gaps = system.connectors.conditions(p, v, time)[0]
        assert np.abs(gaps).max() < 1e-11
        assert np.abs(_rates(system, p, v, time)).max() < 1e-12


def test_a_file_has_the_same_rows(tmp_path):
    model, spin = flying(), bf.RigidVelocity((0.3, -0.2), angular=4.0)
    here = bf.simulate(model, 0.1, 2e-3, velocity=spin)
    there = bf.simulate(model, 0.1, 2e-3, velocity=spin, file=tmp_path / "flight.h5")
    for name in "pva":
        np.testing.assert_array_equal(getattr(there, name), getattr(here, name))
