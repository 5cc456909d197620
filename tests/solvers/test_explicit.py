"""Explicit methods: their orders, their stable steps, and what they refuse."""

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf

RUBBER, DAMPED = bf.Material(5e5, 0.0, 1000.0), bf.Material(5e5, 0.0, 1000.0, retardation_time=2e-3)
ELEMENTS = [bf.CRBF(2), bf.ANCF(integration="lobatto")]
METHODS = [(bf.CentralDifferences(), 2, 0.1), (bf.DormandPrince(), 8, 0.8)]
DURATION = 0.4


def arm(element, start=(0, 0), end=(1, 0), material=RUBBER):
    return bf.Beam(bf.Line(start, end), 1, element, bf.Rectangle(0.02, 0.1), material)


def hanging(*beams, supports=(), **others):
    return beams[-1], bf.Model(list(beams), [bf.Pin(beams[0].start), *supports], [bf.Gravity((0, -9.81))], **others)


def pendulum(element):
    return hanging(arm(element))


def damped(element):
    return hanging(arm(element, material=DAMPED))


def on_a_roller(element):
    one = arm(element)
    return hanging(one, supports=[bf.Roller(one.end, (1, 2))])


def hinged(element):
    one, other = arm(element), arm(element, (1, 0), (2, 0))
    return hanging(one, other, joints=[bf.Hinge(one.end, other.start)])


def sprung(element):
    one, other = arm(element), arm(element, (0, 0.5), (1, 0.6))
    damper = bf.SpringDamper(one.end, other.end, 300.0, 2.0)
    return hanging(one, other, supports=[bf.Pin(other.start)], connectors=[damper])


def driven(element):
    one = arm(element)
    moved = bf.Prescribed(one.start, ux=lambda t: 0.1 * np.sin(5.0 * t) ** 2, uy=0.0)
    return one, bf.Model([one], [moved], [bf.Gravity((0, -9.81))])


def longest(model, method):
    motion = bf.simulate(model, DURATION, integrator=method)
    return float(motion.at[1])


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
@mostly_slow("make", [pendulum, damped, on_a_roller, hinged, sprung, driven], quick=(3, 5))
@pytest.mark.parametrize(("method", "order", "accuracy"), METHODS, ids=["central", "order 8"])
def test_order_of_each_method(method, order, accuracy, make, element):
    one, model = make(element)
    least = DURATION / longest(model, method)
    factors = (12.0, 18.0, 24.0) if order == 2 else (2.0, 2.5, 3.0) if make is damped else (1.5, 2.0, 2.5)
    counts = [10 * int(np.ceil(factor * least / 10)) for factor in factors]
    exact = bf.simulate(model, DURATION, DURATION / 1200, bf.DormandPrince(), save_every=120).position(one.end)
    runs = [bf.simulate(model, DURATION, DURATION / n, method, save_every=n // 10) for n in counts]
    errors = [np.max(np.abs(run.position(one.end) - exact)) for run in runs]
    assert [run.statistics.steps for run in runs] == counts
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(order, abs=accuracy)


@pytest.mark.filterwarnings("ignore::beamfem.errors.EnergyWarning")  # of vibrations at the limit
@pytest.mark.parametrize("method", [method for method, *_ in METHODS])
def test_steps_are_as_long_as_the_highest_frequency_allows(method):
    """The limits are 2 / w of central differences, and where |R(i y)| of the polynomial of order 8 exceeds 1."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.1), RUBBER)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    modes = bf.solve_modes(model, model.size - 3)
    highest = 2.0 * np.pi * modes.frequencies[-1]
    limit = {2: 2.0, 8: 6.0}[method.order]
    step = bf.simulate(model, 1.0, integrator=method).at[1]
    assert 0.75 * limit < step * highest < 0.85 * limit
    start = modes.start(len(modes.frequencies) - 1, 1e-6)
    motion = bf.simulate(model, 500 * step, step, method, start=start)
    assert len(motion) == 501
    assert np.max(np.abs(motion.velocity(beam.end))) < 1.1 * np.max(np.abs(motion.velocity(beam.end)[:20]))


@pytest.mark.parametrize("retardation", [2e-3, 5e-3])
def test_steps_of_damped_beams_are_stable(retardation):
    """Central differences begin with p'' of the predicted velocity: at most 1 / d for x'' + d x' = 0, not 2 / d."""
    rubber = bf.Material(5e5, 0.0, 1000.0, retardation_time=retardation)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.1), rubber)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81))])
    motion = bf.simulate(model, 0.2, integrator=bf.CentralDifferences())
    assert motion.statistics.rejected == 0
    damped = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), model.size - 3).frequencies[-1]
    assert 0.4 < motion.at[1] * retardation * (2.0 * np.pi * damped) ** 2 < 1.0


