"""Section forces against closed forms and against what acts beyond a cut, for every kind of element and of load."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from drawn import EI as DRAWN
from drawn import cantilever

import beamfem as bf
from beamfem.along import AxisPoints
from beamfem.along import section_forces as along_axis
from beamfem.view.shapes import Shapes

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
    forces = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end, (0, 1))], [load])).section_forces(
        beam
    )
    s = forces.arc_length
    np.testing.assert_allclose(forces.moment[-1], 0.5 * SMALL * np.minimum(s, 1.0 - s), atol=1e-9 * SMALL)
    assert forces.moment[-1].max() == pytest.approx(0.25 * SMALL, rel=1e-9)
    before, behind = np.flatnonzero(np.abs(s - 0.5) < 1e-12)
    assert forces.shear[-1, [before, behind]] == pytest.approx([-0.5 * SMALL, 0.5 * SMALL], rel=1e-9)


@each_kind
def test_a_distributed_load_bends_by_its_parabola(element):
    beam = bf.Beam(LINE, 3, element, SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.DistributedLoad(beam, (0, -SMALL))])
    forces = bf.solve_static(model).section_forces(beam)
    left = 1.0 - forces.arc_length
    np.testing.assert_allclose(forces.shear[-1], -SMALL * left, atol=1e-6 * SMALL)
    np.testing.assert_allclose(forces.moment[-1], -0.5 * SMALL * left**2, atol=1e-6 * SMALL)


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


SOFT = bf.Material(2e5, 0.3, 900.0)
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
    for low, high in zip(ends[:-1], ends[1:], strict=True):
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
