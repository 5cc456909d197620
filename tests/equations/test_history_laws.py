"""Section laws with history: plasticity and creep by hand, and their history through solves, files and slices."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from history_laws import (
    LAWS,
    LIGHT,
    NEVER,
    SECTION,
    YIELDING,
    Creeping,
    Plastic,
    Viscous,
    arm,
    bent_there_and_back,
    ids,
    there_and_back,
)
from section_laws import LinearLaw
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import system_of
from beamfem.section import StiffnessSection
from tests.connectors import Rest


@pytest.mark.parametrize("steps", [5, 15, 60])
def test_plastic_bending_there_and_back_is_that_of_the_closed_form(steps):
    """Curvatures 0.9 + 2, and at no moment those where the back stress has shifted the elastic range of 80 N m."""
    beam, model = bent_there_and_back(YIELDING)
    found = bf.solve_static(model, steps=steps)
    assert len(found) == steps + 1
    curvature = found.rotation(beam.end) / 0.1
    assert curvature[steps // 5 :: 2 * steps // 5] == pytest.approx([2.9, -2.9, 2.9], rel=1e-8)
    if steps > 5:
        assert curvature[2 * steps // 5 :: 2 * steps // 5] == pytest.approx([1.6, -1.6], rel=1e-8)
    moments = found.section_forces(beam).moment
    expected = [90.0 * there_and_back(at) for at in found.at]
    assert moments == pytest.approx(np.tile(expected, (moments.shape[1], 1)).T, rel=1e-9, abs=1e-9)


def test_the_area_of_the_loop_is_what_is_dissipated():
    """Rows where the line between moment and curvature has kinks: at the limit and where the moment turns."""
    beam, model = bent_there_and_back(YIELDING)
    kinks = [0.2 * 40.0 / 90.0, 0.2, 0.2 + 0.2 * 80.0 / 90.0, 0.6, 0.6 + 0.2 * 80.0 / 90.0, 1.0]
    found = bf.solve_static(model, steps=2, at=[0.0, *kinks])
    moment = np.array([90.0 * there_and_back(at) for at in found.at])
    work = np.concatenate([[0.0], np.cumsum(np.diff(found.rotation(beam.end)) * 0.5 * (moment[1:] + moment[:-1]))])
    energy = found.energy()
    assert energy.strain + energy.dissipated == pytest.approx(work, rel=1e-7, abs=1e-12)
    loop = 80.0 * 4.0 * 0.1  # [J]: 2 limits high and 4 /m wide
    assert work[-1] - work[2] == pytest.approx(loop, rel=1e-7)
    assert energy.dissipated[-1] - energy.dissipated[2] == pytest.approx(loop, rel=1e-7)


ELEMENTS = [
    *(bf.CRBF(order) for order in range(1, 9)),
    bf.CRBF(3, integration="full"),
    bf.BilinearCRBF(bf.Structural()),
]


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: f"{element.name}-{element.integration}")
def test_what_grows_alone_depends_on_no_steps(element):
    """On every element that takes a law, from one step to twenty; below the limit it is the linear section."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, YIELDING)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 80.0))])
    tips = [bf.solve_static(model, steps=steps).displacement(beam.end)[-1] for steps in (1, 2, 3, 20)]
    assert np.ptp(tips, axis=0).max() < 1e-10
    beams = [replace(beam, section=section) for section in (NEVER, LinearLaw(**SECTION))]
    linear = [
        bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, (0.0, 80.0))])) for own in beams
    ]
    ends = [found.displacement(own.end)[-1] for found, own in zip(linear, beams, strict=True)]
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)


def test_steps_that_are_cut_leave_nothing_behind():
    """Few iterations make steps fail; the turning points of the load are reached all the same."""
    load = lambda beam: [bf.PointForce(beam.end, (0.0, 100.0), amplitude=there_and_back, scale=False)]  # noqa: E731
    beam, model = arm(YIELDING, load)
    easy, hard = (bf.solve_static(model, steps=10, newton=bf.Newton(iterations=count)) for count in (15, 5))
    assert hard.statistics.cuts > easy.statistics.cuts == 0
    assert hard.displacement(beam.end)[-1] == pytest.approx(easy.displacement(beam.end)[-1], rel=1e-9)
    assert hard.energy().dissipated[-1] == pytest.approx(easy.energy().dissipated[-1], rel=1e-9)


