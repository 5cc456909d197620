"""Sections with laws of their own: a linear one in disguise changes nothing, others bend as they do by hand."""

from dataclasses import dataclass

import numpy as np
import pytest
from section_laws import LinearLaw, RambergOsgood, Softening

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import system_of
from beamfem.section import StiffnessSection
from beamfem.testing import check_law

SECTION = {"axial": 1e6, "shear": 4e5, "bending": 100.0, "mass": 1.0, "rotary_inertia": 1e-4}
COUPLED = {**SECTION, "coupling": 3000.0}
PAIRS = [(StiffnessSection(**values), LinearLaw(**values)) for values in (SECTION, COUPLED)]
ORDERS = (1, 2, 3, 5)


def arm(section, order=2, elements=4, force=(0.0, 300.0), moment=0.0):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order=order), section)
    loads = [bf.PointForce(beam.end, force), bf.PointMoment(beam.end, moment)]
    return beam, bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=loads)


def portal(section):
    """A frame of straight and curved beams with a hinge, whose matrix is sparse."""
    left = bf.Beam(bf.Line((0, 0), (0, 1)), 3, bf.CRBF(order=2), section)
    arch = bf.Beam(bf.Arc((1, 1), 1.0, np.pi, 0.0), 6, bf.CRBF(order=2), section)
    right = bf.Beam(bf.Line((2, 1), (2, 0)), 3, bf.CRBF(order=2), StiffnessSection(**SECTION))
    supports = [bf.Clamp(left.start), bf.Clamp(right.end)]
    joints = [bf.Rigid(left.end, arch.start), bf.Hinge(arch.end, right.start)]
    loads = [bf.PointForce(arch.at(0.4), (20.0, -80.0)), bf.Pressure(left, 30.0)]
    return arch.at(0.5), bf.Model([left, arch, right], supports, loads, joints)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(("plain", "disguised"), PAIRS, ids=["plain", "coupled"])
def test_a_linear_law_changes_no_state(plain, disguised, order):
    (beam, model), (same, other) = arm(plain, order), arm(disguised, order)
    expected, found = bf.solve_static(model), bf.solve_static(other)
    assert len(found) == len(expected)
    assert found.displacement(same.end) == pytest.approx(expected.displacement(beam.end), rel=1e-10, abs=1e-12)
    assert found.energy().total == pytest.approx(expected.energy().total, rel=1e-10)
    own, its = (one.section_forces(of) for one, of in ((found, same), (expected, beam)))
    assert own.moment == pytest.approx(its.moment, rel=1e-8, abs=1e-7)
    assert own.normal == pytest.approx(its.normal, rel=1e-8, abs=1e-7)


@pytest.mark.parametrize(("plain", "disguised"), PAIRS, ids=["plain", "coupled"])
def test_a_linear_law_changes_no_frame(plain, disguised):
    (point, model), (same, other) = portal(plain), portal(disguised)
    expected, found = bf.solve_static(model), bf.solve_static(other)
    assert found.displacement(same)[-1] == pytest.approx(expected.displacement(point)[-1], rel=1e-9)
    about = [bf.solve_modes(one, count=5, about=at).frequencies for one, at in ((model, expected), (other, found))]
    assert about[1] == pytest.approx(about[0], rel=1e-9)


