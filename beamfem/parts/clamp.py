"""A clamp."""

from dataclasses import dataclass

from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport, Value


@dataclass(frozen=True)
class Clamp(PointSupport):
    """Constrain position and rotation of the section.

    r_x may still stretch and, except for the elastic line, shear.

    Parameters
    ----------
    point : Point
        The clamped point.

    Examples
    --------
    >>> clamped = bf.Model([beam], supports=[bf.Clamp(beam.start), bf.Clamp(beam.end)])
    >>> len(clamped.supports)
    2
    """

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"ux": 0.0, "uy": 0.0, "rotation": 0.0}
