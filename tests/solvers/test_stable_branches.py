"""Statics that leave an unstable path for the stable branch, as a slow, damped structure does."""

from dataclasses import replace

import numpy as np
import pytest
from connectors import RigidLink
from history_laws import LAWS, bent_there_and_back
from shooting import solved, swept
from slow_values import mostly_slow
from test_multistable_chains import bars, random_chain

import beamfem as bf
from studies.stability import williams_toggle

MATERIAL = bf.Material(1.0, 0.0, 1.0)


def bistable(rise, thickness, supports=(), loads=(), half=False, elements=20):
    """The beam of Qiu, Lang and Slocum (2004), y = rise / 2 (1 - cos 2 pi x), clamped at its ends; or its left half.

    supports, loads: functions of the centre. Returns the beam, its centre, the model, and the unit E I h / L^3 [N].
    """
    curve = bf.Parametric(lambda x: (x, 0.5 * rise * (1.0 - np.cos(2.0 * np.pi * x))), 0.0, 0.5 if half else 1.0)
    beam = bf.Beam(curve, elements, bf.CRBF(3), bf.Rectangle(1.0, thickness), MATERIAL)
    centre = beam.end if half else beam.at(0.5)
    clamps = [bf.Clamp(beam.start)] if half else [bf.Clamp(beam.start), bf.Clamp(beam.end)]
    model = bf.Model([beam], [*clamps, *(make(centre) for make in supports)], [make(centre) for make in loads])
    return beam, centre, model, thickness**3 / 12.0 * rise


def led(rise, held=True, **guided):
    down = {"uy": -2.0 * rise, **guided}
    return lambda centre: bf.Prescribed(centre, **down, rotation=0.0) if held else bf.Prescribed(centre, **down)


