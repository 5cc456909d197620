"""Section forces against closed forms and against what acts beyond a cut, for every kind of element and of load."""

from itertools import pairwise

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from drawn import EI as DRAWN
from drawn import cantilever
from slow_values import mostly_slow

import beamfem as bf
from beamfem.results.axis_fields import section_forces as along_axis
from beamfem.results.axis_points import AxisPoints
from beamfem.view.deformed_shapes import Shapes

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.01, 0.01)
EI = STEEL.youngs_modulus * SECTION.second_moment
LINE = bf.Line((0, 0), (1, 0))
SMALL = 1e-6 * EI  # leaves a beam straight
KINDS = [
    bf.CRBF(1),
    bf.CRBF(3),
    bf.CRBF(4),
    bf.BilinearCRBF(),
    bf.BilinearANCF(bf.Structural(), "reduced"),
    bf.ANCF(),
    bf.ANCF(bf.ElasticLine()),
    bf.ANCFCRBF(bf.Structural()),
    bf.ANCFCRBF(bf.ElasticLine()),
    bf.ShearRigid(),
    bf.ShearRigid(stretchable=False),
]
each_kind = pytest.mark.parametrize("element", KINDS, ids=identify)


@pytest.mark.parametrize("elements", [2, 3, 4, 9, 10])
@each_kind
def test_three_point_bending_shows_the_moment_under_the_load(element, elements):
    """P L / 4 there and both signs of P / 2; the Gauss points nearest to it had 0.93 of that with 2 of order 4."""
    beam = bf.Beam(LINE, elements, element, SECTION, STEEL)
    load = bf.PointForce(beam.at(0.5), (0, -SMALL))
    forces = bf.solve_static(
        bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end, (0, 1))], [load])
    ).section_forces(beam)
    s = forces.arc_length
    np.testing.assert_allclose(forces.moment[-1], 0.5 * SMALL * np.minimum(s, 1.0 - s), atol=1e-9 * SMALL)
    assert forces.moment[-1].max() == pytest.approx(0.25 * SMALL, rel=1e-9)
    there = np.flatnonzero(np.abs(s - 0.5) < 1e-12)
    assert forces.shear[-1, there[[0, -1]]] == pytest.approx([-0.5 * SMALL, 0.5 * SMALL], rel=1e-9)


@each_kind
def test_a_distributed_load_bends_by_its_parabola(element):
    beam = bf.Beam(LINE, 3, element, SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.DistributedLoad(beam, (0, -SMALL))])
    forces = bf.solve_static(model).section_forces(beam)
    left = 1.0 - forces.arc_length
    np.testing.assert_allclose(forces.shear[-1], -SMALL * left, atol=1e-6 * SMALL)
    np.testing.assert_allclose(forces.moment[-1], -0.5 * SMALL * left**2, atol=1e-6 * SMALL)


@each_kind
def test_a_load_that_grows_along_the_beam_bends_by_its_cubic_inside_elements(element):
    """Moments at Gauss points of two-point elements were those of a moment per length that is linear."""
    beam = bf.Beam(LINE, 2, element, SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.DistributedLoad(beam, lambda s: (0.0, -SMALL * s))])
    forces = bf.solve_static(model).section_forces(beam)
    s = forces.arc_length
    np.testing.assert_allclose(forces.shear[-1], -0.5 * SMALL * (1.0 - s**2), atol=1e-6 * SMALL)
    np.testing.assert_allclose(forces.moment[-1], -SMALL * (2.0 - 3.0 * s + s**3) / 6.0, atol=1e-6 * SMALL)


LAYERS = (bf.Layer(STEEL, 0.004), bf.Layer(bf.Material(5e9, 0.3, 1000.0), 0.02))
COUPLED = {
    "layers": (bf.Layered(LAYERS, 0.02), None),
    "stiffness": (bf.Section.from_stiffness(2e7, 8e6, 170.0, 0.8, 1e-5, coupling=4e4), None),
}


