"""Every combination of field, coordinates, forces and integration comes to the limit that its forces promise."""

from itertools import pairwise

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from integrated import Cantilever

import beamfem as bf
from beamfem.equations.equations import residual
from beamfem.equations.model_coordinates import coordinate_columns
from beamfem.equations.system import System
from beamfem.results.postprocess import nodal_vectors
from beamfem.results.solution import Solution, Statistics

STEEL = bf.Material(2e11, 0.3, 7800.0)
THICK = bf.Rectangle(0.1, 0.1)
BENDING = 2e11 * THICK.second_moment
# references, family 1: collocation, 12 digits trusted
TIPS = {
    10: (-0.38922722797924, 0.72054526137677, 1.21246073906392),
    100: (-0.38764432832607, 0.71385896416489, 1.21533917389136),
}


def of_forces(name, keep=lambda element: True):
    chosen = [element for element in ELEMENTS if element.forces.name == name and keep(element)]
    return pytest.mark.parametrize("element", chosen, ids=identify)


@pytest.fixture(params=ELEMENTS, ids=identify)
def element(request):
    """Every integration too."""
    return request.param


def cantilever(element, elements, *loads, section=THICK, supports=()):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, STEEL)
    held = [bf.Clamp(beam.start), *(support(beam) for support in supports)]
    return beam, bf.Model([beam], held, [load(beam) for load in loads])


def tip(element, elements, force, section=THICK):
    """Tip displacement (2,) and rotation under a dead force."""
    beam, model = cantilever(element, elements, lambda b: bf.PointForce(b.end, force), section=section)
    solution = bf.solve_static(model)
    return np.append(solution.displacement(beam.end)[-1], solution.rotation(beam.end)[-1])


def limit(values, order):
    """Richardson extrapolation of values on meshes that are halved, of an error in h^order, h^(order + 2), ..."""
    while len(values) > 1:
        values = [(2**order * fine - coarse) / (2**order - 1) for coarse, fine in pairwise(values)]
        order += 2
    return values[0]


def locked(element):
    """Coordinates without shear on all Gauss points of the cubic: stretch or shear 1.2 times too stiff at any mesh."""
    return element.coordinates.name in ("stretch", "shear-rigid") and element.integration == "full"


@of_forces("structural", lambda element: not locked(element))
def test_structural_forces_come_to_the_reissner_beam(element):
    meshes, order = {1: ((16, 32, 64, 128, 256), 2), 2: ((8, 16, 32, 64), 4)}.get(element.field.degree, ((16, 32), 6))
    if element.field.name == "cubic":
        meshes, order = (16, 32, 64, 128, 256), 2
    values = [tip(element, elements, (0.0, 5 * BENDING)) for elements in meshes]
    assert np.abs(limit(values, order) - TIPS[10]).max() < 1e-9


@of_forces("structural", locked)
def test_full_integration_without_shear_at_the_nodes_is_stiffer_by_a_factor_of_1_2(element):
    """It comes to the beam of 1.2 times the stiffness that its nodes lack: shear, and stretch where s is no coordinate.

    The factor is one of linear interpolation in small elements, so at finite load it is exact in the limit only.
    """
    stretch = 1.0 if element.coordinates.name == "stretch" else 1.2
    axial, shear = 2e11 * THICK.area, THICK.shear_factor * STEEL.shear_modulus * THICK.area
    stiffer = bf.Section.from_stiffness(stretch * axial, 1.2 * shear, BENDING, 1.0, 1.0)
    force = (-0.2 * BENDING, 0.01 * BENDING)
    expected = tip(bf.CRBF(5), 4, force, stiffer)
    found = limit([tip(element, elements, force) for elements in (8, 16, 32)], 2)
    assert np.abs(found / expected - 1.0).max() < 1e-5
    assert np.abs(found / tip(bf.CRBF(5), 4, force) - 1.0).max() > 1e-4


@pytest.mark.parametrize("slenderness", [10, 100, 1000])
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_order_k_converges_with_twice_the_order_however_slender(order, slenderness):
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    force = (0.0, 5 * 2e11 * section.second_moment)
    reference = tip(bf.CRBF(8), 4, force, section)
    if slenderness in TIPS:
        assert np.abs(reference - TIPS[slenderness]).max() < 1e-11
    meshes = {1: (16, 32, 64), 2: (8, 16, 32), 3: (4, 8, 16), 4: (4, 6, 8)}[order]
    errors = [np.abs(tip(bf.CRBF(order), elements, force, section) - reference).max() for elements in meshes]
    rate = -np.polyfit(np.log(meshes), np.log(errors), 1)[0]
    assert 2 * order - 0.3 < rate < 2 * order + 0.6, (rate, errors)


