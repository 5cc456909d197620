"""Section laws with history on the elements that take them: by hand, by CRBF, and through solves and files."""

from dataclasses import replace

import numpy as np
import pytest
from history_laws import LIGHT, SECTION, YIELDING, Creeping, Viscous, there_and_back
from law_elements import LINE, LOBATTO, NEW, TAKEN, arm, at_tip, ids
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import system_of

every = pytest.mark.parametrize("element", TAKEN, **ids)
new = pytest.mark.parametrize("element", NEW, **ids)
SHORT = bf.Line((0, 0), (0.1, 0))


def cycle(force):
    return lambda beam: [bf.PointForce(beam.end, (0.0, force), amplitude=there_and_back, scale=False)]


@pytest.mark.parametrize(
    ("element", "points"),
    [(bf.ANCF(bf.Structural()), 3), (bf.ANCF(bf.Structural(), "full"), 5), (NEW[1], 3), (NEW[2], 3), (NEW[3], 2)],
    ids=["lobatto", "full", "reduced", "rotation", "order2"],
)
def test_only_points_where_a_law_acts_remember(element, points):
    """Thickness has points of its own, the linear section further ones for curvature: none of them has a history."""
    _, model = arm(YIELDING, element, at_tip(0.0, 0.0, 90.0), elements=16, curve=SHORT)
    (mesh,) = model.meshes
    assert mesh.history.shape == (16, points, 2)
    assert np.array_equal(np.sort(mesh.history.ravel()), np.arange(model.size - 32 * points, model.size))
    bent = bf.solve_static(model, steps=3)
    plastic, dissipated = np.moveaxis(bent.p[-1][mesh.history], -1, 0)
    assert plastic == pytest.approx(np.full((16, points), 2.0), rel=2e-4)
    assert dissipated == pytest.approx(np.full((16, points), 80.0), rel=2e-4)


@every
def test_plastic_bending_there_and_back_is_that_of_the_closed_form(element):
    """Curvatures 0.9 + 2 under 90 N m; the loop dissipates 40 N m over 2 + 4 + 4 /m."""
    load = lambda beam: [bf.PointMoment(beam.end, 90.0, amplitude=there_and_back, scale=False)]  # noqa: E731
    locks = element.field.degree == 1 and element.integration == "full"
    beam, model = arm(YIELDING, element, load, elements=64 if locks else 16, curve=SHORT)
    found = bf.solve_static(model, steps=5)
    tolerance = 0.1 if locks else 2e-4
    assert found.rotation(beam.end)[1::2] / 0.1 == pytest.approx([2.9, -2.9, 2.9], rel=tolerance)
    assert found.energy().dissipated[-1] == pytest.approx(40.0 * (2.0 + 4.0 + 4.0) * 0.1, rel=tolerance)


@mostly_slow("element", NEW, quick=(1,), **ids)
def test_the_work_on_an_arm_that_yields_is_stored_or_dissipated(element):
    """Under a transverse force, by the trapezoidal rule over the rows; where it ends depends on no steps."""
    left, ends = [], []
    for steps in (50, 200):
        beam, model = arm(YIELDING, element, cycle(80.0))
        solution = bf.solve_static(model, steps=steps)
        force = 80.0 * np.array([there_and_back(at) for at in solution.at])
        moved = solution.displacement(beam.end)
        work = 0.5 * np.sum((force[1:] + force[:-1]) * np.diff(moved[:, 1]))
        energy = solution.energy()
        left.append(abs(work - energy.strain[-1] - energy.dissipated[-1]) / energy.dissipated[-1])
        ends.append(moved[-1])
    assert left[1] < 0.1 * left[0] < 2e-4
    assert ends[1] == pytest.approx(ends[0], rel=1e-8)


@new
def test_an_arm_that_yields_under_a_force_is_that_of_other_elements(element):
    tips, lost = [], []
    for own, elements in ((bf.CRBF(order=2), 64), (element, 16), (element, 32)):
        beam, model = arm(YIELDING, own, cycle(80.0), elements)
        solution = bf.solve_static(model, steps=10)
        tips.append(solution.displacement(beam.end)[-1])
        lost.append(solution.energy().dissipated[-1])
    errors = [np.abs(tip - tips[0]).max() for tip in tips[1:]]
    assert errors[1] < 0.5 * errors[0] < 4e-3
    assert lost[2] == pytest.approx(lost[0], rel=5e-4)  # meshes of 32 and 64: 3e-4 at most


@pytest.mark.parametrize("law", [YIELDING, Viscous(**SECTION, retardation=0.3)], ids=lambda law: type(law).__name__)
@every
def test_the_tangent_is_the_derivative_of_the_forces_of_a_step(element, law, rng):
    _, model = arm(law, element, at_tip(0.0, 60.0), elements=2)
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


@pytest.mark.slow
@mostly_slow("element", NEW, quick=(1,), **ids)
def test_a_motion_that_yields_is_that_of_other_elements(element):
    """Displacement and dissipation of CRBF(order=2) on a fine mesh; what is dissipated is missed by the rest."""
    moved, lost = [], []
    for own, elements in ((bf.CRBF(order=2), 32), (element, 16)):
        beam, model = arm(replace(YIELDING, limit=10.0), own, at_tip(0.0, 30.0), elements)
        motion = bf.simulate(model, 0.05, 5e-4, integrator=bf.GeneralizedAlpha(1.0))
        energy = motion.energy()
        assert np.ptp(energy.total + energy.dissipated) < 5e-3 * energy.dissipated[-1]
        assert np.all(np.diff(energy.dissipated) >= -1e-12)
        moved.append(motion.displacement(beam.end)[:, 1])
        lost.append(energy.dissipated[-1])
    assert np.abs(moved[1] - moved[0]).max() < 3e-3 * np.ptp(moved[0])
    assert lost[1] == pytest.approx(lost[0], rel=5e-4)  # meshes of 16 and 32: 3e-4 at most


