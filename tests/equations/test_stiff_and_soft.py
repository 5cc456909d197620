"""Stiffnesses far apart in one model: what is found is right to the last digit, or it is said that it is not."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import csr_array
from shooting import Member, solved

import beamfem as bf
from beamfem.equations.equations import STATICS
from beamfem.equations.system import system_of
from beamfem.precision.mixed_tangent import negative_eigenvalues
from beamfem.precision.roundoff import lost_digits

EI, EA = 115.0, 5.5e6
STRUCTURAL_ANCF = bf.Element(bf.Cubic(), bf.Gradients(), bf.Structural())


def cantilever(element, elements, axial, shear, factor):
    section = bf.Section.from_stiffness(axial, shear, EI, mass=1.0, rotary_inertia=1e-4)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, factor * EI))])


def shot(axial, shear, factor):
    """Tip displacement of Reissner's cantilever, and its moment at the clamp."""
    member = Member(1.0, 0.0, 0.0, EI, 1.0 / axial, 1.0 / shear)
    force = factor * EI
    (moment,) = solved(lambda x: member.run((0, 0, 0, 0, force, x[0]))[5] / EI, [0.8 * force])
    end = member.run((0, 0, 0, 0, force, moment))
    return np.array([end[0] - 1.0, end[1]]), moment


def balance(solution, beams, loads):
    """Forces and moment about the origin of reactions and loads, relative to the largest load."""
    total = np.zeros(3)
    for point in (point for beam in beams for point in (beam.start, beam.end)):
        try:
            force = solution.reaction(point)[-1]
        except bf.InputError:
            continue
        x, y = solution.position(point)[-1]
        total += [*force[:2], force[2] + x * force[1] - y * force[0]]
    for point, force in loads:
        x, y = solution.position(point)[-1]
        total += [*force, x * force[1] - y * force[0]]
    return np.abs(total).max() / max(np.abs(force).max() for _, force in loads)


@pytest.mark.parametrize("ratio", [1e-2, 1e2, 1e4, 1e6, 1e8])
@pytest.mark.parametrize(("axial", "shear"), [(1.0, None), (None, 1.0)], ids=["shear-stiff", "axially-stiff"])
def test_a_cantilever_is_right_whatever_its_shear_and_axial_stiffness(ratio, axial, shear):
    """Statics gave up from a shear stiffness of 20 E A on; against shooting with Reissner's equations."""
    axial, shear = (EA, ratio * EA) if shear is None else (ratio * EA, EA)
    beam, model = cantilever(bf.CRBF(4), 6, axial, shear, 1.0)
    solution = bf.solve_static(model)
    tip, moment = shot(axial, shear, 1.0)
    assert solution.displacement(beam.end)[-1] == pytest.approx(tip, abs=1e-7)
    assert solution.reaction(beam.start)[-1] == pytest.approx([0.0, -EI, -moment], rel=1e-6, abs=1e-6 * EI)
    assert solution.statistics.digits > 4.0
    assert solution.iterations < 30


@pytest.mark.parametrize("element", [bf.CRBF(1), bf.CRBF(3), STRUCTURAL_ANCF], ids=["CRBF-1", "CRBF-3", "ANCF"])
@pytest.mark.parametrize("shear", [1e9, 1e10, 1e12])
def test_a_shear_rigid_cantilever_takes_the_iterations_of_a_soft_one(element, shear):
    elements = 8 if element.name == bf.CRBF(3).name else 20
    beam, model = cantilever(element, elements, EA, shear, 3.0)
    solution = bf.solve_static(model)
    tip, _ = shot(EA, shear, 3.0)
    assert solution.displacement(beam.end)[-1] == pytest.approx(tip, abs=2.5e-3)
    assert solution.iterations <= 30
    assert balance(solution, [beam], [(beam.end, (0.0, 3.0 * EI))]) < 1e-8


def test_the_path_of_a_shear_rigid_cantilever_ends_where_statics_does():
    beam, model = cantilever(bf.CRBF(3), 4, EA, 1e6 * EA, 3.0)
    path = bf.trace_equilibrium(model, until=1.0)
    assert path[-1].displacement(beam.end) == pytest.approx(bf.solve_static(model).displacement(beam.end)[-1], abs=1e-8)
    assert path.statistics.digits > 4.0
    assert not path.limit_points
    assert not path.bifurcations


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e8])
def test_a_shear_stiff_cantilever_swings_as_the_theory_says(ratio):
    """Released from a tip force P: u = sum 4 P L^3 / (E I b_n^4) cos w_n t, w_n = b_n^2 (E I / (m L^4))^(1/2)."""
    beam, loaded = cantilever(bf.CRBF(3), 4, EA, ratio * EA, 1e-3)
    roots = np.array([1.87510407, 4.69409113, 7.85475744, *(np.pi * (np.arange(4, 12) - 0.5))])
    time = 0.5 * 2.0 * np.pi / (roots[0] ** 2 * np.sqrt(EI))
    motion = bf.simulate(bf.Model([beam], [bf.Clamp(beam.start)]), time, time / 200, start=bf.solve_static(loaded)[-1])
    exact = 1e-3 * np.sum(4.0 / roots**4 * np.cos(roots**2 * np.sqrt(EI) * time))
    assert motion.displacement(beam.end)[-1, 1] == pytest.approx(exact, rel=0.01)


