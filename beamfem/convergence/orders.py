"""Observed order, Richardson extrapolation and grid convergence index of values over sizes.

Sizes h (n,) fall, values q (n,) belong to them. Sources: P. J. Roache, Verification and Validation in Computational
Science and Engineering, 1998; I. B. Celik et al., J. Fluids Eng. 130 (2008) 078001 for ratios that vary.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

SAFETY = 1.25  # Roache's factor for three or more meshes
_ROUND_OFF = 64 * np.finfo(float).eps
_PLATEAU_BELOW = 1e-6  # relative; an error that stagnates above it is not round-off
_SUDDEN = 0.7  # of the order just before: a drop to less is no part of a smooth curve
_WINDOW = 0.15  # of the finest order: how far others may lie from it and still count as asymptotic
_LARGEST_ORDER = 60.0


@dataclass(frozen=True)
class OrderFit:
    """Order of the asymptotic part: slope of the least-squares line of log error over log size.

    band: half width of its 95 % confidence interval (Student's t), nan with two points. first, last: points used.
    """

    order: float
    band: float
    first: int
    last: int


@dataclass(frozen=True)
class Extrapolation:
    """Limit of values for size 0, the relative error of the finest value (nan where nothing can be said), and how.

    settled: whether the limit is more than a guess.
    """

    limit: float
    error: float
    settled: bool
    note: str


def order_of_three(h: np.ndarray, q: np.ndarray) -> float:
    """Solve (q1 - q2)/(q2 - q3) = (h1^p - h2^p)/(h2^p - h3^p) for p > 0; nan where the values do not close in."""
    coarse, fine = q[0] - q[1], q[1] - q[2]
    from scipy.optimize import brentq  # slow to import, and seldom needed

    up, down = np.log(h[0] / h[1]), np.log(h[2] / h[1])
    if fine == 0.0 or coarse / fine <= up / -down:  # the right side for p -> 0
        return float("nan")

    def mismatch(p: float) -> float:
        return float(np.log(np.expm1(p * up) / -np.expm1(p * down)) - np.log(coarse / fine))

    if mismatch(_LARGEST_ORDER) <= 0.0:
        return float("nan")
    return float(brentq(mismatch, 1e-9, _LARGEST_ORDER, xtol=1e-13))


def clean_points(h: np.ndarray, error: np.ndarray) -> int:
    """Return how many points, from the coarsest on, stand above the round-off plateau.

    error: relative. The plateau begins where an error below 1e-6 falls with less than 0.7 times the order just before.
    """
    before = 0.0
    for i in range(len(error)):
        if error[i] <= _ROUND_OFF:
            return i
        if i:
            order = np.log(error[i - 1] / error[i]) / np.log(h[i - 1] / h[i])
            if error[i] < _PLATEAU_BELOW and order < _SUDDEN * before:
                return i
            before = order
    return len(error)


def extrapolate(h: np.ndarray, q: np.ndarray) -> Extrapolation:
    """Return q3 + (q3 - q2)/((h2/h3)^p - 1) of the three finest with the order they show.

    Values whose differences have reached round-off have the finest value for limit; so have values that do not close
    in steadily, and fewer than three.
    """
    finest = float(q[-1])
    if len(q) < 3:
        return Extrapolation(finest, np.nan, False, "fewer than three values: errors are against the finest")
    change = np.abs(np.diff(q)) / _scale(finest, q)
    if clean_points(h[1:], change) < len(change):
        return Extrapolation(finest, float(change[-1]), True, "the finest values differ by round-off and are the limit")
    order = order_of_three(h[-3:], q[-3:])
    if np.isnan(order):
        return Extrapolation(
            finest, np.nan, False, "the values do not close in steadily: errors are against the finest"
        )
    limit = float(finest + (finest - q[-2]) / np.expm1(order * np.log(h[-2] / h[-1])))
    return Extrapolation(limit, float(errors(q, limit)[-1]), True, "Richardson limit")


def errors(q: np.ndarray, limit: float) -> np.ndarray:
    """Return |q - limit| (n,), relative to the limit where that is not zero."""
    return np.abs(q - limit) / _scale(limit, q)


def is_relative(limit: float, q: np.ndarray) -> bool:
    """Whether errors are relative to the limit; an extrapolated zero is not exactly zero."""
    return bool(abs(limit) > 1e-10 * np.abs(q).max())


def _scale(limit: float, q: np.ndarray) -> float:
    return abs(limit) if is_relative(limit, q) else 1.0


def neighbour_orders(h: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Return log(E1/E2)/log(h1/h2) (n,) of each point and the one before it; nan for the first and for zero errors."""
    orders = np.full(len(h), np.nan)
    for i in range(1, len(h)):
        if error[i - 1] > 0.0 and error[i] > 0.0:
            orders[i] = np.log(error[i - 1] / error[i]) / np.log(h[i - 1] / h[i])
    return orders


def fit_order(h: np.ndarray, error: np.ndarray) -> OrderFit | None:
    """Fit the order of the finest points above round-off, back to where it differs by 15 % from that of the finest.

    None where fewer than two points are left or the finest error does not fall.
    """
    clean = clean_points(h, np.nan_to_num(error, nan=0.0))
    if clean < 2:
        return None
    orders = neighbour_orders(h[:clean], error[:clean])
    finest = orders[-1]
    if not finest > 0.0:
        return None
    first = clean - 2
    while first > 0 and abs(orders[first] - finest) <= _WINDOW * finest:
        first -= 1
    x, y = np.log(h[first:clean]), np.log(error[first:clean])
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    freedom = len(x) - 2
    if freedom == 0:
        return OrderFit(slope, float("nan"), first, clean - 1)
    deviation = np.sqrt(((y - slope * x) ** 2).sum() / freedom / (x @ x))
    return OrderFit(slope, float(stdtrit(freedom, 0.975) * deviation), first, clean - 1)


def grid_convergence_index(h: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return 1.25 |q2 - q3| / |q3| / ((h2/h3)^p - 1) (n,), p of a point and the two before it; nan where it has none.

    Roache's estimate of the relative error of each value (absolute where the value is zero).
    """
    index = np.full(len(h), np.nan)
    for i in range(2, len(h)):
        change = abs(q[i] - q[i - 1])
        order = order_of_three(h[i - 2 : i + 1], q[i - 2 : i + 1])
        if change > _ROUND_OFF * abs(q[i]) and not np.isnan(order):
            index[i] = SAFETY * change / (abs(q[i]) or 1.0) / np.expm1(order * np.log(h[i - 1] / h[i]))
    return index