@new
def test_modes_about_a_state_that_has_yielded_are_those_of_unloading(element):
    _, model = arm(replace(YIELDING, limit=1e-3), element, at_tip(0.0, 3e-3))
    bent = bf.solve_static(model, steps=3)
    assert bent.energy().dissipated[-1] > 0.0
    about, straight = (bf.solve_modes(model, count=3, about=state).frequencies for state in (bent, None))
    assert about == pytest.approx(straight, rel=1e-6)


@new
def test_history_is_saved_sliced_and_continued(element, tmp_path):
    beam, model = arm(YIELDING, element, at_tip(0.0, 90.0))
    motion = bf.simulate(model, 0.2, 5e-3, save_every=4)
    motion.save(tmp_path / "a.h5")
    loaded = bf.load(tmp_path / "a.h5")
    assert np.array_equal(loaded.p, motion.p)
    lost = motion.energy().dissipated
    assert lost[-1] > 0.0
    for other in (loaded, motion[3:]):
        assert other.energy().dissipated == pytest.approx(lost[-len(other) :], rel=1e-14)
        moment = other.section_forces(other.model.beams[0]).moment
        assert moment == pytest.approx(motion.section_forces(beam).moment[-len(other) :], rel=1e-12, abs=1e-9)
    rest = bf.simulate(replace(model, loads=[]), 0.01, 1e-3, start=motion[-1])
    assert rest.energy().dissipated[0] == pytest.approx(lost[-1])
    assert np.isnan(motion.fields(beam.at(0.5)).stress.xx).all()


@new
def test_a_creeping_section_under_a_moment_turns_on(element):
    """M / EI (1 + t / relaxation), exactly with any step: the rate is constant."""
    load = lambda beam: [bf.PointMoment(beam.end, 10.0, scale=False)]  # noqa: E731
    beam, model = arm(Creeping(**LIGHT, relaxation=0.5), element, load)
    motion = bf.simulate(model, 1.0, 0.1, start=bf.solve_static(model)[-1])
    assert motion.rotation(beam.end) == pytest.approx(0.1 * (1.0 + motion.at / 0.5), rel=1e-4)
    assert motion.energy().dissipated == pytest.approx(2.0 * motion.at, rel=1e-5, abs=1e-5)


@new
def test_a_viscous_section_under_a_sudden_moment_creeps(element):
    """1 - exp(-t / retardation), by backward differences; the load sets in with the damping of the law."""
    soft = {"axial": 1e4, "shear": 4e3, "bending": 1.0, "mass": 1e-3, "rotary_inertia": 1e-8}
    beam, model = arm(Viscous(**soft, retardation=0.2), element, lambda beam: [bf.PointMoment(beam.end, 1.0)])
    motion = bf.simulate(model, 0.5, 0.01, integrator=bf.GeneralizedAlpha(0.5))
    assert motion.rotation(beam.end) == pytest.approx(1.0 - np.exp(-motion.at / 0.2), abs=0.3 * 0.01 / 0.2)
    assert motion.energy().kinetic.max() < 5e-3


@new
def test_imposed_strains_do_not_yield(element):
    """Only what the section is held by does: the plastic curvature is that of the strain from the one imposed."""
    _, model = arm(YIELDING, element, lambda beam: [bf.Actuation(beam, stretch=1e-3, curvature=5.0)], curve=SHORT)
    energy = bf.solve_static(model, steps=2).energy()
    assert energy.dissipated[-1] == 0.0
    assert energy.strain[-1] < 1e-5 * (0.5 * 100.0 * 5.0**2 * 0.1)  # if the strain were held
    held, model = arm(YIELDING, element, lambda beam: [bf.Actuation(beam, curvature=-1.0)], curve=SHORT)
    solution = bf.solve_static(replace(model, supports=[*model.supports, bf.Clamp(held.end)]), steps=2)
    assert solution.energy().dissipated[-1] == pytest.approx(40.0 * (1.0 - 52.0 / 100.0) * 0.1, rel=1e-6)


@pytest.mark.parametrize("slenderness", [1e4, 1e6])
@pytest.mark.parametrize("element", [own for own in NEW if own.integration == LOBATTO or own.field.degree == 2], **ids)
def test_slender_arms_yield_as_others_do(element, slenderness):
    """Their tangents may have stress resultants as unknowns; the tip is that of CRBF(order=3)."""
    stiff = replace(YIELDING, axial=100.0 * slenderness**2, shear=40.0 * slenderness**2)
    tips = []
    for own in (bf.CRBF(order=3), element):
        beam, model = arm(stiff, own, at_tip(0.0, 80.0), elements=32)
        tips.append(bf.solve_static(model, steps=4).displacement(beam.end)[-1])
    assert tips[1] == pytest.approx(tips[0], rel=5e-4)  # 32 elements with a linear director: 3e-4


@pytest.mark.slow
def test_elements_of_all_kinds_share_a_model():
    """Arms of all elements in one model yield as each alone: each block has its history and its points."""
    beams = [bf.Beam(bf.Line((0, y), (1, y)), 4, element, YIELDING) for y, element in enumerate(TAKEN)]
    loads = [bf.PointForce(beam.end, (0.0, 70.0)) for beam in beams]
    together = bf.solve_static(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], loads), steps=3)
    for beam, element in zip(beams, TAKEN, strict=True):
        own, model = arm(YIELDING, element, at_tip(0.0, 70.0), curve=LINE)
        alone = bf.solve_static(model, steps=3).displacement(own.end)[-1]
        assert together.displacement(beam.end)[-1] == pytest.approx(alone, rel=1e-6)
