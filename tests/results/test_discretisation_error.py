"""Estimates of the discretisation error against closed forms and much finer meshes."""

import warnings

import numpy as np
import pytest
from coarse_models import coarse_recipe, displacements, fine_recipe
from history_laws import YIELDING
from slow_values import mostly_slow

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.02, 0.01)
EI = 2e11 * SECTION.second_moment
LINE = bf.Line((0, 0), (1, 0))


def cantilever(element, elements, loads, curve=LINE, **options):
    beam = bf.Beam(curve, elements, element, options.pop("section", SECTION), STEEL)
    supports = [bf.Clamp(beam.start), *options.pop("held", lambda beam: [])(beam)]
    parts = {name: make(beam) for name, make in options.items()}
    return beam, bf.solve_static(bf.Model([beam], supports, loads(beam), **parts))


def rolled_up(beam):
    return [bf.PointMoment(beam.end, 2.0 * np.pi * EI)]


def bent(beam):
    return [bf.PointForce(beam.end, (0.0, 5.0 * EI))]


def test_a_roll_up_in_one_element_carries_its_error():
    """It is rolled up into a full circle: the tip is where it was clamped, up to the shortening by the stretch."""
    beam, solution = cantilever(bf.CRBF(5), 1, rolled_up)
    assert np.linalg.norm(solution.position(beam.end)[-1]) == pytest.approx(0.056, abs=0.001)
    corrected = solution.position(beam.end)[-1] + solution.error(beam.end)
    assert np.linalg.norm(corrected) < 1e-3
    assert solution.error(lambda s: s.rotation(beam.end)[-1]) == pytest.approx(
        2.0 * np.pi - solution.rotation(beam.end)[-1], rel=0.02
    )


def test_a_linear_cantilever_of_one_bilinear_element_lacks_a_quarter_of_its_deflection():
    """One point of integration: F L^3 / 4 E I + F L / k G A for F L^3 / 3 E I + F L / k G A; order 2 is exact."""
    beam, solution = cantilever(bf.CRBF(1), 1, lambda beam: [bf.PointForce(beam.end, (0.0, 1e-6 * EI))])
    assert solution.error(beam.end)[1] == pytest.approx(1e-6 / 12.0, rel=1e-6)
    assert solution.error() == pytest.approx(1e-6 / 12.0, rel=1e-6)


QUANTITIES = {
    "displacement": lambda beam: lambda s: s.displacement(beam.end)[-1],
    "inside": lambda beam: lambda s: s.displacement(beam.at(0.3))[-1],
    "rotation": lambda beam: lambda s: s.rotation(beam.at(0.5))[-1],
    "reaction": lambda beam: lambda s: s.reaction(beam.start)[-1, 2],
    "moment": lambda beam: lambda s: s.section_forces(beam).moment[-1, 0],
    "stress": lambda beam: lambda s: s.peak_stress("upper").value,
    "energy": lambda beam: lambda s: s.energy().strain[-1],
}
ELEMENTS = [
    (bf.CRBF(1), 10),
    (bf.CRBF(2), 4),
    (bf.CRBF(3), 2),
    (bf.CRBF(4), 2),
    (bf.CRBF(8), 1),
    (bf.Element(bf.Lagrange(2), bf.Gradients(), bf.Structural(), "reduced"), 4),
    (bf.CRBF(3, bf.SplitContinuum()), 3),
    (bf.ANCF(bf.Structural()), 6),
    (bf.ANCFCRBF(bf.ElasticLine()), 6),
    (bf.ShearRigid(), 6),
]


@pytest.mark.parametrize(("element", "elements"), ELEMENTS, ids=lambda value: getattr(value, "name", None))
def test_results_of_a_bent_cantilever_carry_their_errors(element, elements):
    """Against 32 times the elements of the same kind."""
    beam, solution = cantilever(element, elements, bent)
    fine_beam, fine = cantilever(element, 32 * elements, bent)
    for name, quantity in QUANTITIES.items():
        if name == "stress" and isinstance(element.forces, bf.SplitContinuum):
            continue  # its section forces have no limit at the clamp
        exact = quantity(fine_beam)(fine) - quantity(beam)(solution)
        if np.linalg.norm(exact) < 1e-7 * np.linalg.norm(quantity(fine_beam)(fine)):
            continue  # moments from balance
        ratio = np.linalg.norm(solution.error(quantity(beam))) / np.linalg.norm(exact)
        assert 0.5 < ratio < 2.0, f"{name}: {ratio}"


