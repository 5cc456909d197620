"""Critical points of frames: named, at any rotation, up to the number asked for."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from random_models import random_recipe
from recipes import View
from scipy.optimize import brentq
from scipy.sparse.linalg import ArpackNoConvergence
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.linalg import eigenpairs
from beamfem.solve.continuation.steps import Refused
from beamfem.solve.modes.pencil import Pencil
from beamfem.solve.stability import buckling
from beamfem.solve.stability.linearised import size_of

STEEL = bf.Material(2e11, 0.3, 7800.0)
STRIP = bf.Rectangle(0.02, 0.01)
EI = STEEL.youngs_modulus * STRIP.second_moment


def turned(degrees, mirror=1.0):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s], [s, c]]) @ np.diag([mirror, 1.0])


def portal(place, loads, degrees=0.0, mirror=1.0, section=STRIP, elements=4, support=bf.Pin):
    """A portal, 1 m high and wide; loads (fraction of the beam, newtons downwards)."""
    turn = turned(degrees, mirror)
    corners = [tuple(turn @ corner) for corner in ((0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0))]
    bars = [bf.Beam(bf.Line(a, b), elements, bf.CRBF(3), section, STEEL) for a, b in pairwise(corners)]
    joints = [bf.Rigid(bars[0].end, bars[1].start), bf.Rigid(bars[1].end, bars[2].start)]
    forces = [bf.PointForce(bars[1].at(at), tuple(turn @ (0.0, -size))) for at, size in zip(place, loads, strict=True)]
    return bf.Model(bars, [support(bars[0].start), support(bars[2].end)], forces, joints)


def column(degrees, slenderness, elements=10, order=3, moduli=(2e11,)):
    """Hinged columns side by side, each of length 1, under its own load of E I of the first."""
    turn = turned(degrees)
    section = bf.Rectangle(0.1, 1.0 / slenderness, 1.0)
    beams, supports, loads = [], [], []
    for number, modulus in enumerate(moduli):
        foot, head = turn @ (0.0, number), turn @ (1.0, number)
        beam = bf.Beam(
            bf.Line(tuple(foot), tuple(head)), elements, bf.CRBF(order), section, bf.Material(modulus, 0.3, 1)
        )
        beams.append(beam)
        supports += [bf.Pin(beam.start), bf.Roller(beam.end, tuple(turn @ (0.0, 1.0)))]
        loads.append(bf.PointForce(beam.end, tuple(turn @ (-moduli[0] * section.second_moment, 0.0))))
    return bf.Model(beams, supports, loads)


def reissner(slenderness, number, shear_factor=1.0):
    """P L^2/EI of the n-th mode of a hinged column that is compressed and sheared; see test_buckling."""
    axial = 12.0 * slenderness**2
    shear = axial * shear_factor / 2.6
    exact = (number * np.pi) ** 2

    def missing(load):
        return load * (1.0 - load / axial + load / shear) - exact

    return brentq(missing, 0.5 * exact, 2.0 * exact, xtol=1e-13, rtol=1e-14)


def require_counts(model, found):
    """Assert that one more pivot is negative behind each bifurcation, at states of the traced path on both sides."""
    system = system_of(model, static=True)
    for kind, load in zip(found.kinds, found.load_factors, strict=True):
        if kind == "bifurcation":
            sides = [bf.trace_equilibrium(model, until=float(load * share))[-1] for share in (0.998, 1.002)]
            counts = [Pencil(system, side.p, side.at).below(0.0) for side in sides]
            assert counts[1] == counts[0] + 1


def pinned_column(degrees):
    """E I = 166.7 N m^2, 1 m, 10 CRBF(2), pushed by 1 N along its axis."""
    turn, section = turned(degrees), bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Line((0, 0), tuple(turn @ (1.0, 0.0))), 10, bf.CRBF(2), section, STEEL)
    supports = [bf.Pin(beam.start), bf.Roller(beam.end, tuple(turn @ (0.0, 1.0)))]
    return bf.Model([beam], supports, [bf.PointForce(beam.end, tuple(turn @ (-1.0, 0.0)))])


@pytest.mark.slow
@mostly_slow("degrees", [10, 30, 45, 60, 90, 123], quick=(1, 5))
def test_a_pinned_column_buckles_at_any_angle(degrees):
    """At 1644.7 N, where the path was said to end at 10, 30, 45, 60 and 123 degrees."""
    model = pinned_column(degrees)
    found = bf.solve_buckling(model, 2)
    bending = STEEL.youngs_modulus * model.beams[0].section.second_moment
    exact = bending * np.array([reissner(100, 1, 5 / 6), reissner(100, 2, 5 / 6)])
    # 10 elements of order 2: 4e-4 too high at the second
    assert found.load_factors == pytest.approx(exact, rel=6e-4)
    assert found.load_factors == pytest.approx(bf.solve_buckling(pinned_column(0), 2).load_factors, rel=1e-7)
    assert found.kinds == ("bifurcation", "bifurcation")
    assert found.uncertainty.max() < 1e-9
    require_counts(model, found)


@cache
def path_loaded_at_midspan():
    return bf.trace_equilibrium(portal([0.5], [EI]), until=4.0)


@cache
def loaded_beside_the_middle():
    """The path and the critical loads of the portal as it stands."""
    path = bf.trace_equilibrium(portal([0.25], [EI]), until=lambda state: state.load_factor < 0.0, points=80)
    return path, bf.solve_buckling(portal([0.25], [EI]), 2)


@mostly_slow(("degrees", "mirror"), [(0, 1.0), (17, 1.0), (200, 1.0), (33, -1.0)], quick=(3,))
def test_a_portal_sways_and_then_has_a_limit_point(degrees, mirror):
    """Loaded at midspan; the path, traced by arc length, has the same two points."""
    model = portal([0.5], [EI], degrees, mirror)
    path = path_loaded_at_midspan()
    found = bf.solve_buckling(model, 5)
    assert found.kinds == ("bifurcation", "limit point")
    assert found.load_factors[0] == pytest.approx(path.bifurcations[0].load_factor, rel=1e-7)
    assert found.load_factors[1] == pytest.approx(28.135857, rel=1e-6)
    assert "largest load factor" in found.ended
    assert found.status is bf.Status.COMPLETED
    assert len(found.linearised) >= 2
    assert len(bf.solve_buckling(model).load_factors) == 1
    require_counts(model, found)


def test_a_search_that_runs_out_of_points_has_stopped(monkeypatch):
    monkeypatch.setattr("beamfem.solve.stability.buckling._MOST_POINTS", 2)
    found = bf.solve_buckling(portal([0.5], [EI]), 5)
    assert len(found) < 2
    assert "used up" in found.ended
    assert found.status is bf.Status.STOPPED


@mostly_slow("seed", [61, 168, 174, 189, 197])
def test_beams_in_two_halves_are_searched_as_far_as_whole_ones(seed):
    """Curved beams whose search ended after a movement by the length of the longest one, with nothing found."""
    whole, halves = (bf.solve_buckling(random_recipe(seed).build(View(split=how)).model) for how in (False, True))
    assert halves.kinds == whole.kinds
    assert halves.load_factors == pytest.approx(whole.load_factors, rel=1e-7)
    assert halves.status is whole.status
    assert (whole.status is bf.Status.STOPPED) == (len(whole) == 0)


def test_the_size_of_a_model_does_not_depend_on_how_it_is_divided():
    """A straight beam is as large as it is long; a semicircle reaches from its centre of mass to its ends."""
    radius, semicircle = 2.0, 2.0 * 2.0 * np.hypot(1.0, 2.0 / np.pi)
    for cuts in (1, 2, 5):
        angles = np.linspace(0.3, 0.3 + np.pi, cuts + 1)
        curves = [bf.Arc((1.0, 5.0), radius, float(a), float(b)) for a, b in pairwise(angles)]
        beams = [bf.Beam(curve, 80 // cuts, bf.CRBF(2), STRIP, STEEL) for curve in curves]
        joints = [bf.Rigid(a.end, b.start) for a, b in pairwise(beams)]
        system = system_of(bf.Model(beams, [bf.Clamp(beams[0].start)], joints=joints), static=True)
        assert size_of(system) == pytest.approx(semicircle, rel=1e-4)
    assert size_of(system_of(pinned_column(30.0), static=True)) == pytest.approx(1.0, rel=1e-12)


def test_a_path_that_is_lost_at_once_hands_back_its_start_as_stopped(monkeypatch):
    monkeypatch.setattr(buckling, "take_step", lambda *_, **__: Refused("the tangent is singular", 1))
    with pytest.raises(bf.ConvergenceError, match="lost before any load factor") as caught:
        bf.solve_buckling(portal([0.5], [EI]))
    assert caught.value.solution.status is bf.Status.STOPPED
    assert caught.value.solution.load_factor.tolist() == [0.0]


@pytest.mark.slow
@mostly_slow(("seed", "points"), [(177, 100), (582, 60)], quick=(1,))
@pytest.mark.parametrize("half_width", [64, -1], ids=["band", "sparse"])
def test_a_tie_under_a_large_load_has_the_limit_point_of_its_path(widest_band, seed, points, half_width):
    """One step went over a pair of limit points 3e-7 apart: its length was all load, and counts were equal behind."""
    widest_band(half_width)
    model = random_recipe(seed).build().model
    path = bf.trace_equilibrium(model, points=points)
    found = bf.solve_buckling(model, 2)
    assert found.kinds[-1] == "limit point"
    assert found.load_factors[-1] == pytest.approx(path.limit_points[0].load_factor, rel=1e-9)
    assert found.load_factors[:-1] == pytest.approx([point.load_factor for point in path.bifurcations], rel=1e-9)


@mostly_slow("softer", [0.3, 1e-2, 1e-4, 1e-5, 1e-6, 1e-7], quick=(0, 5))
@pytest.mark.parametrize("half_width", [64, -1], ids=["band", "sparse"])
def test_limit_points_close_together_are_not_stepped_over(widest_band, softer, half_width):
    """A shallow strut on a spring: P = EA (1 - l/l0) y/l + k (h - y), l^2 = 1 + y^2, is largest at a root in l^3.

    k = (1 - softer) EA (1 - 1/l0): between its limit points the load falls by about softer^1.5.
    """
    widest_band(half_width)
    height, section = 0.1, bf.Rectangle(0.1, 0.2)
    length = np.hypot(1.0, height)
    bar = bf.Beam(bf.Line((0, 0), (1, height)), 4, bf.CRBF(2), section, STEEL)
    stiffness = STEEL.youngs_modulus * section.area
    spring = (1.0 - softer) * (1.0 - 1.0 / length)
    supports = [bf.Pin(bar.start), bf.Roller(bar.end, (1, 0)), bf.Spring(bar.end, (0.0, spring * stiffness))]
    model = bf.Model([bar], supports, [bf.PointForce(bar.end, (0.0, -1e-3 * stiffness))])
    at = (1.0 / length + spring) ** (-1.0 / 3.0)
    depths = np.sqrt(at**2 - 1.0) * np.array([1.0, -1.0])
    exact = 1e3 * ((1.0 / at - 1.0 / length) * depths + spring * (height - depths))
    found, path = bf.solve_buckling(model), bf.trace_equilibrium(model, 1.0)
    assert found.kinds == ("limit point",)
    assert found.load_factors == pytest.approx(exact[:1], rel=1e-9)
    assert [point.load_factor for point in path.limit_points] == pytest.approx(exact, rel=1e-9)


def blown_arch(cuts, angle, unit, mirror):
    """A clamped arch of 2.4 rad, length/height = 1000, under pressure from below in E I / R^3, in metres times unit."""
    material, section = bf.Material(2e11 / unit**2, 0.3, 7800.0), bf.Rectangle(0.1 * unit, 2.4e-3 * unit)
    ends = angle + mirror * (0.5 * np.pi + 1.2 - 2.4 * np.linspace(0.0, 1.0, cuts + 1))
    curves = [bf.Arc((0.3 * unit, 0.1 * unit), unit, float(a), float(b)) for a, b in pairwise(ends)]
    beams = [bf.Beam(curve, 12 // cuts, bf.CRBF(4), section, material) for curve in curves]
    pressure = mirror * material.youngs_modulus * section.second_moment / unit**3
    loads = [bf.Pressure(beam, pressure) for beam in beams]
    joints = [bf.Rigid(a.end, b.start) for a, b in pairwise(beams)]
    return bf.Model(beams, [bf.Clamp(beams[0].start), bf.Clamp(beams[-1].end)], loads, joints)


@pytest.mark.slow
def test_stability_that_is_lost_and_regained_in_a_step_is_found():
    """Counts of negative pivots are equal before and behind; one view found both, the other the third point first."""
    plain, other = bf.solve_buckling(blown_arch(1, 0.0, 1.0, 1), 3), bf.solve_buckling(blown_arch(2, 0.7, 1e3, -1), 3)
    assert plain.kinds == other.kinds == ("bifurcation",) * 3
    assert plain.load_factors == pytest.approx(other.load_factors, rel=1e-8)
    assert np.diff(plain.load_factors)[0] < 2e-5 * plain.load_factors[0]


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [0, 17, 90])
def test_a_portal_loaded_beside_its_middle_has_a_limit_point(degrees):
    path, upright = loaded_beside_the_middle()
    found = bf.solve_buckling(portal([0.25], [EI], degrees), 2)
    assert found.kinds == ("limit point",)
    assert found.load_factors == pytest.approx([path.limit_points[0].load_factor], rel=1e-7)
    assert found.linearised == pytest.approx(upright.linearised, rel=1e-8)


@pytest.mark.parametrize("degrees", [0, 71])
@pytest.mark.parametrize(
    ("support", "equation", "low", "high"),
    [
        (bf.Pin, lambda u: u * np.tan(u) - 6.0, 1.2, 1.5),
        (bf.Clamp, lambda u: u / np.tan(u) + 6.0, 2.2, 3.0),
    ],
    ids=["pinned", "clamped"],
)
def test_portals_under_loads_on_their_columns_sway_at_the_root_of_their_equation(support, equation, low, high, degrees):
    """u tan u = 6 and u cot u = -6 of equal bars, u^2 = P h^2/EI (Timoshenko and Gere 1961)."""
    thin = bf.Rectangle(0.02, 0.001)
    size = STEEL.youngs_modulus * thin.second_moment
    found = bf.solve_buckling(portal([0.0, 1.0], [size, size], degrees, section=thin, support=support))
    # the columns get shorter by 1e-6, and carry a little of the bending
    assert found.load_factors == pytest.approx([brentq(equation, low, high) ** 2], rel=2e-5)
    assert found.linearised == pytest.approx([brentq(equation, low, high) ** 2], rel=2e-5)
    assert found.kinds == ("bifurcation",)


@pytest.mark.parametrize("degrees", [0, 30])
@mostly_slow("slenderness", [1e2, 1e3, 1e4, 1e5], quick=(0, 3))
def test_columns_of_any_slenderness_buckle_at_eulers_load(slenderness, degrees):
    """At L/h = 1e5 it was off by 1.2e-3."""
    found = bf.solve_buckling(column(degrees, slenderness, 24, 4), 2)
    exact = [reissner(slenderness, number) for number in (1, 2)]
    # strains of positions of size 1 have an error eps, and P/EA is 0.8 / slenderness^2
    round_off = 20.0 * np.finfo(float).eps * slenderness**2
    assert found.load_factors == pytest.approx(exact, rel=1e-9 + min(round_off, 2e-7))
    assert found.linearised == pytest.approx(exact, rel=2.0 / slenderness**2 * 20 + 1e-7)
    assert found.uncertainty.max() < 1e-9 + round_off


@pytest.mark.parametrize("apart", [3e-3, 1e-4, 1e-6, 0.0])
@mostly_slow("degrees", [0, 25], quick=(1,))
def test_columns_of_nearly_the_same_load_are_told_apart(apart, degrees):
    model = column(degrees, 100.0, 8, 4, moduli=(2e11, 2e11 * (1.0 + apart)))
    found = bf.solve_buckling(model, 2)
    first = reissner(100.0, 1)
    # each strain is the load over the modulus, so that the load factor is proportional to it
    assert found.load_factors == pytest.approx([first, first * (1.0 + apart)], rel=2e-8)
    assert found.kinds == ("bifurcation", "bifurcation")
    if apart > 1e-5:
        moved = np.abs([found.solution(i).displacement(model.beams[j].at(0.5))[1] for i in (0, 1) for j in (0, 1)])
        sizes = moved.max(axis=1).reshape(2, 2)
        assert sizes[0, 0] > 10.0 * sizes[0, 1]
        assert sizes[1, 1] > 10.0 * sizes[1, 0]


def test_a_model_that_no_load_makes_critical_says_so():
    """An L-shaped frame, loaded near its corner, turns about until it hangs; Lee's frame is loaded elsewhere."""
    lower = bf.Beam(bf.Line((0, 0), (0, 1.0)), 5, bf.CRBF(3), STRIP, STEEL)
    upper = bf.Beam(bf.Line((0, 1.0), (1.0, 1.0)), 5, bf.CRBF(3), STRIP, STEEL)
    model = bf.Model(
        [lower, upper],
        [bf.Pin(lower.start), bf.Pin(upper.end)],
        [bf.PointForce(upper.at(0.5), (0.0, EI))],
        [bf.Rigid(lower.end, upper.start)],
    )
    found = bf.solve_buckling(model)
    path = bf.trace_equilibrium(model, until=20.0)
    assert not path.limit_points
    assert not path.bifurcations
    assert len(found) == 0
    assert len(found.linearised) == 1
    assert "no critical point" in repr(found)
    assert "goes no further than" in found.ended
    assert found.status is bf.Status.STOPPED
    with pytest.raises(bf.InputError, match="there is no critical point"):
        found.solution()


