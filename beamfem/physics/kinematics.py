"""Node kinematics, with each kind written once: the nodal vectors that rotate with an angle of the node.

The last nodal vectors w of a node (r_x and r_y, or r_y alone) are functions of coordinates u: w = w(u). Velocities are
w' = B u' with B = dw/du, accelerations w'' = B u'' + B' u'; `compiled_elements` derives them from w. The other
coordinates of a node are components of nodal vectors.

Angles are coordinates relative to the reference; (c, s) is the unit normal of the section in the current state.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

Number = Any  # a float, an array or a symbol


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