@pytest.mark.parametrize("section", COUPLED)
@each_kind
def test_a_section_with_its_neutral_axis_off_the_axis(element, section):
    """N was off by up to 43 % of the load on cubic elements."""
    own, material = COUPLED[section]
    if element.forces.fills_body and section == "stiffness":
        pytest.skip("continuum forces need a body")
    beam = bf.Beam(LINE, 4, element, own, material)
    small = 1e-6 * own.rigidity(material).bending
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (small, small))])
    forces = bf.solve_static(model).section_forces(beam)
    left = 1.0 - forces.arc_length
    for found, exact in ((forces.normal, small), (forces.shear, small), (forces.moment, small * left)):
        np.testing.assert_allclose(found[-1], exact, atol=1e-5 * small)


SOFT = bf.Material(2e5, 0.3, 10.0)
DEAD, FOLLOWING, WEIGHT = np.array([0.6, -1.1]), np.array([0.4, 1.3]), np.array([1.0, -9.81])
FOUNDATION = np.array([0.7, 1.9])
PULL, PUSH, TURN = np.array([-0.5, 0.8]), np.array([0.6, 0.3]), 0.15  # dead, following, moment
AT_PULL, AT_PUSH, AT_TURN = 0.37, 0.81, 0.44
BENT = bf.Arc((0, 0), 1.0, 0.2, 1.3)


def loaded(element, curve=BENT):
    """A clamped beam under loads of every kind, at nodes and inside elements, on a foundation."""
    beam = bf.Beam(curve, 3, element, bf.Rectangle(0.2, 0.2), SOFT)
    loads = [
        bf.Gravity(tuple(WEIGHT)),
        bf.DistributedLoad(beam, tuple(DEAD)),
        bf.DistributedLoad(beam, tuple(FOLLOWING), follower=True),
        bf.PointForce(beam.at(AT_PULL), tuple(PULL)),
        bf.PointForce(beam.at(AT_PUSH), tuple(PUSH), follower=True),
        bf.PointMoment(beam.at(AT_TURN), TURN),
        bf.PointForce(beam.end, tuple(PULL)),
    ]
    return beam, bf.Model([beam], [bf.Clamp(beam.start), bf.Foundation(beam, tuple(FOUNDATION))], loads)


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def turned(vector, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]], axis=-1)


def beyond(solution, beam, share):
    """Force (2,) and moment about a cut at a share of the beam of all that acts beyond it, from the deformed shape."""
    length = beam.curve.length
    here = solution.position(beam.at(share))[-1]
    mesh = solution.model.meshes[0]
    total, moment = np.zeros(2), 0.0
    ends = [share, *(v / length for v in mesh.vertices if v / length > share + 1e-12)]
    xi, weights = np.polynomial.legendre.leggauss(8)
    mass = SOFT.density * 0.04
    for low, high in pairwise(ends):
        for x, w in zip(xi, weights, strict=True):
            point = beam.at(0.5 * (low + high) + 0.5 * (high - low) * x)
            acts = mass * WEIGHT + DEAD + turned(FOLLOWING, solution.rotation(point)[-1])
            acts = (acts - FOUNDATION * solution.displacement(point)[-1]) * 0.5 * (high - low) * w * length
            total = total + acts
            moment += cross(solution.position(point)[-1] - here, acts)
    for at, value, follows in ((AT_PULL, PULL, False), (AT_PUSH, PUSH, True), (1.0, PULL, False)):
        if at > share:
            acts = turned(value, solution.rotation(beam.at(at))[-1]) if follows else value
            total = total + acts
            moment += cross(solution.position(beam.at(at))[-1] - here, acts)
    return total, moment + (TURN if share < AT_TURN else 0.0)


@pytest.mark.parametrize("element", ELEMENTS, ids=identify)
def test_what_acts_beyond_a_cut_is_carried_by_it(element):
    """On a curved beam, bent far, under loads of every kind; on a straight one exactly, as its length is."""
    beam, model = loaded(element, bf.Line((0, 0), (1, 0.3)))
    solution = bf.solve_static(model)
    forces = solution.section_forces(beam)
    share = forces.arc_length / beam.curve.length
    assert {AT_PULL, AT_PUSH, AT_TURN} < set(share.round(12).tolist())
    slope = element.forces.turns_with == "r_x"
    for i in range(0, len(share), 3):
        # just beside nodes and loads, on the side of the station
        beside = share[i] + (1e-9 if i + 1 < len(share) and share[i + 1] > share[i] + 1e-9 else -1e-9)
        fields = solution.fields(beam.at(share[i]))
        along = fields.r_x[-1] if slope else np.array([fields.r_y[-1, 1], -fields.r_y[-1, 0]])
        along = along / np.linalg.norm(along)
        force, moment = beyond(solution, beam, float(np.clip(beside, 0.0, 1.0)))
        exact = (along @ force, cross(along, force), moment)
        found = [getattr(forces, name)[-1, i] for name in ("normal", "shear", "moment")]
        # the turning of a load that follows is no polynomial, so that quadratures differ
        assert found == pytest.approx(exact, abs=2e-3), share[i]


