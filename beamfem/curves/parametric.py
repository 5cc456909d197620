"""An axis given by a user's function."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from beamfem.cached_properties import cached_property
from beamfem.curves.arc_length import ArcLength, measure
from beamfem.curves.bspline import BSpline
from beamfem.curves.curve import Curve, along, piece_at, points, turned, unit
from beamfem.errors import InputError
from beamfem.validation import called, convert, finite, shown, vector

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
        panel = piece_at(self.ends, v)
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


PlaneFunction = Callable[[Any], Any]

# accuracy of the derivative of the panels, relative to the largest speed and as an angle [rad]
_AGREES = 1e-6


@dataclass(frozen=True)
class Parametric(Curve):
    """Smooth axis given by a function, r(u) = function(u) = (x, y), by arc length.

    The axis runs backwards if end < start. Results files hold the curve as its `spline()`, not as the function. Raises
    InputError for values that are not finite, a corner or kink (make a Chain), and if dr/du vanishes.

    Parameters
    ----------
    function : callable, [m]
        x, y as functions of a number u, or of numbers (n,).
    start, end : float
        Values of u at the ends.
    derivative : callable, optional
        dr/du in the same form; by default that of polynomials of degree 12 that approximate the function to round-off.

    Examples
    --------
    >>> sine = bf.Parametric(lambda u: (u, np.sin(u)), 0.0, np.pi)
    >>> round(sine.length, 4)
    3.8202
    """

    function: PlaneFunction
    start: float
    end: float
    derivative: PlaneFunction | None = None

    def __post_init__(self) -> None:
        for name, value in (("function", self.function), ("derivative", self.derivative)):
            if not callable(value) and not (name == "derivative" and value is None):
                raise InputError(f"{name} of a Parametric must be a function of u, got {value!r}")
        convert(self, finite, "start", "end")
        if self.start == self.end:
            raise InputError(f"a Parametric needs two different parameters, start and end are both {self.start}")
        _ = self._arc_length  # refuses cusps
        self._check_derivative()

    @property
    def length(self) -> float:
        return self._arc_length.length

    @along
    def position(self, arc_length: np.ndarray) -> np.ndarray:
        return self._panels.columns(slice(0, 2))(self._arc_length.parameter(arc_length))

    @along
    def tangent(self, arc_length: np.ndarray) -> np.ndarray:
        return unit(self._rate(self._arc_length.parameter(arc_length)))

    def spline(self) -> BSpline:
        """Return the B-spline of degree 12 that is the same curve to round-off.

        Its parameter goes from 0 at the start to 1 at the end.

        >>> bf.Parametric(lambda u: (u, np.sin(u)), 0.0, np.pi).spline().degree
        12
        """
        bezier = bernstein(self._panels.coefficients[:, :, :2])
        control = np.concatenate([bezier[:-1].transpose(1, 0, 2).reshape(-1, 2), bezier[-1:, -1]])
        ends = self._panels.ends
        inner = np.repeat(ends[1:-1], DEGREE)
        return BSpline(
            DEGREE, (*[0.0] * (DEGREE + 1), *inner, *[1.0] * (DEGREE + 1)), points("control_points", control)
        )

    @cached_property
    def _panels(self) -> Panels:
        """Position and, if given, derivative as functions of v = (u - start) / (end - start)."""
        functions = [_plane("function", self.function, self._parameter)]
        if self.derivative is not None:
            functions.append(_plane("derivative", self.derivative, self._parameter))
        scales = (1.0, self.end - self.start)

        def values(v: np.ndarray) -> np.ndarray:
            return np.hstack([scale * part(v) for scale, part in zip(scales, functions, strict=False)])

        return approximate(values, self._name)

    @cached_property
    def _rate(self) -> Panels:
        """Derivative dr/dv."""
        if self.derivative is None:
            return self._panels.derivative()
        return self._panels.columns(slice(2, 4))

    @cached_property
    def _arc_length(self) -> ArcLength:
        ends = self._panels.ends
        size = float(np.abs(self._panels(ends)[:, :2]).max())
        return measure(self._rate, ends, size, self._name)

    def _parameter(self, v: np.ndarray) -> np.ndarray:
        return (1.0 - v) * self.start + v * self.end

    def _name(self, v: float) -> str:
        return f"u = {(1.0 - v) * self.start + v * self.end:g}"

    def _check_derivative(self) -> None:
        ends = self._panels.ends
        before, after = self._rate(np.nextafter(ends[1:-1], 0.0)), self._rate(ends[1:-1])
        corner = ends[1:-1][turned(unit(before), unit(after), _AGREES)]
        if len(corner):
            raise InputError(f"the function has a corner at {self._name(corner[0])}; join two Parametric by a Chain")
        if self.derivative is not None:
            v = (ends[:-1] + ends[1:]) / 2
            expected = self._panels.columns(slice(0, 2)).derivative()(v)
            wrong = np.abs(self._rate(v) - expected).max(axis=1) > _AGREES * np.abs(expected).max()
            if wrong.any():
                at = int(np.argmax(wrong))
                given, due = (part[at] / (self.end - self.start) for part in (self._rate(v), expected))
                raise InputError(
                    f"derivative is not that of function at {self._name(v[at])}: it gives "
                    f"({given[0]:g}, {given[1]:g}), the function changes by ({due[0]:g}, {due[1]:g})"
                )


def _plane(
    name: str, function: PlaneFunction, parameter: Callable[[np.ndarray], np.ndarray]
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the user's function as a function of v (n,) with finite values (n, 2)."""
    at_once = _takes_arrays(function, parameter(np.array([0.1, 0.5, 0.8])))

    def values(v: np.ndarray) -> np.ndarray:
        u = parameter(v)
        table = (
            _table(function, u)
            if at_once
            else np.array([vector(f"{name}({each:g})", called(name, function, each)) for each in u.tolist()])
        )
        bad = ~np.isfinite(table).all(axis=1)
        if bad.any():
            at = int(np.argmax(bad))
            raise InputError(f"{name}({u[at]:g}) must be two finite numbers (x, y), got {tuple(table[at].tolist())}")
        return table

    return values


def _takes_arrays(function: PlaneFunction, u: np.ndarray) -> bool:
    """Return whether a function gives the same values for an array of three numbers as for each of them."""
    try:
        return np.allclose(_table(function, u), [function(float(each)) for each in u], rtol=1e-12, atol=0.0)
    except Exception:  # a function of one number may raise anything for an array
        return False


def _table(function: PlaneFunction, u: np.ndarray) -> np.ndarray:
    x, y = (np.asarray(part) for part in called("function", function, u))
    if x.dtype.kind not in "iuf" or y.dtype.kind not in "iuf":
        raise InputError(f"function({shown(u)}) must be two arrays of numbers (x, y), got {shown((x, y))}")
    return np.stack([np.broadcast_to(part, u.shape) for part in (x, y)], axis=1).astype(float)
