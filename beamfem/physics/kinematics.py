"""Kinematics, each relation written once: nodal vectors that rotate with an angle, and strain measures.

The last nodal vectors w of a node (r_x and r_y, or r_y alone) are functions of coordinates u: w = w(u). Velocities are
w' = B u' with B = dw/du, accelerations w'' = B u'' + B' u'; `compiled_elements` derives them from w. The other
coordinates of a node are components of nodal vectors.

Angles are coordinates relative to the reference; (c, s) is the unit normal of the section in the current state.

A strain measure is a function of r = r0' (derivative of the axis by the reference arc length), d (director) and a third
vector: e = d', or b = r0'' if the curvature comes from the axis. Its arguments are components and a square root
function, so that it works for terms (see `compiled_elements`), for arrays of real or complex numbers, and in
scikit-fem forms.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

Number = Any  # a float, an array or a symbol
Measure = Callable[..., tuple[Number, ...]]


class Kinematics(NamedTuple):
    """A kind of node: names of the coordinates u, with the angle last, and `size` components w(u, c, s, |r_x|)."""

    name: str
    coordinates: tuple[str, ...]
    size: int
    vectors: Callable[[tuple[Number, ...], Number, Number, Number], tuple[Number, ...]]


def _rotation(u: tuple[Number, ...], c: Number, s: Number, length: Number) -> tuple[Number, ...]:
    """Return r_y = (-sin t, cos t); paper, eqs. (5) to (7)."""
    return -s, c


def _stretch(u: tuple[Number, ...], c: Number, s: Number, length: Number) -> tuple[Number, ...]:
    """Return r_x = l (cos t, sin t) and r_y = (-sin t, cos t) with the coordinate l; paper, section 1.5."""
    return u[0] * c, u[0] * s, -s, c


def _shear_rigid(u: tuple[Number, ...], c: Number, s: Number, length: Number) -> tuple[Number, ...]:
    """Return r_x = l (cos t, sin t) and r_y = (-sin t, cos t) with l as in the reference; paper, section 3.5."""
    return length * c, length * s, -s, c


ROTATION = Kinematics("rotation", ("theta",), 2, _rotation)
STRETCH = Kinematics("stretch", ("s", "theta"), 4, _stretch)
SHEAR_RIGID = Kinematics("shear_rigid", ("theta",), 4, _shear_rigid)
KINDS = (ROTATION, STRETCH, SHEAR_RIGID)


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
