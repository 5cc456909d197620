"""Damping of a beam: resistance to the velocities of its mass and to the rates of its strains."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import ClassVar

from beamfem.errors import InputError
from beamfem.validation import convert, items, not_negative, positive


@dataclass(frozen=True)
class Rayleigh:
    """Damping proportional to mass and stiffness, for `Beam(damping=...)`.

    Each section force in a motion is C (eps + b eps'), and each mass dm resists its velocity v by a dm v. A vibration
    of angular frequency w has the damping ratio z = a / (2 w) + b w / 2. The strains eps are those of the elements, so
    a rigid motion loses no energy to b. It does lose energy to a, which represents a surrounding fluid. Statics, modes
    and buckling have no rates and ignore both. Raises InputError for a negative value, which would gain energy.

    Parameters
    ----------
    mass : float, [1/s], default 0
        Factor a >= 0 of the mass.
    stiffness : float, [s], default 0
        Factor b >= 0 of the stiffness, in addition to the `retardation_time` of the material.

    References
    ----------
    Clough and Penzien 2003, Dynamics of Structures, section 12-5.

    Examples
    --------
    >>> damped = bf.Beam(beam.curve, 4, beam.element, beam.section, steel, damping=bf.Rayleigh(stiffness=1e-4))
    """

    mass: float = 0.0
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        convert(self, not_negative, "mass", "stiffness")

    @classmethod
    def from_ratios(cls, first: tuple[float, float], second: tuple[float, float]) -> "Rayleigh":
        """Return the damping that has given ratios at two frequencies.

        z_i = a / (2 w_i) + b w_i / 2 with w_i = 2 pi f_i, solved for a and b. Raises InputError for equal frequencies,
        or ratios that only a negative factor can have: z2 / z1 must lie between f1 / f2 and f2 / f1.

        Parameters
        ----------
        first, second : (float, float), [Hz, -]
            Frequency f and damping ratio z of two modes, such as those that `solve_modes` finds.

        Examples
        --------
        >>> bf.Rayleigh.from_ratios((8.0, 0.02), (50.0, 0.02))
        Rayleigh(mass=1.7333032996201706, stiffness=0.00010976170894450037)
        """
        (f1, z1), (f2, z2) = _mode("first", first), _mode("second", second)
        if f1 == f2:
            raise InputError(f"first and second must be at different frequencies, both are at {f1:g}")
        w1, w2 = 2.0 * pi * f1, 2.0 * pi * f2
        square = (w2 - w1) * (w2 + w1)
        mass, stiffness = 2.0 * w1 * w2 * (z1 * w2 - z2 * w1) / square, 2.0 * (z2 * w2 - z1 * w1) / square
        if mass < 0.0 or stiffness < 0.0:
            low, high = sorted((z1 * f1 / f2, z1 * f2 / f1))
            raise InputError(
                f"no Rayleigh damping has the ratio {z2:g} at {f2:g} beside {z1:g} at {f1:g}: without negative factors "
                f"it is {low:.4g} to {high:.4g} there"
            )
        return cls(mass, stiffness)


def _mode(name: str, given: Sequence[float]) -> tuple[float, float]:
    """Return the frequency [Hz] and the damping ratio of a mode. Raises InputError."""
    values = items(name, given)
    if len(values) != 2:
        raise InputError(f"{name} must be a frequency and a damping ratio, got {len(values)} values")
    return positive(f"frequency of {name}", values[0]), not_negative(f"ratio of {name}", values[1])


@dataclass(frozen=True)
class KelvinVoigt:
    """Damping of a viscoelastic beam after Kelvin and Voigt, for `Beam(damping=...)`.

    Each section force in a motion is C (eps + t eps'): the same as `Rayleigh(stiffness=t)`, or as a material with this
    `retardation_time`, of which it is the sum where both are given. Raises InputError for a negative time, which would
    gain energy.

    Parameters
    ----------
    time : float, [s]
        Retardation time t >= 0, within which a sudden load deforms the beam by 1 - 1 / e of its static deformation.

    Examples
    --------
    >>> creeping = bf.Beam(beam.curve, 4, beam.element, beam.section, steel, damping=bf.KelvinVoigt(time=0.5))
    """

    time: float

    mass: ClassVar[float] = 0.0

    def __post_init__(self) -> None:
        convert(self, not_negative, "time")

    @property
    def stiffness(self) -> float:
        """The retardation time [s]: the factor of the stiffness."""
        return self.time


Damping = Rayleigh | KelvinVoigt
