"""An axis of several curves, each of which starts at the end of the previous one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves.curve import GAP, Curve, along, piece_at, turned
from beamfem.errors import InputError
from beamfem.reprs import brief
from beamfem.validation import fulfils, items, shown


@dataclass(frozen=True)
class Chain(Curve):
    """Axis along consecutive curves.

    There is a corner wherever the tangent jumps between two curves. A gap of up to 1e-5 of the total length is treated
    as rounding and closed by moving the curves after it. Raises InputError if a gap is larger.

    Parameters
    ----------
    curves : sequence of Curve
        The curves in order.

    Examples
    --------
    >>> chain = bf.Chain([bf.Line((0, 0), (1, 0)), bf.Line((1, 0), (1, 2))])
    >>> chain.length, chain.corners
    (3.0, (1.0,))
    """

    curves: Sequence[Curve]

    __repr__ = brief

    def __post_init__(self) -> None:
        object.__setattr__(self, "curves", tuple(items("curves of a Chain", self.curves)))
        if not self.curves:
            raise InputError("a Chain needs a list of at least one curve, got an empty one")
        for i, curve in enumerate(self.curves):
            if not fulfils(curve, Curve):
                raise InputError(f"curves[{i}] of a Chain must be a curve such as Line, got {shown(curve)}")
        for i, (one, other) in enumerate(zip(self.curves, self.curves[1:], strict=False)):
            end, start = one.position(np.array([one.length]))[0], other.position(np.array([0.0]))[0]
            if np.hypot(*(start - end)) > GAP * self.length:
                raise InputError(
                    f"curves[{i + 1}] of a Chain must start where curves[{i}] ends, at ({end[0]:.12g}, {end[1]:.12g}); "
                    f"it starts at ({start[0]:.12g}, {start[1]:.12g}), further than {GAP:g} of the whole length away"
                )

    @property
    def length(self) -> float:
        return float(self._ends[-1])

    @cached_property
    def corners(self) -> tuple[float, ...]:
        corners = [self._ends[i] + corner for i, curve in enumerate(self.curves) for corner in curve.corners]
        for one, other, joint in zip(self.curves, self.curves[1:], self._ends[1:-1], strict=False):
            if turned(one.tangent(np.array([one.length])), other.tangent(np.array([0.0])))[0]:
                corners.append(joint)
        return tuple(sorted(float(corner) for corner in corners))

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        return self._each(arc_length, lambda i, arc: self.curves[i].position(arc) + self._moves[i])

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        return self._each(arc_length, lambda i, arc: self.curves[i].tangent(arc))

    @cached_property
    def _ends(self) -> np.ndarray:
        """Arc lengths at which the curves begin, and the total length (n + 1,) [m]."""
        return np.append(0.0, np.cumsum([curve.length for curve in self.curves]))

    @cached_property
    def _moves(self) -> np.ndarray:
        """Displacement (n, 2) [m] of each curve that closes the gaps before it."""
        ends = np.array([curve.position(np.array([0.0, curve.length])) for curve in self.curves])
        return np.concatenate([np.zeros((1, 2)), np.cumsum(ends[:-1, 1] - ends[1:, 0], axis=0)])

    def _each(self, arc_length: np.ndarray, ask: Callable[[int, np.ndarray], np.ndarray]) -> np.ndarray:
        arc_length = np.asarray(arc_length, dtype=float)
        piece = piece_at(self._ends, arc_length)
        values = np.empty((len(arc_length), 2))
        for i in np.unique(piece):
            mask = piece == i
            values[mask] = ask(int(i), np.clip(arc_length[mask] - self._ends[i], 0.0, self.curves[i].length))
        return values
