"""One curve of a convergence study: values over refinement, and what follows from them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamfem.convergence.limit_estimate import Extrapolation, extrapolate
from beamfem.convergence.observed_order import (
    OrderFit,
    chance_hits,
    clean_points,
    errors,
    fit_order,
    grid_convergence_index,
    is_relative,
    neighbour_orders,
)
from beamfem.reprs import brief


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
