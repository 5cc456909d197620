"""Gauss, Radau and Bathe's methods: their orders, what they keep, and stiff motions at steps without resolution."""

import itertools
import warnings
from dataclasses import replace

import numpy as np
import pytest
from history_laws import SECTION as STIFFNESSES
from history_laws import Creeping
from own_bushing import Mount
from slow_values import mostly_slow

import beamfem as bf

RUBBER = bf.Material(5e5, 0.0, 1000.0)
DAMPED = bf.Material(5e5, 0.0, 1000.0, retardation_time=2e-3)
DEEP = bf.Rectangle(0.02, 0.1)
STEPS = (4e-3, 2e-3, 1e-3)
GAUSS = [(bf.Gauss(stages), 2 * stages) for stages in (1, 2, 3)]
RADAU = [(bf.Radau(stages), 2 * stages - 1) for stages in (1, 2, 3)]
BATHE = (bf.Bathe(), 2)
ids = {"ids": lambda item: f"{type(item).__name__}-{item.stages}" if hasattr(item, "stages") else None}


def bump(time):
    """A smooth start: what begins at once excites vibrations that no step resolves."""
    return float(np.sin(40.0 * time) ** 8)


def beam(element, start=(0, 0), end=(1, 0), material=RUBBER):
    return bf.Beam(bf.Line(start, end), 1, element, DEEP, material)


def pushed(*beams, joints=(), connectors=(), supports=None):
    supports = supports or [bf.Clamp(each.start) for each in beams]
    load = bf.PointForce(beams[0].end, (0.0, -60.0), amplitude=bump)
    return beams[0], bf.Model(list(beams), supports, [load], joints=list(joints), connectors=list(connectors))


def on_a_roller(element):
    one = beam(element)
    loads = [bf.PointMoment(one.end, 3.0, amplitude=bump), bf.PointForce(one.end, (0.0, -60.0), amplitude=bump)]
    return one, bf.Model([one], [bf.Pin(one.start), bf.Roller(one.end, (1, 2))], loads)


def driven(element):
    one = beam(element)
    turning = bf.Prescribed(one.start, ux=0.0, uy=0.0, rotation=lambda t: 0.5 * np.sin(20 * t) ** 8)
    return one, bf.Model([one], [turning])


def hinged(element):
    one, other = beam(element), beam(element, (1, 0), (2, 0))
    supports = [bf.Clamp(one.start), bf.Pin(other.end)]
    return pushed(one, other, joints=[bf.Hinge(one.end, other.start)], supports=supports)


def linked(element):
    one, other = beam(element), beam(element, (0, 0.5), (1, 0.6))
    return pushed(one, other, connectors=[bf.Link(one.end, other.end)])


def linked_twice(element):
    one, other = beam(element), beam(element, (0, 0.5), (1, 0.6))
    return pushed(one, other, connectors=[bf.Link(one.end, other.end), bf.Link(one.at(0.5), other.at(0.5))])


def motored(element):
    one, other = beam(element), beam(element, (1, 0), (2, 0.3))
    hinge = bf.Hinge(one.end, other.start)
    motor = bf.Motor(hinge, angle=lambda t: 0.5 * np.sin(20 * t) ** 8)
    return one, bf.Model([one, other], [bf.Clamp(one.start)], [motor], joints=[hinge])


def sprung(element):
    one, other = beam(element), beam(element, (0, 0.5), (1, 0.6))
    return pushed(one, other, connectors=[bf.SpringDamper(one.end, other.end, 300.0, 2.0)])


def errors(one, model, integrator):
    exact = bf.simulate(model, 0.04, 2.5e-4, integrator=bf.Radau(5)).position(one.end)[-1]
    steps = np.divide(STEPS, 8.0) if integrator == bf.Bathe() else STEPS
    motions = (bf.simulate(model, 0.04, step, integrator=integrator) for step in steps)
    return np.array([np.linalg.norm(motion.position(one.end)[-1] - exact) for motion in motions])


def order(found):
    return float(np.log2(found[0] / found[-1]) / (len(found) - 1))


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF(integration="lobatto")], ids=lambda element: element.name)
@pytest.mark.parametrize(("integrator", "expected"), [*GAUSS, *RADAU, BATHE], **ids)
def test_order_of_each_method(integrator, expected, element):
    assert order(errors(*pushed(beam(element)), integrator)) == pytest.approx(expected, abs=0.25)


@pytest.mark.parametrize("make", [on_a_roller, hinged, linked, sprung])
@pytest.mark.parametrize(("integrator", "expected"), [GAUSS[1], RADAU[1], RADAU[2], BATHE], **ids)
def test_order_with_rollers_hinges_conditions_and_dampers(integrator, expected, make):
    assert order(errors(*make(bf.CRBF(2)), integrator)) == pytest.approx(expected, abs=0.25)


