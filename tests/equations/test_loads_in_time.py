"""Loads that vary in time: impulses of pulses, kinks that functions declare, and what steps cannot resolve."""

from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf
from beamfem.solve.motion.time_steps import stretches
from beamfem.solve.start.functions_of_time import FunctionOfTime

STEEL = bf.Material(2e11, 0.3, 7800.0)


def half_sine(time, begin=0.0, duration=1e-3):
    return float(np.sin(np.pi * (time - begin) / duration)) if begin <= time <= begin + duration else 0.0


def pushed(amplitude, step=2e-3, duration=0.02, rho_inf=0.9, save_every=1):
    """A free beam, pushed along its axis by 100 N times an amplitude."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), STEEL)
    model = bf.Model([one], loads=[bf.PointForce(one.end, (100.0, 0.0), amplitude=amplitude)])
    return bf.simulate(model, duration, step, bf.GeneralizedAlpha(rho_inf), save_every=save_every)


@pytest.mark.parametrize("begin", [0.0, 0.0033, 0.0055])
@pytest.mark.parametrize("rho_inf", [0.0, 0.9, 1.0])
def test_a_short_pulse_between_declared_kinks_gives_its_impulse(begin, rho_inf):
    """A half sine of 1 ms within steps of 2 ms gave nothing."""
    pulse = bf.Piecewise(lambda t: half_sine(t, begin), (begin, begin + 1e-3))
    solution = pushed(pulse, rho_inf=rho_inf)
    assert solution.linear_momentum()[-1, 0] == pytest.approx(100.0 * 2e-3 / np.pi, rel=2e-4)
    assert len(solution) == 11


def test_a_pulse_of_exactly_one_step_gives_its_impulse_when_it_is_declared():
    solution = pushed(bf.Piecewise(lambda t: half_sine(t, 0.0, 2e-3), (0.0, 2e-3)))
    assert solution.linear_momentum()[-1, 0] == pytest.approx(100.0 * 4e-3 / np.pi, rel=2e-4)


@pytest.mark.parametrize(
    ("begin", "end"), [(0.0033, 0.0053), (0.004, 0.006), (0.0, 0.0007), (0.0033, 0.0037), (0.0, 0.02)]
)
@pytest.mark.parametrize("closed", [False, True])
def test_a_rectangular_pulse_gives_its_impulse_exactly(begin, end, closed):
    inside = (lambda t: float(begin <= t <= end)) if closed else (lambda t: float(begin < t < end))
    solution = pushed(bf.Piecewise(inside, (begin, end)))
    assert solution.linear_momentum()[-1, 0] == pytest.approx(100.0 * (end - begin), rel=1e-9)


def test_a_table_gives_the_impulse_of_its_straight_pieces_whatever_the_step():
    table = bf.Interpolated([(0.0031, 0.0), (0.0034, 1.0), (0.0041, -0.5), (0.0049, 0.0)])
    expected = 100.0 * (0.5 * 3e-4 + 0.25 * 7e-4 - 0.25 * 8e-4)
    for step in (2e-3, 7e-4, 1e-4):
        assert pushed(table, step, rho_inf=1.0).linear_momentum()[-1, 0] == pytest.approx(expected, rel=1e-9)


def test_steps_that_end_at_kinks_are_those_of_the_grid():
    """A table at multiples of the step divides nothing, and changes nothing."""
    points = [(0.0, 0.0), (0.004, 1.0), (0.01, 0.2)]
    table, plain = pushed(bf.Interpolated(points)), pushed(lambda t: np.interp(t, *np.transpose(points)))
    assert np.array_equal(table.p, plain.p)
    assert repr(table.statistics) == repr(plain.statistics)  # digits may be nan


@pytest.mark.parametrize("save_every", [1, 3, 100])
def test_divided_steps_are_kept_like_others(save_every):
    pulse = bf.Piecewise(lambda t: half_sine(t, 0.0033), (0.0033, 0.0043))
    every, some = pushed(pulse), pushed(pulse, save_every=save_every)
    rows = [*range(0, 10, save_every), 10]
    assert np.array_equal(some.p, every.p[rows])
    assert some.time == pytest.approx(every.time[rows])


@pytest.mark.parametrize("save_every", [1, 4, 100])
def test_a_failure_in_a_divided_step_hands_back_the_last_whole_one(save_every):
    blow = bf.Piecewise(lambda t: float(t > 0.0051), (0.0051,))
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.ANCF(), bf.Rectangle(0.01, 0.01), STEEL)
    model = bf.Model([one], loads=[bf.PointForce(one.end, (1e15, 0.0), amplitude=blow)])
    with pytest.raises(bf.ConvergenceError, match=r"the step from 0\.0051 s to 0\.006 s did not converge") as caught:
        bf.simulate(model, 0.02, 2e-3, save_every=save_every)
    kept = caught.value.solution
    assert kept.time[-1] == pytest.approx(0.004)
    assert np.abs(kept.p[-1] - kept.p[0]).max() < 1e-15


@pytest.mark.parametrize("rho_inf", [1.0, 0.5])
def test_the_order_stays_two_where_kinks_divide_steps(rho_inf):
    """A ringing cantilever under a table, all of whose kinks lie within steps, against fine steps at its kinks."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Rectangle(0.01, 0.01), STEEL)
    table = bf.Interpolated([(0.0, 0.0), (0.01234, 1.0), (0.03456, -1.0), (0.05678, 0.0)])
    model = bf.Model([one], [bf.Clamp(one.start)], [bf.PointForce(one.end, (0.0, 1.0), amplitude=table)])

    def tip(step):
        return bf.simulate(model, 0.08, step, bf.GeneralizedAlpha(rho_inf)).displacement(one.end)[-1, 1]

    exact = tip(5e-5)
    errors = [abs(tip(step) - exact) for step in (2e-3, 1e-3, 5e-4)]
    assert np.log2(errors[0] / errors[-1]) / 2.0 > 1.8, errors


