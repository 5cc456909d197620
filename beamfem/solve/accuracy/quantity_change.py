"""What is to be accurate: a quantity of a solution, and its change from one mesh to another."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from beamfem.equations.system import system_of
from beamfem.errors import InputError, RoundOffWarning, warn
from beamfem.model.beam import Point
from beamfem.results.solution import Solution
from beamfem.solve.newton.newton import Newton, solve_equilibrium
from beamfem.validation import shown

Quantity = Callable[[Any], Any] | Point | None

LOST = 1.0  # relative error of what a finer mesh does not find again
_COARSE = 1e-4  # relative error of positions above which a mesh may lack a quantity
_NOISE = 10.0  # by how much a quantity is to exceed what round-off of the coordinates makes of it


def require_quantity(quantity: Quantity) -> None:
    """Raise InputError unless it is a function, a point or nothing."""
    if not (quantity is None or isinstance(quantity, Point) or callable(quantity)):
        raise InputError(
            "quantity is a function of a solution, such as lambda s: s.rotation(beam.end)[-1], or a point, got "
            f"{shown(quantity)}"
        )


def evaluated(
    quantity: Callable[[Any], Any] | Point, before: Solution, after: Solution
) -> tuple[np.ndarray, np.ndarray]:
    """Return the values of a quantity in two solutions; of a point its displacements (rows, 2) [m].

    Raises InputError unless they are numbers, and as many.
    """
    found = [each.displacement(quantity) if isinstance(quantity, Point) else quantity(each) for each in (before, after)]
    with suppress(TypeError, ValueError):
        numbers = tuple(np.asarray(each, dtype=float) for each in found)
        if numbers[0].shape == numbers[1].shape and all(np.isfinite(each).all() for each in numbers):
            return numbers[0], numbers[1]
    raise InputError(
        "quantity must return a number, or numbers of which there are as many on every mesh, and finite ones, got "
        f"{shown(found[0])} and {shown(found[1])}"
    )


def relative_change(
    before: Solution, after: Solution, quantity: Callable[[Any], Any] | Point, accuracy: float = np.inf
) -> float:
    """Return the largest change of a quantity over its largest value; 0 of one that is zero but for round-off.

    It is also 0 of one row whose change is above an accuracy [-], but is no more than round-off makes of its
    equilibrium, which is warned of. Raises InputError, see `evaluated`.
    """
    value, other = evaluated(quantity, before, after)

    def largest(numbers: np.ndarray) -> float:
        return float(np.abs(numbers).max(initial=0.0))

    def noise(rounded: Solution) -> float:
        return _NOISE * largest(evaluated(quantity, rounded, after)[0] - value)

    size, change, rounded = largest(value), largest(other - value), _rounded(before)
    if max(size, change) <= noise(rounded):
        return 0.0
    if change > accuracy * size and change <= (left := noise(_in_equilibrium(rounded))):
        digits = np.log10(_NOISE * size / left) if size > 0.0 else 0.0
        warn(f"round-off leaves about {max(digits, 0.0):.0f} digits of the quantity", RoundOffWarning)
        return 0.0
    return change / size if size > 0.0 else change


def change_if_found(before: Solution, after: Solution, quantity: Callable[[Any], Any] | Point, moved: float) -> float:
    """Return the relative change of a quantity, or `LOST` if one of two coarse meshes lacks it, such as a limit point.

    moved: relative change of positions, which says whether they are coarse; if not, errors of the function are raised.
    """
    coarse = moved > _COARSE
    try:
        found, _ = evaluated(quantity, after, after)
    except LookupError:
        if not coarse:
            raise
        return LOST
    if found.size or not coarse:
        with suppress(LookupError, InputError):
            return relative_change(before, after, quantity)
    return LOST


def _rounded(solution: Solution) -> Solution:
    """Return a solution with other round-off: every coordinate off by one part in 2^52, up or down."""
    system = system_of(solution.model, solution.static)
    signs = np.random.default_rng(0).choice((-1.0, 1.0), solution.p.shape)
    off = np.where(system.positions, system.extent, 1.0)
    off[system.history.numbers] = 0.0
    return replace(solution, p=solution.p + np.finfo(float).eps * signs * off)


def _in_equilibrium(row: Solution) -> Solution:
    """Return the equilibrium next to a state that is off by round-off, which differs in all that round-off leaves."""
    found = solve_equilibrium(system_of(row.model, row.static), row.p[0], row.at[0], Newton())
    return replace(row, p=found.state[None])