@pytest.mark.slow
@mostly_slow("element", KINDS, quick=(0, 3, 7, 9), ids=identify)
def test_what_acts_beyond_a_cut_of_a_moving_beam(element):
    """Inertia by differences over neighbouring rows, good to 5e-5: d'Alembert.

    Bending moments at the Gauss points of two-point elements were off by 2e-3 of the weight.
    """
    material = bf.Material(2e6, 0.3, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, bf.Rectangle(0.1, 0.1), material)
    step = 1e-4
    motion = bf.simulate(bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((3.0, -9.81))]), 0.05, step)
    forces, row = motion.section_forces(beam), 400
    mass, rotary = 1000.0 * 0.01, 1000.0 * 0.1**4 / 12.0
    xi, weights = np.polynomial.legendre.leggauss(5)
    size = mass * 9.81
    for i in range(0, len(forces.arc_length), 2):
        share = forces.arc_length[i]
        here, total, moment = motion.position(beam.at(share))[row], np.zeros(2), 0.0
        ends = [share, *(v for v in motion.model.meshes[0].vertices if v > share + 1e-12)]
        for low, high in pairwise(ends):
            for x, w in zip(xi, weights, strict=True):
                point, part = beam.at(0.5 * (low + high) + 0.5 * (high - low) * x), 0.5 * (high - low) * w
                r_y = motion.fields(point).r_y
                rate = motion.velocity(point)
                acts = part * mass * (np.array([3.0, -9.81]) - (rate[row + 1] - rate[row - 1]) / (2.0 * step))
                swing = (r_y[row + 1] - 2.0 * r_y[row] + r_y[row - 1]) / step**2
                total = total + acts
                moment += cross(motion.position(point)[row] - here, acts)
                moment -= part * rotary * cross(r_y[row], swing)
        fields = motion.fields(beam.at(share))
        along = fields.r_x[row] if element.forces.turns_with == "r_x" else turned(fields.r_y[row], -0.5 * np.pi)
        along = along / np.linalg.norm(along)
        found = [getattr(forces, name)[row, i] for name in ("normal", "shear", "moment")]
        assert found == pytest.approx((along @ total, cross(along, total), moment), abs=1e-4 * size)


@pytest.mark.parametrize("joint", [bf.Rigid, bf.Hinge])
def test_the_members_of_a_frame_balance_its_joint(joint):
    """A column and two bars of other elements; the force at the joint is that of the load, the moment that of it."""
    common = {"section": SECTION, "material": STEEL}
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 2, bf.CRBF(3), **common)
    left = bf.Beam(bf.Line((0, 1), (-1, 1)), 3, bf.ANCFCRBF(bf.Structural()), **common)
    right = bf.Beam(bf.Line((0, 1), (1, 1.5)), 2, bf.ANCF(bf.ElasticLine()), **common)
    load, turn = np.array([0.3, -0.8]) * EI, 0.2 * EI
    solution = bf.solve_static(
        bf.Model(
            [column, left, right],
            [bf.Clamp(column.start), bf.Pin(left.end), bf.Clamp(right.end)],
            [bf.PointForce(column.end, tuple(load)), bf.PointMoment(column.end, turn)],
            [joint(column.end, left.start), joint(column.end, right.start)],
        )
    )
    pulls, moments = [], []
    for beam, place, sign in ((column, -1, -1.0), (left, 0, 1.0), (right, 0, 1.0)):
        forces = solution.section_forces(beam)
        fields = solution.fields(beam.end if place else beam.start)
        along = fields.r_x[-1] if beam is right else turned(fields.r_y[-1], -0.5 * np.pi)
        along = along / np.linalg.norm(along)
        across = np.array([-along[1], along[0]])
        pulls.append(sign * (forces.normal[-1, place] * along + forces.shear[-1, place] * across))
        moments.append(sign * forces.moment[-1, place])
    np.testing.assert_allclose(sum(pulls), -load, atol=1e-7 * EI)
    expected = -turn if joint is bf.Rigid else [-turn, 0.0, 0.0]
    np.testing.assert_allclose(sum(moments) if joint is bf.Rigid else moments, expected, atol=1e-7 * EI)