def test_a_linear_law_changes_no_buckling_load_mode_or_motion():
    found = []
    for section in PAIRS[0]:
        _beam, model = arm(section, force=(-1.0, 0.0))
        buckling = bf.solve_buckling(model, count=2).load_factors
        motion = bf.simulate(arm(section, force=(0.0, 100.0))[1], duration=0.02, step=5e-4)
        tip = motion.displacement(motion.model.beams[0].end)
        path = bf.trace_equilibrium(model, until=1.2 * buckling[0])
        found.append(np.concatenate([buckling, bf.solve_modes(model, count=4).frequencies, tip[-1], path.p[-1]]))
    assert found[1] == pytest.approx(found[0], rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("slenderness", [1e2, 1e4, 1e5])
def test_a_linear_law_changes_no_mode_of_a_slender_beam(slenderness):
    """Their tangents have stress resultants as unknowns."""
    found = []
    for kind in (StiffnessSection, LinearLaw):
        thin = dict(SECTION, axial=100.0 * slenderness**2, shear=40.0 * slenderness**2, rotary_inertia=slenderness**-2)
        _, model = arm(kind(**thin), order=3, force=(0.0, 200.0))
        bent = bf.solve_static(model)
        found.append(bf.solve_modes(model, count=4, about=bent).frequencies)
    assert found[1] == pytest.approx(found[0], rel=1e-6)


@pytest.mark.parametrize("order", ORDERS)
def test_a_law_under_a_moment_bends_to_the_curvature_of_the_law(order):
    """The curvature is the same everywhere, so that the tip turns by curvature times length: no mesh, no element."""
    section = RambergOsgood(**SECTION, knee=100.0)
    _, model = arm(section, order, elements=8, force=(0.0, 0.0), moment=90.0)
    beam = model.beams[0]
    solution = bf.solve_static(model)
    error = abs(solution.rotation(beam.end)[-1] / section.curvature(90.0) - 1.0)
    assert error < (3e-2 if order == 1 else 1e-4)
    assert solution.section_forces(beam).moment[-1] == pytest.approx(90.0, rel=1e-9)
    # what the moment did along the way: the integral of M over the curvature
    curvature = section.curvature(90.0)
    work = section.energy(np.array([[0.0, 0.0, curvature]]), None)[0]
    assert solution.energy().strain[-1] == pytest.approx(work, rel=4e-2 if order == 1 else 1e-4)


def test_a_law_under_a_small_force_sags_as_by_virtual_work():
    """delta = P L^3 / (3 E I) + P L / (k_s G A) + knee / E I (P / knee)^n L^(n + 2) / (n + 2)."""
    section, force = RambergOsgood(**SECTION, knee=0.05, exponent=3), 0.08
    _, model = arm(section, order=3, elements=16, force=(0.0, force))
    tip = bf.solve_static(model).displacement(model.beams[0].end)[-1, 1]
    stiff = force / (3.0 * section.bending) + force / section.shear
    yielded = section.knee / section.bending * (force / section.knee) ** 3 / 5.0
    assert tip == pytest.approx(stiff + yielded, rel=3e-5)


def test_a_column_buckles_by_the_tangent_of_its_law():
    """Compressed to where N gives way, a pinned column keeps its bending stiffness: P l^2 = pi^2 E I.

    l: length as it is compressed; Engesser's correction for shear.
    """
    section = Softening(**SECTION, limit=1500.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(order=3), section)
    supports = [bf.Pin(beam.start), bf.Roller(beam.end)]
    model = bf.Model([beam], supports=supports, loads=[bf.PointForce(beam.end, (-1.0, 0.0))])
    path = bf.trace_equilibrium(model, until=1400.0)
    found = path.bifurcations[0].load_factor
    stretch = np.arctanh(-found / section.limit) * section.limit / section.axial
    # of a shear-deformable column along its deformed axis: P (1 + e + P / k_s G A) l^2 = pi^2 E I
    by_hand = np.pi**2 * section.bending / (1.0 + stretch + found / section.shear)
    assert found == pytest.approx(by_hand, rel=1e-6)


def test_the_tangent_of_a_law_is_the_derivative_of_its_forces(rng):
    section = RambergOsgood(**SECTION, knee=20.0)
    _, model = arm(section, order=3)
    system = system_of(model, static=True)
    p = system.reference + 0.05 * rng.standard_normal(model.size)
    zeros = np.zeros(model.size)
    _, tangent = linearise(system, p, zeros, zeros, 1.0, STATICS)
    matrix = tangent.sparse((np.empty(0, dtype=int), np.empty((0, 2)))).toarray()
    free, h = system.free_dofs, 1e-6
    for column, dof in enumerate(free):
        step = np.zeros(model.size)
        step[dof] = h
        ahead, behind = (residual(system, p + sign * step, zeros, zeros, 1.0)[free] for sign in (1, -1))
        slope = (ahead - behind) / (2 * h)
        assert matrix[:, column] == pytest.approx(slope, rel=1e-6, abs=1e-6 * np.abs(matrix).max())


def test_a_motion_of_a_softening_beam_keeps_its_energy():
    section = RambergOsgood(**SECTION, knee=20.0, exponent=3)
    beam, model = arm(section, order=2, force=(0.0, 0.0))
    bent = bf.solve_static(arm(section, order=2, force=(0.0, 60.0))[1])
    free = bf.simulate(model, duration=0.05, step=1e-4, start=bent[-1], integrator=bf.GeneralizedAlpha(1.0))
    energy = free.energy().total
    assert abs(free.displacement(beam.end)[:, 1]).max() > 0.1
    assert np.ptp(energy) < 1e-3 * energy.max()


def test_paths_reach_what_static_solves_reach():
    section = RambergOsgood(**SECTION, knee=30.0)
    beam, model = arm(section, order=3, force=(10.0, 90.0))
    solved, traced = bf.solve_static(model), bf.trace_equilibrium(model, until=1.0)
    assert traced.displacement(beam.end)[-1] == pytest.approx(solved.displacement(beam.end)[-1], rel=1e-7)


def test_beams_with_and_without_a_law_share_a_model():
    """Two arms in one model bend as each alone: blocks are kept apart by their laws."""
    soft, hard = RambergOsgood(**SECTION, knee=10.0), RambergOsgood(**SECTION, knee=1e4)
    alone = [bf.solve_static(arm(own, force=(0.0, 50.0))[1]) for own in (soft, hard, PAIRS[0][0], soft)]
    beams = [
        bf.Beam(bf.Line((0, y), (1, y)), 4, bf.CRBF(order=2), own)
        for y, own in enumerate((soft, hard, PAIRS[0][0], RambergOsgood(**SECTION, knee=10.0)))
    ]
    loads = [bf.PointForce(beam.end, (0.0, 50.0)) for beam in beams]
    together = bf.solve_static(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], loads))
    for beam, own in zip(beams, alone, strict=True):
        tip = own.displacement(own.model.beams[0].end)[-1]
        assert together.displacement(beam.end)[-1] == pytest.approx(tip, rel=1e-9)