@pytest.mark.parametrize("steps", [1, 20, 80])
def test_the_bistable_beam_of_compliant_mechanisms(steps):
    """Published: 740 E I h / L^3 at 0.16 h and -370 at 1.92 h; half of the beam is integrated by shooting."""
    rise, thickness = 0.02, 0.002
    beam, centre, model, unit = bistable(rise, thickness, [led(rise, ux=0.0)], half=True, elements=16)
    solution = bf.solve_static(model, steps, unstable="leave")
    assert solution.stable.all()
    force, down = -2.0 * solution.reaction(centre)[:, 1] / unit, -solution.displacement(centre)[:, 1] / rise
    assert (force.max(), down[force.argmax()]) == pytest.approx((740.0, 0.16), rel=0.03)
    assert (force.min(), down[force.argmin()]) == pytest.approx((-370.0, 1.92), rel=0.01)
    bending = thickness**3 / 12.0

    def end(start):
        slope, state = (lambda x: np.pi * rise * np.sin(2.0 * np.pi * x)), [0.0, 0.0, 0.0, *start]
        return swept(slope, 0.5, state, bending / thickness, 12.0 / 5.0 * bending / thickness)[:3]

    for row in np.flatnonzero((down > 0.17) & (down < 1.9))[:: max(steps // 8, 1)]:
        place = np.array([0.5, rise * (1.0 - down[row]), 0.0])
        found = -solution.reaction(beam.start)[row] / bending
        assert 2.0 * solved(lambda start, place=place: end(start) - place, found)[1] / rise == pytest.approx(
            -force[row], rel=1e-5, abs=0.01
        )


@pytest.mark.slow
@mostly_slow("held", [True, False])
def test_a_path_that_turns_back_where_it_has_long_been_unstable_advises_to_leave_it(held):
    _, centre, model, _ = bistable(0.1, 0.01, [led(0.1, held)])
    with pytest.raises(bf.LimitPointError, match=r'unstable from load factor .*unstable="leave" follows the stable'):
        bf.solve_static(model, 50)
    traced = bf.trace_equilibrium(model, until=1.0)
    solution = bf.solve_static(model, 50, unstable="leave")
    assert solution.stable.all()
    assert "loses its stability at a bifurcation" in solution.statistics.ended
    assert np.abs(solution.load_factor - traced.bifurcations[0].load_factor).min() < 1e-8
    assert solution.reaction(centre)[-1] == pytest.approx(traced.reaction(centre)[-1], rel=1e-6, abs=1e-12)


@pytest.mark.slow
@mostly_slow("rise", [0.02, 0.002, 0.00202, 0.002046], quick=(0, 3))  # the last two once halved their way to the point
def test_a_branch_is_followed_across_the_point_where_it_merges_into_the_primary_path(rise):
    """The branch of half the bistable beam returned to the path and ended there."""
    _, _, model, _ = bistable(rise, rise / 10.0, [led(rise, ux=0.0)], half=True, elements=10)
    primary = bf.trace_equilibrium(model, until=1.0)
    branch = bf.trace_equilibrium(model, until=1.0, start=primary.bifurcations[0])
    assert "the branch is closed" in branch.statistics.ended
    merging, start = (point.load_factor for point in branch.bifurcations)
    assert start == pytest.approx(primary.bifurcations[0].load_factor, rel=1e-7)
    assert min(abs(merging - point.load_factor) for point in primary.bifurcations) < 1e-7


@pytest.mark.parametrize("options", [{"snap": "jump"}, {"unstable": "leave"}])
@mostly_slow("held", [True, False])
def test_a_jump_starts_at_the_bifurcation_and_rests_in_a_stable_state(held, options):
    """Found in review: under 800 E I h / L^3 the beam rested on the unstable path, with a warning."""
    rise = 0.1
    unit = bistable(rise, 0.01)[3]
    hold = [lambda centre: bf.Prescribed(centre, rotation=0.0)] if held else []
    _, centre, model, _ = bistable(rise, 0.01, hold, [lambda centre: bf.PointForce(centre, (0.0, -800.0 * unit))])
    solution = bf.solve_static(model, **options)
    assert solution.stable.all()
    final = solution.displacement(centre)[-1, 1]
    assert final < -2.0 * rise
    # the straightened beam led to the same place from its other shape
    _, led_centre, led_model, _ = bistable(rise, 0.01, [lambda centre: bf.Prescribed(centre, uy=final, rotation=0.0)])
    led_there = bf.solve_static(led_model, unstable="leave")
    assert -led_there.reaction(led_centre)[-1, 1] / unit == pytest.approx(800.0, rel=1e-6)


def member(seed, disturbed=0.0):
    """A random arch, led or pushed at its centre out and back; disturbed: a force that none of its symmetries has."""
    rng = np.random.default_rng(seed)
    rise = 10 ** rng.uniform(-2.0, -0.8)
    thickness = rise / rng.uniform(1.5, 14.0)
    shape, pinned, held, forced = (int(rng.integers(k)) for k in (3, 2, 2, 2))
    heights = [
        lambda x: 0.5 * rise * (1.0 - np.cos(2.0 * np.pi * x)),
        lambda x: rise * np.sin(np.pi * x),
        lambda x: 4.0 * rise * x * (1.0 - x),
    ]
    curve = bf.Parametric(lambda x: (x, heights[shape](x)), 0.0, 1.0)
    beam = bf.Beam(curve, 16, bf.CRBF(3), bf.Rectangle(1.0, thickness), MATERIAL)
    centre, unit = beam.at(0.5), thickness**3 / 12.0 * rise
    end = bf.Pin if pinned and shape else bf.Clamp
    supports, turn = [end(beam.start), end(beam.end)], {"rotation": 0.0} if held else {}
    loads = [bf.PointForce(beam.at(0.3), (0.0, disturbed * rise / thickness * unit), scale=False)] if disturbed else []
    if forced:
        supports += [bf.Prescribed(centre, **turn)] if held else []
        push = bf.PointForce(centre, (0.0, -1500.0 * unit), amplitude=lambda factor: np.sin(2.0 * np.pi * factor))
        loads.append(push)
    else:
        down = lambda factor: -2.2 * rise * (1.0 - abs(1.0 - 2.0 * factor))  # noqa: E731
        supports.append(bf.Prescribed(centre, uy=down, **turn))
    return centre, bool(forced), bf.Model([beam], supports, loads)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(4), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(4, 54))])