def test_longer_steps_are_divided_and_rows_stay_where_they_are():
    one, model = pendulum(bf.CRBF(2))
    motion = bf.simulate(model, 0.2, 0.05, bf.CentralDifferences())
    np.testing.assert_allclose(motion.at, np.linspace(0.0, 0.2, 5), atol=1e-12)
    assert motion.statistics.steps > 40
    between = bf.simulate(model, 0.2, 0.05, bf.CentralDifferences(), save_at=[0.1, 0.2])
    np.testing.assert_allclose(between.position(one.end), motion.position(one.end)[[2, 4]], atol=1e-12)


def test_central_differences_keep_the_energy_of_a_soft_pendulum():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.ANCF(integration="lobatto"), bf.Rectangle(0.02, 0.1), RUBBER)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81))])
    energy = bf.simulate(model, 5.0, 1e-3, bf.CentralDifferences(), save_every=10).energy()
    assert np.ptp(energy.total) < 2e-3 * np.ptp(energy.kinetic)


def test_a_tolerance_is_followed():
    one, model = hinged(bf.CRBF(2))
    exact = bf.simulate(model, DURATION, 1e-3, bf.DormandPrince()).position(one.end)[-1]
    motion = bf.simulate(model, DURATION, integrator=bf.DormandPrince(), tolerance=1e-7)
    assert np.linalg.norm(motion.position(one.end)[-1] - exact) < 2e-7


@pytest.mark.parametrize("method", [method for method, *_ in METHODS])
def test_models_with_conditions_are_refused(method):
    name = type(method).__name__
    bars = [arm(bf.CRBF(2)), arm(bf.CRBF(2), (1.2, 0), (2, 0))]
    linked = bf.Model(bars, [bf.Pin(bars[0].start)], connectors=[bf.Link(bars[0].end, bars[1].start)])
    with pytest.raises(bf.InputError, match=f"{name} is explicit, and does not satisfy conditions"):
        bf.simulate(linked, 0.1, 1e-3, method)


def test_steps_are_cut_where_a_motion_raises_the_highest_frequency():
    """Soft rubber between a pin and an inclined roller: at the steps of the reference it would gain energy."""
    _, model = on_a_roller(bf.ANCF(integration="lobatto"))
    motion = bf.simulate(model, DURATION, integrator=bf.CentralDifferences())
    energy = motion.energy()
    assert motion.statistics.rejected > 0
    assert np.ptp(energy.total) < 0.02 * np.ptp(energy.kinetic)


@pytest.mark.parametrize("method", [bf.Bathe(), bf.CentralDifferences(), bf.DormandPrince()])
def test_friction_of_a_hinge_is_that_of_short_steps(method):
    one, other = arm(bf.CRBF(2)), arm(bf.CRBF(2), (1, 0), (2, 0))
    hinge, rough = bf.Hinge(one.end, other.start), bf.HingeFriction(one.end, other.start, 0.3, 50.0)
    model = bf.Model([one, other], [bf.Clamp(one.start)], [bf.Gravity((0, -9.81))], joints=[hinge], connectors=[rough])
    known = bf.simulate(model, 0.2, 1e-4, bf.GeneralizedAlpha(1.0))
    motion = bf.simulate(model, 0.2, 1e-3 if method.order > 2 else 2e-4, method)
    np.testing.assert_allclose(motion.position(other.end)[-1], known.position(other.end)[-1], atol=2e-6)
    assert motion.energy().dissipated[-1] == pytest.approx(known.energy().dissipated[-1], rel=5e-3)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
@pytest.mark.parametrize(
    "method", [bf.CentralDifferences(), bf.DormandPrince()], ids=lambda method: type(method).__name__
)
def test_steps_of_a_tolerance_are_stable(method, tolerance):
    """Those of order 8 grew beyond the stable step, and were off by 380 times a tolerance of 1e-6."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(2), bf.Rectangle(0.03, 0.03), bf.Material(5e6, 0.3, 1100.0))
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])
    at = np.linspace(0.0, 0.2, 11)
    motion = bf.simulate(model, 0.2, tolerance=tolerance, integrator=method, save_at=at)
    fine = bf.simulate(model, 0.2, 1e-4, bf.Gauss(4), save_at=at)
    error = np.abs(motion.position(beam.end) - fine.position(beam.end)).max()
    assert error < 2.0 * tolerance
