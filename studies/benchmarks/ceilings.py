"""What one core of this machine gives: memory bandwidth, and fused multiply-adds in a chain and side by side."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

_LARGE, _SMALL = 8_000_000, 12_000  # doubles of each of three arrays: beyond the caches, and within the second level
_DEPTH = 16  # multiply-adds after one another on each number of a vector


@dataclass(frozen=True)
class Ceilings:
    """memory, cache: a stream triad from memory and in cache [GB/s]; the others: fused multiply-adds [GFlop/s].

    peak: in vectors, none waits for another; scalar: the same without vectors; chain: each needs the one before.
    """

    memory: float
    cache: float
    peak: float
    scalar: float
    chain: float


@njit(fastmath={"contract"}, error_model="numpy")
def _triad(times: int, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
    for turn in range(times):
        factor = 1.0 + turn
        for i in range(a.shape[0]):
            a[i] = b[i] + factor * c[i]


@njit(fastmath={"contract"}, error_model="numpy")
def _side_by_side(times: int, x: np.ndarray, a: float, b: float) -> None:
    for _ in range(times):
        for i in range(x.shape[0]):
            y = x[i]
            for _ in range(16):
                y = y * a + b
            x[i] = y


@njit(fastmath={"contract"}, error_model="numpy")
def _one_by_one(times: int, x: float, a: float, b: float) -> float:
    for _ in range(times):
        x = x * a + b
    return x


@njit(fastmath={"contract"}, error_model="numpy")
def _scalars(times: int, x: float, a: float, b: float) -> float:
    # numba packs no scalars into vectors, and the loop needs its own results
    p, q, r, s, t, u, v, w, y, z = x, x, x, x, x, x, x, x, x, x
    for _ in range(times):
        p, q, r, s, t = p * a + b, q * a + b, r * a + b, s * a + b, t * a + b
        u, v, w, y, z = u * a + b, v * a + b, w * a + b, y * a + b, z * a + b
    return p + q + r + s + t + u + v + w + y + z


def least_seconds(task: Callable[..., Any], *arguments: Any, rounds: int = 5) -> float:
    """Return the least CPU time [s] of a task, once it is compiled."""
    task(*arguments)
    times = []
    for _ in range(rounds):
        begun = time.process_time()
        task(*arguments)
        times.append(time.process_time() - begun)
    return min(times)


def measure() -> Ceilings:
    """Measure them; takes about two seconds."""
    large, small, numbers = np.ones((3, _LARGE)), np.ones((3, _SMALL)), np.ones(1024)
    memory = 24.0 * _LARGE / least_seconds(_triad, 1, *large, rounds=9)
    cache = 24.0 * _SMALL * 1000 / least_seconds(_triad, 1000, *small)
    peak = 2.0 * _DEPTH * len(numbers) * 10_000 / least_seconds(_side_by_side, 10_000, numbers, 0.999, 1e-3)
    chain = 2.0 * 10_000_000 / least_seconds(_one_by_one, 10_000_000, 1.0, 0.999, 1e-3)
    scalar = 20.0 * 3_000_000 / least_seconds(_scalars, 3_000_000, 1.0, 0.999, 1e-3)
    return Ceilings(memory / 1e9, cache / 1e9, peak / 1e9, scalar / 1e9, chain / 1e9)