def test_stress_of_a_law_is_unknown():
    solution = bf.solve_static(arm(RambergOsgood(**SECTION, knee=30.0), force=(0.0, 10.0))[1])
    assert np.isnan(solution.fields(solution.model.beams[0].at(0.5)).stress.xx).all()


@dataclass(frozen=True)
class Changed(LinearLaw):
    """A law with a mistake."""

    mistake: str = ""

    def resultants(self, strain, material):
        found = super().resultants(strain, material)
        if self.mistake == "abs":
            return found + 1e3 * np.abs(strain)
        if self.mistake == "prestress":
            return found + 5.0
        if self.mistake == "shape":
            return found[:, :2]
        if self.mistake == "unsymmetric":
            return found + 1e3 * strain[:, ::-1] * np.array([1.0, 0.0, 0.0])
        if self.mistake == "stiffer":
            return 2.0 * found
        if self.mistake == "raises":
            raise ZeroDivisionError("no law")
        return found

    def energy(self, strain, material):
        found = super().energy(strain, material)
        return 1.1 * found if self.mistake == "energy" else found


@pytest.mark.parametrize(
    ("mistake", "said"),
    [
        ("abs", "not analytic"),
        ("prestress", "must be zero at zero strain"),
        ("unsymmetric", "not symmetric"),
        ("stiffer", "stiffness at zero strain"),
        ("energy", "energy of Changed does not belong"),
    ],
)
def test_a_law_with_a_mistake_is_found(mistake, said):
    with pytest.raises(AssertionError, match=said):
        check_law(Changed(**SECTION, mistake=mistake))


@pytest.mark.parametrize(
    ("mistake", "said"), [("shape", "must return numbers of the shape"), ("raises", "resultants of Changed")]
)
def test_a_law_that_returns_no_resultants_is_refused(mistake, said):
    with pytest.raises(bf.InputError, match=said):
        arm(Changed(**SECTION, mistake=mistake))


@pytest.mark.parametrize(
    ("element", "said"),
    [
        (bf.ShearRigid(), "takes some of them at other points or scales them, since its nodes do not shear"),
        (bf.ShearRigid(integration="reduced"), 'integration="reduced" takes some of them at other points'),
        (bf.ShearRigid(stretchable=False), r"use CRBF\(order=3\), ANCF\(Structural\(\)\), ANCFCRBF"),
        (bf.CRBF(order=2, forces=bf.SplitContinuum()), "needs Structural forces"),
        (bf.ANCFCRBF(bf.ElasticLine()), "needs Structural forces"),
    ],
)
def test_elements_that_take_sections_for_linear_are_refused(element, said):
    section = LinearLaw(**SECTION)
    with pytest.raises(bf.InputError, match=said):
        bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, section, bf.Material(1e9, 0.3, 1000.0))


def test_a_tapered_law_is_refused():
    with pytest.raises(bf.InputError, match="the same all along"):
        bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=2), lambda s: LinearLaw(**SECTION))


def test_an_error_in_a_law_ends_a_solve():
    @dataclass(frozen=True)
    class Fragile(LinearLaw):
        def resultants(self, strain, material):
            if np.abs(strain.real).max() > 1.6:
                raise ValueError("torn")
            return super().resultants(strain, material)

    _beam, model = arm(Fragile(**SECTION), force=(0.0, 300.0))
    with pytest.raises(bf.InputError, match="torn"):
        bf.solve_static(model)


def test_results_of_a_law_are_saved_with_its_module(tmp_path):
    solution = bf.solve_static(arm(RambergOsgood(**SECTION, knee=30.0), force=(0.0, 10.0))[1])
    solution.save(tmp_path / "a.h5")
    loaded = bf.load(tmp_path / "a.h5")
    assert loaded.model.beams[0].section == RambergOsgood(**SECTION, knee=30.0)
    assert loaded.energy().strain == pytest.approx(solution.energy().strain, rel=1e-14)


def test_a_motion_does_not_jump_to_another_one():
    """A law that pushes with 1e300 N m beyond a curvature led to a rotation of -650 rad in one step, in silence."""

    @dataclass(frozen=True)
    class Wall(bf.Section):
        def resultants(self, strain, material):
            linear = self.rigidity(material)
            stretch, shear, curvature = strain.T
            moment = np.where(np.abs(curvature.real) > 2.5, 1e300, linear.bending * curvature)
            return np.stack([linear.axial * stretch, linear.shear * shear, moment], axis=-1)

        def energy(self, strain, material):
            linear = self.rigidity(material)
            return 0.5 * strain**2 @ np.array([linear.axial, linear.shear, linear.bending])

    section, material = Wall(area=1e-3, second_moment=1e-7, height=0.05), bf.Material(1e7, 0.3, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(order=2), section, material)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -4.0))])
    with pytest.raises(bf.ConvergenceError) as caught:
        bf.simulate(model, duration=0.5, step=5e-3)
    assert abs(caught.value.solution.rotation(beam.end)).max() < 10.0
