"""The acceleration that a time step begins with, extrapolated through the last steps."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.kernels.motion_record import MotionSolver, MotionStatistics, Rule
from beamfem.kernels.motion_steps import check_convergence
from beamfem.kernels.predictor import MOST, complete, difference_rows, padded, predict
from beamfem.kernels.records import aligned
from studies.benchmarks.peer_cases import STRUCTURAL, pendulum, swing

RULE = Rule(time_step=0.01, alpha_m=0.5, alpha_f=0.5, gamma=0.5, beta=0.25)  # trapezoidal rule


def extrapolated(accelerations, weights):
    """Go through accelerations (steps, n); return what each step expected (steps - 1, n), and the last statistics."""
    n = accelerations.shape[1]
    steps = MotionSolver(
        size=n,
        rule=RULE,
        statistics=MotionStatistics(),
        differences=np.zeros(difference_rows(n)),
        inverse_scale=np.zeros(padded(n)),
    )
    steps.fill(**aligned(steps.shapes("state", "before")))
    steps.inverse_scale[:n] = weights
    state, expected = steps.state, []
    state[2] = accelerations[0]
    for now in accelerations[1:]:
        RULE.order = steps.statistics.best_order
        predict(steps)
        expected.append(state[2].copy())
        new = (1.0 - RULE.alpha_f) / (1.0 - RULE.alpha_m) * (now - state[2])
        state[0] += RULE.time_step**2 * RULE.beta * new
        state[1] += RULE.time_step * RULE.gamma * new
        state[2] = now
        complete(steps)
    return np.array(expected), steps.statistics


@pytest.mark.parametrize("degree", range(MOST + 1))
@pytest.mark.parametrize("n", [4, 8, 11, 17])
def test_a_polynomial_is_extrapolated_exactly(degree, n):
    coefficients = np.random.default_rng(degree).standard_normal((n, degree + 1))
    times = np.arange(2 * MOST + 4)
    accelerations = np.array([np.polynomial.polynomial.polyval(0.1 * t, coefficients.T) for t in times])
    expected, statistics = extrapolated(accelerations, 1.0)
    first = degree + 2  # a step more than the differences that are known by then
    assert degree <= statistics.best_order <= MOST
    assert statistics.known_differences >= statistics.best_order
    np.testing.assert_allclose(expected[first:], accelerations[first + 1 :], atol=1e-10 * np.abs(accelerations).max())


@pytest.mark.parametrize("n", [4, 9, 16])
@pytest.mark.parametrize("degree", [0, 1])
def test_what_jumps_to_and_fro_about_a_line_is_expected_to_go_on(n, degree):
    """Polynomials through the last steps expected it three times as far on the wrong side, or farther."""
    steps = np.arange(30.0)[:, None]
    accelerations = (-1.0) ** steps * np.linspace(1.0, 2.0, n) + (0.2 * steps) ** degree
    expected, _ = extrapolated(accelerations, 1.0)
    np.testing.assert_allclose(expected[degree + 4 :], accelerations[degree + 5 :], atol=1e-12)


def test_beside_what_jumps_to_and_fro_smooth_coordinates_are_extrapolated_as_alone():
    smooth = np.cos(0.1 * np.arange(60.0)[:, None] + np.arange(8.0))
    rough = np.column_stack([smooth, (-1.0) ** np.arange(60)])
    alone, beside = (extrapolated(accelerations, 1.0)[0] for accelerations in (smooth, rough))
    errors = [np.abs(expected[:, :8] - smooth[1:])[10:].max() for expected in (alone, beside)]
    assert errors[1] < 3.0 * 0.1**2  # of order 1, where the cosine bends; order 3 has no part that alternates
    assert errors[0] < errors[1]


def left_after_the_last_correction(first, ratios):
    """Return the sum of the corrections, whose ratios are repeated, that come after the one which ends a step."""
    sizes = first * np.cumprod([1.0, *np.tile(ratios, 10)])
    rate, known = np.array([0.1, 0.0]), MotionStatistics()
    for number, size in enumerate(sizes, start=1):
        last = sizes[number - 2] if number > 1 else 0.0
        if check_convergence(number, 0, 0, 0, size, last, 1.0, 1e-9, rate, known) == 1:
            return sizes[number:].sum()
    raise AssertionError("it does not end")


@pytest.mark.parametrize("ratios", [(1e-3, 0.25), (0.25, 1e-3), (1e-2, 1e-2), (1e-4, 0.4)])
@pytest.mark.parametrize("first", [1e-3, 1e-5, 3e-6])
def test_what_is_left_of_the_error_is_small_where_ratios_of_corrections_take_turns(ratios, first):
    """By the last ratio alone a step ended at 1.1e-11 with 4e-12 to come, where 1e-14 was meant."""
    assert left_after_the_last_correction(first, ratios) < 1.1e-14


@pytest.mark.parametrize("first", [1e-3, 4e-4, 1e-5, 1e-8])
@pytest.mark.parametrize("ratios", [(4e-6, 0.4), (1e-8, 0.4), (5e-4, 0.25)])
def test_a_single_small_ratio_does_not_end_a_step_with_much_left(first, ratios):
    """The second correction of 2e-9, by a ratio of 4e-6, ended a step with 6e-10 to come."""
    assert left_after_the_last_correction(first, ratios) < 1e-10 * ratios[1] * 1.1


def test_coordinates_without_weight_do_not_choose_the_order():
    smooth = 0.1 * np.arange(30.0)[:, None] ** 2 * np.ones(3)
    rough = (-1.0) ** np.arange(30)[:, None]
    weights = np.array([1.0, 1.0, 1.0, 0.0])
    expected, statistics = extrapolated(np.hstack([smooth, rough]), weights)
    assert statistics.best_order >= 2.0
    np.testing.assert_allclose(expected[4:, :3], smooth[5:], atol=1e-9)


def test_a_smooth_motion_takes_few_corrections_and_is_the_same():
    model, rule = pendulum(STRUCTURAL, 6), bf.GeneralizedAlpha(1.0)
    solution = swing(model, 1000)
    assert solution.iterations < 2300
    state = solution[0]
    for _ in range(200):  # each step on its own knows no acceleration before
        state = bf.simulate(model, duration=1e-3, step=1e-3, integrator=rule, start=state)[-1]
    alike = bf.simulate(model, duration=0.2, step=1e-3, integrator=rule)
    np.testing.assert_allclose(alike.p[-1], state.p, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("size", [0.99, 1.0, 1.0001, 1.01])
@pytest.mark.parametrize("frame", [False, True])
def test_a_sudden_moment_on_a_pin_turns_it_no_further_in_long_steps(size, frame, uncut_steps):
    """The section at the pin has next to no inertia: its acceleration of before, 1 rad in a step, says nothing of it.

    Steps that began there took 18 iterations each, found another equilibrium now and then (the end turned by 3.5 rad
    instead of 0.006) or none.
    """
    material, section = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    beams = [bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 3, bf.CRBF(2), section, material)]
    if frame:  # no band then
        beams += [bf.Beam(bf.Line((0.0, y), (1.0, y)), 3, bf.CRBF(2), section, material) for y in (1.0, 2.0)]
        corners = [(1.0, 0.0), (1.0, 1.0)]
        ties = [bf.Beam(bf.Line(a, (a[0], a[1] + 1.0)), 3, bf.CRBF(2), section, material) for a in corners]
        beams += ties
    pins = [bf.Pin(beam.start) for beam in beams[:3]]
    joints = []
    if frame:
        joints = [bf.Rigid(beams[0].end, beams[3].start), bf.Rigid(beams[3].end, beams[1].end)]
        joints += [bf.Rigid(beams[1].end, beams[4].start), bf.Rigid(beams[4].end, beams[2].end)]
    model = bf.Model(beams, pins, [bf.PointMoment(beams[0].start, size)], joints=joints)
    found = {}
    for step in (1e-3, 5e-4, 2e-4):
        solution = bf.simulate(model, 0.05, step)
        found[step] = solution.rotation(beams[0].start)[:: round(1e-3 / step)]
        assert solution.iterations < 6 * len(solution.time), step
    fine = found[2e-4]
    for step, turned in found.items():
        assert np.abs(turned - fine).max() < 0.25 * np.abs(fine).max(), step


def test_a_motion_that_gains_energy_says_so(uncut_steps):
    """Three soft elements curl under a sudden moment, 10 steps in half a period: 19 times its energy from nowhere."""
    section, material = bf.Rectangle(0.002, 0.002), bf.Material(2.6e6, 0.3, 1000.0)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 3, bf.CRBF(1), section, material)
    bending, mass = 2.6e6 * section.second_moment, 1000.0 * section.area
    half_period = np.pi / (3.516 * np.sqrt(bending / mass))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, bending)])
    with pytest.warns(bf.errors.EnergyWarning, match="rises by"):
        long = bf.simulate(model, half_period, half_period / 10)
    short = bf.simulate(model, half_period, half_period / 400)
    assert long.energy_drift.change > long.energy_drift.exchanged
    assert any("the time steps do not resolve" in sentence for sentence in long.warnings)
    assert short.energy_drift.digits > 3.0
    assert not short.warnings


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("element", [bf.CRBF(2), bf.BilinearCRBF(), bf.ANCF()], ids=lambda element: element.name)
def test_long_steps_of_a_beam_that_damps_much_converge(element, sparse, widest_band, uncut_steps):
    """Predicted resultants had no viscous part, which is most of them where a step is as long as the retardation."""
    if sparse:
        widest_band(-1)
    section, material = bf.Rectangle(0.05, 0.02), bf.Material(2e11, 0.3, 7800.0, retardation_time=1e-2)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 4, element, section, material)
    force = bf.PointForce(beam.end, (0.0, 0.3 * 2e11 * section.second_moment))
    model, duration = bf.Model([beam], [bf.Clamp(beam.start)], [force]), 0.12
    long, short = (bf.simulate(model, duration, duration / n, bf.GeneralizedAlpha(0.8)) for n in (10, 160))
    assert long.iterations < 120
    assert np.abs(long.p[-1] - short.p[-1]).max() < 0.02 * np.abs(short.p[-1] - short.p[0]).max()