@pytest.mark.parametrize("slenderness", [10, 100, 1000])
@pytest.mark.parametrize(("order", "elements"), [(4, 4), (8, 1)])
def test_few_elements_are_right_to_six_digits_however_slender(order, elements, slenderness):
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    force = (0.0, 5 * 2e11 * section.second_moment)
    reference = TIPS.get(slenderness)
    if reference is None:  # h^2 / L^2 away from the inextensible elastica
        reference = (-0.3876283607244299, 0.7137915236119127, 1.215368117611681)
        assert np.abs(tip(bf.CRBF(8), 4, force, section) - reference).max() < 1e-6
    assert np.abs(tip(bf.CRBF(order), elements, force, section) - reference)[:2].max() < 1.5e-6


def factor_of(element):
    """Bending stiffness over E I; references, 11.i."""
    if element.forces.name != "continuum":
        return 1.0
    return 1.0 / (1.0 - 0.3**2) if element.forces.plane_stress else 0.7 / (1.3 * 0.4)


def test_an_end_moment_a_prescribed_rotation_and_a_clamp_mean_the_same(element):
    """Small pure bending is exact on every mesh, but for the shear locking of the bilinear field in full."""
    turn = 1e-3
    meshes = (32, 64, 128) if element.field.name == "bilinear" and element.integration == "full" else (8,)
    turns, moments, others = [], [], []
    for elements in meshes:
        bending = factor_of(element) * BENDING
        beam, model = cantilever(element, elements, lambda b, bending=bending: bf.PointMoment(b.end, turn * bending))
        turns.append(bf.solve_static(model).rotation(beam.end)[-1])
        beam, model = cantilever(element, elements, supports=[lambda b: bf.Prescribed(b.end, rotation=turn)])
        solution = bf.solve_static(model)
        assert solution.rotation(beam.end)[-1] == pytest.approx(turn, rel=1e-12)
        moments.append(solution.reaction(beam.end)[-1, 2])
        others.append(solution.reaction(beam.start)[-1, 2])
    # the rest is of second order in the turn times h / L, and in the mesh
    assert limit(turns, 2) == pytest.approx(turn, rel=2e-6)
    assert limit(moments, 2) == pytest.approx(turn * bending, rel=2e-6)
    assert limit(others, 2) == pytest.approx(-turn * bending, rel=2e-6)


@of_forces("elastic-line")
@pytest.mark.parametrize("elements", [8, 128])
def test_the_elastic_line_bends_right_on_any_mesh(element, elements):
    """A moment on r_y would turn it 7 % too far with 8 elements and 96 % with 128."""
    beam, model = cantilever(element, elements, lambda b: bf.PointMoment(b.end, 0.01 * BENDING))
    solution = bf.solve_static(model)
    assert solution.rotation(beam.end)[-1] == pytest.approx(0.01, rel=1e-6)
    slope = solution.fields(beam.start).r_x[-1]
    assert slope[1] == pytest.approx(0.0, abs=1e-12)  # the clamp holds the direction of r_x


def elastica(force):
    """Tip displacement and rotation of the extensible elastica: N = E A (|r'| - 1), M = E I theta'."""
    return Cantilever(1.0, 2e11 * THICK.area, None, BENDING).tip(force)[:3] - [1.0, 0.0, 0.0]


@of_forces("elastic-line", lambda element: element.coordinates.name != "shear-rigid")
def test_the_elastic_line_comes_to_the_extensible_elastica(element):
    force = (-0.2 * BENDING, BENDING)
    values = [tip(element, elements, force) for elements in (16, 32, 64)]
    assert np.abs(limit(values, 4) - elastica(force)).max() < 5e-9


@pytest.mark.parametrize("elements", [96, 256])
def test_elements_shorter_than_the_section_is_high_end_at_the_round_off_of_r_xx(elements):
    """Found in review: the curvature carries eps |r| / l^2, and the force of it once more 1 / l."""
    found = tip(bf.ANCFCRBF(bf.ElasticLine()), elements, (-BENDING, 5 * BENDING))
    assert np.abs(found - elastica((-BENDING, 5 * BENDING))).max() < 2e-8


@of_forces("elastic-line", lambda element: element.coordinates.name == "shear-rigid")
def test_the_elastic_line_without_stretch_at_its_nodes_is_off_by_that_stretch(element):
    """s = 1 at the nodes: between them r_x is a parabola, whose direction a curvature from r_xx sees."""
    force = (-0.2 * BENDING, BENDING)
    assert np.abs(tip(element, 64, force) - elastica(force)).max() < (
        2e-6 if element.integration == "reduced" else 2e-4
    )


