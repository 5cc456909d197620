"""Everyday models whose static solve once left the path from the reference; values by shooting, without any element."""

import signal
from contextlib import contextmanager
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shooting import Member, solved
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.system import System
from beamfem.solve.newton.newton import NewtonResult, Termination
from beamfem.solve.statics.load_steps import skips_limit_points
from beamfem.solve.statics.static_record import StaticRecord

STEEL = bf.Material(2e11, 0.3, 7800.0)
STEPS = (1, 10, 100, pytest.param(1000, marks=pytest.mark.slow))


@contextmanager
def within(seconds):
    """Fail where a block does not end in time."""

    def late(*_):
        pytest.fail(f"it did not end within {seconds} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def member(length, angle, section, material=STEEL):
    own = section.rigidity(material)
    return Member(length, angle, bending=own.bending, axial=1.0 / own.axial, shear=1.0 / own.shear)


def strip(elements=8, **end):
    """Steel strip 1 m x 20 x 2 mm, clamped, its end prescribed."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(3), bf.Rectangle(0.02, 0.002), STEEL)
    return beam, [bf.Clamp(beam.start), bf.Prescribed(beam.end, **end)]


STRIP = member(1.0, 0.0, bf.Rectangle(0.02, 0.002))


@pytest.mark.slow
@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize(("elements", "tolerance"), [(8, 1e-3), (16, 2e-5)])
def test_a_squeezed_strip_bows_and_is_not_compressed_straight(elements, tolerance, steps):
    beam, supports = strip(elements, ux=-0.4, uy=0.0, rotation=0.0)
    model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), (0.0, 0.01), scale=False)])
    middle = [None]

    def end(unknown):
        middle[0] = STRIP.run((0.0, 0.0, 0.0, *unknown), 0.5)
        return STRIP.after(0.5).run(middle[0] - [0.0, 0.0, 0.0, 0.0, 0.01, 0.0])

    start = solved(lambda x: end(x)[:3] - [0.6, 0.0, 0.0], [-132.6, 0.005, 23.1])
    force = end(start)[3:]
    solution = bf.solve_static(model, steps)
    assert solution.position(beam.at(0.5))[-1] == pytest.approx(middle[0][:2], abs=0.1 * tolerance)
    assert solution.reaction(beam.end)[-1] == pytest.approx(force, rel=tolerance)
    assert solution.energy().strain[-1] == pytest.approx(47.1, abs=0.02)


@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("aside", [None, 0.0], ids=["free aside", "held aside"])
def test_a_strip_whose_end_comes_closer_and_turns_by_half_a_turn(aside, steps):
    beam, supports = strip(ux=-0.5, uy=aside, rotation=np.pi)

    def conditions(x):
        end = STRIP.run((0.0, 0.0, 0.0, *x))
        return [end[0] - 0.5, end[1 if aside is not None else 4], end[2] - np.pi]

    guess = [41.8, 0.0, 1.6] if aside is None else [1.9, -57.3, -14.0]
    end = STRIP.run((0.0, 0.0, 0.0, *solved(conditions, guess)))
    solution = bf.solve_static(bf.Model([beam], supports), steps)
    assert solution.position(beam.end)[-1] == pytest.approx(end[:2], abs=5e-4)
    assert solution.reaction(beam.end)[-1] == pytest.approx(end[3:], rel=2e-3, abs=5e-2)


@pytest.mark.slow
@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("element", [bf.CRBF(3), bf.CRBF(1)], ids=["8 x CRBF(3)", "48 x CRBF(1)"])
def test_a_portal_with_one_slender_leg_sways_to_its_stable_side(element, steps):
    """Legs 20 x 4 mm clamped, 20 x 1 mm pinned and hinged; beam 20 x 2; gravity and (10, -60) N at its middle."""
    sections = [bf.Rectangle(0.02, height) for height in (0.004, 0.002, 0.001)]
    corners = [((0, 0), (0, 0.5)), ((0, 0.5), (1, 0.5)), ((1, 0), (1, 0.5))]
    counts = (8, 8, 8) if element == bf.CRBF(3) else (24, 48, 24)
    left, top, right = (
        bf.Beam(bf.Line(*ends), count, element, section, STEEL)
        for ends, count, section in zip(corners, counts, sections, strict=True)
    )
    model = bf.Model(
        [left, top, right],
        [bf.Clamp(left.start), bf.Pin(right.start)],
        [bf.Gravity((0.0, -9.81)), bf.PointForce(top.at(0.5), (10.0, -60.0))],
        [bf.Rigid(left.end, top.start), bf.Hinge(top.end, right.end)],
    )
    weights = [(0.0, -9.81 * 7800.0 * section.area) for section in sections]
    legs = member(0.5, 0.5 * np.pi, sections[0]), member(1.0, 0.0, sections[1]), member(0.5, -0.5 * np.pi, sections[2])
    middle = [None]

    def conditions(x):
        corner = legs[0].run((0.0, 0.0, 0.0, *x[:3]), load=weights[0])
        middle[0] = legs[1].run(corner, 0.5, weights[1])
        hinge = legs[1].after(0.5).run(middle[0] - [0.0, 0.0, 0.0, 10.0, -60.0, 0.0], load=weights[1])
        foot = legs[2].run((*hinge[:2], x[3], *hinge[3:5], 0.0), load=weights[2])
        return [hinge[5], foot[0] - 1.0, foot[1], foot[5]]

    base = bf.trace_equilibrium(model, 1.0)
    guess = [*-base.reaction(left.start)[-1], base.rotation(right.end)[-1]]
    solved(conditions, guess)
    solution = bf.solve_static(model, steps)
    tolerance = 2e-4 if element == bf.CRBF(3) else 3e-3
    assert solution.position(top.at(0.5))[-1] == pytest.approx(middle[0][:2], abs=tolerance)
    assert solution.energy().strain[-1] == pytest.approx(9.43, abs=0.06)


@pytest.mark.parametrize("steps", [1, 20, 200])
@pytest.mark.parametrize(("element", "count"), [(bf.CRBF(3), 8), (bf.CRBF(1), 20)], ids=["CRBF-3", "CRBF-1"])
def test_a_clamped_beam_whose_end_is_led_aside_keeps_its_first_shape(element, count, steps):
    section = bf.Section.from_stiffness(5.5e6, 1e6, 115.0, 1.0, 1e-6)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), count, element, section)
    own = member(1.0, 0.0, section, None)

    def conditions(x):
        end = own.run((0.0, 0.0, 0.0, *x))
        return [*(end[:2] - [0.9, -0.35]), end[5]]

    force = solved(conditions, [-1073.7, 417.2, 40.0])[:2]
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, ux=-0.1, uy=-0.35)])
    found = bf.solve_static(model, steps).reaction(beam.end)[-1, :2]
    assert found == pytest.approx(force, rel=1e-4 if count == 8 else 1.2e-2)


@pytest.mark.parametrize("steps", [1, 10, 100])
@pytest.mark.parametrize("slenderness", [30, 100, 300])
@pytest.mark.parametrize("push", [0.1, 0.4])
def test_a_hinged_bar_whose_end_is_pushed_carries_little_more_than_eulers_load(push, slenderness, steps):
    """A lateral load of 0.01 E I / L^2 at the middle tells it which way to bow."""
    section = bf.Section.from_stiffness(12.0 * slenderness**2, 3.846 * slenderness**2, 1.0, 1.0, 1e-6)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 20, bf.CRBF(4), section)
    own = member(1.0, 0.0, section, None)

    def end(x):
        middle = own.run((0.0, 0.0, x[2], *x[:2], 0.0), 0.5)
        return own.after(0.5).run(middle - [0.0, 0.0, 0.0, 0.0, 0.01, 0.0])

    unknown = solved(lambda x: (end(x) - [1.0 - push, 0, 0, 0, 0, 0])[[0, 1, 5]], [-10.0, 0.0, 2.0 * np.sqrt(push)])
    assert 1.0 < -unknown[0] / np.pi**2 < 1.3
    load = bf.PointForce(beam.at(0.5), (0.0, 0.01), scale=False)
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Prescribed(beam.end, ux=-push, uy=0.0)], [load])
    solution = bf.solve_static(model, steps)
    assert solution.reaction(beam.end)[-1, 0] == pytest.approx(end(unknown)[3], rel=1e-6)
    assert solution.rotation(beam.start)[-1] == pytest.approx(unknown[2], abs=1e-6)


def swept(rate, section, material, state, span):
    """Return x, y, theta, nx, ny, M at the end of a stretch of the axis r(u) with r'(u) = rate(u); see shooting."""
    own = section.rigidity(material)

    def slope(u, y):
        x_u, y_u = rate(u)
        speed, phi = np.hypot(x_u, y_u), np.arctan2(y_u, x_u) + y[2]
        c, s = np.cos(phi), np.sin(phi)
        e, g = 1.0 + (y[3] * c + y[4] * s) / own.axial, (y[4] * c - y[3] * s) / own.shear
        x_s, y_s = e * c - g * s, e * s + g * c
        return speed * np.array([x_s, y_s, y[5] / own.bending, 0.0, 0.0, y[3] * y_s - y[4] * x_s])

    return solve_ivp(slope, span, state, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]


@pytest.mark.parametrize("steps", [1, 20])
@pytest.mark.parametrize(
    ("element", "tolerance"),
    [(bf.ShearRigid(), 1e-3), (bf.CRBF(4), 1e-6), (bf.ANCF(), None)],
    ids=["shear-rigid", "CRBF-4", "ANCF"],
)
def test_a_wavy_cantilever_under_one_dead_force_takes_the_near_equilibrium(element, tolerance, steps):
    section = bf.Rectangle(0.01, 0.01)
    force = 2e11 * section.second_moment * np.array([-2.0, 3.0])
    curve = bf.Parametric(lambda u: (u, 0.3 * np.sin(3.0 * u)), 0.0, 1.5)
    beam = bf.Beam(curve, 40, element, section, STEEL)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force)]), steps)

    def tip(x):
        state = (0.0, 0.0, 0.0, *force, x[0])
        return swept(lambda u: (1.0, 0.9 * np.cos(3.0 * u)), section, STEEL, state, (0.0, 1.5))

    moment = -0.007 * force[1] - 1.717 * force[0]
    exact = tip(solved(lambda x: [tip(x)[5] / force[1]], [moment]))[:2]
    assert exact == pytest.approx((-0.007, 1.717), abs=1e-3)
    # full continuum forces bend with 1.346 E I: not the same beam, but the same way
    assert solution.position(beam.end)[-1] == pytest.approx(exact, abs=tolerance or 0.3)


