"""The peak of a section force or a stress: its value, and where and when it is."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from beamfem.model.beam import Beam
from beamfem.units import Units

Force = Literal["normal", "shear", "moment"]
Part = Literal["lower", "upper", "tension", "compression", "shear", "von_mises", "utilisation"]


@dataclass(frozen=True)
class Peak:
    """The extreme of a section force or a stress, which unpacks into its value, arc length and row.

    Parameters
    ----------
    value : float, [Pa]
        The stress; a utilisation is a ratio [-], a section force [N] or [N m].
    arc_length : float, [m]
        Where it is.
    row : int
        Row of the solution.
    at : float
        Load factor of that row, or time of a motion [s].
    beam : Beam
        The beam.
    part : str
        Which stress or section force it is.
    static : bool, default True
        Whether `at` is a load factor.
    units : Units
        Units of the model, for the text.
    unit : str, default "Pa"
        SI unit of the value.

    Examples
    --------
    >>> value, arc_length, row = solution.stresses(beam).peak("tension")
    """

    value: float
    arc_length: float
    row: int
    at: float
    beam: Beam
    part: Part | Force = "von_mises"
    static: bool = True
    units: Units = field(default=Units(), repr=False)
    unit: str = field(default="Pa", repr=False)

    def __iter__(self) -> Iterator[float]:
        return iter((self.value, self.arc_length, self.row))

    def __repr__(self) -> str:
        return f"Peak({self.part} {self.in_words if np.isfinite(self.value) else 'is not known'}, of {self.beam!r})"

    @property
    def in_words(self) -> str:
        """Value and place with their units."""
        unit = "" if self.unit == "-" else f" {self.units.of(self.unit)}"
        when = f"load factor {self.at:.4g}" if self.static else f"t = {self.at:.4g} {self.units.of('s')}"
        return f"{self.value:.4g}{unit} at {self.arc_length:.4g} {self.units.of('m')} in row {self.row}, {when}"
