"""Paths under loads that come and go while the load factor grows."""

import numpy as np
import pytest
from scipy.optimize import brentq
from slow_values import mostly_slow

import beamfem as bf
from beamfem.solve.start.functions_of_time import FunctionOfTime

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.1, 1e-3)
EI = STEEL.youngs_modulus * SECTION.second_moment
SPIKE = (0.0, 0.3, 0.301, 0.302, 1.0), (0.0, 0.0, 1.0, 0.0, 0.0)
EULER = 0.25 * np.pi**2 * EI


def pulse(width):
    return lambda at: float(np.exp(-(((at - 0.5) / width) ** 2)))


def cantilever(force, amplitude):
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 8, bf.CRBF(2), SECTION, STEEL)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force, amplitude=amplitude)])


@mostly_slow("width", [0.3, 0.1, 0.05, 0.02], quick=(0, 3))
@pytest.mark.parametrize("size", [1.0, 1e-2])
def test_a_path_follows_a_pulse(width, size):
    """Two points at the ends of the path were all; a tail of 1e-44 N was said to leave the forces no digits."""
    model = cantilever((0.0, size * EI), pulse(width))
    tip = model.beams[0].end
    path = bf.trace_equilibrium(model, 1.0)
    largest = bf.solve_static(model, at=[0.5]).displacement(tip)[-1, 1]
    assert len(path) < 60
    assert path.load_factor[-1] == 1.0
    assert 0.9 * largest < path.displacement(tip)[:, 1].max() < 1.0001 * largest
    acting = np.array([pulse(width)(at) for at in path.load_factor])
    for row in np.flatnonzero(acting > 1e-3)[::5]:
        alone = cantilever((0.0, size * EI * acting[row]), None)
        exact = bf.solve_static(alone).displacement(alone.beams[0].end)[-1]
        np.testing.assert_allclose(path.displacement(tip)[row], exact, atol=1e-8)


@mostly_slow("width", [0.5, 0.2, 0.05, 0.02], quick=(0, 3))
@pytest.mark.parametrize("peak", [0.95, 1.1, 1.5])
def test_a_column_under_a_pulse_loses_its_stability_and_regains_it(width, peak):
    """One step passed over both bifurcations, and every row was stable."""

    def amplitude(at):
        return peak * pulse(width)(at) + 0.2 * at

    path = bf.trace_equilibrium(cantilever((-EULER, 0.0), amplitude), 1.0)
    exact = [brentq(lambda at: amplitude(at) - 1.0, *ends) for ends in ((0.0, 0.5), (0.5, 1.0))]
    # eight elements buckle 4e-6 above Euler's load, which counts for more where the pulse is flat
    assert [point.load_factor for point in path.bifurcations] == pytest.approx(exact, rel=3e-5)
    assert not path.stable.all()
    assert path.stable[[0, -1]].all()


def test_a_step_over_a_declared_kink_is_seen():
    spike = bf.Piecewise(lambda at: float(np.interp(at, *SPIKE)), kinks=SPIKE[0][1:4])
    assert FunctionOfTime("a spike", spike, True).bulges(0.0, 1.0)
    assert not FunctionOfTime("a spike", spike, True).bulges(0.302, 1.0)
    assert not FunctionOfTime("its rise", spike, True).bulges(0.0, 0.301)


def test_a_pulse_of_a_motion_is_followed():
    """A support that is led aside and back."""
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 8, bf.CRBF(2), SECTION, STEEL)
    led = bf.Prescribed(beam.end, uy=lambda at: 0.2 * pulse(0.05)(at))
    path = bf.trace_equilibrium(bf.Model([beam], [bf.Clamp(beam.start), led]), 1.0)
    assert path.displacement(beam.end)[:, 1].max() > 0.18
