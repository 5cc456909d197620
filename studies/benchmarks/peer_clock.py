"""Time of tasks that take turns, so that what else the machine does meets all of them alike."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

_SHORTEST = 0.05  # [s] of a turn; shorter tasks are repeated within it, so that refilling the caches does not count


@dataclass(frozen=True)
class Timing:
    """Least and median time of a task [ms]."""

    least: float
    median: float

    def times(self, factor: float) -> "Timing":
        return Timing(factor * self.least, factor * self.median)


def once(task: Callable[[], object]) -> float:
    """Return the CPU time [ms] of a task that has run before; of a short one the least of some."""
    least, spent = np.inf, 0.0
    while spent < _SHORTEST:
        begun = time.process_time()
        task()
        own = time.process_time() - begun
        least, spent = min(least, own), spent + own
    return 1e3 * least


def in_turns(
    tasks: Sequence[Callable[[], object]], rounds: int, clock: Callable[[], float] = time.process_time
) -> list[Timing]:
    """Run every task in each round, after one that is not counted; clock: of the processor, or perf_counter."""
    calls = []
    for task in tasks:
        task()
        begun = time.perf_counter()
        task()
        calls.append(max(1, round(_SHORTEST / (time.perf_counter() - begun))))
    seconds = np.empty((len(tasks), rounds))
    for turn in range(rounds):
        for number, task in enumerate(tasks):
            begun = clock()
            for _ in range(calls[number]):
                task()
            seconds[number, turn] = (clock() - begun) / calls[number]
    return [Timing(1e3 * float(own.min()), 1e3 * float(np.median(own))) for own in seconds]


def fastest(timings: Sequence[Timing]) -> Timing:
    """Return the one with the least time."""
    return min(timings, key=lambda timing: timing.least)