@each_kind
def test_supports_carry_what_the_section_beside_them_does(element):
    beam = bf.Beam(bf.Arc((0, 0), 1.0, np.pi, 0.5 * np.pi), 4, element, SECTION, STEEL)
    model = bf.Model(
        [beam],
        [bf.Clamp(beam.start), bf.Spring(beam.at(0.5), (50.0 * EI, 20.0 * EI)), bf.Pin(beam.end)],
        [bf.DistributedLoad(beam, (0, -EI))],
    )
    solution = bf.solve_static(model)
    forces = solution.section_forces(beam)
    start, middle = solution.reaction(beam.start)[-1], solution.reaction(beam.at(0.5))[-1]
    assert [forces.normal[-1, 0], forces.shear[-1, 0]] == pytest.approx([-start[1], start[0]], rel=1e-6, abs=1e-6 * EI)
    assert forces.moment[-1, 0] == pytest.approx(-start[2], rel=1e-6, abs=1e-6 * EI)
    there = np.flatnonzero(np.abs(forces.arc_length - 0.25 * np.pi) < 1e-9)[[0, -1]]
    assert np.hypot(*middle[:2]) > 1e-4 * EI
    jump = [np.diff(getattr(forces, name)[-1, there])[0] for name in ("normal", "shear")]
    assert np.hypot(*jump) == pytest.approx(np.hypot(*middle[:2]), rel=1e-5)
    assert np.diff(forces.moment[-1, there])[0] == pytest.approx(0.0, abs=1e-6 * EI)


@each_kind
def test_pictures_and_files_have_the_moments_at_the_ends_of_elements(element):
    """The clamp's moment and the free end's, which a polynomial through Gauss points missed: 379 for 518.7 N m."""
    solution = cantilever(2.0, 3, element)
    beam = solution.model.beams[0]
    drawn = Shapes(solution, np.array([1]), "moment").values[0][0]
    forces = solution.section_forces(beam)
    assert drawn[0] == pytest.approx(forces.moment[-1, 0], rel=1e-9)
    assert drawn[0] == pytest.approx(-solution.reaction(beam.start)[-1, 2], rel=1e-6)
    assert drawn[-1] == pytest.approx(0.0, abs=1e-6 * DRAWN)
    points = AxisPoints.spaced(solution.model.meshes[0], 4)
    found = along_axis(points, solution, slice(None))["shear"][-1]
    np.testing.assert_allclose(found[[0, -1]], forces.shear[-1, [0, -1]], atol=1e-9 * DRAWN)


def test_rows_do_not_know_of_each_other():
    beam, model = loaded(bf.CRBF(2))
    solution = bf.solve_static(model, steps=4)
    whole, last = solution.section_forces(beam), solution[3:].section_forces(beam)
    np.testing.assert_allclose(whole.moment[3:], last.moment, rtol=1e-12)


def test_a_mode_about_a_loaded_state_carries_the_loads_of_that_state():
    """At rest in its mode, a mode's section forces are those of the state that it moves about; another factor jumps."""
    steel = bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(3), bf.Rectangle(0.02, 0.01), steel)
    load = bf.DistributedLoad(beam, (0.0, -40.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [load, bf.PointForce(beam.at(0.5), (0.0, -20.0))])
    for row in (0, 1):
        state = bf.solve_static(model)[row]
        expected = bf.solve_static(model).section_forces(beam).moment[row]
        found = bf.solve_modes(model, 1, about=state).solution(0, amplitude=1e-9).section_forces(beam).moment
        assert np.abs(found - expected).max() < 1e-4 + 1e-6 * np.abs(expected).max()
