"""Kinks of forces in a motion: where cables become taut or slack, stops are hit, and laws of springs have corners."""

import numpy as np

from beamfem.equations.parts_at_points import Alike
from beamfem.equations.system import System
from beamfem.solve.motion.dense_output import interpolated

_SHARES = np.linspace(0.0, 1.0, 33)  # of a step, between which measures are straight enough
_AT_END = 1e-3  # of a step: a kink this close to its end is there


def kinked(system: System) -> tuple[Alike, ...]:
    """Return the parts of a model whose forces have kinks."""
    parts = [(each, system.reference[None, each.numbers]) for each in system.parts if isinstance(each, Alike)]
    return tuple(each for each, q in parts if each.kinks(q, np.zeros_like(q)).size)


def first_kink(system: System, times: np.ndarray, states: np.ndarray) -> tuple[int, float] | None:
    """Return the first step that a kink is in, and its time [s], or None.

    times (m + 1,) [s], states (m + 1, 3, n): of the ends of m steps of a method with stages. Steps are looked into if a
    measure changes its sign to their ends, or would to their middle with its rate at an end.
    """
    parts = system.table(kinked)
    own, steps = states[:, :, np.concatenate([part.numbers.ravel() for part in parts])], np.diff(times)
    p, v, half = own[:, 0], own[:, 1], 0.5 * steps[:, None]
    p = np.concatenate([p, p[:-1] + half * v[:-1], p[1:] - half * v[1:]])
    taut = _measures(parts, p, np.concatenate([v, v[:-1], v[1:]])) > 0.0
    begin, others = taut[: len(steps)], (taut[1 : len(times)], *np.split(taut[len(times) :], 2))
    for step in np.flatnonzero(np.any([(begin != other).any(axis=1) for other in others], axis=0)).tolist():
        at = times[step] + _SHARES * steps[step]
        near = interpolated(times[step : step + 2], own[step : step + 2], at, smooth=True)
        found = _measures(parts, near[:, 0], near[:, 1])
        for number in np.flatnonzero(((found[1:] > 0.0) != (found[:-1] > 0.0)).any(axis=1)).tolist():
            before, after = found[number : number + 2]
            crossed = (before > 0.0) != (after > 0.0)
            share = _SHARES[number] + _SHARES[1] * float((before / (before - after))[crossed].min())
            if _AT_END < share < 1.0 - _AT_END:
                return step, float(times[step] + share * steps[step])
    return None


def _measures(parts: tuple[Alike, ...], p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the measures (rows, k) of parts whose coordinates (rows, j) stand one after another."""
    ends = np.cumsum([part.numbers.size for part in parts])[:-1]
    pairs = zip(parts, np.split(p, ends, axis=1), np.split(v, ends, axis=1), strict=True)
    shaped = ((part, (x.reshape(-1, *part.numbers.shape) for x in motion)) for part, *motion in pairs)
    return np.concatenate([part.kinks(*motion) for part, motion in shaped], axis=1)
