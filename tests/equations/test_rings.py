"""Rings and lines in disguise against closed forms and integration."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from integrated import Cantilever
from scipy.integrate import quad
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.equations import residual
from beamfem.equations.model_coordinates import coordinate_columns
from beamfem.equations.system import System

STEEL = bf.Material(2e11, 0.3, 7800.0)
SOFT = bf.Material(2e5, 0.3, 1000.0)
CURVES = {
    "arc": bf.Arc((0.3, 1.0), 1.0, -1.2, 0.7),
    "clockwise arc": bf.Arc((0.3, 1.0), 1.0, 0.7, -1.2),
    "spline": bf.BSpline(
        3, (0, 0, 0, 0, 0.5, 1, 1, 1, 1), ((0, 0), (0.4, 0.5), (1, 0.3), (1.4, -0.2), (2, 0.4)), (1, 2, 1, 1, 0.5)
    ),
    "corner": bf.Polyline(((0, 0), (0.7, 0.1), (0.8, 0.8))),
    "parametric": bf.Parametric(lambda u: (u, 0.3 * np.sin(2 * u)), 0.0, 1.5),
}


def castigliano(force, axial, shear, bending):
    """Tip displacement and rotation of a half ring of radius 1, clamped at (1, 0), by unit loads."""

    def energy(one, other):
        def at(angle):
            c, s = np.cos(angle), np.sin(angle)
            moments, normals, shears = (
                [(-1.0 - c) * fy + s * fx + m for fx, fy, m in (one, other)],
                [-s * fx + c * fy for fx, fy, _ in (one, other)],
                [-c * fx - s * fy for fx, fy, _ in (one, other)],
            )
            return np.prod(moments) / bending + np.prod(normals) / axial + np.prod(shears) / shear

        return quad(at, 0.0, np.pi, epsabs=0.0, epsrel=1e-13)[0]

    return np.array([energy((*force, 0.0), unit) for unit in np.eye(3)])


THIN_RING = [
    element
    for element in ELEMENTS
    if element.field.degree == 5
    or (
        element.forces.name == "structural"
        and element.coordinates.name == "rotation"
        and element.integration == "reduced"
    )
]


@pytest.mark.parametrize("element", THIN_RING, ids=identify)
def test_a_thin_half_ring_by_castigliano(element):
    """h / R = 1/1000. Others lock here at low order, in shear, or because d between the nodes is shorter than 1."""
    section = bf.Rectangle(0.01, 1e-3)
    bending = 2e11 * section.second_moment
    stiffness = 2e11 * section.area, 5 / 6 * STEEL.shear_modulus * section.area, bending
    force = np.array([-1e-7, 0.5e-7]) * bending
    factor = 1.0
    if element.forces.name == "continuum":
        factor = 1.0 / (1.0 - 0.3**2) if element.forces.plane_stress else 0.7 / (1.3 * 0.4)
    elements = {1: 256, 2: 24, 3: 12, 5: 8}[1 if element.field.name == "cubic" else element.field.degree]
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, np.pi), elements, element, section, STEEL)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, tuple(force))]))
    found = factor * np.append(solution.displacement(beam.end)[-1], solution.rotation(beam.end)[-1])
    error = np.abs(found / castigliano(force, *stiffness) - 1.0).max()
    assert error < {1: 2e-4, 2: 2e-5, 3: 2e-6, 5: 2e-6}[1 if element.field.name == "cubic" else element.field.degree]


@pytest.mark.parametrize("opens", [1.0, -1.0])
@mostly_slow("order", [2, 3, 4, 6], quick=(1,))
def test_a_quarter_ring_under_a_large_load_by_integration(order, opens):
    """Reissner's beam with initial curvature, h / R = 0.1, against the integration of its differential equations."""
    section = bf.Rectangle(0.1, 0.1)
    bending = 2e11 * section.second_moment
    force = (0.5 * opens * bending, 3.0 * opens * bending)
    expected = Cantilever(
        0.5 * np.pi,
        2e11 * section.area,
        5 / 6 * STEEL.shear_modulus * section.area,
        bending,
        curvature=lambda s: 1.0,
        slope=0.5 * np.pi,
        start=(1.0, 0.0),
    ).tip(force)
    beam = bf.Beam(
        bf.Arc((0, 0), 1.0, 0.0, 0.5 * np.pi), {2: 96, 3: 32, 4: 16, 6: 8}[order], bf.CRBF(order), section, STEEL
    )
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force)]))
    found = np.append(solution.position(beam.end)[-1], solution.rotation(beam.end)[-1])
    assert np.abs(found - expected[:3]).max() < (1e-7 if order == 2 else 1e-8)
    assert solution.reaction(beam.start)[-1, 2] == pytest.approx(-expected[3], rel=1e-6 if order == 2 else 1e-7)
    start, tip = solution.position(beam.start)[-1], solution.position(beam.end)[-1]
    assert -solution.reaction(beam.start)[-1, 2] == pytest.approx(
        np.cross(np.append(tip - start, 0), (*force, 0))[2], rel=1e-9
    )


def test_a_closed_ring_between_two_forces():
    """A quarter of a pinched ring: Timoshenko's closed form for the change of the diameters of a thin ring."""
    section = bf.Rectangle(0.01, 1e-3)
    bending = 2e11 * section.second_moment
    ring = bf.Beam(bf.Arc((0, 0), 1.0, -0.5 * np.pi, 1.5 * np.pi), 16, bf.CRBF(5), section, STEEL)
    force = 1e-6 * bending
    supports = [bf.Clamp(ring.start)]
    model = bf.Model([ring], supports, [bf.PointForce(ring.at(0.5), (0.0, -force))], [bf.Rigid(ring.start, ring.end)])
    solution = bf.solve_static(model)
    shorter = -solution.displacement(ring.at(0.5))[-1, 1]
    wider = solution.displacement(ring.at(0.25))[-1, 0] - solution.displacement(ring.at(0.75))[-1, 0]
    assert shorter == pytest.approx(force / bending * (np.pi / 4 - 2 / np.pi), rel=1e-5)
    assert wider == pytest.approx(force / bending * (2 / np.pi - 0.5), rel=1e-5)


