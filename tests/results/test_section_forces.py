"""Section forces against those of the deformed beam cut by hand."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify

import beamfem as bf
from beamfem.results.axis_points import axis, nodal_vectors
from beamfem.results.postprocess import direction

SOFT = bf.Material(2e5, 0.3, 7800.0)
FORCE, MOMENT = np.array([-3.0, 6.0]), 1.0
SHAPES = {
    "straight": (bf.Line((0, 0), (1, 0.5)), bf.Rectangle(0.2, 0.2)),
    "arc": (bf.Arc((0, 0), 1.0, 0.0, 1.5), bf.Rectangle(0.2, 0.2)),
    "tapered clockwise": (bf.Arc((0, 0), 1.0, 1.5, 0.0), lambda s: bf.Rectangle(0.2, 0.25 - 0.06 * s)),
}


def errors(element, shape, elements):
    """Largest errors of normal force, shear force and moment, relative to the loads, ends of the beam included."""
    curve, section = SHAPES[shape]
    beam = bf.Beam(curve, elements, element, section, SOFT)
    loads = [bf.PointForce(beam.end, tuple(FORCE)), bf.PointMoment(beam.end, MOMENT)]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    found, mesh = solution.section_forces(beam), solution.model.meshes[0]
    # as many stations in each element
    where = np.arange(len(found.arc_length)) * mesh.elements // len(found.arc_length)
    xi = (found.arc_length - mesh.vertices[where]) / mesh.lengths[where]
    now = axis(mesh, nodal_vectors(mesh, solution.p[-1:]), where, xi)
    along, arm = direction(mesh, now)[0], solution.position(beam.end)[-1] - now.r[0]
    normal = along @ FORCE
    shear = along[:, 0] * FORCE[1] - along[:, 1] * FORCE[0]
    moment = MOMENT + arm[:, 0] * FORCE[1] - arm[:, 1] * FORCE[0]
    size = np.linalg.norm(FORCE)
    return np.array(
        [
            np.abs(found.normal[-1] - normal).max() / size,
            np.abs(found.shear[-1] - shear).max() / size,
            np.abs(found.moment[-1] - moment).max() / np.abs(moment).max(),
        ]
    )


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("element", ELEMENTS, ids=identify)
def test_a_cut_through_the_deformed_beam_is_in_equilibrium(element, shape):
    """However coarse the mesh is: interpolated stress resultants were off by up to a fifth with 18 cubic elements."""
    assert errors(element, shape, 4).max() < 1e-8


def test_a_beam_under_its_weight_cut_by_hand():
    """Hanging, standing on its clamp and lying: normal force, shear force and moment from the weight beyond the cut."""
    section, weight = bf.Rectangle(0.1, 0.1), 7800.0 * 0.01 * 9.81
    for end, expected in (((0, -1), (1, 0, 0)), ((0, 1), (-1, 0, 0)), ((1, 0), (0, -1, -1)), ((-1, 0), (0, 1, 1))):
        beam = bf.Beam(bf.Line((0, 0), end), 4, bf.CRBF(4), section, bf.Material(2e11, 0.3, 7800.0))
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -9.81))]))
        forces = solution.section_forces(beam)
        left = 1.0 - forces.arc_length
        for found, sign, load in zip(
            (forces.normal, forces.shear, forces.moment), expected, (left, left, 0.5 * left**2), strict=True
        ):
            np.testing.assert_allclose(found[-1], sign * weight * load, rtol=1e-4, atol=1e-4 * weight)


@pytest.mark.parametrize("element", [bf.ANCF(), bf.ANCF(bf.Structural()), bf.ANCF(bf.ElasticLine())], ids=identify)
def test_a_load_that_follows_a_stretched_section_turns_with_it_and_does_not_grow(element):
    """Gradients become longer or shorter than one: the load at a cut is that beyond it, turned by the rotation."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, element, bf.Rectangle(0.2, 0.2), bf.Material(2e5, 0.3, 10.0))
    pull, following = np.array([800.0, 0.0]), np.array([100.0, 900.0])
    loads = [bf.PointForce(beam.end, tuple(pull)), bf.DistributedLoad(beam, tuple(following), follower=True)]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    xi, weights = np.polynomial.legendre.leggauss(6)
    total = pull.copy()
    for first in range(6):
        for x, w in zip(xi, weights, strict=True):
            angle = solution.rotation(beam.at((first + 0.5 + 0.5 * x) / 6.0))[-1]
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            total += w / 12.0 * turn @ following
    forces, fields = solution.section_forces(beam), solution.fields(beam.start)
    slope = element.forces.turns_with == "r_x"
    along = fields.r_x[-1] if slope else np.array([fields.r_y[-1, 1], -fields.r_y[-1, 0]])
    along = along / np.linalg.norm(along)
    found = forces.normal[-1, 0] * along + forces.shear[-1, 0] * np.array([-along[1], along[0]])
    assert found == pytest.approx(total, abs=2e-3 * np.linalg.norm(following))
    assert abs(solution.rotation(beam.at(0.5))[-1]) > 0.3


@pytest.mark.parametrize(
    "element", [bf.CRBF(1), bf.CRBF(3), bf.ANCF(), bf.ANCFCRBF(bf.Structural()), bf.ShearRigid()], ids=identify
)
def test_a_post_whose_mass_is_beside_its_axis_carries_its_weight_times_the_offset(element):
    """One element, upright: M = c W (L - s) / L about the axis, c the offset of the layers' centre of mass."""
    heavy, light = bf.Material(2e13, 0.3, 8000.0), bf.Material(1e13, 0.3, 500.0)
    beam = bf.Beam(bf.Line((0, 0), (0, 1)), 1, element, bf.Layered((bf.Layer(heavy, 0.01), bf.Layer(light, 0.03)), 0.1))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -10.0))])
    forces = bf.solve_static(model).section_forces(beam)
    # layers from -0.02 to -0.01 and on to 0.02; y points to the left of the axis, here to -x
    weight, turning = 10.0 * (8.0 + 1.5), 10.0 * (8.0 * -0.015 + 1.5 * 0.005)
    left = 1.0 - forces.arc_length
    np.testing.assert_allclose(forces.moment[-1], turning * left, atol=1e-5 * abs(turning))
    np.testing.assert_allclose(forces.normal[-1], -weight * left, atol=1e-5 * weight)