ARCH = bf.Rectangle(10.0, 0.8), bf.Material(1800.0, 0.3, 1e-9)  # mm, N


@cache
def arch():
    """L 100, rise 6, t 0.8, b 10 mm, E 1800 MPa, clamped; 0.01 N at the quarter point, the middle pushed down by 12."""
    curve = bf.Parametric(lambda u: (u, 3.0 * (1.0 - np.cos(0.02 * np.pi * u))), 0.0, 100.0)
    beam = bf.Beam(curve, 16, bf.CRBF(3), *ARCH)
    supports = [bf.Clamp(beam.start), bf.Clamp(beam.end), bf.Prescribed(beam.at(0.5), uy=-12.0)]
    load = bf.PointForce(beam.at(0.25), (0.0, -0.01), scale=False)
    return beam, bf.Model([beam], supports, [load])


@cache
def pushing_force():
    """Force on the middle of the arch in the end, near that of the traced path."""
    beam, model = arch()
    path = bf.trace_equilibrium(model, 1.0)
    assert not path.limit_points
    quarter = float(beam.curve.position(np.array([0.25 * beam.curve.length]))[0, 0])

    def stretch(state, *span):
        return swept(lambda u: (1.0, 0.06 * np.pi * np.sin(0.02 * np.pi * u)), *ARCH, state, span)

    def conditions(x):
        quartered = stretch((0.0, 0.0, 0.0, *x[:3]), 0.0, quarter) - np.array([0.0, 0.0, 0.0, 0.0, -0.01, 0.0])
        middle = stretch(quartered, quarter, 50.0)
        end = stretch(middle - np.array([0.0, 0.0, 0.0, 0.0, x[3], 0.0]), 50.0, 100.0)
        return [middle[1] + 6.0, end[0] - 100.0, end[1], end[2]]

    guess = [*-path.reaction(beam.start)[-1], path.reaction(beam.at(0.5))[-1, 1]]
    return solved(conditions, guess)[3]


