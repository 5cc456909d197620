"""Collocation methods of high order: Gauss and Radau IIA."""

from dataclasses import dataclass
from functools import cache
from math import factorial
from typing import TypeGuard

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import roots_jacobi

from beamfem.quadrature import gauss
from beamfem.validation import number_below


@dataclass(frozen=True)
class Gauss:
    """Gauss collocation with s stages: order 2 s, without numerical damping, symmetric in time.

    One stage is the implicit midpoint rule. Accelerations at the ends of steps are those of the equations there.

    Parameters
    ----------
    stages : int, default 3
        Number of stages s, from 1 to 6.

    Raises
    ------
    InputError
        For another number of stages.

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

    The last stage is the end of the step, where equations and conditions hold.

    Parameters
    ----------
    stages : int, default 3
        Number of stages s, from 1 to 5.

    Raises
    ------
    InputError
        For another number of stages.

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
        inner = roots_jacobi(self.stages - 1, 1.0, 0.0)[0] if self.stages > 1 else np.empty(0)
        return np.append(0.5 * (inner + 1.0), 1.0)

    @property
    def removed(self) -> float:
        """Share of the energy of a slow vibration w that a step h removes, over (w h)^(2 s)."""
        return (factorial(self.stages - 1) / factorial(2 * self.stages - 1)) ** 2


def is_collocation(integrator: object) -> TypeGuard[Gauss | Radau]:
    """Return whether an integrator is a collocation method."""
    return isinstance(integrator, Gauss | Radau)


@dataclass(frozen=True, eq=False)
class Coefficients:
    """A collocation method with s stages at the nodes c (s,) of a step of 1.

    a (s, s): A; weights (s,): b; at_end (s,): polynomial through the stages at the end; ahead (s, s + 1): that through
    the stages, and the end of the step if it is no stage, at the stages of the next step; values: eigenvalues of A, the
    real one first and one of each complex pair; into, back (s, s): the stages as parts of its eigenvectors and the
    inverse, see `kernels.stage_record`; error: factor and power, see there; samples: times of the stages and of the end
    within a step of 1; points: such times, ends included, through which motions of supports are interpolated.
    """

    nodes: np.ndarray
    a: np.ndarray
    weights: np.ndarray
    at_end: np.ndarray
    ahead: np.ndarray
    values: np.ndarray
    into: np.ndarray
    back: np.ndarray
    error: tuple[float, float]
    samples: np.ndarray
    points: np.ndarray

    def motion(self, changes: np.ndarray, step: float) -> np.ndarray:
        """Return u, u' and u'' (3, samples, m) at the stages, and at the end, of values (points, m) in a step [s].

        They are those of the polynomial through the `points`, whose u'' the method integrates without error.
        """
        points = self.points
        fitted = np.linalg.solve(chebyshev.chebvander(2.0 * points - 1.0, len(points) - 1), changes)
        at = 2.0 * self.samples - 1.0
        rates = [chebyshev.chebder(fitted, order, scl=2.0 / step) if order else fitted for order in range(3)]
        return np.array([chebyshev.chebval(at, each).T for each in rates])


@cache
def coefficients(method: Gauss | Radau) -> Coefficients:
    """Return the coefficients of a method."""
    nodes, s = method.nodes, method.stages
    powers, order = np.vander(nodes, increasing=True), np.arange(1, s + 1)
    a = np.ascontiguousarray(np.linalg.solve(powers.T, (nodes[:, None] ** order / order).T).T)
    weights, at_end = np.linalg.solve(powers.T, 1.0 / order), np.linalg.solve(powers.T, np.ones(s))
    known = nodes if nodes[-1] == 1.0 else np.append(nodes, 1.0)
    ahead = np.zeros((s, s + 1))
    wanted = np.vander(1.0 + nodes, len(known), increasing=True)
    ahead[:, : len(known)] = np.linalg.solve(np.vander(known, increasing=True).T, wanted.T).T
    values, vectors = np.linalg.eig(a.astype(complex))
    inverse = np.linalg.inv(vectors)
    real, pairs = np.flatnonzero(np.abs(values.imag) < 1e-9), np.flatnonzero(values.imag > 1e-9)
    into = [*inverse[real].real, *(part for k in pairs for part in (inverse[k].real, inverse[k].imag))]
    back = [*vectors.T[real].real, *(part for k in pairs for part in (2 * vectors[:, k].real, -2 * vectors[:, k].imag))]
    # p'' = x^k / k! within a step is the first that is not extrapolated, and p = x^q / q! that is not integrated
    missed = np.prod(1.0 + nodes[:, None] - known, axis=1) / factorial(len(known))
    first = float(np.max(np.abs(a @ a @ missed)))
    own = factorial(s) * factorial(s - (nodes[-1] == 1.0))
    integrated = own / (factorial(method.order) * factorial(method.order + 1))
    power = (method.order + 2) / (len(known) + 2)  # of p', by which errors of iterations are judged too
    error = integrated / first**power, power
    degree = 2 * s + len(known) - s
    values = np.append(values[real].real, values[pairs])
    return Coefficients(
        nodes, a, weights, at_end, ahead, values, np.array(into), np.ascontiguousarray(np.array(back).T), error,
        known, 0.5 - 0.5 * np.cos(np.pi * np.arange(degree + 1) / degree),
    )  # fmt: skip
