"""Strains that loads impose: actuation and heat, with every element, in every analysis."""

import numpy as np
import pytest
from conftest import USUAL, beam, identify
from section_laws import RambergOsgood

import beamfem as bf
from beamfem.element.coordinates import Gradients, ShearFree
from beamfem.element.fields import Lagrange
from beamfem.equations.equations import linearise, residual
from beamfem.equations.system import system_of
from beamfem.io.vtk_cells import bodies
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics

STEEL = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
SQUARE = bf.Rectangle(0.01, 0.01)
EA, EI = 2e11 * 1e-4, 2e11 * 1e-8 / 12.0
ALPHA = STEEL.thermal_expansion


def straight(element=None, elements=6, length=1.0, material=STEEL, section=SQUARE):
    element = bf.CRBF(order=4) if element is None else element
    return bf.Beam(bf.Line((0.0, 0.0), (length, 0.0)), elements, element, section, material)


def clamped(own, *loads):
    return bf.Model([own], [bf.Clamp(own.start)], loads)


def heated(element):
    plain = beam(element)
    material = bf.Material(0.7e6, 0.3, 5540.0, thermal_expansion=0.01)
    return bf.Beam(plain.curve, plain.elements, element, plain.section, material)


def imposed_on(own):
    """As much as the nodes of an element can follow."""
    coordinates = own.element.coordinates
    stiff = isinstance(coordinates, ShearFree) and not coordinates.stretchable
    shear = 0.0 if isinstance(coordinates, ShearFree) else 0.03
    muscle = bf.Actuation(own, curvature=lambda s: 0.5 + s, stretch=0.0 if stiff else 0.05, shear=shear)
    heat = bf.Temperature(own, change=0.0 if stiff else 4.0, gradient=lambda s: 3.0 - 10.0 * s)
    return muscle, heat


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_forces_are_derivatives_of_the_energy_that_the_solution_tells(element, rng):
    """The energy interpolates strains without the kernels; two loads at once are no sum where strains are squares."""
    own = heated(element)
    model = bf.Model([own], loads=imposed_on(own))
    system = system_of(model, static=True)
    p, zeros, h = system.reference + 0.02 * rng.standard_normal(model.size), np.zeros(model.size), 1e-6
    steps = rng.standard_normal((4, model.size))
    force = residual(system, p, zeros, zeros, 0.7)
    states = np.concatenate([p + h * steps, p - h * steps])
    solution = Solution(model, True, np.full(8, 0.7), states, 0 * states, 0 * states, Statistics(0, 8, 0, "drawn"))
    energy = solution.energy().strain
    assert (energy[:4] - energy[4:]) / (2 * h) == pytest.approx(steps @ force, rel=1e-6, abs=1e-6 * np.abs(force).max())


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_the_tangent_is_the_derivative_of_the_forces(element, rng):
    own = heated(element)
    model = bf.Model([own], loads=imposed_on(own))
    system = system_of(model, static=True)
    p, zeros, h = system.reference + 0.02 * rng.standard_normal(model.size), np.zeros(model.size), 1e-6
    free, step = system.free_dofs, rng.standard_normal(model.size)
    turned = np.empty(0, dtype=np.int64), np.empty((0, 2))
    found = (residual(system, p + h * step, zeros, zeros, 0.7) - residual(system, p - h * step, zeros, zeros, 0.7))[
        free
    ]
    own_tangent = linearise(system, p, zeros, zeros, 0.7, (1.0, 0.0, 0.0))[1].sparse(turned) @ step[free]
    assert own_tangent == pytest.approx(found / (2 * h), rel=1e-6, abs=1e-6 * np.abs(found).max() / (2 * h))


STRETCHING = [own for own in USUAL if getattr(own.coordinates, "stretchable", True)]


