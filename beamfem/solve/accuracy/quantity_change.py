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
_ALIKE = 1e-2  # of a value: difference of sizes up to which another sign is that of an equal peak, not another value
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
        value, other = (np.asarray(each, dtype=float) for each in found)
        if value.shape == other.shape and np.isfinite(value).all() and np.isfinite(other).all():
            return value, np.where(np.abs(other + value) <= _ALIKE * np.abs(value), -other, other)
    raise InputError(
        "quantity must return a number, or numbers of which there are as many on every mesh, and finite ones, got "
        f"{shown(found[0])} and {shown(found[1])}"
    )


def relative_change(
    before: Solution, after: Solution, quantity: Callable[[Any], Any] | Point, accuracy: float = np.inf
) -> float:
    """Return the largest change of a quantity over its largest value; 0 of one that is zero but for round-off.

    Each entry of a list or tuple is a quantity of its own, and so are the moments of arrays (..., 3) of fx, fy and m.
    It is also 0 of one row whose change is above an accuracy [-], but is no more than round-off makes of its
    equilibrium, which is warned of. Raises InputError, see `evaluated`.
    """
    value, other = evaluated(quantity, before, after)
    own = _quantities(value, quantity, before)

    def largest(numbers: np.ndarray) -> np.ndarray:
        result = np.zeros(int(own.max(initial=0)) + 1)
        np.maximum.at(result, own, np.abs(numbers))
        return result

    def noise(rounded: Solution) -> np.ndarray:
        return _NOISE * largest(evaluated(quantity, before, rounded)[1] - value)

    size, change, rounded = largest(value), largest(other - value), _rounded(before)
    change[np.maximum(size, change) <= noise(rounded)] = 0.0
    if (over := change / accuracy > size).any():
        left = noise(_in_equilibrium(rounded))
        if (lost := over & (change <= left)).any():
            digits = np.log10(_NOISE * size[lost & (size > 0.0)] / left[lost & (size > 0.0)]).min(initial=np.inf)
            warn(f"round-off leaves about {max(digits, 0.0):.0f} digits of the quantity", RoundOffWarning)
            change[lost] = 0.0
    return float(np.max(np.divide(change, size, out=change.copy(), where=size > 0.0)))


def _quantities(values: np.ndarray, quantity: Callable[[Any], Any] | Point, solution: Solution) -> np.ndarray:
    """Return to which quantity each number belongs: arrays may hold others than one, see `relative_change`."""
    result = np.zeros(values.shape, dtype=int)
    if values.ndim and values.shape[-1] == 3:
        result[..., 2] = 1
    if not isinstance(quantity, Point) and isinstance(quantity(solution), list | tuple):
        result.T[...] += 2 * np.arange(len(values))
    return result


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
