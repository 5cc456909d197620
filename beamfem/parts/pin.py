"""A pin."""

from dataclasses import dataclass

from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport, Value


@dataclass(frozen=True)
class Pin(PointSupport):
    """Constrain the position; the rotation is free.

    Parameters
    ----------
    point : Point
        The pinned point.

    Examples
    --------
    >>> simply_supported = bf.Model([beam], supports=[bf.Pin(beam.start), bf.Roller(beam.end)])
    >>> len(simply_supported.supports)
    2
    """

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"ux": 0.0, "uy": 0.0}