@pytest.mark.parametrize("element", STRETCHING, ids=identify)
def test_a_free_beam_takes_its_strains_without_stress(element):
    """Stretch and shear of a straight beam are in every field, whatever its direction."""
    # an elastic line is clamped by the direction of its axis, which shear would turn
    shear = 0.0 if isinstance(element.coordinates, ShearFree) or element.forces.name == "elastic-line" else 0.03
    own = beam(element)
    state = bf.solve_static(clamped(own, bf.Actuation(own, stretch=0.05, shear=shear)))
    along = np.array([1.0, 0.5])
    expected = 0.05 * along + shear * np.array([-0.5, 1.0])
    assert state.displacement(own.end)[-1] == pytest.approx(expected, abs=1e-10)
    stiffness = 0.7e6 * 1.6e-3 * np.hypot(*along)
    assert state.energy().strain[-1] == pytest.approx(0.0, abs=1e-18 * stiffness)
    assert np.abs(state.section_forces(own).normal[-1]).max() < 1e-10 * stiffness


@pytest.mark.parametrize("forces", [bf.Structural(), bf.ElasticLine()], ids=lambda own: own.name)
def test_a_free_beam_curls_into_a_circle(forces):
    element = bf.Element(bf.Cubic(), Gradients(), forces)
    own = straight(element, elements=32)
    solution = bf.solve_static(clamped(own, bf.Actuation(own, curvature=2 * np.pi)))
    assert solution.position(own.end)[-1] == pytest.approx([0.0, 0.0], abs=1e-4)
    assert solution.rotation(own.end)[-1] == pytest.approx(2 * np.pi, rel=1e-4)
    assert np.abs(solution.section_forces(own).moment[-1]).max() < 1e-6 * EI


def test_a_circle_of_high_order_is_round_to_the_error_of_its_field():
    """What is left falls with the fields that hold a circle: sixth order elements hold it to 1e-10."""
    tips = []
    for order in (4, 6):
        own = straight(bf.CRBF(order))
        solution = bf.solve_static(clamped(own, bf.Actuation(own, curvature=2 * np.pi)))
        tips.append(np.linalg.norm(solution.position(own.end)[-1]))
    assert tips[0] < 1e-7
    assert tips[1] < 1e-10


def test_continuum_forces_bend_as_the_free_body_does():
    """A body bent to a circle without stress is the natural state of Green-Lagrange strains too."""
    own = straight(bf.Element(Lagrange(5), Gradients(), bf.ContinuumMechanics()))
    state = bf.solve_static(clamped(own, bf.Actuation(own, curvature=1.0)))
    assert state.position(own.end)[-1] == pytest.approx([np.sin(1.0), 1.0 - np.cos(1.0)], abs=1e-9)


def test_an_arc_is_made_straight():
    radius = 2.0
    own = bf.Beam(bf.Arc((0.0, radius), radius, -np.pi / 2, 0.0), 8, bf.CRBF(order=4), SQUARE, STEEL)
    solution = bf.solve_static(clamped(own, bf.Actuation(own, curvature=-1.0 / radius)))
    assert solution.position(own.end)[-1] == pytest.approx([np.pi, 0.0], abs=1e-8)
    assert solution.rotation(own.end)[-1] == pytest.approx(-np.pi / 2, abs=1e-8)


def test_a_moment_and_a_curvature_add_up():
    own = straight()
    loads = bf.Actuation(own, curvature=1.5), bf.PointMoment(own.end, 0.5 * EI)
    solution = bf.solve_static(clamped(own, *loads))
    assert solution.rotation(own.end)[-1] == pytest.approx(2.0, rel=1e-9)
    assert solution.section_forces(own).moment[-1] == pytest.approx(0.5 * EI, rel=1e-8)


JUMPING = [
    bf.CRBF(4),
    bf.ANCF(forces=bf.ElasticLine()),  # these take strains at the ends of elements too
    bf.ANCF(forces=bf.Structural()),
    bf.ANCF(forces=bf.SplitContinuum(), integration="lobatto"),
    bf.ShearRigid(),
]


