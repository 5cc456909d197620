"""Coefficients of methods with stages: collocation, and Runge-Kutta methods whose stages follow from each other."""

from dataclasses import dataclass
from functools import cache
from math import factorial
from typing import TypeGuard

import numpy as np
from numpy.polynomial import chebyshev

from beamfem.equations.system import System
from beamfem.solve.motion.collocation import Gauss, Radau
from beamfem.solve.motion.runge_kutta import Bathe, CentralDifferences, DormandPrince

Explicit = CentralDifferences | DormandPrince
Implicit = Gauss | Radau | Bathe
Staged = Implicit | Explicit


def has_stages(integrator: object) -> TypeGuard[Staged]:
    """Return whether an integrator is a method with stages of the package."""
    return isinstance(integrator, Staged)


def is_explicit(integrator: object) -> TypeGuard[Explicit]:
    """Return whether an integrator is explicit: its steps are limited by the highest frequency."""
    return isinstance(integrator, Explicit)


def is_implicit(integrator: object) -> TypeGuard[Implicit]:
    """Return whether an integrator is a method whose stages are solved for."""
    return has_stages(integrator) and not is_explicit(integrator)


@dataclass(frozen=True, eq=False)
class Coefficients:
    """A method with s stages at the nodes c (s,) of a step of 1.

    of_p, of_v (s, s): weights of p'' of the stages in their p and p', A^2 and A of a Runge-Kutta method; of_begin
    (s, 2): those of p'' at the beginning, if that is a stage besides; at_end (3, s): in p and p' at the end, and
    polynomial through the stages there; to_end (s, k): the least change of p'' at the stages for one of p and p' at the
    end, of p alone with one stage, k = 0 where the beginning is a stage; ahead (s, s + 1): the polynomial through
    the stages, and the end of the step if it is no stage, at the stages of the next step; values: eigenvalues of A, the
    real ones first and one of each complex pair; into, back (s, s): the stages as parts of its eigenvectors and the
    inverse, see `kernels.stage_record`; error: factor and power, see there; samples: times of the stages and of the end
    within a step of 1; points: such times, ends included, through which motions of supports are interpolated.
    """

    nodes: np.ndarray
    of_p: np.ndarray
    of_v: np.ndarray
    of_begin: np.ndarray
    at_end: np.ndarray
    to_end: np.ndarray
    samples: np.ndarray
    points: np.ndarray
    ahead: np.ndarray
    values: np.ndarray
    into: np.ndarray
    back: np.ndarray
    error: tuple[float, float]
    explicit: bool = False

    @property
    def real(self) -> int:
        """Number of real eigenvalues."""
        return int(np.sum(self.values.imag == 0.0))

    def weights(self, step: float) -> np.ndarray:
        """Return the weights (s, 3) of p, p' and p'' in the tangent of each plane, see `kernels.stage_record`."""
        z = step * self.values
        planes = [(each.real**2, each.real, 1.0) for each in z[: self.real]]
        for each in z[self.real :]:
            planes += [((each**2).real, each.real, 1.0), ((each**2).imag, each.imag, 0.0)]
        return np.array(planes) if planes else np.zeros((len(self.nodes), 3))

    def moved(self, system: System, begin: float, end: float, step: float) -> np.ndarray:
        """Return prescribed changes u and their rates (samples, 3, nh) in a step [s] between two times [s].

        They are those of the polynomial through the `points`, whose u'' the method integrates without error. But u is
        at the stages what the method itself makes of u'', or of what is next to it and leads to u and u' at the end of
        the step: what is stiff follows u at the stages, and would end beside it.
        """
        points, stages = self.points, slice(len(self.nodes))
        changes = system.prescribed_course(begin + (end - begin) * points)
        fitted = np.linalg.solve(chebyshev.chebvander(2.0 * points - 1.0, len(points) - 1), changes)
        at = 2.0 * np.array([*self.samples, 0.0, 1.0]) - 1.0
        rates = [chebyshev.chebder(fitted, order, scl=2.0 / step) if order else fitted for order in range(3)]
        result = np.array([chebyshev.chebval(at, each).T for each in rates])
        result, first, last = result[:, :-2], result[:, -2], result[:, -1]
        if not self.explicit:
            accelerations, count = result[2, stages], self.to_end.shape[1]
            means = np.array([(last[0] - first[0]) / step**2 - first[1] / step, (last[1] - first[1]) / step])[:count]
            accelerations = accelerations + self.to_end @ (means - self.at_end[:count] @ accelerations)
            course = first[0] + step * self.nodes[:, None] * first[1]
            course += step**2 * (self.of_p @ accelerations + self.of_begin[:, :1] * first[2])
            own = (count > 0) | (system.prescribed_dofs >= system.model.coordinates)
            result[0, stages, own] = course[:, own].T
        return result.swapaxes(0, 1)