SOFT = 2e11 * 1e-8 / 12.0  # E I of a square steel bar, 10 mm


def chain(order, ratio, load, element, angle=0.0, unit=1.0, ends=1):
    """Bars one metre long, s soft and h hard, the first clamped, the last loaded or clamped as well."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    beams = []
    for i, kind in enumerate(order):
        modulus = 2e11 * (ratio if kind == "h" else 1.0)
        area = modulus * 1e-4
        section = bf.Section.from_stiffness(area, area / 3.12, modulus * 1e-8 / 12 * unit**2, 1.0, 1e-4)
        ends_at = tuple(unit * turn @ (i, 0.0)), tuple(unit * turn @ (i + 1, 0.0))
        beams.append(bf.Beam(bf.Line(*ends_at), 4, element, section))
    joints = [bf.Rigid(a.end, b.start) for a, b in pairwise(beams)]
    force = tuple(turn @ (0.0, load * SOFT))
    supports = [bf.Clamp(beams[0].start)] + ([bf.Clamp(beams[-1].end)] if ends == 2 else [])
    point = beams[-1].end if ends == 1 else beams[-1].start
    return bf.Model(beams, supports, [bf.PointForce(point, force)], joints=joints), beams, (point, force), turn


def small_deflection(order, ratio):
    """Deflection of the tip by a unit force, soft E I = 1: unit-load theorem with shear, exact for small loads."""
    n = len(order)
    shear = SOFT / (2e7 / 3.12)
    total = 0.0
    for i, kind in enumerate(order):
        flexibility = 1.0 / ratio if kind == "h" else 1.0
        total += flexibility * (((n - i) ** 3 - (n - i - 1) ** 3) / 3.0 + shear)
    return total


@pytest.mark.filterwarnings("ignore::beamfem.errors.RoundOffWarning")  # of 4 digits, and 3.6 are asked for
@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize("ratio", [1e4, 1e8, 1e9])
@pytest.mark.parametrize("order", ["sh", "hs", "shs", "hsh"])
def test_a_chain_of_soft_and_hard_bars_under_a_small_load_keeps_its_digits(order, ratio, angle):
    """Reactions and loads were out of balance by up to 3e4 times the load; closed form of the tip's deflection."""
    model, beams, load, turn = chain(order, ratio, 1e-7, bf.CRBF(3), angle)
    solution = bf.solve_static(model)
    assert balance(solution, beams, [load]) < 1e-4
    # the last bits decide: over 108 such chains the mean is 6.9 and the least 3.8, whatever the order of summation
    assert solution.statistics.digits > 3.6
    across = (solution.displacement(load[0])[-1] @ turn)[1]
    assert across == pytest.approx(1e-7 * small_deflection(order, ratio), rel=1e-7)


def test_a_chain_in_millimetres_is_the_same_chain():
    found = []
    for unit in (1.0, 1000.0):
        model, beams, load, _ = chain("hs", 1e8, 1e-7, bf.CRBF(2), 0.3, unit)
        solution = bf.solve_static(model)
        assert balance(solution, beams, [load]) < 1e-6 * unit
        found.append(solution.displacement(load[0])[-1] / unit)
    assert found[1] == pytest.approx(found[0], rel=1e-6)


def test_a_chain_clamped_at_both_ends_balances():
    model, beams, load, _ = chain("sh", 1e8, 1e-3, bf.CRBF(2), 0.4, ends=2)
    assert balance(bf.solve_static(model), beams, [load]) < 1e-6


def test_section_forces_at_the_ends_of_a_hard_bar_are_those_of_its_load():
    model, beams, (_, force), _ = chain("hs", 1e8, 1e-5, bf.CRBF(2), 0.2)
    found = bf.solve_static(model).section_forces(beams[0])
    size = np.hypot(*force)
    assert np.abs(found.shear[-1, [0, -1]]) == pytest.approx(size, rel=1e-5)
    assert np.abs(found.moment[-1, [0, -1]]) == pytest.approx(size * np.array([2.0, 1.0]), rel=1e-5)


def test_the_path_of_a_soft_bar_with_a_hard_one_balances():
    model, beams, (point, force), _ = chain("hs", 1e8, 1e-3, bf.CRBF(2))
    path = bf.trace_equilibrium(model, until=1.0)
    assert path.statistics.digits > 4.0
    assert balance(path, beams, [(point, force)]) < 1e-6


def test_round_off_is_named_where_it_takes_all_digits():
    model, *_ = chain("hsh", 1e15, 1e-12, bf.CRBF(2), 0.7)
    with pytest.raises(bf.ConvergenceError, match="round-off leaves no digit"):
        bf.solve_static(model)