@pytest.mark.parametrize("elements", [4, 8], ids=["dense", "sparse"])
def test_buckling_is_found_where_the_iteration_does_not_converge(monkeypatch, elements):
    exact = bf.solve_buckling(portal([0.5], [EI], elements=elements), 2)

    def never(*args, **options):
        raise ArpackNoConvergence("no convergence", np.empty(0), np.empty((0, 0)))

    monkeypatch.setattr(eigenpairs, "eigsh", never)
    monkeypatch.setattr(eigenpairs, "eigs", never)
    found = bf.solve_buckling(portal([0.5], [EI], elements=elements), 2)
    assert found.load_factors == pytest.approx(exact.load_factors, rel=1e-8)
    assert found.linearised == pytest.approx(exact.linearised, rel=1e-8)


@pytest.mark.slow
@mostly_slow("led", [0.005, 0.01, 0.02], quick=(1,))
def test_a_search_that_finds_the_same_place_again_ends(led):
    """It went on for ever: behind a step onto another path the tangent seemed to change wherever it was looked."""
    curve, rubber = bf.Line((0, 0), (1.029752878431586, -0.41368336197898953)), bf.Material(2e9, 0.3, 1000.0)
    beam = bf.Beam(curve, 1, bf.BilinearCRBF(), bf.Rectangle(0.05, 0.05), rubber)
    spring = bf.Spring(beam.at(0.6915750966897879), (1e5, 0.0), 100.0)
    loads = [bf.PointForce(beam.end, (1.129427939135084, 3.4673748983930257)), bf.Gravity((0.0, -9.81))]
    loads.append(bf.PointForce(beam.at(0.18637701771339518), (1.2234820193249452, 12.979194119574597)))
    found = bf.solve_buckling(bf.Model([beam], [bf.Pin(beam.start), bf.Prescribed(beam.end, ux=led), spring], loads))
    path = bf.trace_equilibrium(found.model, until=lambda state: state.load_factor > 50.0)
    assert not len(found) or found.load_factors[0] > 50.0
    assert not path.limit_points
    assert not path.bifurcations


