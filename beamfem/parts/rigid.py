"""A rigid joint."""

from dataclasses import dataclass
from typing import ClassVar

from beamfem.model.beam import Point
from beamfem.model.joint_base import Joint


@dataclass(frozen=True, slots=True)
class Rigid(Joint):
    """Join two points rigidly: displacement and rotation are the same, at any angle between the beams.

    Parameters
    ----------
    a, b : Point
        Coincident points of beams.

    Examples
    --------
    >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> angle = bf.Model([beam, post], [bf.Clamp(beam.start)], joints=[bf.Rigid(beam.end, post.start)])
    """

    keeps_angle: ClassVar[bool] = True

    a: Point
    b: Point