def test_bistable_members_go_out_and_back_like_slightly_imperfect_ones(seed):
    found = []
    for disturbed, options in ((0.0, {"unstable": "leave"}), (0.01, {"snap": "jump"})):
        centre, forced, model = member(seed, disturbed)
        solution = bf.solve_static(model, at=np.linspace(0.0, 1.0, 41), **options)
        assert solution.stable.all()
        found.append((solution.displacement(centre) if forced else solution.reaction(centre))[:, 1])
    assert found[0] == pytest.approx(found[1], abs=2e-3 * np.abs(found[1]).max())


@pytest.mark.slow
@pytest.mark.parametrize("equal", [True, False])
@pytest.mark.parametrize("forced", [True, False])
@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2, 14))])
def test_multistable_chains_go_out_and_back_over_stable_states(seed, forced, equal):
    """Bars in series: their forces, and the stability of the whole, follow in closed form from their shortenings."""
    chain = random_chain(seed)
    end, model, units = bars([chain[0]] * len(chain) if equal else chain)
    if forced:
        size = 1.3 * max(unit.force(unit.peak) for unit in units)
        push = bf.PointForce(end, (0.0, -size), amplitude=lambda factor: np.sin(2.0 * np.pi * factor))
        model = replace(model, loads=[push])
    else:
        size = 2.2 * sum(height for _, _, height in chain)
        lead = bf.Prescribed(end, ux=0.0, uy=lambda factor: -size * (1.0 - abs(1.0 - 2.0 * factor)))
        model = replace(model, supports=[*model.supports[:-1], lead], loads=[])
    solution = bf.solve_static(model, 40, unstable="leave")
    assert solution.stable.all()
    at = solution.load_factor
    load = size * np.sin(2.0 * np.pi * at) if forced else -solution.reaction(end)[:, 1]
    places = np.array([np.zeros(len(at)), *(solution.displacement(beam.end)[:, 1] for beam in model.beams)])
    shortened = -np.diff(places, axis=0)
    forces = np.array([[unit.force(d) for d in row] for unit, row in zip(units, shortened, strict=True)])
    assert np.abs(forces - load).max() < 1e-9 * np.abs(forces).max()
    slopes = np.array(
        [
            [(unit.force(d + 1e-6) - unit.force(d - 1e-6)) / 2e-6 for d in row]
            for unit, row in zip(units, shortened, strict=True)
        ]
    )
    falling = np.sum(slopes < 0.0, axis=0)
    stable = (falling == 0) if forced else (falling == 0) | (falling == 1) & (np.sum(1.0 / slopes, axis=0) < 0.0)
    critical = np.append(np.diff(at) <= 1.01e-4 * at[1:], False)
    assert (stable | critical).all()
    assert critical.any()


@pytest.mark.parametrize("apart", [0.0, 1e-7, 1e-5, 1e-3])
def test_columns_that_buckle_at_nearly_one_load_all_buckle_and_keep_their_side(apart):
    """Elastica at 1.3 times Euler's load: the tip is 0.7229 L aside."""
    section, euler = bf.Rectangle(0.01, 0.01), np.pi**2 / 4.0 * 1e-8 / 12.0
    beams = [bf.Beam(bf.Line((3 * k, 0), (3 * k + 1, 0)), 6, bf.CRBF(3), section, MATERIAL) for k in range(3)]
    loads = [bf.PointForce(b.end, (-1.3 * euler * (1.0 - k * apart), 0.0)) for k, b in enumerate(beams)]
    solution = bf.solve_static(bf.Model(beams, [bf.Clamp(b.start) for b in beams], loads), 7, unstable="leave")
    assert solution.stable.all()
    aside = np.array([solution.displacement(beam.end)[:, 1] for beam in beams])
    assert np.abs(aside[:, -1]) == pytest.approx(0.7229 * np.ones(3), abs=1e-4 + 2.0 * apart)
    beyond = solution.load_factor > 0.8
    assert (np.sign(aside[:, beyond]) == np.sign(aside[:, -1:])).all()