@pytest.mark.parametrize(("integrator", "expected"), [GAUSS[1], RADAU[1], RADAU[2], BATHE], **ids)
def test_order_with_a_damped_material(integrator, expected):
    assert order(errors(*pushed(beam(bf.CRBF(2), material=DAMPED)), integrator)) == pytest.approx(expected, abs=0.25)


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF(integration="lobatto")], ids=lambda element: element.name)
@pytest.mark.parametrize(("integrator", "expected"), [*GAUSS, *RADAU[1:], BATHE], **ids)
def test_order_with_moved_supports_of_positions_and_reactions(integrator, expected, element):
    one, model = driven(element)
    steps = np.multiply(STEPS, 1.5 if integrator.order > 5 else 1.0)  # to stay above round-off
    exact = bf.simulate(model, 0.12, 2.5e-4, integrator=bf.Radau(5), save_every=round(steps[0] / 2.5e-4))
    motions = [bf.simulate(model, 0.12, step, integrator, save_every=round(steps[0] / step)) for step in steps]
    for result, at in ((bf.Solution.position, one.end), (bf.Solution.reaction, one.start)):
        found = [np.max(np.abs(result(motion, at) - result(exact, at))[:-1]) for motion in motions]
        assert order(found) == pytest.approx(expected, abs=0.35)


@mostly_slow(
    ("make", "integrator", "expected"),
    [
        *((linked_twice, each, (order,) * 3) for each, order in (*GAUSS, *RADAU[1:], BATHE)),
        *((motored, each, (order,) * 3) for each, order in (*GAUSS, *RADAU[1:], BATHE)),
        (motored, bf.Gauss(4), (8, 8)),  # its forces are exact to round-off
    ],
    quick=(3, 4, 5, 9, 10, 11, 12),
)
def test_orders_of_positions_velocities_and_multipliers(make, integrator, expected):
    one, model = make(bf.CRBF(2))
    conditions = (*model.connectors, *model.loads)[0]
    fast = make is motored and integrator.order > 5
    steps = (6e-3, 3e-3) if integrator.order == 8 else np.multiply(STEPS, 2.0) if fast else STEPS
    exact = bf.simulate(model, 0.12, 2.5e-4, integrator=bf.Radau(5), save_every=round(steps[0] / 2.5e-4))
    motions = [bf.simulate(model, 0.12, step, integrator, save_every=round(steps[0] / step)) for step in steps]
    results = ((bf.Solution.position, one.end), (bf.Solution.velocity, one.end), (bf.Solution.joint_force, conditions))
    for (result, of), wanted in zip(results, expected, strict=False):
        reference = np.asarray(result(exact, of))
        found = [np.abs(np.asarray(result(motion, of)) - reference).max() for motion in motions]
        assert order(found) == pytest.approx(wanted, abs=0.35)


class Failing(Mount):
    def force(self, at):
        if np.abs(at.v).max() > 0.5:
            raise ZeroDivisionError("too fast")
        return super().force(at)


def mounted(kind):
    one, other = beam(bf.CRBF(2)), beam(bf.CRBF(2), (1, 0), (2, 0))
    mount = kind(one.end, other.start, (300.0, 300.0, 5.0), (1.0, 1.0, 0.1))
    return pushed(one, other, connectors=[mount], supports=[bf.Clamp(one.start), bf.Pin(other.end)])


@pytest.mark.parametrize("integrator", [bf.Gauss(2), bf.Radau(3), bf.Bathe()], **ids)
def test_connectors_in_python_take_the_steps_of_compiled_ones_and_raise_their_errors(integrator):
    tips = []
    for kind in (Mount, bf.Bushing):
        one, model = mounted(kind)
        tips.append(bf.simulate(model, 0.04, 2e-3, integrator=integrator).position(one.end))
    np.testing.assert_allclose(*tips, atol=1e-10)
    with pytest.raises(bf.InputError, match="ZeroDivisionError: too fast") as raised:
        bf.simulate(mounted(Failing)[1], 0.04, 2e-3, integrator=integrator)
    assert len(raised.value.solution) > 1


@pytest.mark.parametrize("make", [on_a_roller, hinged, sprung])
@pytest.mark.parametrize("integrator", [bf.Gauss(2), bf.Radau(3), bf.Bathe()], **ids)
def test_sparse_tangents_take_the_steps_of_bands(monkeypatch, integrator, make):
    one, model = make(bf.CRBF(2))
    band = bf.simulate(model, 0.04, 2e-3, integrator=integrator).position(one.end)
    monkeypatch.setattr("beamfem.equations.equation_numbering._WIDEST_BAND", -1)
    sparse = bf.simulate(replace(model), 0.04, 2e-3, integrator=integrator).position(one.end)
    np.testing.assert_allclose(sparse, band, atol=1e-10)


