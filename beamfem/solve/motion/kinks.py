"""Kinks of forces in a motion: cables become taut, stops are hit, laws of springs have corners, friction slips."""

import numpy as np

from beamfem.equations.parts_at_points import Alike
from beamfem.equations.system import System
from beamfem.solve.motion.dense_output import interpolated

_SHARES = np.linspace(0.0, 1.0, 33)  # of a step, between which measures are straight enough
_AT_END = 1e-3  # of a step: a kink this close to one of its ends is there


def first_kink(system: System, times: np.ndarray, states: np.ndarray) -> tuple[int, float] | None:
    """Return the first step that a kink is in, and its time [s], or None.

    times (m + 1,) [s], states (m + 1, 3, n): of the ends of m steps of a method with stages. Steps are looked into if a
    measure changes its sign to their ends, or would to their middle with its rate at an end, with their history at the
    beginning. A stop that turns back within a step may be no deeper at its end, so that what counts is whether history
    would change to the middle as well.
    """
    parts, steps, past = system.kinked, np.diff(times), states[:-1, 0]
    changed, half = past != states[1:, 0], 0.5 * steps[:, None]
    (p0, v0), (p1, v1) = (states[rows, :2].swapaxes(0, 1) for rows in (slice(-1), slice(1, None)))
    rows = (p0, v0), (p1, v1), (p0 + half * v0, v0), (p1 - half * v1, v1)
    for each in parts:
        middle = ((p0 + half * v0)[:, each.numbers], v0[:, each.numbers])
        changed[:, each.history] |= each.changes(*middle, past[:, each.history])
    begin, *others = (_measures(parts, p, v, past, changed) for p, v in rows)
    for step in np.flatnonzero(np.any([_crossings(begin, other) >= _AT_END for other in others], axis=(0, 2))).tolist():
        at, same = times[step] + _SHARES * steps[step], np.zeros(len(_SHARES), dtype=int) + step
        p, v, _ = interpolated(times[step : step + 2], states[step : step + 2], at, smooth=True).swapaxes(0, 1)
        found = _measures(parts, p, v, past[same], changed[same])
        shares = _SHARES[:-1, None] + _SHARES[1] * _crossings(found[:-1], found[1:])
        shares = shares[(shares > _AT_END) & (shares < 1.0 - _AT_END)]
        if shares.size:
            return step, float(times[step] + shares.min() * steps[step])
    return None


def _crossings(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return the share at which measures that are straight in between change their sign, nan if they do not."""
    changed = (before > 0.0) != (after > 0.0)
    return np.divide(before, before - after, out=np.full(before.shape, np.nan), where=changed)


def _measures(
    parts: tuple[Alike, ...], p: np.ndarray, v: np.ndarray, past: np.ndarray, changed: np.ndarray
) -> np.ndarray:
    """Return the measures (rows, k) of parts in states p, p' (rows, n); past, changed: see `Alike.kinks`."""
    own = ((each, each.numbers, each.history) for each in parts)
    return np.concatenate(
        [each.kinks(p[:, at], v[:, at], past[:, kept], changed[:, kept]) for each, at, kept in own],
        axis=1,
    )