def test_a_load_that_varies_within_a_step_is_named():
    with pytest.warns(UserWarning, match=r"amplitude of PointForce at \(1, 0\).* within the step from 0 s to 0\.002 s"):
        solution = pushed(half_sine)
    assert "varies within steps" in solution.statistics.ended
    # nothing but round-off of what 100 N would give, 0.06 N s
    assert abs(solution.linear_momentum()[-1, 0]) < 1e-20


def test_the_weight_follows_its_amplitude():
    """Found by mutation: gravity's amplitude frozen at its start went unnoticed."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), STEEL)
    model = bf.Model([one], loads=[bf.Gravity((0.0, -10.0), amplitude=lambda t: 3.0 * t)])
    solution = bf.simulate(model, 0.1, 1e-3, bf.GeneralizedAlpha(1.0))
    gained = solution.linear_momentum()[:, 1]
    assert gained == pytest.approx(-7800.0 * 1e-4 * 15.0 * solution.time**2, rel=1e-9)


@pytest.mark.parametrize("kinks", [(0.1, 0.1), (0.2, 0.1), ("a",), 3.0])
def test_kinks_that_are_no_increasing_times_are_refused(kinks):
    with pytest.raises(bf.InputError, match="kinks"):
        bf.Piecewise(np.sin, kinks)


@pytest.mark.parametrize("save_every", [1, 3, 100])
def test_a_failed_step_is_undone_whatever_is_kept(save_every):
    """Found by mutation: the last state was that of the failed step where save_every does not divide."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.ANCF(), bf.Rectangle(0.01, 0.01), STEEL)

    def run(size, duration):
        amplitude = lambda t: 1.0 if t < 0.0095 else size  # noqa: E731
        model = bf.Model([one], loads=[bf.PointForce(one.end, (0.0, 1.0), amplitude=amplitude)])
        return bf.simulate(model, duration, 2e-3, save_every=save_every)

    with pytest.raises(bf.ConvergenceError, match=r"the step from 0\.008 s to 0\.01 s did not converge") as caught:
        run(1e15, 0.02)
    kept, good = caught.value.solution, run(1.0, 0.008)
    assert kept.time == pytest.approx(good.time)
    assert np.array_equal(kept.p, good.p)
    assert np.array_equal(kept.a, good.a)


@pytest.mark.parametrize("unit", [1e-5, 1e5])
def test_a_pulse_gives_its_impulse_in_any_unit_of_time(unit):
    """Lengths in m, times in `unit` s: what is asked beside a kink is asked at a share of the step."""
    stiff = bf.Material(2e11 * unit**2, 0.3, 7800.0)
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), stiff)
    begin, end = 0.0033 / unit, 0.0043 / unit
    pulse = bf.Piecewise(lambda t: float(begin < t < end), (begin, end))
    force = bf.PointForce(one.end, (100.0 * unit**2, 0.0), amplitude=pulse)
    solution = bf.simulate(bf.Model([one], loads=[force]), 0.02 / unit, 2e-3 / unit)
    assert solution.linear_momentum()[-1, 0] == pytest.approx(100.0 * 1e-3 * unit, rel=1e-9)