@pytest.mark.parametrize("element", JUMPING, ids=identify)
@pytest.mark.parametrize("declared", [True, False])
def test_what_is_imposed_may_jump_along_the_beam(element, declared):
    """Elements end there, and each takes the value of its own side."""

    def bend(s):
        return 0.1 if s < 0.37 else -0.2

    def heat(s):
        return 100.0 if s < 0.37 else -50.0

    if declared:
        bend, heat = bf.Piecewise(bend, [0.37]), bf.Piecewise(heat, [0.37])
    own = straight(element, elements=13)
    bent = bf.solve_static(clamped(own, bf.Actuation(own, curvature=bend)))
    assert bent.rotation(own.end)[-1] == pytest.approx(0.037 - 0.126, rel=1e-5)
    assert 0.37 in bent.model.meshes[0].vertices.round(12)
    # a clamp would hold the thickness of gradients, as what it has in common does at the jump, by 6e-6
    ends = [bf.Pin(own.start), bf.Roller(own.end)]
    heated = bf.solve_static(bf.Model([own], ends, [bf.Temperature(own, heat)]))
    assert heated.displacement(own.end)[-1, 0] == pytest.approx(ALPHA * (37.0 - 31.5), rel=1e-5)


def test_elements_end_where_only_the_expansion_jumps():
    warmer = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=2.4e-5)
    own = straight(material=None, section=lambda s: bf.Layered([bf.Layer(STEEL if s < 0.37 else warmer, 0.01)], 0.01))
    state = bf.solve_static(clamped(own, bf.Temperature(own, 100.0, 1000.0)))
    assert state.rotation(own.end)[-1] == pytest.approx(-1000.0 * (0.37 * 1.2e-5 + 0.63 * 2.4e-5), rel=1e-8)


@pytest.mark.parametrize(
    "element", [bf.CRBF(4), bf.ANCF(forces=bf.ElasticLine()), bf.CRBF(1), bf.ShearRigid()], ids=identify
)
def test_a_bar_between_walls_pushes_when_it_is_heated(element):
    own = straight(element)
    held = [bf.Clamp(own.start), bf.Clamp(own.end)]
    solution = bf.solve_static(bf.Model([own], held, [bf.Temperature(own, change=20.0)]))
    assert solution.section_forces(own).normal[-1] == pytest.approx(-EA * ALPHA * 20.0, rel=1e-9)
    assert solution.reaction(own.start)[-1, 0] == pytest.approx(EA * ALPHA * 20.0, rel=1e-9)
    assert solution.fields(own.at(0.3)).stress.xx[-1] == pytest.approx(-2e11 * ALPHA * 20.0, rel=1e-9)


def test_a_gradient_bends_what_is_free_and_loads_what_is_held():
    own = straight()
    heat = bf.Temperature(own, change=0.0, gradient=3000.0)
    bent = bf.solve_static(clamped(own, heat))
    assert bent.rotation(own.end)[-1] == pytest.approx(-ALPHA * 3000.0, rel=1e-9)
    held = bf.solve_static(bf.Model([own], [bf.Clamp(own.start), bf.Clamp(own.end)], [heat]))
    assert held.section_forces(own).moment[-1] == pytest.approx(EI * ALPHA * 3000.0, rel=1e-9)


@pytest.mark.parametrize(
    "forces", [bf.Structural(), bf.SplitContinuum(), bf.ContinuumMechanics(True)], ids=lambda own: own.name
)
def test_a_free_beam_expands_whatever_its_forces(forces):
    """With gradients the thickness grows as well, so that no stress is left of the continuum either."""
    own = straight(bf.ANCF(forces=forces))
    state = bf.solve_static(clamped(own, bf.Temperature(own, change=100.0)))
    assert state.displacement(own.end)[-1] == pytest.approx([ALPHA * 100.0, 0.0], rel=2e-2, abs=1e-9)
    pinned = bf.Model([own], [bf.Pin(own.start), bf.Roller(own.end)], [bf.Temperature(own, change=100.0)])
    free = bf.solve_static(pinned)
    assert free.displacement(own.end)[-1] == pytest.approx([ALPHA * 100.0, 0.0], rel=1e-9, abs=1e-12)
    assert free.energy().strain[-1] < 1e-16 * EA