@mostly_slow(
    ("element", "elements"),
    [(bf.CRBF(1), 24), (bf.CRBF(2), 8), (bf.CRBF(3), 4), (bf.CRBF(4), 4), (bf.CRBF(6), 4), (bf.CRBF(8), 4)],
    quick=(0, 2, 5),
)
@mostly_slow("size", [-200.0, 20.0])
def test_the_default_is_the_largest_error_of_a_position(element, elements, size):
    """Between the nodes of a ring under two forces positions are off by up to 200 times as much as there."""
    found = []
    for number, kind in ((elements, element), (16, bf.CRBF(8))):
        ring = bf.Beam(bf.Arc((0, 0), 1.0, -0.5 * np.pi, 1.5 * np.pi), number, kind, bf.Rectangle(0.02, 0.01), STEEL)
        load = bf.PointForce(ring.at(0.5), (0.0, size))
        solution = bf.solve_static(bf.Model([ring], [bf.Clamp(ring.start)], [load], [bf.Rigid(ring.end, ring.start)]))
        found.append((solution, np.array([solution.position(ring.at(x))[-1] for x in np.linspace(0.0, 1.0, 193)])))
    (solution, coarse), (_, fine) = found
    assert 0.5 < solution.error() / np.linalg.norm(fine - coarse, axis=1).max() < 2.0


def test_errors_of_other_rows():
    beam = bf.Beam(LINE, 3, bf.CRBF(2), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], bent(beam))
    solution = bf.solve_static(model, at=[0.1, 1.0])
    alone = bf.solve_static(model, at=[0.1])
    assert solution.error(beam.end, row=0) == pytest.approx(alone.error(beam.end), rel=1e-9)
    assert solution.error() > 3.0 * solution.error(row=0)


def corner(element, elements):
    """A column and a bar, joined rigidly, on a spring, with a link to the ground side and a mass under gravity."""
    column = bf.Beam(bf.Line((0, 0), (0, 1)), elements, element, SECTION, STEEL, "column")
    bar = bf.Beam(bf.Line((0, 1), (1, 1)), elements, element, SECTION, STEEL, "bar")
    tie = bf.Link(column.at(0.5), bar.at(0.5))
    model = bf.Model(
        [column, bar],
        [bf.Clamp(column.start), bf.Spring(bar.end, (0.0, 2.0 * EI))],
        [bf.PointForce(bar.end, (-2.0 * EI, -4.0 * EI)), bf.Gravity((0.0, -9.81))],
        [bf.Rigid(column.end, bar.start)],
        [tie],
        masses=[bf.PointMass(bar.at(0.75), 20.0)],
    )
    return column, bar, tie, bf.solve_static(model)


@pytest.mark.parametrize(("element", "elements"), [(bf.CRBF(2), 2), (bf.ANCF(bf.Structural()), 3)])
def test_frames_with_joints_springs_links_and_masses(element, elements):
    column, bar, tie, solution = corner(element, elements)
    _, fine_bar, fine_tie, fine = corner(element, 16 * elements)
    pairs = [
        (solution.error(bar.end), fine.displacement(fine_bar.end)[-1] - solution.displacement(bar.end)[-1]),
        (
            solution.error(lambda s: s.connector_force(tie)[-1, 0, :2]),
            fine.connector_force(fine_tie)[-1, 0, :2] - solution.connector_force(tie)[-1, 0, :2],
        ),
        (
            solution.error(lambda s: s.reaction(bar.end)[-1, 1]),
            fine.reaction(fine_bar.end)[-1, 1] - solution.reaction(bar.end)[-1, 1],
        ),
        (solution.error(lambda s: s.energy().total[-1]), fine.energy().total[-1] - solution.energy().total[-1]),
    ]
    for estimate, exact in pairs:
        assert 0.5 < np.linalg.norm(estimate) / np.linalg.norm(exact) < 2.0
    assert np.all(solution.error(lambda s: s.displacement(column.start)[-1]) == 0.0)


SPLINE = bf.BSpline(3, (0, 0, 0, 0, 0.6, 1, 1, 1, 1), ((0, 0), (0.3, 0.2), (0.6, -0.1), (0.8, 0.1), (1.0, 0.3)))


