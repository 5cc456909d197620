"""Arc length of a curve given by a parameter, and the parameter at an arc length."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.curves.curve import piece_at
from beamfem.errors import InputError
from beamfem.quadrature import gauss

Function = Callable[[np.ndarray], np.ndarray]

_NODES, _WEIGHTS = gauss(16)
# A panel is fine enough if halving it changes its length by less than this fraction of the total: the halves, which are
# kept, are then more accurate by a factor of about 2^32.
_CHANGE = 4e-15
_HALVINGS = 48
# a curve shorter than this fraction of its largest coordinate is a point with round-off
_POINT = 1e-13
_NEWTON = 60
# a speed below this fraction of the largest in its span counts as zero: a minimum is located to 1e-8
_ZERO = 1e-7


@dataclass(frozen=True, eq=False)
class ArcLength:
    """Arc length s(u) = integral of speed(u) du, panel by panel.

    rate: dr/du (n, 2) at u (n,), where it jumps the value after the break, and the speed its size; ends: parameters of
    the panels' ends (m + 1,); sums: arc lengths there (m + 1,) [m].
    """

    rate: Function
    ends: np.ndarray
    sums: np.ndarray

    @property
    def length(self) -> float:
        return float(self.sums[-1])

    def at(self, u: np.ndarray) -> np.ndarray:
        """Return the arc lengths at parameters (n,) [m]."""
        panel = piece_at(self.ends, u)
        return self.sums[panel] + _integral(self.rate, self.ends[panel], u)

    def parameter(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the parameters at arc lengths (n,) [m] to round-off; beyond the ends of the curve, those of the ends.

        Newton's method from a linear guess, with bisection where it would leave the bracket.
        """
        s = np.clip(np.asarray(arc_length, dtype=float), 0.0, self.length)
        panel = piece_at(self.sums, s)
        low, high = self.ends[panel], self.ends[panel + 1]
        u = low + (high - low) * (s - self.sums[panel]) / (self.sums[panel + 1] - self.sums[panel])
        # points before a break must be evaluated before it, whatever the round-off
        last = np.where(panel == len(self.sums) - 2, high, np.nextafter(high, low))
        u = np.minimum(u, last)
        left, right = low, last
        for _ in range(_NEWTON):
            miss = self.sums[panel] + _integral(self.rate, low, u) - s
            left, right = np.where(miss < 0.0, u, left), np.where(miss > 0.0, u, right)
            new = u - miss / _speed(self.rate, u)
            new = np.where((left <= new) & (new <= right), new, (left + right) / 2)
            eps = np.finfo(float).eps
            done = (np.abs(miss) <= 2 * eps * self.length) | (np.abs(new - u) <= eps * np.abs(u))
            u = np.where(done, u, new)
            if done.all():
                break
        return u


def measure(rate: Function, breaks: np.ndarray, size: float, where: Callable[[float], str]) -> ArcLength:
    """Return the arc length over spans between increasing breaks (m + 1,); within a span the speed is smooth.

    rate: dr/du (n, 2) at u (n,); size: largest coordinate [m]; where: name of a parameter for messages. Raises
    InputError if the speed vanishes.
    """
    low, high = breaks[:-1], breaks[1:]
    whole = _integral(rate, low, high)
    total = whole.sum()
    if not total > _POINT * size:
        raise InputError("all points of the curve coincide: it has no length")
    starts, ends, lengths = [], [], []
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        first, second = _integral(rate, low, middle), _integral(rate, middle, high)
        fine = np.abs(first + second - whole) <= _CHANGE * total
        for a, b, length in ((low, middle, first), (middle, high, second)):
            starts.append(a[fine])
            ends.append(b[fine])
            lengths.append(length[fine])
        low, high = np.concatenate([low[~fine], middle[~fine]]), np.concatenate([middle[~fine], high[~fine]])
        whole = np.concatenate([first[~fine], second[~fine]])
        if fine.all():
            break
    else:
        raise InputError(f"the curve is not smooth near {where(float(low[0]))}: its arc length cannot be found there")
    order = np.argsort(np.concatenate(starts))
    panels = np.append(np.concatenate(starts)[order], breaks[-1])
    _refuse_standstill(rate, breaks, panels, where)
    return ArcLength(rate, panels, np.append(0.0, np.cumsum(np.concatenate(lengths)[order])))


def _speed(rate: Function, u: np.ndarray) -> np.ndarray:
    return np.hypot(*rate(u).T)


def _integral(rate: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    u = low[:, None] + (high - low)[:, None] * _NODES
    return (high - low) * (_speed(rate, u.ravel()).reshape(u.shape) @ _WEIGHTS)


def _refuse_standstill(rate: Function, breaks: np.ndarray, panels: np.ndarray, where: Callable[[float], str]) -> None:
    """Raise InputError if the speed vanishes, where a curve may reverse and its tangent is undefined."""
    from scipy.optimize import minimize_scalar  # slow to import, and seldom needed

    low, high = panels[:-1, None], panels[1:, None]
    u = np.hstack([low, low + (high - low) * _NODES, np.nextafter(high, low)]).ravel()
    values = _speed(rate, u)
    span = piece_at(breaks, u)
    largest = np.zeros(len(breaks) - 1)
    np.maximum.at(largest, span, values)
    around = np.concatenate([[np.inf], values, [np.inf]])
    low_points = (values <= around[:-2]) & (values <= around[2:]) & (values < 0.2 * largest[span])
    for i in np.flatnonzero(low_points).tolist():
        begin, end = u[max(i - 1, 0)], u[min(i + 1, len(u) - 1)]
        least, at = values[i], u[i]
        if least > _ZERO * largest[span[i]]:
            # relative to `begin`, so that the minimum is found to a fraction of the bracket
            minimum = minimize_scalar(
                lambda step, begin=begin: float(_speed(rate, np.array([begin + step]))[0]) ** 2,
                bounds=(0.0, end - begin),
                method="bounded",
                options={"xatol": 1e-12 * (end - begin)},
            )
            least, at = np.sqrt(minimum.fun), begin + minimum.x
        if least <= _ZERO * largest[span[i]]:
            raise InputError(
                f"the curve stands still at {where(float(at))} (a cusp, or points that coincide): it has no tangent "
                f"there; move or remove a point, or give the parts before and after as curves of a Chain"
            )
