"""A spring from a point to the ground."""

from dataclasses import dataclass, field

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport
from beamfem.validation import convert, finite, squared, vector


@dataclass(frozen=True)
class Spring(PointSupport):
    """Spring to the ground, unstressed in the reference.

    Raises InputError for a negative stiffness, or if all are zero.

    Parameters
    ----------
    point : Point
        The supported point.
    stiffness : (float, float), [N/m], default (0, 0)
        Stiffness (kx, ky) against displacement.
    rotational : float, [N m/rad], default 0
        Stiffness against rotation.

    Examples
    --------
    >>> spring = bf.Spring(beam.end, stiffness=(0.0, 1e5), rotational=200.0)
    """

    point: Point
    stiffness: tuple[float, float] = field(default=(0.0, 0.0), metadata={"unit": "N/m"})
    rotational: float = field(default=0.0, metadata={"unit": "N m/rad"})

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        convert(self, squared(finite), "rotational")
        values = (*self.stiffness, self.rotational)
        if min(values) < 0.0 or max(values) == 0.0:
            raise InputError(f"the stiffness of a Spring must not be negative, and somewhere positive, got {values}")

    def springs(self) -> dict[str, float]:
        """Return the stiffness by direction, [N/m] and [N m/rad], without zeros."""
        pairs = zip(("ux", "uy", "rotation"), (*self.stiffness, self.rotational), strict=True)
        return {name: value for name, value in pairs if value > 0.0}
