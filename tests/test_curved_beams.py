"""Stress-free curved references: rigid motion, derivatives, rings by Castigliano and integration, disguised lines."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from integrated import Cantilever
from scipy.integrate import quad
from test_kernels import dense

import beamfem as bf
from beamfem.analysis.equations import linearise, residual
from beamfem.model.reference import energy_points, reference_axis
from beamfem.model.system import System, coordinate_columns
from beamfem.postprocess import axis, nodal_vectors, strain_energy

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
            where, xi, _, _ = energy_points(mesh)
            now, then = axis(mesh, nodal_vectors(mesh, p[None]), where, xi), reference_axis(mesh, where, xi)
            strains = mesh.beam.element.forces.strains(now) - mesh.beam.element.forces.strains(then)
            assert np.abs(strains).max() < 2e-12
            assert strain_energy(mesh, p[None])[0] < 1e-24 * stiffness


def test_energy_residual_and_tangent_are_derivatives_of_each_other(element, rng):
    system = framed(element)
    n = system.model.size
    p, d, rest = system.reference + 0.02 * rng.standard_normal(n), rng.standard_normal(n), np.zeros(n)
    force, tangent = linearise(system, p, rest, rest, 0.0, (1.0, 0.0, 0.0))

    def energy(step):
        return sum(strain_energy(mesh, (p + step * d)[None])[0] for mesh in system.model.meshes)

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


# the split forces of gradients add a term on the centreline, a reduced stretch coordinate has two rules
BODIES = [
    element
    for element in ELEMENTS
    if element.forces.name == "continuum"
    or (element.forces.name == "split" and element.coordinates.name != "gradients")
    if len(element.energy_rules()) == 1
]


@pytest.mark.parametrize("element", BODIES, ids=identify)
@pytest.mark.parametrize(("curve", "section"), [("arc", "layers"), ("spline", "tapered"), ("spline", "rectangle")])
def test_strain_and_kinetic_energy_of_a_curved_body_by_brute_force(element, curve, section, rng):
    """St. Venant-Kirchhoff with E = (G^T G - 1) / 2, G = F J^-1 the true deformation gradient, over the body."""
    beam = bf.Beam(CURVES[curve], 2, element, SECTIONS[section], bf.Material(2e5, 0.3, 1000.0))
    system = System(bf.Model([beam], loads=[bf.Gravity((0.0, -1.0))]), static=False)
    mesh, n = system.model.meshes[0], system.model.size
    p, v = system.reference + 0.05 * rng.standard_normal(n), rng.standard_normal(n)
    solution = bf.Solution(
        system.model, False, np.zeros(1), p[None], v[None], 0 * p[None], bf.solution.Statistics(0, 0, 0, "")
    )
    e0, e = (nodal_vectors(mesh, q[None])[0] for q in (system.reference, p))
    e_dot = bf.postprocess.nodal_velocities(mesh, p[None], v[None])[0]
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
@pytest.mark.parametrize("order", [2, 3, 4, 6])
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
