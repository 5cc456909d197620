"""The protocol of curves, and functions that the kinds of curve share."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, Protocol, runtime_checkable

import numpy as np

from beamfem.errors import InputError, SeveralTurnsWarning, warn
from beamfem.validation import finite, items, shown, vector

# A smaller rotation of the tangent [rad] is round-off of the data: its square is negligible compared with 1.
CORNER = 1e-8

# Gap between connected ends, as a fraction of the length, that is allowed for drawings rounded to 6 decimals.
GAP = 1e-5

_FULL_TURN = 2.0 * np.pi * (1.0 + 1e-9)  # allows for round-off


@runtime_checkable
class Curve(Protocol):
    """A planar curve, as a function of its arc length s from 0 to `length` [m].

    At a corner the tangent is that after it; at an arc length just before the corner, that before it.
    """

    __slots__ = ()

    @property
    def length(self) -> float:
        """Length of the axis [m]."""

    @property
    def corners(self) -> tuple[float, ...]:
        """Arc lengths (k,) [m] of the corners between the two ends, at which the tangent jumps."""
        return ()

    def position(self, arc_length: np.ndarray | float) -> np.ndarray:
        """Return the positions (n, 2) [m] at arc lengths (n,) [m] from the start, or (2,) at one of them.

        Raises InputError for arc lengths beyond the ends.

        >>> bf.Line((0, 0), (3, 4)).position(np.array([0.0, 2.5]))
        array([[0. , 0. ],
               [1.5, 2. ]])
        """

    def tangent(self, arc_length: np.ndarray | float) -> np.ndarray:
        """Return the unit tangents (n, 2) [-] at arc lengths (n,) [m] from the start, or (2,) at one of them.

        At a corner it is the tangent after it. Raises InputError for arc lengths beyond the ends.

        >>> bf.Line((0, 0), (3, 4)).tangent(np.array([2.5]))
        array([[0.6, 0.8]])
        """


def along(method: Callable[[Any, np.ndarray], np.ndarray]) -> Callable[[Any, np.ndarray | float], np.ndarray]:
    """Return a method of a curve that takes one arc length as well, and refuses those beyond the ends."""

    @wraps(method)
    def evaluate(self: Any, arc_length: np.ndarray | float) -> np.ndarray:
        s = np.asarray(arc_length)
        if s.dtype.kind not in "iuf" or s.ndim > 1:
            raise InputError(f"arc_length must be a number, or an array (n,) of numbers, got {shown(arc_length)}")
        length = self.length
        if s.size and not (s.min() >= -GAP * length and s.max() <= (1.0 + GAP) * length):
            kind = type(self).__name__
            raise InputError(f"arc lengths along this {kind} go from 0 to {length:g}, got {shown(arc_length)}")
        return method(self, s[None])[0] if s.ndim == 0 else method(self, s)

    return evaluate


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return vectors (n, 2) scaled to unit length."""
    return vectors / np.hypot(vectors[:, 0], vectors[:, 1])[:, None]


def piece_at(ends: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the number (n,) of the piece between ascending ends (m + 1,) that holds each value (n,), or is nearest."""
    return np.clip(np.searchsorted(ends, values, side="right") - 1, 0, len(ends) - 2)


def turned(before: np.ndarray, after: np.ndarray, limit: float = CORNER) -> np.ndarray:
    """Return the mask (n,) of points where unit tangents before and after (n, 2) differ by more than a limit [rad]."""
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.abs(np.arctan2(cross, np.sum(before * after, axis=1))) > limit


def warn_of_turns(what: str, turn: float) -> None:
    """Warn of an arc with an angle [rad] of more than one full turn, which may have been given in degrees."""
    if abs(turn) > _FULL_TURN:
        warn(
            f"{what} turns by {abs(turn):g} rad, more than one full turn; angles are in radians: for {abs(turn):g} "
            f"degrees give np.radians({abs(turn):g})",
            SeveralTurnsWarning,
        )


def points(name: str, values: Sequence[Any] | np.ndarray) -> tuple[tuple[float, float], ...]:
    """Return `values` as a tuple of finite points, or raise InputError naming the invalid one."""
    return tuple(vector(f"{name}[{i}]", value) for i, value in enumerate(items(name, values)))


def numbers(name: str, values: Sequence[Any] | np.ndarray) -> tuple[float, ...]:
    """Return `values` as a tuple of finite floats, or raise InputError naming the invalid one."""
    return tuple(finite(f"{name}[{i}]", value) for i, value in enumerate(items(name, values)))