@pytest.mark.parametrize("law", LAWS, **ids)
def test_the_tangent_is_the_derivative_of_the_forces_of_a_step(law, rng):
    _, model = arm(law, lambda beam: [bf.PointForce(beam.end, (0.0, 60.0))], elements=3)
    system = system_of(model, static=True)
    p = bf.solve_static(model)[-1].p
    p = p + 0.03 * rng.standard_normal(len(p)) * (system.scale < 1e200)
    zeros, free, dt, h = np.zeros(len(p)), system.free_dofs, 0.2, 1e-6
    tangent = linearise(system, p, zeros, zeros, 1.0, STATICS, dt=dt)[1].sparse(system.rotated).toarray()
    for column, dof in enumerate(free):
        ends = [
            residual(system, p + side * h * (zeros + np.eye(len(p))[dof]), zeros, zeros, 1.0, dt) for side in (1, -1)
        ]
        slope = (ends[0] - ends[1])[free] / (2 * h)
        assert tangent[:, column] == pytest.approx(slope, rel=1e-6, abs=1e-6 * np.abs(tangent).max())


@pytest.mark.parametrize("steps", [10, 20, 40])
def test_a_creeping_section_under_a_moment_turns_on(steps):
    """M / EI (1 + t / relaxation), exactly with any step: the rate is constant."""
    beam, model = arm(
        Creeping(**LIGHT, relaxation=0.5), lambda beam: [bf.PointMoment(beam.end, 10.0, scale=False)], 2, 4
    )
    motion = bf.simulate(model, 1.0, 1.0 / steps, start=bf.solve_static(model)[-1])
    assert motion.rotation(beam.end) == pytest.approx(0.1 * (1.0 + motion.at / 0.5), rel=2e-5)
    energy = motion.energy()
    assert energy.strain == pytest.approx(np.full(steps + 1, 0.5), rel=1e-4)
    assert energy.dissipated == pytest.approx(10.0 * 0.1 * motion.at / 0.5, rel=1e-4, abs=1e-4)
    assert motion.energy_drift is None


def test_a_creeping_section_that_is_held_relaxes():
    """M0 exp(-t / relaxation), by the backward Euler method M0 / (1 + h / relaxation)^n: of first order."""
    errors = []
    for steps in (10, 20, 40):
        beam, free = arm(Creeping(**LIGHT, relaxation=0.5), order=2, elements=4)
        model = replace(free, supports=[*free.supports, bf.Prescribed(beam.end, rotation=0.1)])
        held = bf.solve_static(model)[-1]
        motion = bf.simulate(replace(model, supports=[*free.supports, _held(beam)]), 1.0, 1.0 / steps, start=held)
        moment = motion.section_forces(beam).moment[:, 0]
        assert moment == pytest.approx(10.0 * (1.0 + 2.0 / steps) ** -np.arange(steps + 1.0), rel=1e-4)
        errors.append(abs(moment[-1] - 10.0 * np.exp(-2.0)))
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([1.0, 1.0], abs=0.15)


def _held(beam):
    return bf.Prescribed(beam.end, rotation=lambda time: 0.1)


def test_a_viscous_section_is_that_of_a_retardation_time():
    """A vibration whose damping the package has as well; backward differences are of first order."""
    force = lambda beam: [bf.PointForce(beam.end, (0.0, 5.0))]  # noqa: E731
    own, damped = arm(StiffnessSection(**SECTION), force, 2, 4, material=bf.Material(1.0, 0.3, 1.0, 0.02))
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        expected = bf.simulate(damped, 0.6, step).displacement(own.end)[:, 1]
        beam, model = arm(Viscous(**SECTION, retardation=0.02), force, 2, 4)
        errors.append(np.abs(bf.simulate(model, 0.6, step).displacement(beam.end)[:, 1] - expected).max())
    assert errors[-1] < 0.02 * expected.max()
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([1.0, 1.0], abs=0.2)


def test_a_motion_with_plastic_bending_keeps_its_energy():
    """What is dissipated is missed by the rest; the trapezoidal rule along the steps is of second order."""
    left = []
    for step in (1e-3, 5e-4):
        _, model = arm(replace(YIELDING, limit=10.0), lambda beam: [bf.PointForce(beam.end, (0.0, 30.0))], 2, 6)
        energy = bf.simulate(model, 0.1, step, integrator=bf.GeneralizedAlpha(1.0)).energy()
        left.append(np.ptp(energy.total + energy.dissipated))
        assert np.all(np.diff(energy.dissipated) >= 0.0)
    assert energy.dissipated[-1] > 1.0
    assert left[1] < 0.5 * left[0] < 2e-3 * energy.dissipated[-1]