@pytest.mark.parametrize("make", [bf.ANCF, bf.BilinearANCF])
def test_gradients_of_a_closed_ring_and_at_a_corner_start_free_of_stress(make):
    """Found in review: a shared vector r_y took the direction of the node that follows, not of its owner."""
    bent = bf.Beam(bf.Polyline(((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))), 8, make(), bf.Rectangle(0.1, 0.1), SOFT)
    system = System(bf.Model([bent], joints=[bf.Rigid(bent.start, bent.end)]), static=True)
    rest = np.zeros(system.model.size)
    assert np.abs(residual(system, system.reference, rest, rest, 0.0)).max() < 1e-10


LINES = {
    "spline": bf.BSpline(3, (0, 0, 0, 0, 1, 1, 1, 1), ((0, 0), (1, 0.5), (2, 1.0), (3, 1.5))),
    "uneven spline": bf.BSpline(2, (0, 0, 0, 1, 1, 1), ((0, 0), (0.4, 0.2), (3, 1.5))),
    "rational spline": bf.BSpline(2, (0, 0, 0, 0.3, 1, 1, 1), ((0, 0), (1, 0.5), (2, 1.0), (3, 1.5)), (1, 5, 0.3, 2)),
    "polyline": bf.Polyline(((0, 0), (1.2, 0.6), (3, 1.5))),
    "parametric": bf.Parametric(lambda u: (u**3 + u, 0.5 * (u**3 + u)), 0.0, 1.2134116627622296),
}


@pytest.mark.parametrize("curve", LINES.values(), ids=LINES)
@pytest.mark.parametrize("element", [element for element in ELEMENTS if element.integration == "full"], ids=identify)
def test_a_line_in_disguise_is_the_line(element, curve):
    def tip(axis):
        beam = bf.Beam(axis, [0.0, 0.1, 0.3, 1.0], element, bf.Rectangle(0.2, 0.3), SOFT)
        loads = [bf.PointForce(beam.end, (-0.5, 2.0)), bf.Gravity((0.01, -0.02)), bf.PointMoment(beam.at(0.6), 1.0)]
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
        forces = solution.section_forces(beam)
        return (
            *solution.displacement(beam.end)[-1],
            solution.rotation(beam.end)[-1],
            forces.moment[-1],
            forces.shear[-1],
        )

    for found, expected in zip(tip(curve), tip(bf.Line((0, 0), (3, 1.5))), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-9)


def test_what_is_said_of_the_reference_holds_between_the_nodes_of_a_coarse_curved_mesh():
    """Found in review: interpolation cuts the curve's corners, which is no displacement, load or spring force."""
    for element in (bf.CRBF(1), bf.CRBF(3), bf.ANCF(), bf.ANCF(bf.ElasticLine())):
        beam = bf.Beam(CURVES["arc"], 3, element, bf.Rectangle(0.1, 0.1), SOFT)
        loads = [bf.Gravity((0.0, -1.0)), bf.DistributedLoad(beam, (0.0, -1.0))]
        model = bf.Model([beam], [bf.Clamp(beam.start), bf.Foundation(beam, (1e4, 1e4))], loads)
        start = bf.simulate(model, 1e-3, 1e-3)
        assert np.abs(start.displacement(beam.at(0.4))[0]).max() < 1e-14
        assert start.energy().potential[0] == pytest.approx(0.0, abs=1e-12)
        system = System(bf.Model([beam], model.supports), static=True)
        rest = np.zeros(system.model.size)
        assert np.abs(residual(system, system.reference, rest, rest, 0.0)).max() < 1e-10
        pushed = bf.PointForce(beam.at(0.4), (1.0, 2.0), follower=True)
        system = System(bf.Model([beam], loads=[pushed]), static=True)
        rest = np.zeros(system.model.size)
        force = residual(system, system.reference, rest, rest, 1.0)
        columns = {label: dofs for label, _, dofs in coordinate_columns(system.model.meshes[0])}
        found = [-force[columns[f"r^{name}"]].sum() for name in "xy"]
        assert found == pytest.approx([1.0, 2.0], abs=1e-10)


@pytest.mark.parametrize("forces", [bf.Structural(), bf.ContinuumMechanics(True)], ids=lambda forces: forces.name)
def test_a_free_thin_ring_vibrates_as_it_should(forces):
    """Hoppe 1871, in the plane: omega^2 = n^2 (n^2 - 1)^2 / (n^2 + 1) EI / (rho A R^4), in pairs."""
    section = bf.Rectangle(0.01, 0.002)
    ring = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2 * np.pi), 12, bf.CRBF(5, forces), section, STEEL)
    modes = bf.solve_modes(bf.Model([ring], joints=[bf.Rigid(ring.start, ring.end)]), 7)
    factor = 1.0 / (1.0 - 0.3**2) if forces.name == "continuum" else 1.0
    speed = np.sqrt(factor * 2e11 * section.second_moment / (7800.0 * section.area)) / (2 * np.pi)
    expected = [n * (n**2 - 1) / np.sqrt(n**2 + 1) * speed for n in (2, 2, 3, 3)]
    assert modes.frequencies[:3] == pytest.approx(0.0, abs=1e-3 * speed)
    assert modes.frequencies[3:] == pytest.approx(expected, rel=2e-5)