@pytest.mark.parametrize("unit", [1e-12, 1e12])
def test_steps_are_divided_at_the_same_kinks_in_any_unit_of_time(unit):
    """A jump at the end of a step, a hump that bulges inside one, and a kink in the middle of another.

    The ramp that they stand on is there during the motion only: nothing is asked before or after it.
    """

    def amplitude(time):
        share = time / unit
        ramp = share * (0.0 <= share <= 10.0)
        return ramp + (share >= 3.0) + max(0.0, 1.0 - abs(share - 5.5)) + 16.0 * max(0.0, 0.25 - (share - 7.5) ** 2)

    found = []
    for own in (1.0, unit):
        function = bf.Piecewise(lambda t, own=own: amplitude(t * unit / own), tuple(own * np.array([3.0, 5.5])))
        found.append(stretches(own * np.arange(11.0), [FunctionOfTime("amplitude", function, True)]))
    plain, scaled = found
    assert [len(one.times) for one in scaled] == [len(one.times) for one in plain]
    for one, other in zip(plain, scaled, strict=True):
        np.testing.assert_allclose(other.times, unit * one.times, rtol=1e-12)
        assert (one.whole, one.ends_whole) == (other.whole, other.ends_whole)
        assert [other.loads_from, other.loads_to] == pytest.approx([unit * one.loads_from, unit * one.loads_to])
    assert [one.times[0] for one in plain] == [0.0, 3.0, 5.0, 5.5, 6.0, 7.0, 8.0]