def test_gauss_is_symmetric_in_time_and_keeps_the_energy_of_a_soft_pendulum():
    arm = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), DEEP, RUBBER)
    model = bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0.0, -9.81))])
    motion = bf.simulate(model, 0.5, 5e-3, integrator=bf.Gauss(3))
    energy = motion.energy()
    assert np.ptp(energy.total) < 1e-5 * np.ptp(energy.kinetic)
    last = motion[-1:]
    turned = bf.State(last.p[-1], -last.v[-1], last.a[-1], 0.0, model)
    back = bf.simulate(model, 0.5, 5e-3, integrator=bf.Gauss(3), start=turned)
    np.testing.assert_allclose(back.position(arm.end)[-1], motion.position(arm.end)[0], atol=1e-7)


@pytest.mark.filterwarnings("ignore:accelerations in the rows:beamfem.TimeStepWarning")
def test_gauss_refuses_steps_that_gain_energy_where_they_do_not_resolve_vibrations():
    """A step that converges to another solution has 1e7 times the energy of the fall."""
    square, steel = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
    plank = bf.Beam(bf.Line((0, 0), (1, -0.5)), 4, bf.CRBF(4), square, steel)
    rod = bf.Beam(bf.Line((0.1, -0.05), (0.1, 0.05)), 1, bf.CRBF(2), square, steel)
    clamped, fall = [bf.Clamp(plank.start), bf.Clamp(plank.end)], [bf.Gravity((0, -9.81))]
    for stiffness, duration in ((1e6, 0.05), (1e5, 0.1)):
        spring = bf.SpringDamper(plank.end, rod.start, stiffness)
        model = bf.Model([plank, rod], clamped, fall, connectors=[spring], masses=[bf.PointMass(rod.start, 1.0)])
        energy = bf.simulate(model, duration, 2e-3, bf.Gauss(2)).energy()
        assert np.ptp(energy.total) < 0.02 * np.ptp(energy.potential)


def test_accelerations_and_reactions_satisfy_the_equations_at_the_ends_of_gauss_steps():
    one, model = pushed(beam(bf.CRBF(2)))
    coarse, fine = (bf.simulate(model, 0.04, step, integrator=bf.Gauss(3)) for step in (2e-3, 5e-4))
    np.testing.assert_allclose(coarse.reaction(one.start)[-1], fine.reaction(one.start)[-1], rtol=1e-6, atol=1e-6)


def double_pendulum(element):
    strips, aluminium = bf.Rectangle(0.02, 0.005), bf.Material(7e10, 0.3, 2700.0)
    upper, lower = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 4, element, strips, aluminium) for x in (0.0, 0.5))
    hinge = bf.Hinge(upper.end, lower.start)
    return bf.Model([upper, lower], [bf.Pin(upper.start)], [bf.Gravity((0, -9.81))], joints=[hinge]), 5e-3, None


def released_strip(element):
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 8, element, bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0))
    stiffness = 2.1e11 * 0.02 * 0.002**3 / 12
    bent = bf.solve_static(bf.Model([strip], [bf.Clamp(strip.start)], [bf.PointForce(strip.end, (0, 3 * stiffness))]))
    return bf.Model([strip], [bf.Clamp(strip.start)]), 5e-3, bent


def four_bar(element):
    places = [(0, 0), (0.5, 1), (1.7, 1.2), (1.5, 0)]
    section = bf.Section.from_stiffness(axial=1e6, shear=4e5, bending=50.0, mass=1.0, rotary_inertia=1e-3)
    bars = [bf.Beam(bf.Line(*ends), 4, element, section) for ends in itertools.pairwise(places)]
    hinges = [bf.Hinge(one.end, other.start) for one, other in itertools.pairwise(bars)]
    supports = [bf.Pin(bars[0].start), bf.Pin(bars[-1].end)]
    return bf.Model(bars, supports, [bf.Gravity((0, -9.81))], joints=hinges), 4e-3, None


ELEMENTS = [bf.CRBF(1), bf.CRBF(2), bf.CRBF(3), bf.ANCF(bf.Structural()), bf.ANCFCRBF(bf.Structural()), bf.ShearRigid()]


@mostly_slow("element", ELEMENTS, quick=(1, 4), ids=lambda element: element.name)
@pytest.mark.parametrize("make", [double_pendulum, released_strip, four_bar])
@pytest.mark.parametrize("integrator", [bf.Radau(3), bf.Bathe()], **ids)
def test_stable_methods_go_on_where_steps_resolve_no_vibration_and_never_gain_energy(integrator, make, element):
    model, step, start = make(element)
    motion = bf.simulate(model, 40 * step, step, integrator=integrator, start=start)
    energy = motion.energy()
    assert len(motion) == 41
    assert np.max(energy.total - energy.total[0]) < 1e-6 * np.ptp(energy.kinetic)
    assert np.min(energy.total - energy.total[0]) > -0.01 * np.ptp(energy.kinetic)


