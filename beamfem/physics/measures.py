"""Strain measures of a beam, with each written once: everything else about a measure is derived from its definition.

A measure is a function of r = r0' (derivative of the axis by the reference arc length), d (director) and a third
vector: e = d', or b = r0'' if the curvature comes from the axis. Its arguments are components and a square root
function, so that it works for terms (see `compiled_elements`), for arrays of real or complex numbers, and in
scikit-fem forms.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

Number = Any  # a float, an array or a symbol
Measure = Callable[..., tuple[Number, ...]]


def green_lagrange(rx: Number, ry: Number, dx: Number, dy: Number, ex: Number, ey: Number, sqrt: Any) -> tuple:
    """Return a, b, c, eyy, g0, g1 of E = (F^T F - 1) / 2 for r = r0 + y d: exx = a + b y + c y^2, 2 exy = g0 + g1 y.

    Paper, section 3.3.
    """
    return (
        (rx * rx + ry * ry - 1) / 2,
        rx * ex + ry * ey,
        (ex * ex + ey * ey) / 2,
        (dx * dx + dy * dy - 1) / 2,
        rx * dx + ry * dy,
        dx * ex + dy * ey,
    )


def structural(rx: Number, ry: Number, dx: Number, dy: Number, ex: Number, ey: Number, sqrt: Any) -> tuple:
    """Return stretch, shear, curvature and thickness stretch of a section along t = d / |d|.

    (r'.n - 1, r'.t, (d x d') / |d|^2, |d| - 1) with n = (t_y, -t_x); Reissner 1972, Simo and Vu-Quoc 1986.
    """
    size = sqrt(dx * dx + dy * dy)
    tx, ty = dx / size, dy / size
    return rx * ty - ry * tx - 1, rx * tx + ry * ty, (tx * ey - ty * ex) / size, size - 1


def elastic_line(rx: Number, ry: Number, dx: Number, dy: Number, bx: Number, by: Number, sqrt: Any) -> tuple:
    """Return (|r'| - 1, (r' x r'') / |r'|^2, r'.d, (d.d - 1) / 2), with the curvature from r''; paper, section 3.4."""
    square = rx * rx + ry * ry
    return sqrt(square) - 1, (rx * by - ry * bx) / square, rx * dx + ry * dy, (dx * dx + dy * dy - 1) / 2


MEASURES: tuple[Measure, ...] = (green_lagrange, structural, elastic_line)


def evaluate(measure: Measure, r: np.ndarray, d: np.ndarray, third: np.ndarray) -> np.ndarray:
    """Return a measure (..., m) for r', d and the third vector (..., 2), real or complex."""
    return np.stack(measure(*(vector[..., axis] for vector in (r, d, third) for axis in (0, 1)), np.sqrt), axis=-1)
