"""Cross-sections."""

from dataclasses import dataclass

import numpy as np

from beamfem.validation import positive


@dataclass(frozen=True)
class Section:
    """Section by its area moments; without `fourth_moment` that of the rectangle of the same area and second moment.

    area A [m^2], second_moment I [m^4], shear_factor k_s [-], fourth_moment I4 = integral of y^4 dA [m^6].
    For a rectangle h = sqrt(12 I / A) and I4 = A h^4 / 80. Raises InputError.
    """

    area: float
    second_moment: float
    shear_factor: float = 5 / 6
    fourth_moment: float | None = None

    def __post_init__(self) -> None:
        for name in ("area", "second_moment", "shear_factor"):
            positive(name, getattr(self, name))
        if self.fourth_moment is None:
            object.__setattr__(self, "fourth_moment", self.area * self.height**4 / 80.0)
        positive("fourth_moment", self.fourth_moment)

    @property
    def height(self) -> float:
        """Height of the equivalent rectangle [m]."""
        return float(np.sqrt(12.0 * self.second_moment / self.area))

    @property
    def width(self) -> float:
        """Width of the equivalent rectangle [m]."""
        return self.area / self.height


def Rectangle(width: float, height: float, shear_factor: float = 5 / 6) -> Section:
    """Return the rectangular section width [m] (out of the plane) x height [m] (along y). Raises InputError."""
    positive("width", width)
    positive("height", height)
    return Section(width * height, width * height**3 / 12.0, shear_factor)
