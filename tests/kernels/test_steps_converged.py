"""The steps of a motion are converged and those of its rule, also where a kept tangent hardly sees what is left."""

from dataclasses import replace

import numpy as np
import pytest
from fuzz_steps import faults_of_steps

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.kernels.motion_record import MotionLimits, MotionStatistics
from beamfem.kernels.motion_steps import check_convergence
from beamfem.solve.motion.compiled_steps import CompiledSteps
from beamfem.solve.motion.energy_judgement import radius_at_infinity

TOLERANCE = 1e-9


def slender_arc_in_flight():
    """Found by the fuzz (seed 608): corrections of 6e-10 and 4e-10 hid that the end of a step was 4e-7 away."""
    points = [(-0.4589, 0.3101), (-0.4648, 0.0886), (-0.5024, -0.4235), (-0.5338, -0.6586)]
    curve = bf.BSpline(3, (0.0,) * 4 + (1.0,) * 4, points)
    beam = bf.Beam(curve, 1, bf.ANCFCRBF(), bf.Rectangle(4.7e-5, 1.64e-4), bf.Material(1.35e7, 0.49, 257.0))
    velocity = bf.RigidVelocity((0.0035, 0.0018), angular=0.0113)
    return bf.Model([beam]), {"step": 5.12, "velocity": velocity, "integrator": bf.GeneralizedAlpha(0.0)}


def bow_let_go():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(1e7, 0.3, 1000.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -0.3)), bf.Gravity((0.0, -9.81))])
    return model, {"step": 2e-3, "integrator": bf.GeneralizedAlpha(0.9)}


@pytest.mark.parametrize("kind", ["band", "sparse"])
@pytest.mark.parametrize("case", [slender_arc_in_flight, bow_let_go])
def test_no_step_ends_before_it_is_converged(case, kind, widest_band):
    if kind == "sparse":
        widest_band(-1)
    model, options = case()
    options |= {"duration": 39 * options["step"], "save_every": 1}
    assert list(faults_of_steps(bf.simulate(model, **options), options)) == []


def test_a_step_that_is_not_converged_or_does_not_follow_is_seen():
    model, options = bow_let_go()
    options |= {"duration": 20 * options["step"], "save_every": 1}
    motion = bf.simulate(model, **options)
    shift = np.zeros_like(motion.p)
    shift[:, -1] = 1e-6
    assert any("is left" in fault for fault in faults_of_steps(replace(motion, p=motion.p + shift), options))
    slow = replace(motion, v=motion.v * (1.0 + 1e-6))
    assert any("does not follow" in fault for fault in faults_of_steps(slow, options))


@pytest.mark.parametrize(
    ("own", "size", "last", "noise", "verdict"),
    [
        (0, 4e-10, 6e-10, 0.0, 2),  # a kept tangent that no longer gains
        (0, 4e-10, 6e-10, 5e-10, 1),  # where a new one has found no more than noise
        (1, 5e-10, 4e-10, 0.0, 1),  # a new one finds nothing
        (1, 1e-16, 4e-10, 0.0, 1),  # a new one finds that it was no noise, and that all is done
        (1, 4e-7, 4e-10, 0.0, 0),  # a new one finds what was left
        (0, 3e-12, 6e-10, 0.0, 0),
        (0, 1e-15, 6e-10, 0.0, 1),
        (0, np.nan, 6e-10, 0.0, -1),
    ],
)
def test_a_kept_tangent_does_not_judge_itself(own, size, last, noise, verdict):
    rate, known = np.array([0.1, 0.0]), MotionStatistics(noise=noise)
    assert check_convergence(3, 0, own, 0, size, last, 1.0, TOLERANCE, rate, known) == verdict
    assert known.noise == (2.0 * last if own and size == 5e-10 else noise)


@pytest.mark.parametrize(("own", "far", "verdict"), [(0, 0, 1), (0, 1, 2), (1, 1, 1)])
def test_a_tangent_from_far_away_does_not_judge_what_it_led_to(own, far, verdict):
    """A beam that creeps: from 38 m away it converged to 7e-5 m beside the equilibrium."""
    assert (
        check_convergence(2, 0, own, far, 1e-15, 38.0, 38.0, TOLERANCE, np.array([1.0, 0.0]), MotionStatistics())
        == verdict
    )