CURVED = [
    bf.CRBF(4),
    bf.ANCF(),
    bf.Element(Lagrange(4), Gradients(), bf.ContinuumMechanics()),
    bf.Element(Lagrange(4), Gradients(), bf.SplitContinuum()),
    bf.ANCF(forces=bf.ElasticLine()),
]


@pytest.mark.parametrize("element", CURVED, ids=identify)
def test_a_heated_arc_keeps_its_shape(element):
    """A free body of one material grows alike in all directions."""
    own = bf.Beam(bf.Arc((0.0, 0.0), 1.0, 0.0, np.pi / 2), 12, element, bf.Rectangle(0.05, 0.05), STEEL)
    held = [bf.Pin(own.start), bf.Roller(own.end, (0.0, 1.0))]
    state = bf.solve_static(bf.Model([own], held, [bf.Temperature(own, 100.0)]))
    chord = np.linalg.norm(state.position(own.end)[-1] - state.position(own.start)[-1])
    assert (chord / np.sqrt(2.0) - 1.0) / (100.0 * ALPHA) == pytest.approx(1.0, rel=1e-4)
    assert state.rotation(own.at(0.5))[-1] == pytest.approx(state.rotation(own.start)[-1], abs=1e-6)


def bimetal(axis=None):
    brass = bf.Material(1e11, 0.3, 8500.0, thermal_expansion=1.9e-5)
    return bf.Layered([bf.Layer(STEEL, 0.001), bf.Layer(brass, 0.001)], width=0.01, axis=axis)


def timoshenko(change):
    """Curvature of a strip of two layers of 1 mm; Analysis of bi-metal thermostats, 1925."""
    m, n, thickness = 1.0, 2.0, 0.002
    ratio = 3 * (1 + m) ** 2 + (1 + m * n) * (m**2 + 1 / (m * n))
    return -6 * (1.9e-5 - 1.2e-5) * change * (1 + m) ** 2 / (thickness * ratio)


@pytest.mark.parametrize("axis", [None, 0.0, 0.0015])
def test_a_bimetal_bends_as_timoshenko_says(axis):
    own = straight(material=None, section=bimetal(axis), length=0.1)
    state = bf.solve_static(clamped(own, bf.Temperature(own, change=100.0)))
    assert state.rotation(own.end)[-1] / 0.1 == pytest.approx(timoshenko(100.0), rel=1e-7)


def test_layers_of_a_bimetal_strain_each_other_in_balance():
    """Stresses on its faces: E (eps - y kappa - alpha T), whose normal force vanishes."""
    own = straight(material=None, section=bimetal(), length=0.1)
    solution = bf.solve_static(clamped(own, bf.Temperature(own, change=100.0)))
    found = [layer.arrays(solution, slice(-1, None))["stress_xx"][0] for layer in bodies(solution.model)]
    lower, upper = (np.array([part.min(), part.max()]) for part in found)
    kappa, stretch = timoshenko(100.0), 0.0
    modulus, alpha, low = np.array([2e11, 1e11]), np.array([1.2e-5, 1.9e-5]), np.array([-0.001, 0.0])
    first = 0.5 * ((low + 0.001) ** 2 - low**2)
    stretch = (modulus @ (alpha * 100.0 * 0.001 + kappa * first)) / (modulus.sum() * 0.001)
    for part, e, a, y in zip((lower, upper), modulus, alpha, low, strict=True):
        faces = e * (stretch - kappa * np.array([y, y + 0.001]) - a * 100.0)
        assert part == pytest.approx(np.sort(faces), rel=1e-6)
    mean = 0.5 * (lower.sum() + upper.sum())
    assert mean == pytest.approx(0.0, abs=1e-6 * np.abs(lower).max())


