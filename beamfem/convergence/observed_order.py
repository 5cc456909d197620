"""Expected and observed order of values or errors over sizes, and the grid convergence index."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.element.element import Element


def highest_order(parameters: Mapping[str, Any]) -> float:
    """Return twice the highest degree of the fields among the parameters of a curve, 16 if there is none.

    Nodal values and energies of elements of degree k gain at most order 2 k; G. Strang and G. Fix, An Analysis of the
    Finite Element Method, 1973, sections 1.6 and 3.4.
    """
    degrees = [value.field.degree for value in parameters.values() if isinstance(value, Element)]
    return 2.0 * max(degrees) if degrees else HIGHEST_ORDER


SAFETY = 1.25  # Roache's factor for three or more meshes
ROUND_OFF = 64 * np.finfo(float).eps
HIGHEST_ORDER = 16.0  # of any element here: order 8, twice
PLATEAU_BELOW = 1e-6  # relative; an error that stagnates above it is not round-off
WINDOW = 0.15  # orders that differ by less agree; also how far an observed order may lie above the highest possible
_SUDDEN = 0.7  # of the order just before: a drop to less is no part of a smooth curve
_SMALLEST_ORDER, _LARGEST_ORDER = 1e-9, 60.0


@dataclass(frozen=True)
class OrderFit:
    """Order of the asymptotic part: slope of the least-squares line of log error over log size.

    band: half width of its 95 % confidence interval (Student's t), nan with two points; first, last: points used.
    """

    order: float
    band: float
    first: int
    last: int


def order_of_three(h: np.ndarray, q: np.ndarray) -> float:
    """Solve (q1 - q2)/(q2 - q3) = (h1^p - h2^p)/(h2^p - h3^p) for p > 0; nan if the values do not converge."""
    coarse, fine = q[0] - q[1], q[1] - q[2]
    up, down = np.log(h[0] / h[1]), np.log(h[2] / h[1])
    if fine == 0.0 or coarse / fine <= up / -down:  # the right side for p -> 0
        return float("nan")
    return _root(lambda p: float(np.log(np.expm1(p * up) / -np.expm1(p * down)) - np.log(coarse / fine)))


def order_of_bracket(h: np.ndarray, q: np.ndarray) -> float:
    """Solve (q1 - q2)/(q3 - q2) = (h1^p + h2^p)/(h2^p + h3^p) for p > 0: values that alternate about the limit."""
    coarse, fine = q[0] - q[1], q[2] - q[1]
    up, down = np.log(h[0] / h[1]), np.log(h[2] / h[1])
    if fine == 0.0 or coarse / fine <= 1.0:
        return float("nan")
    return _root(lambda p: float(np.log((np.exp(p * up) + 1.0) / (1.0 + np.exp(p * down))) - np.log(coarse / fine)))


def _root(mismatch: Callable[[float], float]) -> float:
    from scipy.optimize import brentq  # slow to import, and seldom needed

    if mismatch(_SMALLEST_ORDER) >= 0.0 or mismatch(_LARGEST_ORDER) <= 0.0:
        return float("nan")
    return float(brentq(mismatch, _SMALLEST_ORDER, _LARGEST_ORDER, xtol=1e-13))


def believable(order: float, highest: float) -> bool:
    """Return whether elements of the given highest order can show this order; anything above it is an accident."""
    return bool(0.0 < order <= (1.0 + WINDOW) * highest)


def chance_hits(h: np.ndarray, error: np.ndarray, highest: float = HIGHEST_ORDER) -> np.ndarray:
    """Return which relative errors (n,) are small by accident.

    They decrease faster than the elements allow, and are the last ones or are followed by larger errors above
    round-off.
    """
    hit = np.zeros(len(error), dtype=bool)
    before = 0
    for i in range(1, len(error)):
        ratio = error[before] / error[i] if error[i] > 0.0 else np.inf
        sudden = np.log(ratio) > (1.0 + WINDOW) * highest * np.log(h[before] / h[i]) if ratio > 1.0 else False
        last = i == len(error) - 1
        hit[i] = sudden and error[before] > PLATEAU_BELOW and (last or error[i + 1 :].max() > ROUND_OFF)
        if not hit[i]:
            before = i
    return hit


def clean_points(h: np.ndarray, error: np.ndarray, highest: float = HIGHEST_ORDER) -> int:
    """Return how many points, from the coarsest on, are above the round-off plateau.

    error: relative. The plateau begins where an error below 1e-6 decreases with less than 0.7 times the previous order;
    accidentally small errors are skipped.
    """
    order_before, before = 0.0, -1
    for i in np.flatnonzero(~chance_hits(h, error, highest)).tolist():
        if error[i] <= ROUND_OFF:
            return i
        if before >= 0:
            order = np.log(error[before] / error[i]) / np.log(h[before] / h[i])
            if error[i] < PLATEAU_BELOW and order < _SUDDEN * order_before:
                return i
            order_before = order
        before = i
    return len(error)


def errors(q: np.ndarray, limit: float) -> np.ndarray:
    """Return |q - limit| (n,), relative to the limit unless that is zero."""
    return np.abs(q - limit) / scale_of(limit, q)


def is_relative(limit: float, q: np.ndarray) -> bool:
    """Return whether errors are relative to the limit; an extrapolated zero is not exactly zero."""
    return bool(abs(limit) > 1e-10 * np.abs(q).max())


def scale_of(limit: float, q: np.ndarray) -> float:
    """Return the number that errors are relative to: the limit, or 1."""
    return abs(limit) if is_relative(limit, q) else 1.0


def neighbour_orders(h: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Return log(E1/E2)/log(h1/h2) (n,) from each point to the next; nan for the first and for zero errors."""
    orders = np.full(len(h), np.nan)
    for i in range(1, len(h)):
        if error[i - 1] > 0.0 and error[i] > 0.0:
            orders[i] = np.log(error[i - 1] / error[i]) / np.log(h[i - 1] / h[i])
    return orders


def fit_order(h: np.ndarray, error: np.ndarray, highest: float = HIGHEST_ORDER) -> OrderFit | None:
    """Fit the order of the finest points above round-off, as far back as it stays within 15 % of that of the finest.

    Accidentally small errors end the range. None if fewer than two points are left or the finest error does not
    decrease.
    """
    from scipy.special import stdtrit  # slow to import

    finite_error = np.nan_to_num(error, nan=0.0)
    first, clean = _finest_run(clean_points(h, finite_error, highest), chance_hits(h, finite_error, highest))
    if clean - first < 2:
        return None
    orders = neighbour_orders(h[:clean], error[:clean])
    finest = orders[-1]
    if not finest > 0.0:
        return None
    start, first = first, clean - 2
    while first > start and abs(orders[first] - finest) <= WINDOW * finest:
        first -= 1
    x, y = np.log(h[first:clean]), np.log(error[first:clean])
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    freedom = len(x) - 2
    if freedom == 0:
        return OrderFit(slope, float("nan"), first, clean - 1)
    deviation = np.sqrt(((y - slope * x) ** 2).sum() / freedom / (x @ x))
    return OrderFit(slope, float(stdtrit(freedom, 0.975) * deviation), first, clean - 1)


def _finest_run(clean: int, hit: np.ndarray) -> tuple[int, int]:
    """Return first and end index of the finest run of two or more points that are neither noisy nor accidental."""
    end = clean
    while end > 0:
        hits = np.flatnonzero(hit[:end])
        first = int(hits[-1]) + 1 if len(hits) else 0
        if end - first >= 2 or first == 0:
            return first, end
        end = first - 1
    return 0, 0


def grid_convergence_index(h: np.ndarray, q: np.ndarray, highest: float = HIGHEST_ORDER) -> np.ndarray:
    """Return 1.25 |q2 - q3| / |q3| / ((h2/h3)^p - 1) (n,), with p of a point and the two before it; nan without p.

    Roache's estimate of the relative error of each value (absolute if the value is zero). Orders above the highest of
    the elements give none.
    """
    index = np.full(len(h), np.nan)
    for i in range(2, len(h)):
        change = abs(q[i] - q[i - 1])
        order = order_of_three(h[i - 2 : i + 1], q[i - 2 : i + 1])
        if change > ROUND_OFF * abs(q[i]) and believable(order, highest):
            index[i] = SAFETY * change / (abs(q[i]) or 1.0) / np.expm1(order * np.log(h[i - 1] / h[i]))
    return index