@pytest.mark.slow
@pytest.mark.parametrize("steps", [1, 40, 100, 400])
def test_a_pushed_arch_snaps_aside_and_carries_no_more_than_that(steps):
    beam, model = arch()
    solution = bf.solve_static(model, steps)
    carried = solution.reaction(beam.at(0.5))[:, 1]
    assert carried[-1] == pytest.approx(pushing_force(), rel=1e-4)
    assert -carried.min() < 1.7248  # the peak on the path is 1.72479 N, at load factor 0.03985
    for row in range(1, len(solution), max(1, len(solution) // 4)):
        there = bf.trace_equilibrium(model, float(solution.load_factor[row]))
        assert carried[row] == pytest.approx(there.reaction(beam.at(0.5))[-1, 1], rel=1e-6)


FOLLOWER = bf.Rectangle(0.02, 0.002)
PUSH = 2e11 * FOLLOWER.second_moment * np.array([10.0, -40.0])


@cache
def follower_limit():
    """Largest load factor as the loaded point comes down."""
    legs = member(1.0, 0.5 * np.pi, FOLLOWER), member(1.0, 0.0, FOLLOWER), member(1.0, -0.5 * np.pi, FOLLOWER)
    unknown = [[42.44, -18.43, -18.12, 0.5575]]

    def load(down):
        def conditions(x):
            loaded = legs[1].run(legs[0].run((0.0, 0.0, 0.0, *x[:3])), 0.3)
            c, s = np.cos(loaded[2]), np.sin(loaded[2])
            jump = x[3] * np.array([[c, -s], [s, c]]) @ PUSH
            end = legs[2].run(legs[1].after(0.3).run(loaded - [0.0, 0.0, 0.0, *jump, 0.0]))
            return [loaded[1] - (1.0 - down), end[0] - 1.0, end[1], end[2]]

        unknown[0] = solved(conditions, unknown[0])
        return unknown[0][3]

    away = np.array([0.0, -0.01, 0.01])
    fit = np.polynomial.Polynomial.fit(away, [load(0.85 + far) for far in away], 2)
    return float(fit(fit.deriv().roots()[0]))


@pytest.mark.parametrize("steps", STEPS)
@mostly_slow("elements", [8, 16])
def test_a_portal_under_a_follower_load_ends_at_its_limit_point(elements, steps):
    """Clamped legs and beam 1 m, 20 x 2 mm steel; (10, -40) E I / L^2 turns with the beam at 0.3 of its length.

    Found in review: steps of all sizes went over the limit point at 0.5575 to 0.746.
    """
    corners = [((0, 0), (0, 1)), ((0, 1), (1, 1)), ((1, 0), (1, 1))]
    left, top, right = (bf.Beam(bf.Line(*ends), elements, bf.CRBF(3), FOLLOWER, STEEL) for ends in corners)
    model = bf.Model(
        [left, top, right],
        [bf.Clamp(left.start), bf.Clamp(right.start)],
        [bf.PointForce(top.at(0.3), PUSH, follower=True)],
        [bf.Rigid(left.end, top.start), bf.Rigid(top.end, right.end)],
    )
    with pytest.raises(bf.LimitPointError) as caught:
        bf.solve_static(model, steps)
    assert caught.value.load_factor == pytest.approx(follower_limit(), rel=1e-4 if elements == 8 else 5e-6)
    assert caught.value.solution.load_factor[-1] <= caught.value.load_factor


@pytest.mark.parametrize("steps", [1, 10])
@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF()], ids=["CRBF-3", "ANCF"])
def test_a_prescribed_rotation_that_jumps_is_named_and_does_not_run_for_ever(element, steps):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, element, bf.Rectangle(0.02, 0.002), STEEL)
    turn = bf.Prescribed(beam.end, rotation=lambda load: 1.5 if load > 0.3 else 0.0)
    model = bf.Model([beam], [bf.Clamp(beam.start), turn])
    with within(60.0), pytest.raises(bf.ConvergenceError, match="rotation") as caught:
        bf.solve_static(model, steps)
    assert caught.value.solution.load_factor[-1] == pytest.approx(0.3, abs=1e-3)