def frame(section):
    """A column with a curved and a straight beam behind it, whose matrix is sparse, that is warmed as well."""
    left = bf.Beam(bf.Line((0, 0), (0, 1)), 3, bf.CRBF(order=2), section)
    arch = bf.Beam(bf.Arc((1, 1), 1.0, np.pi, 0.0), 6, bf.CRBF(order=3), section)
    right = bf.Beam(bf.Line((2, 1), (2, 0)), 3, bf.CRBF(order=2), StiffnessSection(**SECTION))
    supports = [bf.Clamp(left.start), bf.Clamp(right.end)]
    loads = [bf.PointForce(arch.at(0.4), (20.0, -80.0)), bf.Actuation(left, stretch=1e-3, curvature=0.1)]
    return arch.at(0.5), bf.Model(
        [left, arch, right], supports, loads, [bf.Rigid(left.end, arch.start), bf.Hinge(arch.end, right.start)]
    )


def test_a_section_that_never_yields_is_the_linear_one():
    """In frames with imposed strains, about a state and in motion, by a band and a sparse matrix."""
    found = []
    for section in (LinearLaw(**SECTION), NEVER):
        point, model = frame(section)
        solution = bf.solve_static(model, steps=2)
        modes = bf.solve_modes(model, count=4, about=solution).frequencies
        swung = bf.simulate(model, 0.01, 1e-3).displacement(point)[-1]
        beam, chain = arm(section, lambda beam: [bf.PointForce(beam.end, (0.0, 50.0))], elements=3)
        tip = bf.simulate(chain, 0.02, 1e-3).displacement(beam.end)[-1]
        found.append(np.concatenate([solution.displacement(point)[-1], modes, swung, tip]))
    assert found[1] == pytest.approx(found[0], rel=1e-7, abs=1e-10)


@pytest.mark.slow
def test_the_work_on_a_frame_that_yields_is_stored_or_dissipated():
    """The trapezoidal rule over the rows is of second order; where it ends depends on no steps."""
    left, ends = [], []
    for steps in (20, 100):
        point, model = frame(replace(YIELDING, limit=15.0))
        load = bf.PointForce(point, (20.0, -80.0), amplitude=there_and_back, scale=False)
        model = replace(model, loads=[load])
        solution = bf.solve_static(model, steps=steps)
        force = np.array([[20.0, -80.0]]) * np.array([[there_and_back(at)] for at in solution.at])
        work = 0.5 * np.sum((force[1:] + force[:-1]) * np.diff(solution.displacement(point), axis=0))
        energy = solution.energy()
        left.append(abs(work - energy.strain[-1] - energy.dissipated[-1]) / energy.dissipated[-1])
        ends.append(solution.displacement(point)[-1])
    assert left[1] < 0.08 * left[0] < 3e-3
    assert ends[1] == pytest.approx(ends[0], rel=1e-9)


@pytest.mark.parametrize("slenderness", [1e4, 1e6])
def test_slender_arms_yield_as_others_do(slenderness):
    """Their tangents may have stress resultants as unknowns, and their load steps are not taken for jumps."""
    stiff = {"axial": 100.0 * slenderness**2, "shear": 40.0 * slenderness**2}
    beam, model = arm(replace(YIELDING, **stiff), lambda beam: [bf.PointForce(beam.end, (0.0, 80.0))])
    solution = bf.solve_static(model, steps=4)
    assert solution.statistics.cuts == 0
    assert solution.displacement(beam.end)[-1] == pytest.approx([-0.11023408, 0.4279426], rel=1e-6)


def test_imposed_strains_do_not_yield():
    """Only what the section is held by does: the plastic curvature is that of the strain from the one imposed."""
    _, model = arm(YIELDING, lambda beam: [bf.Actuation(beam, curvature=5.0)], length=0.1)
    energy = bf.solve_static(model, steps=2).energy()
    assert energy.dissipated[-1] == 0.0
    assert energy.strain[-1] < 1e-12
    held, model = arm(YIELDING, lambda beam: [bf.Actuation(beam, curvature=-1.0)], length=0.1)
    model = replace(model, supports=[*model.supports, bf.Clamp(held.end)])
    solution = bf.solve_static(model, steps=2)
    assert solution.section_forces(held).moment[-1] == pytest.approx((1.0 + 40.0 / 25.0) / (1 / 100 + 1 / 25), rel=1e-8)
    assert solution.energy().dissipated[-1] == pytest.approx(40.0 * (1.0 - 52.0 / 100.0) * 0.1, rel=1e-8)


def test_modes_about_a_state_that_has_yielded_are_those_of_unloading():
    _, model = arm(replace(YIELDING, limit=1e-3), lambda beam: [bf.PointForce(beam.end, (0.0, 3e-3))])
    bent = bf.solve_static(model, steps=3)
    assert bent.energy().dissipated[-1] > 0.0
    about, straight = (bf.solve_modes(model, count=3, about=state).frequencies for state in (bent, None))
    assert about == pytest.approx(straight, rel=1e-6)


