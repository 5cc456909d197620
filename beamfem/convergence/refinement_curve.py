"""Observed order of values over sizes, and a curve of a study: its limit and an error estimate of the finest value.

An order is accepted if two triples of values agree on it. Otherwise the changes between levels bound the error: that of
the finest value is at most its size times the steepest of the last slopes, |q(h) - q(0)| <= h max |dq/dh|, as long as
the slope does not grow towards size 0.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamfem.element.element import Element
from beamfem.reprs import brief

SAFETY = 1.25  # Roache's factor for three or more meshes
ROUND_OFF = 64 * np.finfo(float).eps
HIGHEST_ORDER = 16.0  # of any element here: order 8, twice
PLATEAU_BELOW = 1e-6  # relative; an error that stagnates above it is not round-off
WINDOW = 0.15  # orders that differ by less agree; also how far an observed order may lie above the highest possible
_SUDDEN = 0.7  # of the order just before: a drop to less is no part of a smooth curve
_SMALLEST_ORDER, _LARGEST_ORDER = 1e-9, 60.0
_LAST = 3  # changes that are looked at
_STEEPER = 1.2  # steepness that grows by more towards fine levels bounds nothing
_AGREE = 0.25  # orders of two triples that differ by less agree: they are still on their way to the asymptotic one


def highest_order(parameters: Mapping[str, Any]) -> float:
    """Return twice the highest degree of the fields among the parameters of a curve, 16 if there is none.

    Nodal values and energies of elements of degree k gain at most order 2 k; G. Strang and G. Fix, An Analysis of the
    Finite Element Method, 1973, sections 1.6 and 3.4.
    """
    degrees = [value.field.degree for value in parameters.values() if isinstance(value, Element)]
    return 2.0 * max(degrees) if degrees else HIGHEST_ORDER


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


@dataclass(frozen=True)
class Extrapolation:
    """Limit of values for size 0, the relative error of the finest value (nan if unknown), and how they were found.

    settled: whether the limit is more than a guess.
    """

    limit: float
    error: float
    settled: bool
    note: str


@dataclass(frozen=True)
class _Triple:
    """Result of three successive values: order (nan if they show none), limit, and whether they bracket the limit."""

    order: float
    limit: float
    brackets: bool


def extrapolate(h: np.ndarray, q: np.ndarray, highest: float = HIGHEST_ORDER) -> Extrapolation:
    """Return the limit of values q (n,) over sizes h (n,) and the estimated error of the finest.

    If the last two triples (and, less strictly, the third) agree on an order that does not exceed the highest: the
    Richardson limit; the error is the distance to it plus the difference between the limits of the two triples, or the
    last change if values alternate about the limit. With three values, or if the triples differ: the changes between
    levels. No estimate (nan) if values diverge or turn, and from fewer than three.
    """
    finest = float(q[-1])
    if len(q) < 3:
        return Extrapolation(finest, np.nan, False, "fewer than three values: errors are against the finest")
    change = np.abs(np.diff(q))[-_LAST:]
    round_off = ROUND_OFF * np.abs(q[-3:]).max()
    if change[-2:].max() <= round_off:
        error = float(max(change[-2:].max(), round_off)) / scale_of(finest, q)
        return Extrapolation(finest, error, True, "the finest values differ by round-off and are the limit")
    triples = [_triple(h[i : i + 3], q[i : i + 3], highest) for i in range(max(len(q) - 5, 0), len(q) - 2)]
    last = triples[-1]
    if _agree(triples):
        if last.brackets:
            error, how = float(change[-1]), "the values bracket their limit: the estimate is the last change"
        else:
            error, how = abs(finest - last.limit) + abs(last.limit - triples[-2].limit), "Richardson limit"
        return Extrapolation(last.limit, max(error, float(round_off)) / scale_of(last.limit, q), True, how)
    return _bounded(h, q, change, triples, highest)


def _triple(h: np.ndarray, q: np.ndarray, highest: float) -> _Triple:
    brackets = bool((q[0] - q[1]) * (q[1] - q[2]) < 0.0)
    order = order_of_bracket(h, q) if brackets else order_of_three(h, q)
    if not believable(order, highest):
        return _Triple(np.nan, np.nan, brackets)
    ratio = order * np.log(h[1] / h[2])
    beyond = -1.0 / (np.exp(ratio) + 1.0) if brackets else 1.0 / np.expm1(ratio)
    return _Triple(order, float(q[2] + (q[2] - q[1]) * beyond), brackets)


def _agree(triples: list[_Triple]) -> bool:
    """Return whether the last two orders agree within a quarter, and the one before them, if any, within half."""
    if len({triple.brackets for triple in triples}) > 1 or len(triples) < 2:
        return False
    orders = [triple.order for triple in triples[::-1]]
    pairs = zip(orders, orders[1:], (_AGREE, 2.0 * _AGREE), strict=False)
    return all(abs(one - other) <= window * min(one, other) for one, other, window in pairs)


def _bounded(h: np.ndarray, q: np.ndarray, change: np.ndarray, triples: list[_Triple], highest: float) -> Extrapolation:
    """Return the estimate from the last changes (2 or 3,) between levels, and why there is no better one."""
    finest, last = float(q[-1]), triples[-1]
    scale = scale_of(finest, q)
    rises = np.diff(change) >= 0.0
    # elements that lock creep on in one direction; round-off goes to and fro
    turns = np.ptp(np.sign(np.diff(q)[-_LAST:])) > 0.0
    small = len(change) == _LAST and change.max() < PLATEAU_BELOW * np.abs(q).max()
    if small and turns and rises.any() and not rises.all():
        return Extrapolation(finest, float(change.max()) / scale, True, "the finest values differ by round-off")
    step, size = -np.diff(h)[-_LAST:], h[1:][-_LAST:]
    steep = change / step
    if change[-1] >= change[-2] or (not last.brackets and steep[-1] > _STEEPER * steep[-2]):
        return Extrapolation(
            finest, np.nan, False, "the values do not close in: no estimate, errors are against the finest"
        )
    if last.brackets and len(q) == 3:
        return Extrapolation(finest, np.nan, False, "the values turn: no estimate, errors are against the finest")
    if np.isnan(last.order) or last.brackets:
        seen = "the values turn" if last.brackets else f"the last change is too small for an order up to {highest:g}"
        error = float((change * size / step).max()) / scale
        return Extrapolation(finest, error, False, f"{seen}: the estimate is the largest of the last changes")
    steepest = float(steep.max() * h[-1])
    if len(q) == 3:
        return Extrapolation(
            last.limit,
            steepest / scale_of(last.limit, q),
            True,
            f"order {last.order:.2g} of three values, which no other confirms: the estimate is their change",
        )
    other = triples[-2].order
    seen = "no order" if np.isnan(other) or triples[-2].brackets else f"order {other:.2g}"
    why = f"order {last.order:.2g} after {seen}: the estimate is the steepest of the last changes"
    return Extrapolation(finest, steepest / scale, False, why)


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve of a convergence study: one combination of the other parameters, without failed points.

    refinement (n,): from coarse to fine; size (n,): h, 1/refinement for counts, the refinement itself for step sizes;
    value (n,): the quantity; error (n,): difference from `limit`, `relative` unless that is zero, nan if the value is
    the limit itself; order (n,): observed between each point and the one before it, nan where there is none; gci (n,):
    grid convergence index of Roache; fit: order of the asymptotic part; limit: the reference, or extrapolated;
    estimated_error: of the finest value, nan if unknown; notes: what the estimate is based on, and remarks; label: the
    other parameters as text, for legends; parameters, texts: the same by name, as values and as text; others: the other
    numbers (n,) that the function returns; seconds (n,): duration of each call.
    """

    refinement: tuple[Any, ...]
    size: np.ndarray
    value: np.ndarray
    error: np.ndarray
    relative: bool
    order: np.ndarray
    gci: np.ndarray
    fit: OrderFit | None
    limit: float
    estimated_error: float
    notes: tuple[str, ...]
    label: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    others: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)
    seconds: np.ndarray = field(default_factory=lambda: np.empty(0))

    __repr__ = brief


