"""Node kinematics, each kind written once: the vectors of a node that its coordinates turn.

A kind of node carries its last nodal vectors w (r_x and r_y, or r_y alone) by coordinates u: w = w(u). Velocities are
w' = B u' with B = dw/du, accelerations w'' = B u'' + B' u'; all of them are derived from w by `generate`. What a node
carries besides are components of nodal vectors themselves.

Angles are measured from the reference: (c, s) = (cos, sin) of the angle of the section, whose normal points along them.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

Number = Any  # a float, an array or a symbol


class Kinematics(NamedTuple):
    """The vectors of a node: names of the coordinates u, the angle last, and `size` components w(u, c, s, |r_x|)."""

    name: str
    coordinates: tuple[str, ...]
    size: int
    vectors: Callable[[tuple[Number, ...], Number, Number, Number], tuple[Number, ...]]


def _rotation(u: tuple[Number, ...], c: Number, s: Number, length: Number) -> tuple[Number, ...]:
    """r_y = (-sin t, cos t); paper, eqs. (5) to (7)."""
    return -s, c


def _stretch(u: tuple[Number, ...], c: Number, s: Number, length: Number) -> tuple[Number, ...]:
    """r_x = l (cos t, sin t), r_y = (-sin t, cos t), l a coordinate; paper, section 1.5."""
    return u[0] * c, u[0] * s, -s, c


def _shear_rigid(u: tuple[Number, ...], c: Number, s: Number, length: Number) -> tuple[Number, ...]:
    """The same with the length of r_x as in the reference; paper, section 3.5."""
    return length * c, length * s, -s, c


ROTATION = Kinematics("rotation", ("theta",), 2, _rotation)
STRETCH = Kinematics("stretch", ("s", "theta"), 4, _stretch)
SHEAR_RIGID = Kinematics("shear_rigid", ("theta",), 4, _shear_rigid)
KINDS = (ROTATION, STRETCH, SHEAR_RIGID)
