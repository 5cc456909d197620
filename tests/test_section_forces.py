"""Section forces against those of the deformed beam cut by hand, and by virtual work."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify

import beamfem as bf
from beamfem.element.axis import Axis
from beamfem.model.reference import stiffness_at
from beamfem.model.system import System
from beamfem.postprocess import axis, direction, nodal_vectors, section_forces, strain_energy

SOFT = bf.Material(2e5, 0.3, 7800.0)
FORCE, MOMENT = np.array([-3.0, 6.0]), 1.0
CURVES = {
    "straight": bf.Line((0, 0), (1, 0.5)),
    "arc": bf.Arc((0, 0), 1.0, 0.0, 1.5),
    "clockwise": bf.Arc((0, 0), 1.0, 1.5, 0.0),
}
SECTIONS = {
    "prismatic": bf.Rectangle(0.2, 0.2),
    "tapered": lambda s: bf.Rectangle(0.2, 0.25 - 0.06 * s),
}


def errors(element, curve, section, elements):
    """Largest errors of normal force, shear force and moment, relative to the loads, ends of the beam included."""
    beam = bf.Beam(CURVES[curve], elements, element, SECTIONS[section], SOFT)
    loads = [bf.PointForce(beam.end, tuple(FORCE)), bf.PointMoment(beam.end, MOMENT)]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    found, mesh = solution.section_forces(beam), solution.model.meshes[0]
    where = np.clip(np.searchsorted(mesh.vertices, found.arc_length, side="right") - 1, 0, mesh.elements - 1)
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


# full integration of all but the highest order leaves shear that oscillates about the right one over an element
REDUCED = [element for element in ELEMENTS if element.field.name != "cubic" and element.integration == "reduced"]


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("element", REDUCED, ids=identify)
def test_a_cut_through_the_deformed_beam_is_in_equilibrium(element, curve, section):
    # with gradients the thickness has a boundary layer as deep as the section, which these meshes are coarse for
    layer = 20.0 if element.coordinates.name == "gradients" else 1.0
    allowed = layer * {1: 6e-4, 2: 4e-5, 3: 4e-6, 5: 1e-7}[element.field.degree]
    assert errors(element, curve, section, 32 if element.field.degree < 3 else 16).max() < allowed


# the nodes of the locked ones have no shear at all (and no stretch): between them they have half as much again
CUBIC = [
    element
    for element in ELEMENTS
    if element.field.name == "cubic"
    and not (element.coordinates.name in ("stretch", "shear-rigid") and element.integration == "full")
]


@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("element", CUBIC, ids=identify)
def test_the_cut_converges_on_the_cubic_field(element, curve):
    coarse, fine = errors(element, curve, "tapered", 6), errors(element, curve, "tapered", 18)
    assert fine.max() < 0.2
    assert fine.max() < 0.55 * coarse.max()


# strains of the Lobatto points are those of a whole element; their section forces are cut by hand, here and in slender
# beams in test_locking
POINTWISE = [e for e in ELEMENTS if e.forces.name != "elastic-line" and e.integration != "lobatto"]


@pytest.mark.parametrize("element", POINTWISE, ids=identify)
@pytest.mark.parametrize("curve", ["straight", "arc"])
def test_section_forces_do_the_work_of_the_strain_energy(element, curve, rng):
    """Normal, shear and moment are dW/dr0' and d x dW/dd': turn, shift or move all that follows a cut, and W changes.

    Here by an infinitesimal motion of the whole beam r -> r + (n0 + w x r) s, d -> d + w s x d in the strain measures.
    """
    beam = bf.Beam(CURVES[curve], 1, element, bf.Rectangle(0.2, 0.2), SOFT)
    system = System(bf.Model([beam]), static=True)
    mesh, p = system.model.meshes[0], system.reference + 0.03 * rng.standard_normal(system.model.size)
    forces = section_forces(mesh, p[None])
    where, xi = (np.array(part) for part in zip(*[(0, x) for x in element.quadrature()[0]], strict=True))
    now = axis(mesh, nodal_vectors(mesh, p[None]), where, xi)
    along = direction(mesh, now)[0]
    n = forces.normal[0][:, None] * along + forces.shear[0][:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
    stiffness, reference = stiffness_at(mesh, where, xi)

    def energy(at):
        strains = element.forces.strains(at) - reference
        return 0.5 * np.einsum("qi,qij,qj->q", strains, stiffness, strains)

    def changed(h, pull, turn):
        """r0' + h pull and d' + h turn (k x d)."""
        spin = np.stack([-now.d[0][:, 1], now.d[0][:, 0]], axis=1)
        return Axis(now.r[0], now.r_s[0] + h * np.array(pull), now.r_ss[0], now.d[0], now.d_s[0] + h * turn * spin)

    for pull, turn, expected in (((1, 0), 0, n[:, 0]), ((0, 1), 0, n[:, 1]), ((0, 0), 1, forces.moment[0])):
        h = 1e-5
        slope = (energy(changed(h, pull, turn)) - energy(changed(-h, pull, turn))) / (2 * h)
        np.testing.assert_allclose(slope, expected, rtol=1e-7, atol=1e-7 * np.abs(n).max())
    assert strain_energy(mesh, p[None])[0] > 0.0


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
