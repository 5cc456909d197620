"""Collocation methods of high order: Gauss and Radau IIA."""

from dataclasses import dataclass
from math import factorial

import numpy as np

from beamfem.quadrature import gauss
from beamfem.validation import number_below


@dataclass(frozen=True)
class Gauss:
    """Gauss collocation with s stages: order 2 s, without numerical damping, symmetric in time.

    One stage is the implicit midpoint rule. Accelerations at the ends of steps are those of the equations there, which
    strain what is stiff: steps that do not resolve its vibrations give wrong forces (TimeStepWarning), unlike those of
    `Radau`. Raises InputError for another number of stages.

    Parameters
    ----------
    stages : int, default 3
        Number of stages s, from 1 to 6.

    References
    ----------
    Hairer, Lubich and Wanner 2006, II.1.3.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.002, integrator=bf.Gauss(stages=2))
    >>> len(motion)
    11
    """

    stages: int = 3

    def __post_init__(self) -> None:
        object.__setattr__(self, "stages", number_below("stages of Gauss", self.stages, 7, 1))

    @property
    def order(self) -> int:
        """Order of positions, 2 s."""
        return 2 * self.stages

    @property
    def nodes(self) -> np.ndarray:
        """Times (s,) of the stages within a step of 1."""
        return gauss(self.stages)[0]

    @property
    def removed(self) -> float:
        """Share of the energy of a vibration w that a step h removes, over (w h)^(2 s)."""
        return 0.0


def Midpoint() -> Gauss:
    """Return the implicit midpoint rule: Gauss collocation with one stage, order 2, without numerical damping.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.Midpoint())
    """
    return Gauss(1)


@dataclass(frozen=True)
class Radau:
    """Radau IIA collocation with s stages: order 2 s - 1, L-stable: what a step does not resolve decays.

    The last stage is the end of the step, where equations and conditions hold. Raises InputError for another number of
    stages.

    Parameters
    ----------
    stages : int, default 3
        Number of stages s, from 1 to 5.

    References
    ----------
    Hairer and Wanner 1996, IV.5 and IV.8.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.002, integrator=bf.Radau())
    >>> len(motion)
    11
    """

    stages: int = 3

    def __post_init__(self) -> None:
        object.__setattr__(self, "stages", number_below("stages of Radau", self.stages, 6, 1))

    @property
    def order(self) -> int:
        """Order of positions, 2 s - 1."""
        return 2 * self.stages - 1

    @property
    def nodes(self) -> np.ndarray:
        """Times (s,) of the stages within a step of 1."""
        from scipy.special import roots_jacobi  # slow to import

        inner = roots_jacobi(self.stages - 1, 1.0, 0.0)[0] if self.stages > 1 else np.empty(0)
        return np.append(0.5 * (inner + 1.0), 1.0)

    @property
    def removed(self) -> float:
        """Share of the energy of a slow vibration w that a step h removes, over (w h)^(2 s)."""
        return (factorial(self.stages - 1) / factorial(2 * self.stages - 1)) ** 2
