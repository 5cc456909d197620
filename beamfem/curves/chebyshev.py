"""Approximation of a smooth function by Chebyshev polynomials on panels, which also give its derivative.

Source: L. N. Trefethen, Approximation Theory and Approximation Practice, SIAM 2013, chapters 3, 4 and 8.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from beamfem.errors import InputError

# low enough for a conversion to a spline to round-off, high enough for few panels
DEGREE = 12
_FIRST_PANELS = 8
_HALVINGS = 17
_MOST_PANELS = 4096  # at a time; a corner needs two, noise needs all
# A panel is fine enough if its last coefficients and its error between the nodes are below this fraction of the extent;
# nothing below the round-off of the values can be reached.
_SMALL = 1e-14
_ROUND_OFF = 16 * np.finfo(float).eps
_BETWEEN_NODES = np.array([-0.77, 0.31])


@dataclass(frozen=True, eq=False)
class Panels:
    """Polynomials on panels: their ends (m + 1,) in [0, 1] and Chebyshev coefficients (degree + 1, m, columns)."""

    ends: np.ndarray
    coefficients: np.ndarray

    def __call__(self, v: np.ndarray) -> np.ndarray:
        """Return the values (n, columns) at v (n,)."""
        panel = np.clip(np.searchsorted(self.ends, v, side="right") - 1, 0, len(self.ends) - 2)
        x = 2.0 * (v - self.ends[panel]) / (self.ends[panel + 1] - self.ends[panel]) - 1.0
        return chebyshev.chebval(x[:, None], self.coefficients[:, panel, :], tensor=False)

    def derivative(self) -> "Panels":
        slope = 2.0 / np.diff(self.ends)[:, None]
        return Panels(self.ends, chebyshev.chebder(self.coefficients, axis=0) * slope)

    def columns(self, which: slice) -> "Panels":
        return Panels(self.ends, self.coefficients[:, :, which])


def approximate(function: Callable[[np.ndarray], np.ndarray], where: Callable[[float], str]) -> Panels:
    """Return panels that approximate a function of v (n,) in [0, 1] with values (n, columns) to round-off.

    where: name of a v for messages. Raises InputError for noise, and if halving a panel 17 times is not enough.
    """
    nodes = chebyshev.chebpts1(DEGREE + 1)
    to_coefficients = np.linalg.inv(chebyshev.chebvander(nodes, DEGREE))
    between = chebyshev.chebvander(_BETWEEN_NODES, DEGREE)
    grid = np.linspace(0.0, 1.0, _FIRST_PANELS + 1)
    starts, widths = grid[:-1], np.diff(grid)
    done_starts, done_coefficients = [], []
    floor = 0.0
    for _ in range(_HALVINGS + 1):
        v = starts[:, None] + widths[:, None] * (np.concatenate([nodes, _BETWEEN_NODES]) + 1.0) / 2.0
        values = function(v.ravel()).reshape(*v.shape, -1)
        if np.ndim(floor) == 0:
            extent = np.ptp(values, axis=(0, 1))
            floor = np.maximum(_SMALL * extent.max(), _ROUND_OFF * np.abs(values).max(axis=(0, 1)))
        coefficients = np.einsum("ij,mjc->imc", to_coefficients, values[:, : len(nodes)])
        error = np.abs(np.einsum("ij,jmc->mic", between, coefficients) - values[:, len(nodes) :]).max(axis=1)
        tail = np.abs(coefficients[-3:]).max(axis=0)
        fine = np.all((tail <= floor) & (error <= 4.0 * floor), axis=1)
        done_starts.append(starts[fine])
        done_coefficients.append(coefficients[:, fine])
        starts, widths = starts[~fine], widths[~fine] / 2.0
        starts, widths = np.concatenate([starts, starts + widths]), np.concatenate([widths, widths])
        if fine.all():
            break
        if len(starts) > _MOST_PANELS:
            raise InputError(
                f"the function is not smooth: between {_MOST_PANELS // 2} points it still varies, near "
                f"{where(float(starts[0]))} by {float(tail[~fine][0].max()):.1g}, as noise does; fit a BSpline to it"
            )
    else:
        raise InputError(
            f"the function is not smooth near {where(float(starts[0]))}; make the smooth parts before and after curves "
            f"of their own and join them by a Chain"
        )
    order = np.argsort(np.concatenate(done_starts))
    ends = np.append(np.concatenate(done_starts)[order], 1.0)
    return Panels(ends, np.concatenate(done_coefficients, axis=1)[:, order])


def bernstein(coefficients: np.ndarray) -> np.ndarray:
    """Return the Bezier points (degree + 1, ...) of polynomials with Chebyshev coefficients (degree + 1, ...)."""
    degree = len(coefficients) - 1
    nodes = chebyshev.chebpts1(degree + 1)
    fraction = (nodes[:, None] + 1.0) / 2.0
    binomials = np.append(1.0, np.cumprod([(degree - i) / (i + 1) for i in range(degree)]))
    power = np.arange(degree + 1)
    collocation = binomials * fraction**power * (1.0 - fraction) ** (degree - power)
    matrix = np.linalg.solve(collocation, chebyshev.chebvander(nodes, degree))
    # the constant is added afterwards: it needs no conversion, which would cause round-off of its size
    points = np.tensordot(matrix[:, 1:], coefficients[1:], axes=1)
    return points + coefficients[0]