@pytest.mark.parametrize(
    ("element", "elements", "curve", "finer"),
    [
        (bf.CRBF(3), 2, bf.Arc((0, 0), 0.5, 0.0, np.pi), 32),
        (bf.ANCF(bf.Structural()), "knots", SPLINE, 32),
        (bf.CRBF(1), 12, bf.Polyline(((0, 0), (0.5, 0), (0.5, 0.5))), 192),
        (bf.CRBF(2), (0.0, 0.2, 1.0), LINE, 32),
    ],
    ids=["arc", "knots", "polyline", "fractions"],
)
def test_curved_beams_and_uneven_meshes(element, elements, curve, finer):
    def loads(beam):
        return [bf.DistributedLoad(beam, (0.0, -2.0 * EI)), bf.Actuation(beam, 0.5, 0.0)]

    beam, solution = cantilever(element, elements, loads, curve)
    fine_beam, fine = cantilever(element, finer, loads, curve)
    exact = fine.displacement(fine_beam.end)[-1] - solution.displacement(beam.end)[-1]
    assert 0.5 < np.linalg.norm(solution.error(beam.end)) / np.linalg.norm(exact) < 2.0


def test_motions_of_supports_and_full_turns_are_kept():
    beam = bf.Beam(LINE, 8, bf.BilinearANCF(bf.Structural(), "reduced"), SECTION, STEEL)
    turns = bf.Prescribed(beam.end, rotation=5.0 * np.pi)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), turns]), steps=10)
    assert solution.error(lambda s: s.rotation(beam.end)[-1]) == pytest.approx(0.0, abs=1e-9)
    assert abs(solution.error(lambda s: s.rotation(beam.at(0.5))[-1])) < 0.1


@pytest.mark.parametrize("order", [1, 2])
def test_a_section_that_yields_is_led_through_the_rows_again(order):
    def made(elements):
        beam = bf.Beam(bf.Line((0, 0), (0.1, 0)), elements, bf.CRBF(order), YIELDING)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 900.0))])
        return beam, bf.solve_static(model, steps=20)

    beam, solution = made(4)
    fine_beam, fine = made(128)
    exact = fine.displacement(fine_beam.end)[-1] - solution.displacement(beam.end)[-1]
    assert 0.5 < np.linalg.norm(solution.error(beam.end)) / np.linalg.norm(exact) < 2.0


def test_what_is_no_static_result_is_refused():
    beam, solution = cantilever(bf.CRBF(2), 2, bent)
    with pytest.raises(bf.InputError, match="quantity is a function of a solution"):
        solution.error("tip")
    with pytest.raises(bf.InputError, match="must return a number"):
        solution.error(lambda s: "tip")
    with pytest.raises(bf.InputError, match="row must be between -2 and 1"):
        solution.error(beam.end, row=2)
    motion = bf.simulate(solution.model, 1e-4, 1e-5)
    with pytest.raises(bf.InputError, match="static solutions only"):
        motion.error(beam.end)


def test_estimates_warn_of_nothing():
    beam = bf.Beam(LINE, 2, bf.CRBF(2), SECTION, STEEL)
    with pytest.warns(bf.UnitsWarning):
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, EI))], units="N, mm")
    solution = bf.solve_static(model)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution.error(beam.end)


def effectivities(seeds):
    """Return the effectivity of the displacements of random coarse models that are off by less than 5 %."""
    found = []
    for seed in seeds:
        recipe = coarse_recipe(seed)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                built, meshes = recipe.build(), [fine_recipe(recipe, elements).build() for elements in (24, 72)]
                solution = bf.solve_static(built.model)
                estimate = solution.error(lambda s, built=built: displacements(built, s))
                coarser, exact = (displacements(mesh, bf.solve_static(mesh.model)) for mesh in meshes)
            except bf.BeamfemError:  # limit points, mostly
                continue
        off = np.linalg.norm(exact - displacements(built, solution), axis=1)
        known = np.linalg.norm(exact - coarser, axis=1).max() < 0.2 * off.max()
        if known and 1e-8 < off.max() / np.linalg.norm(exact, axis=1).max() < 0.05:
            found.append(np.linalg.norm(estimate, axis=1).max() / off.max())
    return np.array(found)


def require_effective(seeds):
    ratios = effectivities(seeds)
    assert len(ratios) > 0.25 * len(seeds)
    assert np.mean((ratios > 0.5) & (ratios < 2.0)) >= 0.95
    assert np.mean((ratios > 0.2) & (ratios < 5.0)) >= 0.99


@pytest.mark.slow
def test_random_models_carry_the_errors_of_their_displacements():
    require_effective(range(24))


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 300, 100))
def test_300_random_models_carry_the_errors_of_their_displacements(first):
    require_effective(range(first, first + 100))
