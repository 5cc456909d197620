"""What one core of this machine gives: memory bandwidth, and fused multiply-adds in a chain and side by side."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.kernels.compiling import routine
from beamfem.kernels.simd import WIDTH

_LARGE, _SMALL = 8_000_000, 12_000  # doubles of each of three arrays: beyond the caches, and within the second level
_DEPTH = 16  # multiply-adds after one another on each number of a vector
_STRIDE = 4 * WIDTH  # what waits for nothing


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


@routine("iivvv", fastmath={"contract"})
def _triad(times, count, a, b, c):
    for turn in range(times):
        factor = 1.0 + turn
        for i in range(0, count, WIDTH):
            a[i] = b[i] + factor * c[i]


@routine("iiddv", fastmath={"contract"})
def _side_by_side(times, count, a, b, x):
    for _ in range(times):
        for i in range(0, count, _STRIDE):
            p, q, r, s = x[i], x[i + WIDTH], x[i + 2 * WIDTH], x[i + 3 * WIDTH]
            for _ in range(16):
                p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            x[i], x[i + WIDTH], x[i + 2 * WIDTH], x[i + 3 * WIDTH] = p, q, r, s


@routine("iddd", "d", fastmath={"contract"})
def _one_by_one(times, x, a, b):
    for _ in range(times):
        x = x * a + b
    return x


@routine("iddd", "d", fastmath={"contract"})
def _scalars(times, x, a, b):
    # the loop needs its own results, and their factors differ, so that nothing is packed into vectors
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
    memory = 24.0 * _LARGE / least_seconds(_triad, 1, _LARGE, *large, rounds=9)
    cache = 24.0 * _SMALL * 1000 / least_seconds(_triad, 1000, _SMALL, *small)
    peak = (
        2.0 * _DEPTH * len(numbers) * 10_000 / least_seconds(_side_by_side, 10_000, len(numbers), 0.999, 1e-3, numbers)
    )
    chain = 2.0 * 10_000_000 / least_seconds(_one_by_one, 10_000_000, 1.0, 0.999, 1e-3)
    scalar = 20.0 * 3_000_000 / least_seconds(_scalars, 3_000_000, 1.0, 0.999, 1e-3)
    return Ceilings(memory / 1e9, cache / 1e9, peak / 1e9, scalar / 1e9, chain / 1e9)