def judge(
    refinement: tuple[Any, ...], size: np.ndarray, value: np.ndarray, reference: float | None, highest: float
) -> Curve:
    """Return errors, orders, index and fitted order of one or more values, without names and seconds.

    highest: orders above it are not accepted.
    """
    extrapolated = (
        extrapolate(size, value, highest) if reference is None else Extrapolation(reference, np.nan, True, "")
    )
    error = errors(value, extrapolated.limit)
    fit = fit_order(size, error, highest) if extrapolated.settled else None
    notes = [extrapolated.note] if extrapolated.note else _notes(refinement, size, error, fit, highest)
    order = neighbour_orders(size, error)
    estimate = extrapolated.error if reference is None else float(error[-1])
    if reference is None and extrapolated.limit == value[-1]:
        error[-1] = np.nan
    return Curve(
        refinement=refinement,
        size=size,
        value=value,
        error=error,
        relative=is_relative(extrapolated.limit, value),
        order=order,
        gci=grid_convergence_index(size, value, highest),
        fit=fit,
        limit=extrapolated.limit,
        estimated_error=estimate,
        notes=tuple(notes),
    )


def _notes(
    refinement: tuple[Any, ...], size: np.ndarray, error: np.ndarray, fit: OrderFit | None, highest: float
) -> list[str]:
    """Return the notes on errors from a reference."""
    hits = [refinement[i] for i in np.flatnonzero(chance_hits(size, error, highest))]
    notes = [f"the error at {', '.join(map(str, hits))} is small by chance and left out of the order"] if hits else []
    if clean_points(size, error, highest) < len(error):
        notes.append("the finest errors are round-off and left out of the order")
    elif fit is None and len(error) > 1 + len(hits):
        notes.append("the finest error does not fall: the reference may not be the limit of these values")
    return notes
