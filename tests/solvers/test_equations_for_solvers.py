"""The equations of motion as a right-hand side for solvers of ordinary differential equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from slow_values import mostly_slow

import beamfem as bf

RUBBER, SECTION = bf.Material(0.7e6, 0.3, 5540.0), bf.Section(1.6e-3, 8.533e-6)
WEIGHT = bf.Gravity((0.0, -9.81))


def arm(x, length, elements):
    return bf.Beam(bf.Line((x, 0), (x + length, 0)), elements, bf.CRBF(2), SECTION, RUBBER)


def pendulum():
    beam = arm(0.0, 1.2, 2)
    return bf.Model([beam], [bf.Pin(beam.start)], [WEIGHT])


def linked():
    """Two bars that a link joins, whose multiplier is no coordinate."""
    bars = [arm(0.0, 1.0, 1), arm(1.2, 0.5, 1)]
    return bf.Model(bars, [bf.Pin(bars[0].start)], [WEIGHT], connectors=[bf.Link(bars[0].end, bars[1].start)])


@pytest.mark.parametrize("made", [pendulum, linked])
@mostly_slow("method", ["DOP853", "Radau"])
@pytest.mark.filterwarnings("ignore::beamfem.errors.CoarseMeshWarning")
def test_a_pendulum_moves_as_with_short_steps(made, method):
    model = made()
    equations, tip = bf.EquationsOfMotion.of(model), model.beams[-1].end
    rows = [equations.state(0.0, equations.coordinates())]
    tolerances = {"rtol": 1e-7, "atol": 1e-8} if method == "DOP853" else {"rtol": 1e-5, "atol": 1e-6}
    solved = solve_ivp(equations.rates, (0.0, 0.2), equations.coordinates(), method, [0.1, 0.2], **tolerances)
    rows += [equations.state(t, y) for t, y in zip(solved.t, solved.y.T, strict=True)]
    fine = bf.simulate(model, 0.2, 2e-5, bf.GeneralizedAlpha(1.0), save_every=5000)
    np.testing.assert_allclose(fine.time, [row.at for row in rows], atol=1e-12)
    p, v, a = (np.array([getattr(row, name) for row in rows]) for name in "pva")
    found = bf.Solution(model, False, fine.at, p, v, a, fine.statistics)
    accuracy = 2e-6 if method == "DOP853" else 2e-5
    np.testing.assert_allclose(found.position(tip), fine.position(tip), atol=accuracy)
    exchanged = np.ptp(fine.energy().kinetic)
    np.testing.assert_allclose(found.energy().total, fine.energy().total[0], atol=10.0 * accuracy * exchanged)


def test_a_state_of_a_motion_becomes_coordinates_and_back():
    model = pendulum()
    motion = bf.simulate(model, 0.1, 1e-3, bf.Gauss(3))
    equations = bf.EquationsOfMotion.of(model)
    again = equations.state(0.1, equations.coordinates(motion))
    np.testing.assert_array_equal([again.p, again.v], [motion.p[-1], motion.v[-1]])
    np.testing.assert_allclose(again.a, motion.a[-1], rtol=1e-7, atol=1e-7 * np.abs(again.a).max())


def test_models_that_need_steps_are_refused():
    beam = arm(0.0, 1.2, 2)
    with pytest.raises(bf.InputError, match="whose supports move"):
        bf.EquationsOfMotion.of(bf.Model([beam], [bf.Prescribed(beam.start, ux=np.sin, uy=0.0)]))
    mild = bf.ElasticPlastic(2e11, 2e8, poisson_ratio=0.3, density=7800.0)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Fibres(bf.Rectangle(0.02, 0.02), mild))
    with pytest.raises(bf.InputError, match="history variables"):
        bf.EquationsOfMotion.of(bf.Model([bar], [bf.Clamp(bar.start)]))
    equations = bf.EquationsOfMotion.of(pendulum())
    with pytest.raises(bf.InputError, match="y must have 26 values"):
        equations.rates(0.0, equations.coordinates()[1:])