def test_of_many_close_critical_loads_no_more_are_located_than_are_sought(monkeypatch):
    """N_m = EI (m pi / L)^2 + k (L / m pi)^2 of a column on a stiff foundation, nearly equal around m = 32."""
    length, stiffness = 10.0, 1e4
    section = bf.Rectangle(1.0, 1e-3 * length)
    material = bf.Material(youngs_modulus=1.0 / section.second_moment, poisson_ratio=0.3, density=1.0)
    beam = bf.Beam(bf.Line((0, 0), (length, 0)), 32, bf.CRBF(6), section, material)
    parts = [bf.Pin(beam.start), bf.Roller(beam.end), bf.Foundation(beam, (0.0, stiffness))]
    located, take_step = [], buckling.take_step

    def counted(*args, **options):
        step = take_step(*args, **options)
        located.append(len(getattr(step, "crossings", ())))
        return step

    monkeypatch.setattr(buckling, "take_step", counted)
    found = bf.solve_buckling(bf.Model([beam], parts, [bf.PointForce(beam.end, (-1.0, 0.0))]))
    waves = (np.arange(1, 60) * np.pi / length) ** 2
    assert found.load_factors == pytest.approx([(waves + stiffness / waves).min()], rel=2e-3)  # strains of 1.7e-3
    assert sum(located) == 1