def test_a_column_pulled_through_its_base_by_a_rigid_link_leaves_at_its_own_critical_load():
    """A load that always points at the base of a cantilever: pi^2 E I / L^2, here with a Lagrange multiplier."""
    column = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), bf.Rectangle(0.01, 0.01), MATERIAL)
    slider = bf.Beam(bf.Line((0, 0), (-0.1, 0)), 1, bf.CRBF(3), bf.Rectangle(0.01, 0.01), MATERIAL)
    critical = np.pi**2 * 1e-8 / 12.0
    model = bf.Model(
        [column, slider],
        [bf.Clamp(column.start), bf.Prescribed(slider.start, uy=0.0, rotation=0.0)],
        [bf.PointForce(slider.start, (-1.2 * critical, 0.0))],
        connectors=[RigidLink(column.end, slider.start)],
    )
    solution = bf.solve_static(model, 12, unstable="leave")
    assert solution.stable.all()
    aside = np.abs(solution.displacement(column.at(0.5))[:, 1])
    left = np.flatnonzero(aside > 1e-6)
    assert 1.2 * solution.load_factor[left[0] - 1] == pytest.approx(1.0, rel=1e-3)
    assert np.array_equal(left, np.arange(left[0], len(solution)))


def test_what_cannot_be_left_is_refused():
    column = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), MATERIAL)
    push = bf.PointForce(column.end, (-(np.pi**2) * 1e-8 / 12.0, 0.0), scale=False)
    with pytest.raises(bf.ConvergenceError, match="under the loads that do not scale is unstable"):
        bf.solve_static(bf.Model([column], [bf.Clamp(column.start)], [push]), unstable="leave")
    with pytest.raises(bf.InputError, match='unstable="leave" does not support section laws with history'):
        bf.solve_static(bent_there_and_back(LAWS[0])[1], unstable="leave")
    with pytest.raises(bf.InputError, match='unstable must be "keep" or "leave"'):
        bf.solve_static(bf.Model([column], [bf.Clamp(column.start)], [push]), unstable="yes")


@pytest.mark.parametrize("ratio", [1.25, 2.0, 4.0])
@pytest.mark.parametrize("element", [bf.CRBF(2), bf.CRBF(3)], ids=lambda element: element.name)
def test_a_bifurcation_at_the_end_of_a_load_step_is_left(element, ratio):
    """Halved load steps end on the critical load, whose pivots have any sign; rows beyond it were unstable."""
    beam = bf.Beam(bf.Line((0, 0), (0, 1)), 6, element, bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1.0))])
    critical = float(bf.solve_buckling(column, count=1).load_factors[0])
    loaded = column.with_loads([bf.PointForce(beam.end, (0.0, -ratio * critical))])
    found = bf.solve_static(loaded, unstable="leave")
    assert found.stable.all()
    # the same load led there by a force aside, which is taken away
    aside = bf.PointForce(beam.end, (1e-3 * critical, 0.0), amplitude=lambda at: 1.0 - at)
    other = bf.solve_static(loaded.with_loads([*loaded.loads, aside]), steps=7)
    x, y = found.displacement(beam.end)[-1]
    assert (abs(x), y) == pytest.approx(
        (abs(other.displacement(beam.end)[-1, 0]), other.displacement(beam.end)[-1, 1]), abs=1e-7
    )


def arch(rise, elements, load):
    """A clamped or pinned shallow arc of span 1, pressed down by a weight; load [N/m] grows from 0."""
    radius = (0.25 + rise**2) / (2.0 * rise)
    side = np.arctan2(radius - rise, 0.5)
    curve = bf.Arc((0.5, rise - radius), radius, np.pi - side, side)
    beam = bf.Beam(curve, elements, bf.CRBF(2), bf.Rectangle(1.0, 0.01), MATERIAL)
    return beam, bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [bf.DistributedLoad(beam, (0.0, -load))])


