"""Relative error of the period that the steps of a motion give the frequency that carries its energy."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from beamfem.equations.system import System, system_of
from beamfem.errors import TimeStepWarning, warn
from beamfem.results.solution import Solution
from beamfem.solve.start.functions_of_time import FunctionOfTime

_OF_SCHEME = 5  # numbers of a rule, see `Scheme`
_PERIODS = 2.0  # fewest in the second half of a motion that define a frequency
_NEAR = 0.25  # of a natural frequency, within which a driven motion is near resonance
_DETUNED = 0.1  # of a period; a response that is out of phase by less over the whole motion has hardly changed
_ROWS = 200  # most rows at which energies are evaluated
_OF_PERIOD = 20  # fewest of these in a period; fewer can fall on the same phases of all periods


def lengthened_period(solution: Solution) -> tuple[float, float]:
    """Return the frequency [Hz] of a motion, and by which ratio its steps lengthen the period there; nan if unknown."""
    rule = solution.statistics.rule
    frequency = _main_frequency(solution) if len(rule) == _OF_SCHEME else np.nan
    return frequency, period_error(rule, frequency) if frequency > 0.0 else np.nan


def period_error(rule: Sequence[float], frequency: float) -> float:
    """Return by which ratio a method lengthens the period of an undamped vibration; rule: see `Scheme`.

    The principal roots of the method for x'' + w^2 x = 0 turn by an angle a in a step h; the ratio is w h / a - 1.
    """
    step, alpha_m, alpha_f, gamma, beta = rule
    turn = 2.0 * np.pi * frequency * step
    stiffness = turn**2
    # in x, h x' and h^2 a
    after = [[1.0, 0.0, -beta], [0.0, 1.0, -gamma], [(1.0 - alpha_f) * stiffness, 0.0, 1.0 - alpha_m]]
    before = [[1.0, 1.0, 0.5 - beta], [0.0, 1.0, 1.0 - gamma], [-alpha_f * stiffness, 0.0, -alpha_m]]
    roots = np.linalg.eigvals(np.linalg.solve(after, before))
    angles = np.abs(np.angle(roots[np.abs(roots.imag) > 0.0]))
    if not len(angles):
        return np.inf
    return float(turn / angles[np.argmin(np.abs(angles - turn))] - 1.0)


def _main_frequency(solution: Solution) -> float:
    """Return the frequency [Hz] of the second half of a motion: w^2 is the mean square velocity per displacement.

    nan for less than two periods, which define none.
    """
    half = slice(len(solution) // 2, None)
    if len(solution.at[half]) < 4:
        return np.nan
    dofs = np.flatnonzero(system_of(solution.model, static=False).positions)
    moved = solution.p[half][:, dofs]
    moved = moved - moved.mean(axis=0)
    speed = float(np.linalg.norm(solution.v[half][:, dofs]))
    size = float(np.linalg.norm(moved))
    if not size > 0.0:
        return np.nan
    frequency = speed / size / (2.0 * np.pi)
    return frequency if frequency * float(np.ptp(solution.at[half])) >= _PERIODS else np.nan


def detuned(solution: Solution, system: System, functions: list[FunctionOfTime]) -> tuple[str, ...]:
    """Warn of a motion that is driven near resonance if the steps change its period by too much.

    That is more than half the damping ratio; without damping, more than a tenth of a period over the motion. Return the
    sentence. Only damping of beams counts, with the smallest ratio w t / 2 + a / (2 w) of a retardation time t and a
    factor a of the mass.
    """
    if not functions:
        return ()
    frequency, error = lengthened_period(solution)
    cycles = frequency * float(solution.at[-1])
    if not error * cycles > _DETUNED:
        return ()
    omega = 2.0 * np.pi * frequency
    ratios = [0.5 * (omega * beam.retardation_time + beam.mass_damping / omega) for beam in solution.model.beams]
    damping = min((ratio for ratio in ratios if ratio > 0.0), default=0.0)
    if damping > 0.0:
        resonant = error > 0.5 * damping and _resonates(solution, functions, frequency)
        allowed, compared = 0.1 * damping, f"more than half the damping ratio there, {100 * damping:.2g} %"
    else:
        damped = not system.connectors.keep_energy or system.damped
        # steps do not show at which frequency they drive a vibration of less than two of them
        unknown = damped or system.history.laws or frequency * solution.statistics.rule[0] > 0.5
        drives = [] if unknown else [_frequency_of(function, solution) / frequency for function in functions]
        # between the period with steps and without; over some periods, those within 1 of as many resonate
        resonant = any(1.0 / (1.0 + error) - 1.0 / cycles < drive < 1.0 + 1.0 / cycles for drive in drives)
        allowed, compared = _DETUNED / cycles, f"{error * cycles:.2g} periods over the motion, which has no damping"
    if not resonant:
        return ()
    sentence = (
        f"the time steps lengthen the period at {frequency:.4g} {solution.model.unit('Hz')}, where the motion is "
        f"driven near resonance, by {100 * error:.2g} %, {compared}: they detune the resonance. Use steps shorter by a "
        f"factor of {np.sqrt(error / allowed):.2g}"
    )
    warn(sentence, TimeStepWarning)
    return (sentence,)


def _resonates(solution: Solution, functions: list[FunctionOfTime], frequency: float) -> bool:
    """Return whether functions of time vary in the second half of a motion that vibrates near a natural frequency.

    Its kinetic energy then equals, in the mean, the strain and potential energy above the least one of each period,
    with loads as they are in the mean.
    """
    first = len(solution.at) // 2
    half = solution.at[first:]
    values = np.array([[function.at(time) for time in half.tolist()] for function in functions])
    varied = np.ptp(values, axis=1)
    if not varied.any():
        return False
    spacing = (half[-1] - half[0]) / (len(half) - 1)
    stride = max(int(1.0 / (_OF_PERIOD * frequency * spacing)), 1)
    rows = solution[max(first, len(solution) - _ROWS * stride) :: stride]
    off = np.abs(values - values.mean(axis=1, keepdims=True))[varied > 0.0] / varied[varied > 0.0, None]
    energy = replace(rows, at=np.full(len(rows), half[np.argmin(off.sum(axis=0))])).energy()
    stored, period = energy.strain + energy.potential, max(int(1.0 / (frequency * stride * spacing)), _OF_PERIOD)
    parts = np.array_split(stored, max(len(stored) // period, 1))
    exchanged = sum(float(np.sum(part - part.min())) for part in parts) / len(stored)
    ratio = np.sqrt(float(np.mean(energy.kinetic)) / max(exchanged, np.finfo(float).tiny))
    return bool(abs(ratio - 1.0) <= _NEAR)


def _frequency_of(function: FunctionOfTime, solution: Solution) -> float:
    """Return the frequency [Hz] of a function in the second half of a motion, from its second differences over steps.

    Those of a sine of angular frequency w are -4 sin^2(w h / 2) times its values.
    """
    last, step = float(solution.at[-1]), solution.statistics.rule[0]
    values = np.array([function.at(time) for time in np.arange(0.5 * last, last, step).tolist()])
    values = values - values.mean()
    square = float(values @ values)
    share = -float(np.diff(values, 2) @ values[1:-1]) / (4.0 * square) if square > 0.0 else 0.0
    return float(np.arcsin(np.sqrt(np.clip(share, 0.0, 1.0))) / (np.pi * step))
