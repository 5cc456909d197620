"""Time integrators."""

from dataclasses import dataclass
from typing import Protocol, TypeGuard

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import convert, finite, shown


class Scheme(Protocol):
    """A time integration method of the generalized-alpha family, such as Newmark's method or HHT-alpha.

    With the auxiliary acceleration a, (1 - alpha_m) a1 + alpha_m a0 = (1 - alpha_f) p1'' + alpha_f p0'',
    p1 = p0 + h p0' + h^2 ((1/2 - beta) a0 + beta a1), p1' = p0' + h ((1 - gamma) a0 + gamma a1), and the equations of
    motion hold at the end of a step (Arnold and Bruels 2007).
    """

    def rule(self, step: float) -> np.ndarray:
        """Return the parameters of the method.

        Parameters
        ----------
        step : float, [s]
            Time step h.

        Returns
        -------
        array, (5,)
            Time step [s], alpha_m and alpha_f below 1, gamma and beta above 0 [-].
        """
        ...


def is_scheme(integrator: object) -> TypeGuard[Scheme]:
    """Return whether an integrator is a rule; one with a step of its own is not, whatever its rule is."""
    return callable(getattr(integrator, "rule", None)) and not callable(getattr(integrator, "step", None))


def require_rule(scheme: Scheme, step: float) -> tuple[float, ...]:
    """Return the rule of a scheme. Raises InputError unless it gives an implicit method."""
    given = scheme.rule(step)
    try:
        rule = np.array(given, dtype=float)
    except (TypeError, ValueError):
        rule = np.empty(0)
    implicit = rule.shape == (5,) and np.isfinite(rule).all() and rule[0] == step
    if not implicit or not (max(rule[1:3]) < 1.0 and min(rule[3:]) > 0.0):
        raise InputError(
            f"rule of {type(scheme).__name__} must return (step, alpha_m, alpha_f, gamma, beta) with alpha_m and "
            f"alpha_f below 1, and gamma and beta above 0, got {shown(given)}"
        )
    return tuple(rule.tolist())


@dataclass(frozen=True)
class GeneralizedAlpha:
    """Generalized-alpha method, second order accurate, unconditionally stable for linear systems.

    Raises InputError for a value outside 0 to 1.

    Parameters
    ----------
    rho_inf : float, [-], default 0.9
        Spectral radius at infinite frequency, from 0 to 1; 1 has no numerical damping, 0 removes the highest
        frequencies in one step.

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


@dataclass(frozen=True)
class HHT:
    """Method of Hilber, Hughes and Taylor, a member of the generalized-alpha family.

    alpha_m = 0, alpha_f = -alpha, gamma = 1/2 - alpha, beta = (1 - alpha)^2 / 4, see `Scheme`. It is second order
    accurate and unconditionally stable for linear systems. Raises InputError for a value outside -1/3 to 0.

    Parameters
    ----------
    alpha : float, [-], default -0.05
        Numerical damping, from -1/3 to 0; the spectral radius at infinite frequency is (1 + alpha) / (1 - alpha).

    References
    ----------
    Hilber, Hughes and Taylor 1977.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.HHT(alpha=-0.1))
    """

    alpha: float = -0.05

    def __post_init__(self) -> None:
        convert(self, finite, "alpha")
        if not -1.0 / 3.0 <= self.alpha <= 0.0:
            raise InputError(f"alpha of HHT lies between -1/3 and 0, got {self.alpha}")

    def rule(self, step: float) -> np.ndarray:
        """Return the parameters of the method, see `Scheme`."""
        return np.array([step, 0.0, -self.alpha, 0.5 - self.alpha, 0.25 * (1.0 - self.alpha) ** 2])


@dataclass(frozen=True)
class Newmark:
    """Newmark's method, a member of the generalized-alpha family.

    p1 = p0 + h p0' + h^2 ((1/2 - beta) p0'' + beta p1''), p1' = p0' + h ((1 - gamma) p0'' + gamma p1'').

    With gamma = 1/2 it is second order accurate, otherwise first order; with 2 beta >= gamma it is unconditionally
    stable for linear systems. The default is the trapezoidal rule. Raises InputError for beta that is not positive, and
    gamma below 1/2, which would feed energy into the motion.

    Parameters
    ----------
    beta : float, [-], default 0.25
        Weight of the new acceleration in displacements, above 0.
    gamma : float, [-], default 0.5
        Weight of the new acceleration in velocities, from 1/2, without numerical damping.

    References
    ----------
    Newmark 1959.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.Newmark(beta=0.3025, gamma=0.6))
    """

    beta: float = 0.25
    gamma: float = 0.5

    def __post_init__(self) -> None:
        convert(self, finite, "beta", "gamma")
        if self.beta <= 0.0 or self.gamma < 0.5:
            raise InputError(
                f"Newmark needs beta above 0 and gamma of at least 1/2, got beta {self.beta} and gamma {self.gamma}"
            )

    def rule(self, step: float) -> np.ndarray:
        """Return the parameters of the method, see `Scheme`."""
        return np.array([step, 0.0, 0.0, self.gamma, self.beta])


def Trapezoidal() -> Newmark:
    """Return the trapezoidal rule: Newmark's method with beta = 1/4 and gamma = 1/2, without numerical damping.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.Trapezoidal())
    """
    return Newmark()