@pytest.mark.slow
@mostly_slow("off", [0.0, 1e-9, -1e-9, 1e-6], quick=(0, 2))
@pytest.mark.parametrize("options", [{"unstable": "leave"}, {"snap": "jump"}])
@pytest.mark.parametrize("row", [0.5, 0.9])
def test_a_row_may_lie_on_the_bifurcation_that_is_left(row, options, off):
    """The end is that of a solve whose rows lie elsewhere; the row on the bifurcation is still symmetric."""
    rise, elements = 0.2, 6
    _, model = arch(rise, elements, 1e-7)
    critical = 1e-7 * bf.solve_buckling(model).load_factors[0]
    beam, model = arch(rise, elements, (1.0 + off) * critical / row)
    solution, other = (bf.solve_static(model, steps, **{"snap": "jump"} | options) for steps in (10, 7))
    assert solution.stable.all()
    apex = beam.at(0.5)
    on = np.flatnonzero(solution.load_factor == row)[0]
    assert abs(solution.displacement(apex)[on, 0]) < 1e-3 * abs(solution.displacement(apex)[on, 1])
    end, expected = solution.displacement(apex)[-1], other.displacement(apex)[-1]
    assert abs(end) == pytest.approx(abs(expected), rel=1e-6, abs=1e-9)  # either side of a symmetric bifurcation


@pytest.mark.slow
@mostly_slow(("slender", "elements"), [(5, 11), (5, 19), (6, 19), (7, 11)], quick=(0, 2))
def test_the_way_of_a_table_turns_near_the_end_of_a_step(slender, elements):
    """Steps along the path once became ever shorter towards the kink of the table.

    Nothing snaps, so the way back is the way out in reverse.
    """
    rise = 0.05
    way = bf.Interpolated([(0.0, 0.0), (0.5, -2.0 * rise), (1.0, 0.0)])
    curve = bf.Parametric(lambda x: (x, 0.5 * rise * (1.0 - np.cos(2.0 * np.pi * x))), 0.0, 1.0)
    beam = bf.Beam(curve, elements, bf.CRBF(2), bf.Rectangle(1.0, rise / slender), MATERIAL)
    led_centre = bf.Prescribed(beam.at(0.5), uy=way, rotation=0.0)
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end), led_centre])
    wanted = np.linspace(0.0, 1.0, 41)
    solution = bf.solve_static(model, at=wanted, unstable="leave")
    assert solution.stable.all()
    rows = np.searchsorted(solution.load_factor, wanted - 1e-12)
    force = solution.reaction(beam.at(0.5))[rows, 1]
    assert force == pytest.approx(force[::-1], abs=1e-8 * np.abs(force).max())


def test_a_path_says_that_stability_is_lost_before_its_first_limit_point():
    """The one-mode solution of the arch has its bifurcation at 5.0 kN, the symmetric limit load is above 6 kN."""
    axis = bf.Parametric(lambda x: (x, 0.05 * np.sin(np.pi * x)), 0.0, 1.0)
    arch = bf.Beam(axis, 8, bf.CRBF(3), bf.Rectangle(0.03, 0.01), bf.Material(2.1e11, 0.3, 7850.0))
    crown = arch.at(0.5)
    model = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [bf.PointForce(crown, (0.0, -1e3))])
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(crown)[1] < -0.02)
    limit = path.stability_limit
    assert limit is path.bifurcations[0]
    assert limit.load_factor == pytest.approx(5.0, rel=0.05)
    assert limit.load_factor == pytest.approx(bf.solve_buckling(model).load_factors[0], rel=1e-6)
    assert path.limit_points[0].load_factor > 6.0
    assert f"stability is lost first at load factor {limit.load_factor:.6g} by a bifurcation" in str(path)


