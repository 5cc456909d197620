"""Signs, offsets and factors that no other test would notice: small cases with a value by hand."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.model_coordinates import coordinate_columns
from beamfem.equations.system import System
from beamfem.mesh.reference import reference_axis
from beamfem.results.axis_points import axis, nodal_vectors
from beamfem.results.postprocess import green_strain

STIFF = bf.Section.from_stiffness(1e9, 1e9, 1.0, 1.0, 1.0)
KINDS = [
    bf.CRBF(3),
    bf.ANCF(bf.Structural()),
    bf.ANCF(bf.ElasticLine()),
    bf.ANCFCRBF(bf.ElasticLine()),
    bf.ShearRigid(),
]
NAMES = [f"{element.name}-{element.forces.name}" for element in KINDS]


@pytest.mark.parametrize("moment", [0.3, -0.2])
@pytest.mark.parametrize("element", KINDS, ids=NAMES)
def test_the_potential_of_a_moment_is_minus_the_moment_times_its_turn(element, moment):
    """A cantilever under a moment at its end is an arc: turn M L / EI, strain energy M^2 L / (2 EI)."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, element, STIFF)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)])
    solution = bf.solve_static(model)
    energy = solution.energy()
    assert solution.rotation(beam.end)[-1] == pytest.approx(moment, rel=2e-3)
    assert energy.potential[-1] == pytest.approx(-(moment**2), rel=2e-3)
    assert energy.potential[-1] == pytest.approx(-2.0 * energy.strain[-1], rel=2e-3)


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF()])
def test_angular_momentum_of_layers_whose_mass_is_off_the_axis_and_off_the_origin(element):
    """Each layer is a rectangle: m r x v of its centre, and m (L^2 + h^2) / 12 times the angular velocity."""
    heavy, light = bf.Material(1e9, 0.3, 5000.0), bf.Material(1e8, 0.3, 800.0)
    width, axis_at, length = 0.1, 0.02, 1.3
    parts = ((heavy, 0.05), (light, 0.08))
    section = bf.Layered(tuple(bf.Layer(*part) for part in parts), width, axis=axis_at)
    start, along = np.array([2.0, -1.0]), np.array([0.6, 0.8])
    beam = bf.Beam(bf.Line(tuple(start), tuple(start + length * along)), 3, element, section)
    speed, spin, about = np.array([3.0, -2.0]), 1.7, np.array([0.4, 0.9])
    rigid = bf.RigidVelocity(tuple(speed), spin, tuple(about))
    motion = bf.simulate(bf.Model([beam]), 1e-4, 1e-4, velocity=rigid)
    expected, momentum, bottom = 0.0, np.zeros(2), -axis_at
    for material, height in parts:
        mass = material.density * width * height * length
        y = bottom + 0.5 * height
        bottom += height
        centre = start + 0.5 * length * along + y * np.array([-along[1], along[0]])
        arm = centre - about
        velocity = speed + spin * np.array([-arm[1], arm[0]])
        expected += mass * (centre[0] * velocity[1] - centre[1] * velocity[0])
        expected += spin * mass * (length**2 + height**2) / 12
        momentum += mass * velocity
    assert motion.linear_momentum()[0] == pytest.approx(momentum, rel=1e-10)
    assert motion.angular_momentum()[0] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize(("begin", "end", "side"), [(0.0, 2.0, 1.0), (2.0, 0.0, -1.0)])
def test_strain_along_a_curved_reference_is_measured_on_its_own_length(begin, end, side):
    """An arc of radius R whose axis grows by e: at height y a length R - y becomes R (1 + e) - y."""
    radius, grown = 0.4, 0.15
    section, material = bf.Rectangle(0.1, 0.2), bf.Material(1e6, 0.3, 1.0)
    arc = bf.Arc((0, 0), radius, begin, end)
    beam = bf.Beam(arc, 8, bf.CRBF(5, bf.ContinuumMechanics()), section, material)
    system = System(bf.Model([beam]), static=True)
    (mesh,) = system.model.meshes
    p = system.reference.copy()
    for label, _, dofs in coordinate_columns(mesh):
        if label.startswith("r^"):
            p[dofs] *= 1.0 + grown
    element, xi = np.repeat(np.arange(8), 3), np.tile([0.1, 0.5, 0.8], 8)
    y = np.tile([-0.1, -0.03, 0.0, 0.07], (len(xi), 1))
    now = axis(mesh, nodal_vectors(mesh, p[None]), element, xi)
    strain = green_strain(now, reference_axis(mesh, element, xi), y).xx[0]
    before, after = radius - side * y, radius * (1.0 + grown) - side * y
    assert strain == pytest.approx(0.5 * ((after / before) ** 2 - 1.0), rel=1e-6)


@pytest.mark.parametrize("moment", [0.02, -0.02])
@pytest.mark.parametrize("end", [(-1.0, 0.0), (-1.0, -0.0), (-1.0, 1e-12), (-1.0, -1e-12)])
@pytest.mark.parametrize("element", KINDS, ids=NAMES)
def test_a_beam_along_minus_x_turns_as_any_other(element, end, moment):
    """Its angle is pi or -pi, and a small turn crosses from one to the other: M L / EI all the same."""
    beam = bf.Beam(bf.Line((0, 0), end), 8, element, STIFF)
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [bf.PointMoment(beam.end, moment)])
    solution = bf.solve_static(model)
    assert solution.rotation(beam.end)[-1] == pytest.approx(moment / 3, rel=2e-2)
    assert solution.rotation(beam.start)[-1] == pytest.approx(-moment / 6, rel=5e-2)
    assert solution.energy().potential[-1] == pytest.approx(-(moment**2) / 3, rel=2e-2)


@pytest.mark.parametrize("element", KINDS, ids=NAMES)
def test_beams_along_minus_x_are_joined_without_a_turn_between_them(element):
    """Two halves, one drawn from left to right and one from right to left: an arc under a moment."""
    one = bf.Beam(bf.Line((-1, 0), (0, 0)), 4, element, STIFF)
    other = bf.Beam(bf.Line((-1, 0), (-2, 0)), 4, element, STIFF)
    loads, joints = [bf.PointMoment(other.end, 0.5)], [bf.Rigid(one.start, other.start)]
    model = bf.Model([one, other], [bf.Clamp(one.end)], loads, joints)
    solution = bf.solve_static(model)
    assert solution.rotation(one.start)[-1] == pytest.approx(0.5, rel=5e-3)
    assert solution.rotation(other.start)[-1] == pytest.approx(0.5, rel=5e-3)
    assert solution.rotation(other.end)[-1] == pytest.approx(1.0, rel=5e-3)
