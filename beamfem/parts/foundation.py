"""Springs along a beam to the ground."""

from dataclasses import dataclass, field

from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.model.supports import LineSupport
from beamfem.validation import convert, squared, vector


@dataclass(frozen=True)
class Foundation(LineSupport):
    """Winkler foundation along a beam, unstressed in the reference.

    Raises InputError for a negative stiffness, or if both are zero.

    Parameters
    ----------
    beam : Beam
        The supported beam.
    stiffness : (float, float), [N/m^2]
        Stiffness (kx, ky) per reference length.

    Examples
    --------
    >>> soil = bf.Foundation(beam, stiffness=(0.0, 1e6))
    """

    beam: Beam
    stiffness: tuple[float, float] = field(metadata={"unit": "N/m^2"})

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        if min(self.stiffness) < 0.0 or max(self.stiffness) == 0.0:
            raise InputError(f"the stiffness of a Foundation must not be negative, and somewhere positive: {self}")
