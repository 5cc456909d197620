"""One curve of a convergence study: values over refinement, their limit, and an error estimate of the finest value.

An order is accepted if two triples of values agree on it. Otherwise the changes between levels bound the error: that of
the finest value is at most its size times the steepest of the last slopes, |q(h) - q(0)| <= h max |dq/dh|, as long as
the slope does not grow towards size 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamfem.convergence.observed_order import (
    HIGHEST_ORDER,
    PLATEAU_BELOW,
    ROUND_OFF,
    OrderFit,
    believable,
    chance_hits,
    clean_points,
    errors,
    fit_order,
    grid_convergence_index,
    is_relative,
    neighbour_orders,
    order_of_bracket,
    order_of_three,
    scale_of,
)
from beamfem.reprs import brief

_LAST = 3  # changes that are looked at
_STEEPER = 1.2  # steepness that grows by more towards fine levels bounds nothing
_AGREE = 0.25  # orders of two triples that differ by less agree: they are still on their way to the asymptotic one


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