def test_the_stability_limit_of_a_path_may_be_a_limit_point_or_not_there():
    model = williams_toggle.toggle(None, 4, 3)
    path = bf.trace_equilibrium(model, until=lambda state: state.load_factor < 33.0 and not state.stable)
    assert path.stability_limit is path.limit_points[0]
    assert path.stability_limit.load_factor == pytest.approx(33.849, rel=1e-3)  # of the literature, see LIMITS
    assert "stability is lost first at load factor 33.8" in str(path)
    below = bf.trace_equilibrium(model, until=20.0)
    assert below.stability_limit is None
    assert "stability" not in str(below)


@pytest.mark.parametrize("until", [30.0, 50.0])
@pytest.mark.parametrize("make", [bf.Temperature, bf.Actuation])
def test_the_stability_limit_of_a_bar_that_does_not_move_is_its_bifurcation(make, until):
    """Where nothing moves but by round-off, it once was the first unstable row, up to 75 % above."""
    steel = bf.Material(2.1e11, 0.3, 7850.0, thermal_expansion=1.2e-5)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), steel)
    heat = make(bar, change=1.0) if make is bf.Temperature else make(bar, stretch=1.2e-5)
    model = bf.Model([bar], [bf.Clamp(bar.start), bf.Clamp(bar.end)], [heat])
    path = bf.trace_equilibrium(model, until=until)
    assert path.stability_limit is path.bifurcations[0]
    slender = 4.0 * np.pi**2 * 0.01**2 / 12.0 / 1.2e-5
    assert path.stability_limit.load_factor == pytest.approx(slender, rel=2e-3)


@pytest.mark.filterwarnings("ignore::beamfem.errors.UnstableWarning")
@pytest.mark.parametrize(("damping", "stable"), [(1.0, [True, True, False]), (-1.0, [False] * 3)])
def test_states_with_forces_of_the_velocity_are_stable_where_no_small_motion_grows(damping, stable):
    """They once ended with an error of solve_modes, which nobody had called."""
    steel, section = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.01, 0.01)
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), section, steel)
    euler = np.pi**2 / 4.0 * 2.1e11 * section.second_moment
    push = bf.PointForce(column.end, (0.0, -2.0 * euler))
    control = bf.StateForce(column.end, lambda time, q, v: (-damping * v[0], -damping * v[1], 0.0))
    model = bf.Model([column], [bf.Clamp(column.start)], [push], connectors=[control])
    assert bf.solve_static(model, at=[0.2, 0.4, 0.8]).stable.tolist() == stable


def test_a_path_follows_forces_of_the_load_factor_alone():
    """Such a model once had no path, as no load of its list changes."""
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Rectangle(0.01, 0.01), steel)
    pull = bf.StateForce(beam.end, lambda factor, q, v: (0.0, -30.0 * factor, 0.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], connectors=[pull])
    path, solved = bf.trace_equilibrium(model, until=1.0), bf.solve_static(model)
    assert path[-1].displacement(beam.end) == pytest.approx(solved.displacement(beam.end)[-1], rel=1e-9)


def test_a_snap_out_and_back_to_no_load_has_completed():
    """Without a load in the end, the residual is as small as round-off allows, which leaves many digits."""
    axis = bf.Parametric(lambda x: (x, 0.05 * np.sin(np.pi * x)), 0.0, 1.0)
    arch = bf.Beam(axis, 8, bf.CRBF(3), bf.Rectangle(0.03, 0.01), bf.Material(2.1e11, 0.3, 7850.0))
    crown = arch.at(0.5)
    loop = bf.Interpolated([(0.0, 0.0), (0.25, 1.0), (0.75, -1.0), (1.0, 0.0)])
    push = bf.PointForce(crown, (0.0, -7.2e3), amplitude=loop)
    solution = bf.solve_static(bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [push]), 20, snap="jump")
    assert solution.displacement(crown)[-1] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert solution.displacement(crown)[:, 1].min() < -0.1
    assert solution.status is bf.Status.COMPLETED
    assert solution.statistics.digits > 6.0