@pytest.mark.parametrize("plane_stress", [False, True])
def test_continuum_cantilever(plane_stress):
    """References, 11.ii: stationary energy of the same continuum, degree 10 on 9 graded pieces."""
    reference = {
        False: (-0.0001324099067977, 0.01485507106598, -0.02227981390133, -0.0002482302074627),
        True: (-0.0001986563066799, 0.01819510330389, -0.02728915621194, -0.000372422466096),
    }[plane_stress]
    element = bf.Element(bf.CRBF(4).field, bf.ANCF().coordinates, bf.ContinuumMechanics(plane_stress))
    # the thickness has boundary layers as deep as the section at both ends
    layer = np.array([0.0, 0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.2, 0.5])
    ends = (*layer, *(1.0 - layer[-2::-1]))
    beam, model = cantilever(element, ends, lambda b: bf.PointForce(b.end, (0, 10.0)), section=bf.Rectangle(0.01, 0.01))
    solution = bf.solve_static(model)
    found = (*solution.displacement(beam.end)[-1], *(solution.fields(beam.end).r_y[-1] - [0.0, 1.0]))
    assert found == pytest.approx(reference, abs=2e-9)


# references, 11.iii: stretch, lateral stretch, force / area / (E / (1 - nu^2))
STRETCHES = [
    (0.8, 1.0743768958265, -31648351648.352),
    (0.99, 1.0042552322137, -2164945054.9451),
    (1.1, 0.95393920141695, 25384615384.615),
    (1.25, 0.87116506554646, 77266483516.484),
]


@pytest.mark.filterwarnings("ignore:.*unstable equilibria:beamfem.errors.UnstableWarning")  # a short column buckles
@of_forces("continuum", lambda element: element.coordinates.name == "gradients" and not element.forces.plane_stress)
@pytest.mark.parametrize(("stretch", "thickness", "stress"), STRETCHES)
def test_uniaxial_stretch_of_the_continuum(element, stretch, thickness, stress):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, THICK, STEEL)
    pulled = bf.Prescribed(beam.end, ux=stretch - 1.0, uy=0.0)
    solution = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), pulled]))
    assert solution.reaction(beam.end)[-1, 0] == pytest.approx(stress * THICK.area, rel=1e-11)
    fields = solution.fields(beam.at(0.4))
    assert np.linalg.norm(fields.r_y[-1]) == pytest.approx(thickness, rel=1e-12)
    assert solution.section_forces(beam).normal[-1] == pytest.approx(stress * THICK.area, rel=1e-9)


@pytest.mark.filterwarnings("ignore:.*unstable equilibria:beamfem.errors.UnstableWarning")  # a short column buckles
@pytest.mark.parametrize("forces", [bf.SplitContinuum(), bf.ContinuumMechanics(True)])
@pytest.mark.parametrize(("stretch", "thickness", "stress"), STRETCHES)
def test_uniaxial_stretch_in_plane_stress(forces, stretch, thickness, stress):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.ANCF(forces), THICK, STEEL)
    pulled = bf.Prescribed(beam.end, ux=stretch - 1.0, uy=0.0)
    solution = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), pulled]))
    expected = 0.5 * 2e11 * stretch * (stretch**2 - 1.0) * THICK.area
    assert solution.reaction(beam.end)[-1, 0] == pytest.approx(expected, rel=1e-11)
    lateral = np.sqrt(1.0 - 0.3 * (stretch**2 - 1.0))
    assert np.linalg.norm(solution.fields(beam.at(0.4)).r_y[-1]) == pytest.approx(lateral, rel=1e-11)


@of_forces("continuum", lambda element: element.coordinates.name == "gradients" and not element.forces.plane_stress)
@pytest.mark.parametrize(
    ("k", "stress"),
    [
        (0.01, (13461538.461538, 769365384.61538, 769230769.23077, 13461538.461538)),
        (0.5, (33653846153.846, 55288461538.462, 38461538461.538, 33653846153.846)),
    ],
)
def test_simple_shear_of_the_continuum(element, k, stress):
    """References, 11.iv: P11, P12, P21, P22 where r_y = (k, 1) everywhere."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, THICK, STEEL)
    system = System(bf.Model([beam]), static=True)
    mesh, p = system.model.meshes[0], system.reference.copy()
    labels = {label: dofs for label, _, dofs in coordinate_columns(mesh)}
    p[labels["r_y^x"]] = k
    still = np.zeros((1, len(p)))
    forces = Solution(system.model, True, np.zeros(1), p[None], still, still, Statistics(0, 0, 0, "")).section_forces(
        beam
    )
    normal = np.array([1.0, -k]) / np.hypot(1.0, k)
    across = np.array([k, 1.0]) / np.hypot(1.0, k)
    nominal = np.outer(forces.normal[0], normal) + np.outer(forces.shear[0], across)
    expected = np.tile([stress[0], stress[2]], (len(nominal), 1))
    np.testing.assert_allclose(nominal / THICK.area, expected, rtol=1e-12, atol=1e-13 * 2e11)
    assert np.linalg.norm(nodal_vectors(mesh, p[None])[0, 0, -1]) == pytest.approx(np.hypot(k, 1.0))
    force = residual(system, p, 0 * p, 0 * p, 0.0)
    found = [force[labels[f"r_y^{axis}"]].sum() / (THICK.area * beam.curve.length) for axis in "xy"]
    assert found == pytest.approx([stress[1], stress[3]], rel=1e-12, abs=1e-14 * 2e11)
