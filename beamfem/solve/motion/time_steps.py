"""Ends of the time steps of a motion: multiples of the step, and the kinks that its loads declare."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from beamfem.solve.start.functions_of_time import FunctionOfTime

_NEAR = 1e-4  # of a step: a kink this close to the end of a step is taken to be there
SIDE = 1e-9  # of a step: distance from a kink at which a load is evaluated on either side of it
_JUMP = 1e-6  # of the values of a load: a larger difference across a kink is a jump
_STRAIGHT = 1e-4  # of the values of a load: accuracy with which divided steps follow it
_MOST_PARTS = 128
PARTS = 4  # into which a step is cut


@dataclass(frozen=True)
class Stretch:
    """A sequence of equal steps.

    times (m + 1,) [s]: its beginning and the ends of its steps; step [s]; ends_whole, whole: whether its end, and the
    ends of all its steps, are multiples of the requested step; loads_from, loads_to [s]: times at which the loads at
    its beginning and end are evaluated, inside of a jump.
    """

    times: np.ndarray
    step: float
    ends_whole: bool
    whole: bool
    loads_from: float
    loads_to: float

    def cut(self, first: int, last: int) -> "Stretch":
        """Return the steps from one to another of its times, each divided into `PARTS`."""
        begin, end = float(self.times[first]), float(self.times[last])
        times = np.interp(
            np.arange(PARTS * (last - first) + 1) / PARTS, np.arange(last - first + 1), self.times[first : last + 1]
        )
        loads_from = self.loads_from if first == 0 else begin
        loads_to = self.loads_to if last == len(self.times) - 1 else end
        return Stretch(times, self.step / PARTS, False, False, loads_from, loads_to)

    def ending_at(self, times: list[float]) -> "Stretch":
        """Return the same with its beginning and end, and those of the times [s] at which steps are to end."""
        begin, end, near = float(self.times[0]), float(self.times[-1]), _NEAR * self.step
        inside = [at for at in sorted(times) if begin + near < at < end - near]
        apart = [at for at, later in pairwise([*inside, end]) if later - at > near]
        return replace(self, times=np.array([begin, *apart, end]))

    def end_of_steps(self, time: float) -> float:
        """Return the first of its times [s] after another."""
        return float(self.times[np.searchsorted(self.times, time, "right")])

    def after(self, first: int) -> "Stretch":
        """Return the same steps from one of its times on."""
        return replace(self, times=self.times[first:], loads_from=float(self.times[first])) if first else self


def stretches(grid: np.ndarray, amplitudes: list[FunctionOfTime]) -> tuple[Stretch, ...]:
    """Return the steps between the times of a grid (steps + 1,) [s], divided at the kinks of amplitudes.

    A part in which such an amplitude is not linear is divided further.
    """
    step, end_time = float(grid[1]), float(grid[-1])
    declaring = [function for function in amplitudes if function.kinks]
    if not declaring:
        return (Stretch(grid, step, True, True, 0.0, end_time),)
    kinks = _apart(np.concatenate([function.kinks for function in declaring]), _NEAR * step, end_time)
    nearest = np.minimum(np.round(kinks / step).astype(int), len(grid) - 1)
    inside = np.abs(kinks - grid[nearest]) > _NEAR * step
    places = np.where(inside, kinks, grid[nearest])
    looks = [function.look(grid, SIDE * step) for function in declaring]
    sizes = [size for _, size in looks]
    jumps = {
        at: kink
        for at, kink in zip(places.tolist(), kinks.tolist(), strict=True)
        if any(
            _jump(function, kink, SIDE * step, end_time) > _JUMP * size
            for function, size in zip(declaring, sizes, strict=True)
        )
    }
    bulging = np.flatnonzero(np.any([steps for steps, _ in looks], axis=0))
    divided = np.union1d(np.searchsorted(grid, kinks[inside]) - 1, bulging)
    bounds = np.unique(np.concatenate([grid[[0, -1]], kinks[inside], grid[divided], grid[divided + 1], list(jumps)]))
    result = []
    for begin, end in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
        whole = int(np.searchsorted(grid, 0.5 * (begin + end))) - 1 not in divided
        if whole:
            times, size = grid[np.searchsorted(grid, begin) : np.searchsorted(grid, end) + 1], step
        else:
            parts = _parts(declaring, sizes, begin, end)
            times, size = np.linspace(begin, end, parts + 1), (end - begin) / parts
        loads_from = jumps[begin] + SIDE * step if begin in jumps else begin
        loads_to = jumps[end] - SIDE * step if end in jumps else end
        result.append(Stretch(times, size, end in grid, whole, loads_from, loads_to))
    return tuple(result)


def _apart(kinks: np.ndarray, near: float, end_time: float) -> np.ndarray:
    """Return the kinks (n,) [s] within a motion that are further apart than `near`, in order."""
    kept: list[float] = []
    for kink in np.unique(kinks).tolist():
        if -near <= kink <= end_time + near and (not kept or kink - kept[-1] > near):
            kept.append(kink)
    return np.array(kept)


def _jump(function: FunctionOfTime, kink: float, side: float, end_time: float) -> float:
    """Return the jump of a load across a kink; it is not evaluated before or after the motion."""
    return abs(function.at(min(kink + side, end_time)) - function.at(max(kink - side, 0.0)))


def _parts(declaring: list[FunctionOfTime], sizes: list[float], begin: float, end: float) -> int:
    """Return the number of equal steps into which the time between two kinks is divided."""
    inset, parts = SIDE * (end - begin), 1
    for function, size in zip(declaring, sizes, strict=True):
        if size > 0.0:
            bend = function.bend(begin + inset, end - inset)
            parts = max(parts, int(np.ceil(np.sqrt(bend / (_STRAIGHT * size)))))
    return min(parts, _MOST_PARTS)
