"""Newton's method on a band finds what it finds with pivoting: equilibria, iterations, endings, negative pivots."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.newton.newton import (
    BandProblem,
    Newton,
    PivotedProblem,
    PrescribedStep,
    Termination,
)

SECTION, MATERIAL = bf.Rectangle(0.05, 0.05), bf.Material(1e9, 0.3, 1000.0)
EI = MATERIAL.youngs_modulus * 0.05**4 / 12.0
LINE = bf.Line((0.0, 0.0), (1.0, 0.0))
ELEMENTS = (bf.CRBF(1, integration="reduced"), bf.CRBF(2), bf.ANCF(), bf.CRBF(4))
NAMES = [element.name for element in ELEMENTS]


def cantilever(beam):
    loads = bf.PointForce(beam.end, (-0.5 * EI, EI)), bf.PointForce(beam.at(0.3), (0.0, -EI)), bf.Gravity((0.0, -9.81))
    return bf.Model([beam], [bf.Clamp(beam.start)], loads)


def between_pin_and_roller(beam):
    """Its middle is loaded, and the last element as well, between its nodes."""
    loads = bf.PointForce(beam.at(0.5), (0.0, -EI)), bf.PointMoment(beam.at(0.97), 0.5 * EI)
    return bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], loads)


def on_springs(beam):
    springs = [bf.Spring(beam.at(share), (200.0 * EI, 50.0 * EI), EI) for share in (0.0, 0.5, 1.0)]
    foundation = bf.Foundation(beam, (EI, 10.0 * EI))
    loads = bf.PointForce(beam.at(0.25), (0.0, EI)), bf.PointForce(beam.end, (EI, EI))
    return bf.Model([beam], [*springs, foundation], loads)


def moved(beam):
    """Both ends are moved, and the middle is held."""
    ends = bf.Prescribed(beam.start, 0.0, 0.0, 0.3), bf.Prescribed(beam.end, ux=-0.01, rotation=-0.2)
    return bf.Model([beam], [*ends, bf.Prescribed(beam.at(0.5), uy=0.02)])


def clamped_in_the_middle(beam):
    return bf.Model([beam], [bf.Clamp(beam.at(0.5))], [bf.PointForce(beam.end, (0.0, EI))])


def followed(beam):
    loads = bf.DistributedLoad(beam, (0.0, EI), follower=True), bf.PointForce(beam.end, (0.0, EI), follower=True)
    return bf.Model([beam], [bf.Clamp(beam.start)], loads)


def curled(beam):
    muscle = bf.Actuation(beam, curvature=lambda s: 2.0 * s - 0.5, stretch=0.02)
    return bf.Model([beam], [bf.Clamp(beam.start)], [muscle, bf.PointForce(beam.end, (0.0, EI))])


CASES = (cantilever, between_pin_and_roller, on_springs, moved, clamped_in_the_middle, followed, curled)


def beam_of(element, elements=9, curve=LINE):
    return bf.Beam(curve, elements, element, SECTION, MATERIAL)


def both(model, settings=None):
    """Return the results on a band and with pivoting."""
    system, used = system_of(model, static=True), settings or Newton()
    given = system, system.reference, 1.0, used, PrescribedStep(system, system.reference, 1.0)
    return BandProblem(*given, None).find(), PivotedProblem(*given).find()


def assert_alike(model, settings=None):
    one, two = both(model, settings)
    assert np.abs(one.state - two.state).max() <= 1e-11
    assert (one.iterations, one.negative_pivots) == (two.iterations, two.negative_pivots)
    assert one.ended is two.ended
    return one, two


@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
@pytest.mark.parametrize("case", CASES)
def test_pivots_change_no_equilibrium(case, element):
    model = case(beam_of(element))
    one, _ = assert_alike(model)
    assert one.ended.good
    assert np.abs(one.state - system_of(model, static=True).reference).max() > 0.01


@pytest.mark.parametrize("elements", [2, 3, 8])
def test_odd_and_even_numbers_of_pivots(elements):
    assert_alike(cantilever(beam_of(bf.CRBF(2), elements)))


@pytest.mark.parametrize(("load", "negative"), [(0.9, 0), (1.1, 1), (8.9, 1), (9.1, 2), (25.1, 3)])
def test_negative_pivots_count_the_buckling_loads_below(load, negative):
    """Euler: (2 k - 1)^2 pi^2 EI / (4 L^2), k = 1, 2, ..., for a slender clamped column."""
    section = bf.Rectangle(0.001, 0.001)
    beam = bf.Beam(LINE, 40, bf.CRBF(2), section, MATERIAL)
    force = load * np.pi**2 / 4.0 * MATERIAL.youngs_modulus * 0.001**4 / 12.0
    one, two = assert_alike(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-force, 0.0))]))
    assert (one.negative_pivots, two.negative_pivots) == (negative, negative)


def test_iterations_that_run_out_or_lead_nowhere_end_alike():
    beam = beam_of(bf.CRBF(2))
    one, _ = assert_alike(cantilever(beam), Newton(iterations=3))
    assert one.ended is Termination.EXHAUSTED
    assert_alike(cantilever(beam), Newton(independent_stresses=False))
    far = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1e9 * EI))])
    one, _ = assert_alike(far)
    assert one.ended is Termination.DIVERGED


def test_a_mechanism_is_singular_on_a_band():
    beam = beam_of(bf.CRBF(2))
    loose = bf.Model([beam], [bf.Roller(beam.start), bf.Roller(beam.end)], [bf.PointForce(beam.end, (1.0, 0.0))])
    on_band, _ = both(loose)
    assert on_band.ended is Termination.SINGULAR


def test_a_chain_of_20_000_elements_bends_as_the_elastica():
    """P L^2 / EI = 5, L / h = 100, structural forces: tip of the Reissner beam, k_s = 5 / 6."""
    beam = bf.Beam(LINE, 20_000, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    force = 5.0 * 2e11 * 0.01**4 / 12.0
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))]))
    assert solution.position(beam.end)[-1] == pytest.approx((1.0 - 0.38764432832607, 0.71385896416489), abs=1e-10)
    assert solution.statistics.steps == 1


def test_pivots_cost_no_iteration(monkeypatch):
    """What a band cannot hold takes the same corrections, prescribed motions or not."""
    beam = bf.Beam(LINE, 6, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    force = bf.PointForce(beam.at(0.5), (0.0, 500.0))
    for lift in (0.0, 0.1):
        model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=lift)], [force])
        system, settings = system_of(model, static=True), bf.Newton()
        given = system, system.reference, 1.0, settings, PrescribedStep(system, system.reference, 1.0)
        compiled, general = (problem.find() for problem in (BandProblem(*given, 0), PivotedProblem(*given, 0)))
        assert general.first == pytest.approx(compiled.first, rel=1e-6)
        assert general.iterations == compiled.iterations
