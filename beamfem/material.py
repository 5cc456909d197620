"""Linear elastic, isotropic material."""

from dataclasses import dataclass

from beamfem.errors import InputError
from beamfem.validation import convert, finite, optional, positive


@dataclass(frozen=True)
class Material:
    """Hookean material, with Kelvin-Voigt damping if it has a retardation time.

    With a retardation time t, every section force in a motion is C (eps + t eps'). A small vibration of angular
    frequency w then has the damping ratio t w / 2. A rigid motion is not damped, but every change of strain is,
    including a free expansion. Raises InputError for an invalid value.

    Parameters
    ----------
    youngs_modulus : float, [Pa]
        Young's modulus E.
    poisson_ratio : float, [-]
        Poisson's ratio nu, in (-1, 0.5).
    density : float, [kg/m^3]
        Density.
    retardation_time : float, [s], default 0
        Retardation time t of the damping.
    thermal_expansion : float, [1/K], default 0
        Coefficient alpha of thermal expansion of a length, for `Temperature`.
    strength : float, [Pa], optional
        Strength that the von Mises stress is compared with.

    Examples
    --------
    >>> bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0).shear_modulus / 1e9  # GPa
    80.76923076923077
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
                f"poisson_ratio of Material must lie between -1 and 0.5 (both excluded), got {self.poisson_ratio}: "
                "else its shear modulus E / (2 (1 + nu)) or bulk modulus E / (3 (1 - 2 nu)) would not be positive and "
                "finite; rubber has about 0.49"
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
        """Return Lamé's first parameter, E nu / ((1 + nu)(1 - 2 nu)), or E nu / (1 - nu^2) in plane stress [Pa].

        Parameters
        ----------
        plane_stress : bool, default False
            Whether to return the value of plane stress.

        Examples
        --------
        >>> round(steel.lame_lambda() / 1e9, 2)  # GPa
        121.15
        """
        ratio = self.poisson_ratio
        divisor = 1.0 - ratio**2 if plane_stress else (1.0 + ratio) * (1.0 - 2.0 * ratio)
        return self.youngs_modulus * ratio / divisor