@pytest.mark.parametrize("size", [1e10, 1e12, 1e14])
def test_loads_beyond_all_stiffness_are_named_at_once(size):
    """The path goes straight to a tip that is millions of lengths away, in steps of half a length each."""
    section, material = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10, bf.CRBF(3), section, material)
    force = size * material.youngs_modulus * section.second_moment
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -force))])
    with pytest.raises(bf.ConvergenceError, match="out of reach: the loads are far too large") as caught:
        bf.solve_static(model)
    found = caught.value.solution
    assert len(found) < 200
    assert 0.0 < found.load_factor[-1] < 1e6 / size
    np.testing.assert_allclose(found.reaction(beam.start)[1:, 1], force * found.load_factor[1:], rtol=1e-8)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_a_load_step_whose_first_correction_goes_far_beyond_its_end_is_a_gap_in_any_unit(unit):
    """An end that moves by a tenth of its length: a first correction by a whole one is far, one by a fifth is not."""
    section, material = bf.Rectangle(0.02 * unit, 0.002 * unit), bf.Material(2e11 / unit**2, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (unit, 0)), 1, bf.CRBF(1), section, material)
    system = System(bf.Model([beam], [bf.Clamp(beam.start)]), static=True)
    (mesh,), moved = system.model.meshes, system.reference.copy()
    moved[mesh.coordinates_of(1)["r^y"]] += 0.1 * unit
    done = StaticRecord(system.model, system.symmetric)
    done.add(0.5, system.reference, 0, Termination.CONVERGED)
    for first, gap in ((1.0, True), (0.2, False)):
        assert (
            skips_limit_points(
                system, done, 1.0, NewtonResult(moved, 3, Termination.CONVERGED, first=first), bf.Newton()
            )
            == gap
        )