@cache
def coefficients(method: Staged) -> Coefficients:
    """Return the coefficients of a method."""
    degree = method.order + 1
    points = 0.5 - 0.5 * np.cos(np.pi * np.arange(degree + 1) / degree)
    if isinstance(method, Explicit):
        return _explicit(method, points)
    a = _BATHE if isinstance(method, Bathe) else _collocation(method.nodes)
    inner = len(a) - method.stages  # the beginning comes first, if it is a stage
    nodes, s, weights = a.sum(axis=1)[inner:], method.stages, _weights(method, a)
    of_p, of_v = (each[inner:, inner:] for each in (a @ a, a))
    of_begin = np.stack([each[inner:, 0] for each in (a @ a, a)], axis=1) if inner else np.zeros((s, 2))
    there = np.linalg.solve(np.vander(nodes, increasing=True).T, np.ones(s))
    at_end = np.array([(weights @ a)[inner:], weights[inner:], there])
    known = nodes if nodes[-1] == 1.0 else np.append(nodes, 1.0)
    ahead = np.zeros((s, s + 1))
    wanted = np.vander(1.0 + nodes, len(known), increasing=True)
    ahead[:, : len(known)] = np.linalg.solve(np.vander(known, increasing=True).T, wanted.T).T
    values, vectors = np.linalg.eig(of_v.astype(complex))
    inverse = np.linalg.inv(vectors)
    real, pairs = np.flatnonzero(np.abs(values.imag) < 1e-9), np.flatnonzero(values.imag > 1e-9)
    into = [*inverse[real].real, *(part for k in pairs for part in (inverse[k].real, inverse[k].imag))]
    back = [*vectors.T[real].real, *(part for k in pairs for part in (2 * vectors[:, k].real, -2 * vectors[:, k].imag))]
    # p'' = x^k / k! within a step is the first that is not extrapolated, and p = x^q / q! that is not integrated
    missed = np.prod(1.0 + nodes[:, None] - known, axis=1) / factorial(len(known))
    first = float(np.max(np.abs(of_p @ missed)))
    integrated = float(weights @ np.linalg.matrix_power(a, method.order).sum(axis=1)) - 1.0 / factorial(
        method.order + 1
    )
    power = (method.order + 2) / (len(known) + 2)  # of p', by which errors of iterations are judged too
    return Coefficients(
        nodes, of_p, of_v, of_begin, at_end, np.linalg.pinv(at_end[: 0 if inner else min(s, 2)]), known, points,
        ahead, np.append(values[real].real, values[pairs]), np.array(into), np.ascontiguousarray(np.array(back).T),
        (abs(integrated) / first**power, power),
    )  # fmt: skip


# trapezoidal rule over half the step, then the backward difference formula of second order
_BATHE = np.array([[0.0, 0.0, 0.0], [0.25, 0.25, 0.0], [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]])


def _collocation(nodes: np.ndarray) -> np.ndarray:
    """Return A (s, s): integrals of the polynomials that are 1 at one node and 0 at the others, up to each node."""
    powers, order = np.vander(nodes, increasing=True), np.arange(1, len(nodes) + 1)
    return np.ascontiguousarray(np.linalg.solve(powers.T, (nodes[:, None] ** order / order).T).T)


def _weights(method: Implicit, a: np.ndarray) -> np.ndarray:
    """Return b (s,): integrals over the step, the last row of A where the last stage is the end."""
    if isinstance(method, Bathe):
        return np.asarray(a[-1])
    return np.linalg.solve(np.vander(method.nodes, increasing=True).T, 1.0 / np.arange(1, method.stages + 1))


def _explicit(method: Explicit, points: np.ndarray) -> Coefficients:
    """Return the coefficients of an explicit method; those of `DormandPrince` are of scipy."""
    if isinstance(method, DormandPrince):
        from scipy.integrate import DOP853  # takes a while to import

        nodes, of_v, weights = DOP853.C[: len(DOP853.B)], DOP853.A[: len(DOP853.B), : len(DOP853.B)], DOP853.B
        of_p, at_end, samples = of_v @ of_v, np.array([weights @ of_v, weights, 0.0 * weights]), np.append(nodes, 1.0)
    else:
        nodes, of_v = np.array([0.0, 1.0]), np.array([[0.0, 0.0], [1.0, 0.0]])
        of_p, at_end, samples = 0.5 * of_v, np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 1.0]]), nodes
    none, square = np.zeros(0), np.zeros_like(of_v)
    return Coefficients(
        nodes, of_p, of_v, np.zeros((len(nodes), 2)), at_end, np.zeros((len(nodes), 0)), samples, points,
        np.zeros((len(nodes), len(nodes) + 1)), none, square, square, (0.0, 1.0), explicit=True,
    )  # fmt: skip
