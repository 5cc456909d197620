"""Bifurcations that lie close together, and branches, against closed forms of Reissner's column."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipk
from slow_values import mostly_slow
from test_path import LIMIT_HEIGHT, SOFT, bar_force

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.solve.modes.pencil import UNROTATED
from beamfem.solve.paths.trace import trace_equilibrium

FOUNDATION = 4.0 * np.pi**4  # where the first two modes of a hinged column with E I = L = 1 buckle together


def buckling_load(wave, foundation=0.0, slenderness=1e3, stiffness=1.0):
    """Load of a Reissner column with E I = 1, nu = 0 that buckles into v = sin(wave s), exact.

    With the stretch c = 1 - P / E A: Q = G A (v' - c phi) = n + P phi, n' = k v, E I phi'' = -c n - P v'.
    """
    axial = 12.0 * slenderness**2 * stiffness
    shear = axial * 5.0 / 12.0

    def unbalanced(load):
        c = 1.0 - load / axial
        of_angle = (load * wave - c * foundation / wave) * (load + shear * c)
        return of_angle - stiffness * wave**2 * (shear * wave + foundation / wave)

    thin = stiffness * wave**2 + foundation / wave**2
    return brentq(unbalanced, 0.9 * thin, 1.1 * thin, xtol=1e-13)


def column(slenderness=1e3, stiffness=1.0, angle=0.0, unit=1.0, elements=8):
    """A straight beam with E I = `stiffness`, L = 1 in a unit of length, and the direction it points to."""
    side = unit / slenderness
    section = bf.Section(area=side**2, second_moment=side**4 / 12.0)
    material = bf.Material(12.0 * stiffness * unit**2 / side**4, 0.0, 1.0)
    way = np.array([np.cos(angle), np.sin(angle)])
    return bf.Beam(bf.Line((0, 0), tuple(unit * way)), elements, bf.CRBF(4), section, material), way


def hinged(gap, angle=0.0, unit=1.0, sideways_only=True):
    """A hinged column on a Winkler foundation k = 4 pi^4 (1 + gap) under a unit load along it."""
    beam, way = column(angle=angle, unit=unit)
    k = FOUNDATION * (1.0 + gap) / unit**2
    supports = [bf.Pin(beam.start), bf.Roller(beam.end, (-way[1], way[0]))]
    supports.append(bf.Foundation(beam, (0.0 if sideways_only else k, k)))
    return beam, bf.Model([beam], supports, [bf.PointForce(beam.end, tuple(-way))])


def clamped(stiffnesses, angle=0.0):
    """Cantilever columns that have nothing to do with each other, each under a unit load."""
    made = [column(stiffness=value, angle=angle) for value in stiffnesses]
    beams = [beam for beam, _ in made]
    loads = [bf.PointForce(beam.end, tuple(-way)) for beam, way in made]
    return beams, bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], loads)


def waves(beam, state):
    """Shares of sin(pi s) and sin(2 pi s) in the deflection of a column along x."""
    s = np.linspace(0.05, 0.95, 19)
    sideways = np.array([state.displacement(beam.at(float(at)))[1] for at in s])
    return np.abs([sideways @ np.sin(number * np.pi * s) for number in (1, 2)]) / 10.0


def loads_of(path):
    return [found.load_factor for found in path.bifurcations]


@pytest.mark.parametrize("gap", [pytest.param(1e-2, marks=pytest.mark.slow), 1e-3, 1e-4, -1e-2])
def test_two_close_buckling_loads_are_told_apart_and_each_branch_leads_to_its_own_mode(gap):
    beam, model = hinged(gap)
    path = trace_equilibrium(model, 60.0)
    expected = {number: buckling_load(number * np.pi, FOUNDATION * (1.0 + gap)) for number in (1, 2)}
    order = sorted(expected, key=expected.get)
    assert loads_of(path) == pytest.approx([expected[number] for number in order], rel=1e-8)
    for found, number in zip(path.bifurcations, order, strict=True):
        branch = trace_equilibrium(model, lambda state: max(waves(beam, state)) > 0.05, start=found, points=40)
        shares = waves(beam, branch[-1])
        assert shares[number - 1] > 0.05
        assert shares[2 - number] < 1e-6


@mostly_slow("angle", [0.0, 0.3, 2.5], quick=(1,))
@pytest.mark.parametrize("stiffnesses", [(1.0, 1.003), (1.0, 1.0001), (1.0, 1.003, 1.0031)])
def test_columns_of_nearly_equal_stiffness_have_the_load_of_each_at_any_angle(stiffnesses, angle):
    beams, model = clamped(stiffnesses, angle)
    path = trace_equilibrium(model, 3.0)
    expected = [buckling_load(0.5 * np.pi, stiffness=value) for value in stiffnesses]
    assert loads_of(path) == pytest.approx(expected, rel=1e-8)
    for number, found in enumerate(path.bifurcations):
        branch = trace_equilibrium(model, points=4, start=found)
        turned = np.abs([branch.rotation(beam.end)[-1] for beam in beams])
        assert turned[number] > 0.01
        assert np.delete(turned, number).max() < 1e-4 * turned[number]


def gap_with_foundation_along(gap):
    """Gap of the first two loads where the foundation k holds the column along its axis as well, to second order.

    It takes k P / (2 E A) (1 - s^2) of the normal force: to a share of 1 - 1.6e-5 (2/3 - 1 / (2 n^2 pi^2)) of the whole
    in mode n, and it couples both modes by 1.6e-5 (2 / pi^2) (1 + 1/9), which a gap of 3e-3 feels.
    """
    taken = FOUNDATION / (2.0 * 12.0 * 1e6)
    loads = [buckling_load(n * np.pi, FOUNDATION * (1.0 + gap)) for n in (1, 2)]
    one, two = (load * (1.0 + taken * (2 / 3 - 0.5 / (n * np.pi) ** 2)) for n, load in zip((1, 2), loads, strict=True))
    return np.hypot(one - two, 2.0 * loads[0] * taken * (2.0 / np.pi**2) * (1.0 + 1 / 9))


@pytest.mark.parametrize(("angle", "unit"), [(0.3, 1.0), (-0.3, 1.0), (2.5, 1.0), (0.0, 1e3), (1.234, 1e-3)])
def test_close_buckling_loads_depend_on_neither_direction_nor_units(angle, unit):
    plain = loads_of(trace_equilibrium(hinged(1e-4, sideways_only=False)[1], 60.0))
    moved = loads_of(trace_equilibrium(hinged(1e-4, angle, unit, sideways_only=False)[1], 60.0))
    assert plain[1] - plain[0] == pytest.approx(gap_with_foundation_along(1e-4), rel=3e-4)
    assert moved == pytest.approx(plain, rel=1e-8)


@pytest.mark.parametrize("gap", [1e-2, 1e-4])
def test_the_tangent_loses_an_eigenvalue_at_each_bifurcation(gap):
    """All eigenvalues of the assembled tangent, in equilibria a little below and above."""
    _, model = hinged(gap)
    path = trace_equilibrium(model, 60.0)
    system = system_of(model, static=True)
    width = 0.2 * (loads_of(path)[1] - loads_of(path)[0])
    counts = []
    for load in loads_of(path):
        for beside in (load - width, load + width):
            p = trace_equilibrium(model, beside).p[-1]
            tangent = linearise(system, p, 0.0 * p, 0.0 * p, beside, STATICS)[1].sparse(UNROTATED)
            counts.append(int((np.linalg.eigvalsh(tangent.toarray()) < 0.0).sum()))
    assert counts == [0, 1, 1, 2]


@pytest.mark.parametrize("angle", [0.0, 0.3])
def test_a_double_bifurcation_is_listed_once_for_each_of_its_modes(angle):
    beams, model = clamped((1.0, 1.0), angle)
    path = trace_equilibrium(model, 3.0)
    assert loads_of(path) == pytest.approx([buckling_load(0.5 * np.pi)] * 2, rel=1e-8)
    assert loads_of(path)[0] == loads_of(path)[1]
    one, other = (found.mode for found in path.bifurcations)
    assert abs(one @ other) < 1e-6 * (one @ one)
    for found in path.bifurcations:
        branch = trace_equilibrium(model, points=4, start=found)
        turns = np.array([branch.rotation(beam.end)[-1] for beam in beams])
        # any combination of the modes is one; on a branch each column is straight or bent as its elastica
        bent = turns[np.abs(turns) > 1e-6]
        assert np.abs(bent).max() > 1e-3
        elastica = (2.0 / np.pi * ellipk(np.sin(0.5 * bent) ** 2)) ** 2
        assert branch.load_factor[-1] / found.load_factor == pytest.approx(elastica, rel=2e-5)


@pytest.mark.parametrize(("share", "count"), [(0.9999, 0), (1.0001, 1)])
def test_a_bifurcation_beyond_the_end_of_the_path_is_not_listed(share, count):
    _, model = clamped((1.0,))
    path = trace_equilibrium(model, share * buckling_load(0.5 * np.pi))
    assert len(path.bifurcations) == count


def guided(elements):
    """Half of a clamped cosine arch (L 100, h 6, t 0.8, b 10, E 1800; N, mm) whose middle is guided downwards."""
    beam = bf.Beam(
        bf.Parametric(lambda u: (u, 3.0 * (1.0 - np.cos(2.0 * np.pi * u / 100.0))), 0.0, 50.0),
        elements,
        bf.CRBF(3),
        bf.Rectangle(10.0, 0.8),
        bf.Material(1800.0, 0.3, 1e-9),
    )
    supports = [bf.Clamp(beam.start), bf.Prescribed(beam.end, ux=0.0, rotation=0.0)]
    return beam, bf.Model([beam], supports, [bf.PointForce(beam.end, (0.0, -0.5))])


def uneven(beam, state):
    """How far the half arch is from being antisymmetric about its own middle, as it is on the primary path."""
    quarters = state.displacement(beam.at(0.25)) + state.displacement(beam.at(0.75))
    return float(np.abs(quarters - state.displacement(beam.end)).max())


@pytest.fixture(scope="module")
def bistable():
    beam, model = guided(8)
    primary = trace_equilibrium(model, lambda state: state.displacement(beam.end)[1] < -11.5)
    return beam, model, primary


@pytest.mark.parametrize("direction", [1, -1])
def test_a_branch_of_a_bistable_beam_comes_back_to_its_path_at_the_bifurcation_that_the_path_has_there(
    bistable, direction
):
    beam, model, primary = bistable
    first, last = primary.bifurcations[0], primary.bifurcations[-1]
    # the reference has four digits, and eight elements are 2e-5 from the limit
    assert last.load_factor == pytest.approx(-1.598, abs=6e-5)
    branch = trace_equilibrium(model, points=40, start=first, direction=direction)
    assert branch.limit_points == ()
    assert [found.load_factor for found in branch.bifurcations[:2]] == pytest.approx(
        [last.load_factor, first.load_factor], rel=1e-8
    )
    assert branch.bifurcations[0].displacement(beam.end) == pytest.approx(last.displacement(beam.end), abs=1e-7)
    assert max(uneven(beam, state) for state in primary) < 1e-6 < 0.1 < uneven(beam, branch[5])


@pytest.mark.parametrize("direction", [1, -1])
def test_a_branch_is_left_onto_the_path_that_it_comes_back_to(bistable, direction):
    beam, model, primary = bistable
    branch = trace_equilibrium(model, points=40, start=primary.bifurcations[0])
    back = trace_equilibrium(model, points=4, start=branch.bifurcations[0], direction=direction)
    assert max(uneven(beam, state) for state in back) < 1e-5
    assert direction * (back.load_factor[1] - back.load_factor[0]) > 0.0


@mostly_slow("elements", [5, 6, 7, 10], quick=(1,))
def test_a_branch_comes_back_wherever_its_steps_fall(elements):
    beam, model = guided(elements)
    primary = trace_equilibrium(model, lambda state: state.displacement(beam.end)[1] < -11.5)
    known = np.array(loads_of(primary))
    branch = trace_equilibrium(model, points=40, start=primary.bifurcations[0])
    assert len(branch.bifurcations) >= 2
    for found in branch.bifurcations:
        assert np.abs(known - found.load_factor).min() < 1e-7


def test_bars_that_snap_together_have_a_limit_point_and_a_bifurcation_at_one_load():
    """Two equal bars of a von Mises truss: at the limit load of each, one may go on while the other comes back."""
    section = bf.Section(area=1.0, second_moment=10.0)
    bars = [bf.Beam(bf.Line((0, 0), (1.0, 0.4)), 1, bf.CRBF(1), section, SOFT) for _ in range(2)]
    supports = [support for one in bars for support in (bf.Pin(one.start), bf.Roller(one.end, (1.0, 0.0)))]
    model = bf.Model(bars, supports, [bf.PointForce(one.end, (0.0, -1.0)) for one in bars])
    path = trace_equilibrium(model, lambda state: state.displacement(bars[0].end)[1] < -1.2)
    limits = [bar_force(0.4 - height) for height in (LIMIT_HEIGHT, -LIMIT_HEIGHT)]
    assert [found.load_factor for found in path.limit_points] == pytest.approx(limits, rel=1e-7)
    assert loads_of(path) == pytest.approx(limits, rel=1e-7)
    branch = trace_equilibrium(model, points=4, start=path.bifurcations[0])
    moved = -np.array([branch.displacement(one.end)[-1, 1] for one in bars])
    assert moved.min() < 0.4 - LIMIT_HEIGHT < moved.max()
    assert bar_force(moved) == pytest.approx(branch.load_factor[-1], rel=1e-9)


def heated_bar(size=0.01):
    """A steel bar of 1 m between two pins; the load factor is its change of temperature [K]."""
    steel = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), bf.Rectangle(size, size), steel)
    return bar, bf.Model([bar], [bf.Pin(bar.start), bf.Pin(bar.end)], [bf.Temperature(bar, 1.0)])


@pytest.mark.parametrize("until", [8.0, 20.56, 200.0])
def test_the_first_step_of_a_branch_ends_where_the_path_ends(until):
    """Until 20.56 K the rows were 6.85, 48.5, ..., 1.2e8 K. A sine of amplitude a is longer by (pi a)^2 / 4."""
    bar, model = heated_bar()
    (first, *_) = bf.trace_equilibrium(model, 10.0).bifurcations
    branch = bf.trace_equilibrium(model, until, start=first)
    assert branch.load_factor[-1] == pytest.approx(until, rel=1e-12)
    assert branch.load_factor.max() <= until
    expected = 2.0 / np.pi * np.sqrt(1.2e-5 * until - np.pi**2 * 0.01**2 / 12.0)
    assert abs(branch.displacement(bar.at(0.5))[-1, 1]) == pytest.approx(expected, rel=2e-3)


def test_the_first_step_of_a_branch_is_not_beyond_a_condition_that_ends_the_path():
    _, model = heated_bar()
    (first, *_) = bf.trace_equilibrium(model, 10.0).bifurcations
    branch = bf.trace_equilibrium(model, lambda state: state.load_factor > 20.0, start=first)
    assert branch.load_factor[-2] <= 20.0 < branch.load_factor[-1] < 40.0


@pytest.mark.parametrize("direction", [1, -1])
def test_a_branch_that_comes_back_to_its_start_ends_there_as_closed(bistable, direction):
    _, model, primary = bistable
    branch = trace_equilibrium(model, points=200, start=primary.bifurcations[0], direction=direction)
    assert "the branch is closed" in branch.statistics.ended
    # it passes the bifurcation where it crosses the primary path again, and ends at that of its start
    loads = [primary.bifurcations[-1].load_factor, primary.bifurcations[0].load_factor]
    assert loads_of(branch) == pytest.approx(loads, rel=1e-8)
    assert len(branch.load_factor) < 100


def test_a_limit_point_under_a_prescribed_displacement_alone_advises_no_displacement():
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 2.0, 1.1), 8, bf.CRBF(3), bf.Rectangle(0.02, 0.02), bf.Material(1e9, 0.3, 1.0))
    supports = [bf.Pin(beam.start), bf.Pin(beam.end), bf.Prescribed(beam.at(0.3), uy=-0.5)]
    model = bf.Model([beam], supports)
    with pytest.raises(bf.LimitPointError) as raised:
        bf.solve_static(model)
    assert "prescribe a displacement" not in str(raised.value)
    assert 'snap="jump"' in str(raised.value)
