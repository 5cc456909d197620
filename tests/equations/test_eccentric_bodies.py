"""Velocity terms of an eccentric body are no damping, drag is; a state must be one of its load factor."""

from dataclasses import replace

import numpy as np
import pytest
from eccentric import Eccentric

import beamfem as bf
from beamfem.equations.system import system_of

LIGHT = bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=1e-3)
SQUARE = bf.Rectangle(0.01, 0.01)


def rod(supports=lambda beam: [], **body):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), SQUARE, LIGHT)
    connectors = [Eccentric(beam.end, 2.0, 0.2, **body)] if body else []
    return beam, bf.Model([beam], [bf.Clamp(beam.start), *supports(beam)], connectors=connectors)


@pytest.mark.parametrize("drag", [0.0, 1.0])
def test_modes_of_an_eccentric_body(drag):
    """Cubic drag vanishes in small vibrations as well."""
    stiffness = 2.1e11 * 0.01**4 / 12 * np.array([[12.0, -6.0], [-6.0, 4.0]])
    mass = 2.0 * np.array([[1.0, 0.2], [0.2, 0.04]])  # singular: one mode, the other one is that of the light rod
    flexible = np.max(np.linalg.eigvals(np.linalg.solve(stiffness, mass)).real)
    found = bf.solve_modes(rod(drag=drag)[1], count=1).frequencies
    assert found == pytest.approx([1.0 / (2.0 * np.pi * np.sqrt(flexible))], rel=1e-4)


def test_a_damper_is_refused():
    with pytest.raises(bf.InputError, match="the force of Eccentric depends on velocities"):
        bf.solve_modes(rod(damper=1e-6)[1])


@pytest.mark.parametrize(("body", "damps"), [({"drag": 0.0}, False), ({"drag": 1.0}, True), ({"damper": 1e-6}, True)])
def test_what_dissipates(body, damps):
    _, model = rod(**body)
    assert system_of(model, static=False).connectors.damp is damps
    motion = bf.simulate(model, duration=0.02, step=0.01)
    assert (motion.energy_drift is None) == damps


def test_a_state_with_the_load_factor_of_another_one():
    _, model = rod(lambda beam: [bf.Prescribed(beam.end, uy=lambda at: 0.3 * at)])
    state = bf.solve_static(model)[-1]
    assert len(bf.solve_modes(model, 2, about=state)) == 2
    with pytest.raises(bf.InputError, match=r"no state of load factor 0.5.* prescribes 0.15 of a coordinate .* 0.3\b"):
        bf.solve_modes(model, 2, about=replace(state, at=0.5))


def test_buckling_about_a_state_with_the_load_factor_of_another_one():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), SQUARE, LIGHT)
    push = bf.PointForce(beam.end, (-100.0, 0.0))
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Roller(beam.end)], [push])
    state = bf.solve_static(model)[-1]
    bf.solve_buckling(model, about=state)
    for solve in (bf.solve_buckling, bf.solve_modes):
        with pytest.raises(bf.InputError, match=r"no state of load factor 0.5.* a force of 50 is unbalanced"):
            solve(model, about=replace(state, at=0.5))
