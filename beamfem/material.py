"""Linear elastic, isotropic material."""

from dataclasses import dataclass

from beamfem.errors import InputError
from beamfem.validation import convert, finite, optional, positive


@dataclass(frozen=True)
class Material:
    """Hookean material, damped after Kelvin and Voigt where it has a retardation time.

    youngs_modulus [Pa], poisson_ratio [-] in (-1, 0.5), density [kg/m^3]; retardation_time t [s]: in motions every
    stress resultant is C (eps + t eps'), so that a small vibration of angular frequency w has the damping ratio t w / 2
    and a rigid motion is not damped, but every change of strain is, a free expansion too; thermal_expansion alpha
    [1/K], of a length, for `Temperature`; strength [Pa] that von Mises' stress is compared with. Raises InputError.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    retardation_time: float = 0.0
    thermal_expansion: float = 0.0
    strength: float | None = None

    def __post_init__(self) -> None:
        convert(self, positive, "youngs_modulus", "density")
        convert(self, finite, "poisson_ratio", "retardation_time", "thermal_expansion")
        convert(self, optional(positive), "strength")
        if not -1.0 < self.poisson_ratio < 0.5:
            raise InputError(
                f"poisson_ratio of Material must lie between -1 and 0.5 (both excluded), got {self.poisson_ratio}"
            )

        if self.retardation_time < 0.0:
            raise InputError(
                f"retardation_time of Material must not be negative, got {self.retardation_time}: it would gain energy"
            )

    @property
    def shear_modulus(self) -> float:
        """mu = E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    def lame_lambda(self, plane_stress: bool = False) -> float:
        """lambda [Pa] = E nu / ((1 + nu)(1 - 2 nu)), or E nu / (1 - nu^2) in plane stress."""
        ratio = self.poisson_ratio
        divisor = 1.0 - ratio**2 if plane_stress else (1.0 + ratio) * (1.0 - 2.0 * ratio)
        return self.youngs_modulus * ratio / divisor
