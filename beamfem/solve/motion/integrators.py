"""Time integrators."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import convert, finite


@dataclass(frozen=True)
class GeneralizedAlpha:
    """Generalized-alpha method, second order accurate, unconditionally stable for linear systems.

    Parameters
    ----------
    rho_inf : float, [-], default 0.9
        Spectral radius at infinite frequency, from 0 to 1; 1 has no numerical damping, 0 removes the highest
        frequencies in one step.

    Raises
    ------
    InputError
        For a value outside 0 to 1.

    References
    ----------
    Chung and Hulbert 1993.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.GeneralizedAlpha(rho_inf=0.8))
    >>> len(motion)
    21
    """

    rho_inf: float = 0.9

    def __post_init__(self) -> None:
        convert(self, finite, "rho_inf")
        if not 0.0 <= self.rho_inf <= 1.0:
            raise InputError(f"rho_inf lies between 0 and 1, got {self.rho_inf}")

    def rule(self, step: float) -> np.ndarray:
        """Return the parameters of the method.

        Parameters
        ----------
        step : float, [s]
            Time step.

        Returns
        -------
        array, (5,)
            Time step [s], alpha_m, alpha_f, gamma and beta [-].
        """
        alpha_m = (2.0 * self.rho_inf - 1.0) / (self.rho_inf + 1.0)
        alpha_f = self.rho_inf / (self.rho_inf + 1.0)
        gamma = 0.5 + alpha_f - alpha_m
        return np.array([step, alpha_m, alpha_f, gamma, 0.25 * (gamma + 0.5) ** 2])