def test_few_digits_are_said():
    model, *_ = chain("hsh", 1e11, 1e-7, bf.CRBF(2), 0.7)
    with pytest.warns(bf.RoundOffWarning, match="round-off leaves [123] digits of the forces"):
        solution = bf.solve_static(model)
    assert solution.statistics.digits < 4.0
    assert "round-off leaves" in solution.statistics.ended


def test_negative_eigenvalues_are_counted_block_by_block():
    """Graded bands of any sign; at once they took up to 15 s, for a path through 64 coordinates minutes."""
    rng = np.random.default_rng(3)
    for size in (1, 2, 5, 40, 150, 400):
        for width in (1, 4, 11):
            matrix = np.zeros((size, size))
            for beside in range(min(width + 1, size)):
                entries = rng.standard_normal(size - beside) * 10.0 ** rng.uniform(-6.0, 0.0, size - beside)
                # small diagonals need pivots of two rows
                matrix += np.diag(entries * (0.1 if beside == 0 else 1.0), beside)
            matrix += np.triu(matrix, 1).T
            assert negative_eigenvalues(csr_array(matrix)) == np.sum(np.linalg.eigvalsh(matrix) < 0.0)


@pytest.mark.parametrize("stiffness", [1.0, 1e6, 1e10])
def test_what_a_block_cannot_eliminate_waits_for_the_next(stiffness):
    """A held chain of pairs of springs whose forces are unknowns too: a part that ends between two is as stiff."""
    rng, count = np.random.default_rng(5), 130
    for _ in range(20):
        matrix = np.zeros((3 * count, 3 * count))
        place, forces = np.arange(0, 3 * count, 3), np.arange(3 * count).reshape(-1, 3)[:, 1:]
        matrix[place, place] = 0.1 * rng.standard_normal(count)
        for force in forces.T:
            matrix[place, force] = matrix[force, place] = -1.0
            matrix[force[:-1], place[1:]] = matrix[place[1:], force[:-1]] = 1.0
            matrix[force, force] = -1.0 / stiffness
        held = matrix[1:, 1:]
        assert negative_eigenvalues(csr_array(held)) == np.sum(np.linalg.eigvalsh(held) < 0.0)


@pytest.mark.slow
def test_eigenvalues_of_a_matrix_without_narrow_places_are_not_counted():
    matrix = np.zeros((3200, 3200))
    matrix[:1600, 1600:] = np.random.default_rng(0).standard_normal((1600, 1600))
    assert negative_eigenvalues(csr_array(matrix + matrix.T)) is None


@pytest.mark.parametrize(("elements", "angle"), [(200, 0.7), (300, 0.3), (500, 0.7), (500, 1.1)])
@pytest.mark.parametrize("share", [0.9, 0.97, 1.1])
def test_a_finely_divided_column_is_stable_below_its_buckling_load_whoever_counts(elements, angle, share):
    """Found with a state of another model: round-off in the stiffness exceeded that of bending, and counted as less."""
    thin, along = 1e-5, np.array([np.cos(angle), np.sin(angle)])
    modulus, inertia = 2e11, thin**4 / 12.0
    beam = bf.Beam(
        bf.Line((0, 0), along), elements, bf.CRBF(3), bf.Rectangle(thin, thin), bf.Material(modulus, 0.3, 7800.0)
    )
    load = share * np.pi**2 * modulus * inertia / 4.0
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, -load * along)])
    system = system_of(model, static=True)
    straight = np.array(system.reference)
    shortening = load / (modulus * thin**2)
    straight[system.positions] *= 1.0 - shortening
    rest = np.zeros_like(straight)
    state = bf.PathState(straight, rest, rest, 1.0, model)
    assert state.stable == (share < 1.0)


@pytest.mark.parametrize("element", [bf.ShearRigid(stretchable=False), bf.ANCF(bf.ElasticLine()), bf.CRBF(3)])
@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1.0, 1e3, 1e4, 1e6])
def test_a_block_keeps_its_digits_with_stress_resultants_as_unknowns_in_any_unit(element, unit):
    """In a model of 1000 its flexibility was below round-off beside one: the plain tangent was right, and given up."""
    block = bf.Beam(
        bf.Line((0.0, 0.0), (0.8 * unit, 0.6 * unit)),
        12,
        element,
        bf.Rectangle(unit, unit),
        bf.Material(7e10, 0.3, 2700.0),
    )
    force = 7e10 * unit**2 / 12.0
    model = bf.Model([block], [bf.Clamp(block.start)], [bf.PointForce(block.end, (0.3e-3 * force, -1e-3 * force))])
    system = system_of(model, static=True)
    assert lost_digits(system, system.reference, 1.0, STATICS) < 1e-8
    path = bf.trace_equilibrium(model, 1.0)
    static = bf.solve_static(model)
    expected = pytest.approx(static.displacement(block.end)[-1], abs=1e-9 * unit)
    assert path.displacement(block.end)[-1] == expected