@pytest.mark.parametrize("law", LAWS, **ids)
def test_history_is_saved_and_sliced(law, tmp_path):
    beam, model = arm(law, lambda beam: [bf.PointForce(beam.end, (0.0, 90.0))], 2, 4)
    solution = bf.simulate(model, 0.2, 5e-3, save_every=4)
    solution.save(tmp_path / "a.h5")
    loaded = bf.load(tmp_path / "a.h5")
    assert np.array_equal(loaded.p, solution.p)
    assert solution.energy().dissipated[-1] > 0.0
    for other in (loaded, solution[3:], solution[::-1][::-1]):
        own = len(other)
        assert other.energy().dissipated == pytest.approx(solution.energy().dissipated[-own:], rel=1e-14)
        moment = other.section_forces(other.model.beams[0]).moment
        assert moment == pytest.approx(solution.section_forces(beam).moment[-own:], rel=1e-12)
        assert other.reaction(other.model.beams[0].start)[-1, 2] == pytest.approx(-moment[-1, 0], rel=1e-9)


def test_a_motion_goes_on_where_another_one_ended():
    """With the first half's end as its start, in a model of its own with the same beam and section."""
    load = lambda beam: [bf.PointMoment(beam.end, 10.0, scale=False)]  # noqa: E731
    beam, model = arm(Creeping(**LIGHT, relaxation=0.5), load, 2, 4)
    elastic = bf.solve_static(model)[-1]
    half = bf.simulate(model, 0.5, 0.05, start=elastic)[-1]
    for again in (model, replace(model, supports=[bf.Clamp(beam.start)]), arm(model.beams[0].section, load, 2, 4)[1]):
        rest = bf.simulate(again, 0.5, 0.05, start=half)
        assert rest.rotation(again.beams[0].end)[-1] == pytest.approx(0.3, rel=1e-4)
        assert rest.energy().dissipated[-1] == pytest.approx(2.0, rel=1e-4)


def test_a_bent_arm_that_is_let_go_stays_bent():
    """From a static state in which the load has gone again; without loads, nothing moves."""
    there = lambda at: 1.0 - abs(2.0 * at - 1.0)  # noqa: E731
    beam, model = arm(YIELDING, lambda beam: [bf.PointForce(beam.end, (0.0, 80.0), amplitude=there, scale=False)])
    bent = bf.solve_static(model, steps=4)
    tip = bent.displacement(beam.end)[:, 1]
    assert 0.1 * tip[2] < tip[4] < 0.9 * tip[2]
    still = bf.simulate(replace(model, loads=[]), 0.01, 1e-4, start=bent[-1])
    assert still.displacement(beam.end)[:, 1] == pytest.approx(np.full(len(still), tip[4]), rel=1e-9)


def test_connectors_that_remember_may_hold_sections_that_do():
    """An arm drawn to and fro along a rough floor."""
    found = []
    for section in (StiffnessSection(**SECTION), NEVER):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), section)
        push = bf.PointForce(beam.end, (0.0, -5.0), scale=False)
        pull = bf.PointForce(beam.end, (4.0, 0.0), amplitude=there_and_back, scale=False)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [push, pull], connectors=[Rest(beam.end, 1e-9, 1e7, 0.3)])
        solution = bf.solve_static(model, steps=10)
        kept = system_of(model, static=True).connectors.memory
        found.append(np.column_stack([solution.displacement(beam.end)[:, 0], solution.p[:, kept]]))
    assert found[1] == pytest.approx(found[0], rel=1e-7, abs=1e-12)


class Same(Plastic):
    """A law that is compared by what its base knows."""


@mostly_slow("kind", [Plastic, Same])
def test_a_history_that_is_not_continued_is_warned_of(kind):
    def bent(limit):
        section = kind(**SECTION, limit=limit, hardening=30.0)
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), section)
        load = bf.PointForce(beam.end, (0, 12.0), amplitude=lambda at: 1.0)
        return bf.Model([beam], [bf.Clamp(beam.start)], [load])

    bending = bf.solve_static(bent(5.0), 2)
    state, lost = bending[-1], bending.energy().dissipated[-1]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        motion = bf.simulate(bent(5.0), 0.01, 0.001, start=state)
    assert motion.energy().dissipated[0] == pytest.approx(lost)
    assert lost > 0.1
    lost_history = pytest.warns(UserWarning, match=f"what the {kind.__name__} of beam 0 remembers in start is lost")
    with lost_history, pytest.warns(bf.errors.EnergyWarning, match="falls by"):
        bf.simulate(bent(4.0), 0.01, 0.001, start=state)