@pytest.mark.parametrize(("last", "own", "verdict"), [(0.8e-9, 0, 2), (1.6e-9, 0, 0), (0.8e-9, 1, 1), (1.6e-9, 1, 0)])
def test_one_small_correction_after_a_larger_one_is_no_round_off(last, own, verdict):
    """Ratios of 0.56 would leave as much again; only two corrections within the tolerance may be noise."""
    size = 0.56 * last
    known = MotionStatistics()
    assert check_convergence(2, 0, own, 0, size, last, 1.0, TOLERANCE, np.array([1.0, 0.0]), known) == verdict
    assert (known.noise > 0.0) == (verdict == 1)


@pytest.mark.parametrize(("factor", "verdict"), [(0.9, 1), (1.1, 0)])
def test_what_steps_leave_decreases_with_what_they_change(factor, verdict):
    """The geometric series size (0.1 + 0.01 + ...) of what is to come is at most 1e-8 of the change by a step."""
    changed = 1e-7
    size = factor * 1e-8 * changed * 9.0
    rate = np.array([0.1, 0.1])
    assert check_convergence(3, 0, 0, 0, size, 10.0 * size, changed, 1e-3, rate, MotionStatistics()) == verdict


@pytest.fixture
def steps_taken(monkeypatch):
    """The compiled steps of the motions of a test."""
    taken, advance = [], CompiledSteps.advance

    def seen(steps, *arguments):
        taken.append(steps)
        return advance(steps, *arguments)

    monkeypatch.setattr(CompiledSteps, "advance", seen)
    return taken


def test_the_change_of_the_acceleration_counts_as_what_it_changes_in_positions(steps_taken):
    """h^2 beta (1 - alpha_f) / (1 - alpha_m) times it; of the average-acceleration rule h^2 / 4."""
    model, _ = bow_let_go()
    motion = bf.simulate(model, 0.04, 2e-3, bf.GeneralizedAlpha(1.0))
    changed = np.abs(motion.a[-1] - motion.a[-2]) / system_of(model, static=False).scale
    assert steps_taken[-1]._statistics.change == pytest.approx(0.25 * 2e-3**2 * changed.max(), rel=1e-9)


@pytest.mark.parametrize(("begins", "order"), [(None, -1.0), (0.019, 0.0)], ids=["first", "tenth"])
def test_a_step_that_fails_starts_anew_from_what_was_nearer(begins, order, steps_taken):
    """A moment acts at once on a strip: in its first step from its positions, later from its acceleration before."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(1e7, 0.3, 1000.0))
    sudden = {} if begins is None else {"amplitude": lambda t: float(t > begins)}
    loads = [bf.PointMoment(beam.end, 0.2, **sudden), bf.Gravity((0.0, -0.1))]
    bf.simulate(bf.Model([beam], [bf.Clamp(beam.start)], loads), begins or 2e-3, 2e-3)
    steps = steps_taken[-1]
    assert steps._statistics.tangents > 3
    assert steps._space.solver.rule.order == order


@pytest.mark.parametrize(("begins", "order"), [(None, 0.0), (0.095, -1.0)], ids=["first", "tenth"])
def test_a_step_that_fails_again_starts_from_the_other_guess(begins, order, steps_taken, uncut_steps):
    """The moment winds the strip up so much in a step that neither guess leads to its end."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(1e7, 0.3, 1000.0))
    sudden = {} if begins is None else {"amplitude": lambda t: float(t > begins)}
    loads = [bf.PointMoment(beam.end, 5.0, **sudden), bf.Gravity((0.0, -0.1))]
    with pytest.raises(bf.ConvergenceError, match="did not converge"):
        bf.simulate(bf.Model([beam], [bf.Clamp(beam.start)], loads), begins or 1e-2, 1e-2)
    assert steps_taken[-1]._space.solver.rule.order == order


@pytest.mark.parametrize("rho_inf", [0.0, 0.3, 0.9, 1.0])
def test_the_spectral_radius_at_infinite_frequency(rho_inf):
    assert radius_at_infinity(bf.GeneralizedAlpha(rho_inf).rule(0.1)) == pytest.approx(rho_inf, abs=1e-6)


@pytest.mark.parametrize(("correction", "why"), [(4e-14, "turned inside out"), (3e-2, "3.00e-02 of the model")])
def test_the_reason_of_a_failed_step_is_not_a_correction_that_is_round_off(correction, why):
    """Iterations that converge are refused where beams would be inside out."""
    steps = CompiledSteps.__new__(CompiledSteps)
    steps._statistics, steps._limits = MotionStatistics(correction=correction), MotionLimits()
    assert why in steps.why