@pytest.mark.parametrize("save_every", [1, 2, 3])
def test_a_motion_that_fails_behind_a_kink_ends_with_its_last_whole_step(save_every):
    """It flies at 3 m/s; the load that tears it begins at 0.055 s, inside the step from 0.05 s to 0.06 s."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.ANCF(), bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1e3))
    tearing = bf.Piecewise(lambda t: float(t > 0.055), (0.055,))
    model = bf.Model([one], loads=[bf.PointForce(one.end, (1e15, 0.0), amplitude=tearing)])
    with pytest.raises(bf.ConvergenceError, match=r"from 0\.055 s to 0\.06 s") as caught:
        bf.simulate(model, 0.1, 0.01, velocity=bf.RigidVelocity((3.0, 0.0)), save_every=save_every)
    found = caught.value.solution
    assert found.time[-1] == pytest.approx(0.05)
    assert found.displacement(one.start)[:, 0] == pytest.approx(3.0 * found.time, abs=1e-9)


ROWS = {
    "all": {},
    "some": {"save_every": 5},
    "at times": {"save_at": 0.005 * np.arange(5)},
    "with an event": {"events": [bf.Event("never", lambda state: 1.0)]},
    "under a tolerance": {"tolerance": 1e-4},
    "in a file": {"file": "motion.h5"},
}


@pytest.mark.parametrize("from_there", [True, False])
@pytest.mark.parametrize("rows", ROWS)
def test_the_acceleration_in_the_row_of_a_jump_is_that_of_the_load_at_its_time(rows, from_there, tmp_path):
    """A free bar of 0.78 kg whose weight begins at once, ends at 10 ms, and begins anew at the end, or right after it.

    Rows that a file, `save_at`, an event or a tolerance kept had the acceleration before the jump.
    """
    jumps = (0.0, 0.01, 0.02)
    acts = (lambda t: t < 0.01 or t >= 0.02) if from_there else (lambda t: 0.0 < t <= 0.01)
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    weight = bf.Gravity((0.0, -10.0), amplitude=bf.Piecewise(lambda t: float(acts(t)), jumps))
    how = {key: tmp_path / value if key == "file" else value for key, value in ROWS[rows].items()}
    motion = bf.simulate(bf.Model([one], loads=[weight]), 0.02, 1e-3, **how)
    acceleration = motion.acceleration(one.at(0.3))[:, 1]
    assert set(jumps) < set(motion.time.tolist())
    assert acceleration == pytest.approx([-10.0 * acts(time) for time in motion.time.tolist()], abs=1e-9)


@pytest.mark.parametrize("rows", ["all", "in a file"])
def test_forces_in_the_row_of_a_jump_are_those_under_the_load_at_its_time(rows, tmp_path):
    """A rod that a link ties to a mass, on a post with next to no mass of its own, is pushed from 10 ms on."""
    light = bf.Material(2.1e11, 0.3, 7.8e-6)
    post, rod = (
        bf.Beam(bf.Line((x, 0.0), (x + 1.0, 0.0)), 1, bf.CRBF(2), bf.Rectangle(0.02, 0.02), material)
        for x, material in ((0.0, light), (2.0, STEEL))
    )
    link = bf.Link(post.end, rod.start)
    push = bf.PointForce(rod.end, (1e3, 0.0), amplitude=bf.Piecewise(lambda t: float(t >= 0.01), (0.01,)))
    mass = bf.PointMass(post.end, 2.0)
    model = bf.Model([post, rod], [bf.Clamp(post.start)], [push], connectors=[link], masses=[mass])
    how = {"file": tmp_path / "motion.h5"} if rows == "in a file" else {}
    motion = bf.simulate(model, 0.015, 1e-3, **how)
    needed = replace(motion, v=motion.a).linear_momentum()[:, 0]  # it is linear in p', so that this is its rate
    by_link, carried = motion.joint_force(link)[:, 0], 2.0 * motion.acceleration(post.end)[:, 0]
    assert by_link[:10] == pytest.approx(0.0, abs=1e-9)
    assert by_link[10] == pytest.approx(-carried[10], rel=1e-4)
    assert by_link[10] < -100.0
    assert by_link[10] + 1e3 == pytest.approx(needed[10] - carried[10], rel=1e-4)


def flying_bar(amplitude):
    """A bar of 78.5 kg under 100 N."""
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(3), bf.Rectangle(0.1, 0.1), steel)
    return bar, bf.Model([bar], loads=[bf.DistributedLoad(bar, (100.0, 0.0), amplitude=amplitude)])


@pytest.mark.parametrize("integrator", [None, bf.Radau(2), bf.Gauss(3), bf.GeneralizedAlpha()])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
@pytest.mark.parametrize("jump", [0.31, 0.32, 0.5])
def test_steps_that_follow_a_tolerance_find_jumps_that_nobody_declares(jump, tolerance, integrator):
    """Between the beginning of a step and its first stage, no step saw them: off by 4.5 cm at any tolerance."""
    bar, model = flying_bar(lambda t: 1.0 if t < jump else -1.0)
    motion = bf.simulate(model, 1.0, None, integrator, tolerance=tolerance)
    later, acceleration = 1.0 - jump, 100.0 / 78.5
    expected = acceleration * (0.5 * jump**2 + jump * later - 0.5 * later**2)
    assert motion.displacement(bar.end)[-1, 0] == pytest.approx(expected, abs=0.1 * tolerance)


@pytest.mark.parametrize("integrator", [None, bf.GeneralizedAlpha()])
@pytest.mark.parametrize(
    ("smooth", "begin", "width"),
    [(False, 0.4, 2e-3), (False, 0.4321, 0.02), (False, 0.7, 0.05), (True, 0.4321, 0.02), (True, 0.7, 0.05)],
)
def test_steps_that_follow_a_tolerance_see_single_pulses(smooth, begin, width, integrator):
    """Steps once went over them without a warning."""

    def pulse(t):
        return np.exp(-(((t - begin) / (0.3 * width)) ** 2)) if smooth else float(begin < t < begin + width)

    _, model = flying_bar(pulse)
    motion = bf.simulate(model, 1.0, None, integrator, tolerance=1e-5)
    impulse = 100.0 * width * (0.3 * np.sqrt(np.pi) if smooth else 1.0)
    assert motion.linear_momentum()[-1, 0] == pytest.approx(impulse, rel=5e-3)


@pytest.mark.parametrize("how", [{"tolerance": 1e-4}, {"tolerance": 1e-6}, {"step": 0.02}])
@pytest.mark.parametrize("kind", ["force", "motor"])
def test_functions_of_the_state_declare_when_they_jump(kind, how):
    class Torque:
        kinks = (0.31,)

        def __call__(self, time, *state):
            moment = 10.0 if time < 0.31 else -10.0
            return moment if kind == "motor" else (0.0, 0.0, moment)

    steel, section = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.1, 0.1)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(3), section, steel, damping=bf.KelvinVoigt(1e-4))
    motor = [bf.Motor(bar.start, torque=Torque())] if kind == "motor" else []
    forces = [] if kind == "motor" else [bf.StateForce(bar.start, Torque())]
    model = bf.Model([bar], [bf.Pin(bar.start)], motor, connectors=forces)
    motion = bf.simulate(model, 1.0, **how)
    inertia = 7850.0 * (0.01 / 3.0 + 0.1**4 / 12.0)
    expected = 10.0 / inertia * (0.5 * 0.31**2 + 0.31 * 0.69 - 0.5 * 0.69**2)
    assert motion.rotation(bar.end)[-1] == pytest.approx(expected, abs=2e-5)
    energy = motion.energy()
    assert energy.work[-1] == pytest.approx(energy.total[-1] + energy.dissipated[-1], rel=1e-3)