@pytest.mark.parametrize(("ends", "factor"), [(bf.Clamp, 4.0), (bf.Pin, 1.0)])
def test_a_heated_column_buckles(ends, factor):
    """E A alpha T = factor pi^2 E I / L^2: the reference is under stress though nothing has moved."""
    own = straight(elements=12)
    model = bf.Model([own], [ends(own.start), ends(own.end)], [bf.Temperature(own, change=1.0)])
    critical = factor * np.pi**2 * EI / (EA * ALPHA)
    found = bf.solve_buckling(model, count=1)
    assert found.load_factors[0] == pytest.approx(critical, rel=2e-3)
    path = bf.trace_equilibrium(model, until=1.2 * critical)
    assert path.bifurcations[0].load_factor == pytest.approx(critical, rel=2e-3)
    cold = bf.solve_modes(bf.Model([own], model.supports), count=1).frequencies[0]
    half = bf.solve_static(bf.Model([own], model.supports, [bf.Temperature(own, change=0.5 * critical)]))
    warm = bf.solve_modes(half.model, count=1, about=half[-1]).frequencies[0]
    # the mode of a pinned column is its buckling mode; of a clamped one nearly so
    assert (warm / cold) ** 2 == pytest.approx(0.5, abs=2e-2)


def test_statics_and_the_path_end_in_the_same_state():
    own = straight(elements=4)
    model = clamped(own, bf.Actuation(own, curvature=3.0, stretch=0.1), bf.PointForce(own.end, (0.0, -5.0 * EI)))
    solved, traced = bf.solve_static(model), bf.trace_equilibrium(model, until=1.0)
    assert traced.position(own.end)[-1] == pytest.approx(solved.position(own.end)[-1], abs=1e-9)


def test_one_beam_is_two_that_are_joined():
    whole = straight(elements=4)
    one = bf.solve_static(clamped(whole, bf.Actuation(whole, curvature=2.0), bf.PointForce(whole.end, (0.0, 3.0 * EI))))
    halves = [bf.Beam(bf.Line((x, 0.0), (x + 0.5, 0.0)), 2, bf.CRBF(4), SQUARE, STEEL) for x in (0.0, 0.5)]
    loads = [*(bf.Actuation(own, curvature=2.0) for own in halves), bf.PointForce(halves[1].end, (0.0, 3.0 * EI))]
    joined = bf.Model(halves, [bf.Clamp(halves[0].start)], loads, [bf.Rigid(halves[0].end, halves[1].start)])
    two = bf.solve_static(joined)
    assert two.position(halves[1].end)[-1] == pytest.approx(one.position(whole.end)[-1], abs=1e-10)


def test_a_law_of_a_section_takes_imposed_strains_off_too():
    """A moment makes the curvature of its law, whatever is imposed besides."""
    law = RambergOsgood(EA, EA / 3.0, EI, 0.78, 1e-6, knee=0.5 * EI)
    own = straight(section=law, material=None)
    moment = 0.4 * EI
    by_moment = bf.solve_static(clamped(own, bf.PointMoment(own.end, moment))).rotation(own.end)[-1]
    both = clamped(own, bf.PointMoment(own.end, moment), bf.Actuation(own, curvature=0.4))
    assert bf.solve_static(both).rotation(own.end)[-1] == pytest.approx(by_moment + 0.4, rel=1e-8)


@pytest.mark.parametrize("axis", [None, 0.0, 0.0015])
def test_the_thickness_of_a_bimetal_grows_by_the_mean_of_its_expansions(axis):
    """Weighted with E: a director that stretches alike at all heights has sum E (d - alpha T) = 0."""
    section = bimetal(axis)
    own = straight(bf.ANCF(bf.Structural()), 2, 0.1, None, section)
    low = -section.axis
    mean = (2e11 * 1.2e-5 + 1e11 * 1.9e-5) / 3e11
    lever = (2e11 * 1.2e-5 * (low + 0.0005) + 1e11 * 1.9e-5 * (low + 0.0015)) / 3e11
    for heat, expected in (((100.0, 0.0), 100.0 * mean), ((0.0, 1e3), 1e3 * lever)):
        state = bf.solve_static(clamped(own, bf.Temperature(own, *heat)))
        mesh = state.model.meshes[0]
        tip = mesh.coordinates_of(mesh.nodes - 1)
        director = np.hypot(*(state.p[-1, tip[name]] for name in ("r_y^x", "r_y^y")))
        assert director - 1.0 == pytest.approx(expected, rel=1e-6, abs=1e-12)