@pytest.mark.slow
def test_history_is_committed_once_a_step():
    law = Creeping(**STIFFNESSES, relaxation=0.3)
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), law)
    load = bf.PointMoment(rod.end, 20.0, amplitude=lambda t: float(np.sin(10.0 * t) ** 4))
    model = bf.Model([rod], [bf.Clamp(rod.start)], [load])
    known = bf.simulate(model, 0.2, 2e-4, integrator=bf.GeneralizedAlpha(0.5))
    for integrator in (bf.Radau(2), bf.Bathe(), bf.CentralDifferences()):
        own = bf.simulate(model, 0.2, 2e-4, integrator=integrator)
        np.testing.assert_allclose(own.rotation(rod.end)[-1], known.rotation(rod.end)[-1], rtol=2e-3)


@pytest.mark.parametrize(("make", "message"), [(bf.Gauss, "Gauss"), (bf.Radau, "Radau")])
def test_number_of_stages_is_checked(make, message):
    for stages in (0, 9, 1.5):
        with pytest.raises(bf.InputError, match=f"stages of {message}"):
            make(stages)


def test_vibrations_decay_as_by_the_recursion_of_bathe():
    """R(z) of his method at z = i w h, from the trapezoidal rule and the backward difference formula."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    modes = bf.solve_modes(bf.Model([one], [bf.Clamp(one.start)]), 1)
    step = 0.15 / modes.frequencies[0]
    z = 2j * np.pi * 0.15
    half = (1.0 + z / 4.0) / (1.0 - z / 4.0)
    factor = (4.0 * half - 1.0) / (3.0 - z)
    motion = bf.simulate(modes.model, 12 * step, step, bf.Bathe(), start=modes.start(0, 1e-7))
    found = motion.displacement(one.end)[:, 1]
    assert found / found[0] == pytest.approx((factor ** np.arange(13)).real, abs=1e-5)
    assert 1.0 - abs((4.0 * (1 + 1e-2j / 4) / (1 - 1e-2j / 4) - 1) / (3 - 1e-2j)) ** 2 == pytest.approx(
        bf.Bathe().removed * 1e-8, rel=1e-2
    )


@pytest.mark.parametrize(
    ("method", "step", "warns"),
    [(bf.Midpoint(), 4e-3, True), (bf.Gauss(2), 4e-3, True), (bf.Gauss(3), 1e-3, False), (bf.Radau(2), 4e-3, False)],
    ids=repr,
)
def test_forces_of_vibrations_that_gauss_does_not_damp_are_named(method, step, warns, tmp_path):
    """A falling steel bar pulls its pin with 77 N; rows of the midpoint rule had 4.8 kN in silence."""
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([bar], [bf.Pin(bar.start)], [bf.Gravity((0.0, -9.81))])
    for file in (None, tmp_path / "motion.h5"):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            motion = bf.simulate(model, 0.6, step, method, file=file)
        named = [str(each.message) for each in caught if each.category is bf.TimeStepWarning]
        assert [sentence.endswith("Use Radau, or smaller steps") for sentence in named] == [True] * warns
        assert motion.statistics.warnings == tuple(named)
        weight = 7800.0 * 4e-4 * 9.81
        most = np.linalg.norm(motion.reaction(bar.start)[:, :2], axis=1).max()
        assert (most > 4.0 * weight) == warns  # 2.5 times the weight, 77 N, at the bottom


def test_rows_between_steps_of_gauss_do_not_follow_vibrations_that_it_does_not_resolve():
    """A bar that its support carries and turns: rows between steps were off by 2 cm, and had 740 N for 0.14 N."""
    bar = bf.Beam(bf.Line((0, 0), (0.3, 0)), 3, bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(2e8, 0.3, 1000.0))
    model = bf.Model([bar], [bf.Prescribed(bar.start, vx=0.0, vy=1.0, angular=2.0)])
    at, start = np.linspace(0.01, 0.2, 20), bf.RigidVelocity((0.0, 1.0), angular=2.0)
    motion = bf.simulate(model, 0.2, integrator=bf.Gauss(2), velocity=start, tolerance=1e-4, save_at=at)
    exact = np.stack([0.3 * np.cos(2.0 * at), at + 0.3 * np.sin(2.0 * at)], axis=1)
    np.testing.assert_allclose(motion.position(bar.end), exact, atol=5e-5)
    pull = 1000.0 * 4e-4 * 0.3 * 0.15 * 2.0**2
    assert np.linalg.norm(motion.reaction(bar.start)[:, :2], axis=1).max() < 10.0 * pull
