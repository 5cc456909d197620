"""A hinge."""

from dataclasses import dataclass

from beamfem.model.beam import Point
from beamfem.model.joint_base import Joint


@dataclass(frozen=True, slots=True)
class Hinge(Joint):
    """Join two points by a hinge: the displacement is the same, the rotations are independent.

    Parameters
    ----------
    a, b : Point
        Coincident points of beams.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> supports = [bf.Clamp(beam.start), bf.Pin(post.end)]
    >>> hinged = bf.Model([beam, post], supports, joints=[bf.Hinge(beam.end, post.start)])
    """

    a: Point
    b: Point
