"""Stress-free curved references: rigid motion, derivatives, rings by Castigliano and integration, disguised lines."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from test_kernels import dense

import beamfem as bf
from beamfem.equations.equations import linearise, residual
from beamfem.equations.model_coordinates import coordinate_columns
from beamfem.equations.system import System
from beamfem.mesh.reference import curvature, energy_points, reference_axis
from beamfem.results.axis_points import axis, nodal_vectors
from beamfem.results.postprocess import strain_energies
from beamfem.results.status import Statistics

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


def tapered(s):
    return bf.Rectangle(0.1, 0.12 - 0.02 * s)


def framed(element):
    """Clamped beams along all curves, one tapered, each joined rigidly to another element and hinged to a third."""
    beams, joints = [], []
    for name, curve in CURVES.items():
        section = tapered if name == "spline" else bf.Rectangle(0.1, 0.12)
        one = bf.Beam(curve, 2, element, section, SOFT)
        end = tuple(one.end.reference)
        other = bf.Beam(bf.Line(end, (3.0, 1.0)), 1, bf.CRBF(2), bf.Rectangle(0.1, 0.1), SOFT)
        third = bf.Beam(bf.Line(end, (3.0, -1.0)), 1, bf.ANCF(), bf.Rectangle(0.1, 0.1), SOFT)
        beams += [one, other, third]
        joints += [bf.Rigid(one.end, other.start), bf.Hinge(one.end, third.start)]
    return System(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams[::3]], joints=joints), static=True)


def moved(system, angle, shift):
    """Coordinates of the reference after a rigid motion; coordinates of joined nodes once."""
    c, s = np.cos(angle), np.sin(angle)
    turn, reference = np.array([[c, -s], [s, c]]), system.reference
    p = reference.copy()
    for mesh in system.model.meshes:
        columns = coordinate_columns(mesh)
        for place, (label, _, dofs) in enumerate(columns):
            if label == "theta":
                p[dofs] = reference[dofs] + angle
            elif label.endswith("^x"):
                pair = np.stack([dofs, columns[place + 1][2]])
                p[pair] = turn @ reference[pair] + (shift[:, None] if label == "r^x" else 0.0)
    return p


def test_a_moved_and_turned_beam_has_neither_strain_nor_force(element):
    system = framed(element)
    rest = np.zeros(system.model.size)
    stiffness = np.abs(linearise(system, system.reference, rest, rest, 0.0, (1.0, 0.0, 0.0))[1].rows).max()
    for angle, shift in ((0.0, (0.0, 0.0)), (2.0, (3.0, -1.0))):
        p = moved(system, angle, np.array(shift))
        assert np.abs(residual(system, p, rest, rest, 0.0)).max() < 1e-14 * stiffness
        for mesh in system.model.meshes:
            where, xi, _ = energy_points(mesh)
            now, then = axis(mesh, nodal_vectors(mesh, p[None]), where, xi), reference_axis(mesh, where, xi)
            strains = mesh.beam.element.forces.strains(now) - mesh.beam.element.forces.strains(then)
            assert np.abs(strains).max() < 2e-12
            assert strain_energies(mesh, p[None])[0, 0] < 1e-24 * stiffness


def test_energy_residual_and_tangent_are_derivatives_of_each_other(element, rng):
    system = framed(element)
    n = system.model.size
    p, d, rest = system.reference + 0.02 * rng.standard_normal(n), rng.standard_normal(n), np.zeros(n)
    force, tangent = linearise(system, p, rest, rest, 0.0, (1.0, 0.0, 0.0))

    def energy(step):
        return sum(strain_energies(mesh, (p + step * d)[None])[0, 0] for mesh in system.model.meshes)

    def slope(function, h):  # of fourth order
        return (8 * (function(h) - function(-h)) - function(2 * h) + function(-2 * h)) / (12 * h)

    assert slope(energy, 1e-4) == pytest.approx(force @ d, abs=1e-8 * np.abs(force) @ np.abs(d))
    free = system.free_dofs
    d[np.setdiff1d(np.arange(n), free)] = 0.0
    numeric = slope(lambda h: residual(system, p + h * d, rest, rest, 0.0)[free], 1e-4)
    exact = dense(tangent) @ d[free]
    assert np.abs(numeric - exact).max() < 1e-8 * np.abs(exact).max()


def table(mesh, vectors, element, xi, derivative):
    """r0 and d, or their derivatives by xi, written out of the nodal vectors (nodes, vectors, 2)."""
    field = mesh.beam.element.field
    own, length = vectors[mesh.node[element]], mesh.lengths[element]
    position = [own[:, i] * (length if name == "r_x" else 1.0) for i, name in enumerate(field.vectors[:-1])]
    r = field.centreline(xi, derivative) @ np.stack(position, axis=1).reshape(-1, 2)
    return r, field.director(xi, derivative) @ own[:, -1]


LAYERS = bf.Layered(
    (bf.Layer(bf.Material(3e5, 0.2, 7800.0), 0.03), bf.Layer(bf.Material(1e5, 0.35, 1000.0), 0.09)), 0.2
)
SECTIONS = {
    "rectangle": bf.Rectangle(0.2, 0.12),
    "layers": LAYERS,
    "tapered": lambda s: bf.Rectangle(0.2, 0.12 - 0.02 * s),
}


def body_points(beam, arc, points=14):
    """Material, height and weight [m^2] over the section at an arc length; all are 0.2 m wide."""
    section = beam.section_at(arc)
    low, high = section.bounds
    parts = [(beam.material, low, high)]
    if isinstance(section, bf.Layered):
        parts = [(section.layers[0].material, low, low + 0.03), (section.layers[1].material, low + 0.03, high)]
    at, weights = np.polynomial.legendre.leggauss(points)
    for material, bottom, top in parts:
        half = 0.5 * (top - bottom)
        for y, weight in zip(half * at, 0.2 * half * weights, strict=True):
            yield material, 0.5 * (bottom + top) + y, weight


def density(element, material, green, normal, across, shear_factor):
    """Strain energy per volume of the forces of an element."""
    if element.forces.name == "continuum":
        lame = material.lame_lambda(element.forces.plane_stress)
        return 0.5 * lame * np.trace(green) ** 2 + material.shear_modulus * (green * green).sum()
    xx, yy, xy = normal @ green @ normal, across @ green @ across, normal @ green @ across
    return 0.5 * material.youngs_modulus * (xx**2 + yy**2) + 2.0 * shear_factor * material.shear_modulus * xy**2


# the split forces of gradients add a term on the centreline, a reduced stretch coordinate has two rules, and what is
# taken at the nodes is checked term by term in test_locking
BODIES = [
    element
    for element in ELEMENTS
    if element.forces.name == "continuum"
    or (element.forces.name == "split" and element.coordinates.name != "gradients")
    if element.integration != "lobatto" and len(element.energy_rules()) == 1
]


@pytest.mark.parametrize("element", BODIES, ids=identify)
@pytest.mark.parametrize(("curve", "section"), [("arc", "layers"), ("spline", "tapered"), ("spline", "rectangle")])
def test_strain_and_kinetic_energy_of_a_curved_body_by_brute_force(element, curve, section, rng):
    """St. Venant-Kirchhoff with E = (G^T G - 1) / 2, G = F J^-1 the true deformation gradient, over the body."""
    beam = bf.Beam(CURVES[curve], 2, element, SECTIONS[section], bf.Material(2e5, 0.3, 1000.0))
    system = System(bf.Model([beam], loads=[bf.Gravity((0.0, -1.0))]), static=False)
    mesh, n = system.model.meshes[0], system.model.size
    p, v = system.reference + 0.05 * rng.standard_normal(n), rng.standard_normal(n)
    solution = bf.Solution(system.model, False, np.zeros(1), p[None], v[None], 0 * p[None], Statistics(0, 0, 0, ""))
    e0, e = (nodal_vectors(mesh, q[None])[0] for q in (system.reference, p))
    e_dot = nodal_vectors(mesh, p[None], v=v[None])[0]
    points = max(element.field.degree, element.field.director_degree) + 1
    strain, kinetic, potential = 0.0, 0.0, 0.0
    momentum = np.zeros(2)
    for number in range(mesh.elements):
        for rule, elastic in ((element.quadrature(), True), (np.polynomial.legendre.leggauss(points), False)):
            xi, weights = rule if elastic else (0.5 * (rule[0] + 1.0), 0.5 * rule[1])
            (r_0, d_0), (r_0x, d_0x) = table(mesh, e0, number, xi, 0), table(mesh, e0, number, xi, 1)
            (r, d), (r_x, d_x) = table(mesh, e, number, xi, 0), table(mesh, e, number, xi, 1)
            r_t, d_t = table(mesh, e_dot, number, xi, 0)
            for i, arc in enumerate(mesh.arc_length(np.full(len(xi), number), xi)):
                across = d_0[i] / np.linalg.norm(d_0[i])
                normal = np.array([across[1], -across[0]])
                for material, y, area in body_points(beam, arc):
                    jacobian = np.stack([r_0x[i] + y * d_0x[i], d_0[i]], axis=1)
                    volume = weights[i] * area * np.linalg.det(jacobian)
                    if elastic:
                        gradient = np.stack([r_x[i] + y * d_x[i], d[i]], axis=1) @ np.linalg.inv(jacobian)
                        green = 0.5 * (gradient.T @ gradient - np.eye(2))
                        strain += volume * density(element, material, green, normal, across, 5 / 6)
                    else:
                        velocity = r_t[i] + y * d_t[i]
                        kinetic += 0.5 * volume * material.density * velocity @ velocity
                        momentum += volume * material.density * velocity
                        potential += volume * material.density * (r[i] + y * d[i] - r_0[i] - y * d_0[i])[1]
    energy = solution.energy()
    assert energy.strain[0] == pytest.approx(strain, rel=1e-12)
    assert energy.kinetic[0] == pytest.approx(kinetic, rel=1e-12)
    assert energy.potential[0] == pytest.approx(potential, rel=1e-11)
    assert solution.linear_momentum()[0] == pytest.approx(momentum, rel=1e-11)


@pytest.mark.parametrize("elements", [1, 4])
def test_the_curvature_of_a_curve_is_that_at_the_ends_of_elements_too(elements):
    """Of the parabola y = x^2 / 2 it is (1 + x^2)^-3/2; found as a peak stress whose error did not show."""
    parabola = bf.Parametric(lambda x: (x, 0.5 * x**2), 0.0, 1.5)
    beam = bf.Beam(parabola, elements, bf.CRBF(3), bf.Rectangle(0.02, 0.01), STEEL)
    mesh = bf.Model([beam], [bf.Clamp(beam.start)]).meshes[0]
    every = np.arange(elements)
    for xi in (0.0, 0.3, 1.0):
        x = [mesh.beam.curve.position(s)[0] for s in mesh.arc_length(every, np.full(elements, xi))]
        exact = (1.0 + np.array(x) ** 2) ** -1.5
        assert curvature(mesh, every, np.full(elements, xi)) == pytest.approx(exact, rel=1e-7)
