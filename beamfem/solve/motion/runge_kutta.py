"""Runge-Kutta methods whose stages follow from each other: that of Bathe, and explicit ones."""

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class Bathe:
    """Bathe's method: the trapezoidal rule over half the step, then the backward difference formula of second order.

    v1 = v0 + h / 4 (a0 + a1), v2 = (4 v1 - v0) / 3 + h / 3 a2, and the same for positions; also known as TR-BDF2. It is
    L-stable, of order 2, and damps what a step does not resolve. Forces of stiff parts on a support that moves are of
    order 1.

    References
    ----------
    Bathe and Baig 2005; Bank et al. 1985.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.Bathe())
    >>> len(motion)
    21
    """

    order: ClassVar[int] = 2
    stages: ClassVar[int] = 2
    removed: ClassVar[float] = 1.0 / 144.0  # |R(i y)|^2 = 1 - y^4 / 144 + ...


@dataclass(frozen=True)
class CentralDifferences:
    """Explicit method of central differences, of order 2: one acceleration a step, and no numerical damping.

    p1 = p0 + h v0 + h^2 / 2 a0, v1 = v0 + h / 2 (a0 + a1), with a1 for p1 and v0 + h a0. Steps are at most 0.8 times
    those that the highest frequency w of the reference allows, 2 / w without damping; longer ones are divided, and
    without `step` they have that size. Masses are consistent, those of the other integrators.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.02, step=0.001, integrator=bf.CentralDifferences())
    >>> len(motion)
    21
    """

    order: ClassVar[int] = 2
    stages: ClassVar[int] = 1
    removed: ClassVar[float] = 0.0


@dataclass(frozen=True)
class DormandPrince:
    """Explicit Runge-Kutta method of Dormand and Prince, of order 8 with 12 stages.

    Steps are limited by the highest frequency of the reference, as those of `CentralDifferences`. Sections with
    history, which is known at the beginning of steps, reduce its order to 1 or 2.

    References
    ----------
    Hairer, Norsett and Wanner 1993, II.5.

    Examples
    --------
    >>> motion = bf.simulate(model, duration=0.002, step=0.001, integrator=bf.DormandPrince())
    >>> len(motion)
    3
    """

    order: ClassVar[int] = 8
    stages: ClassVar[int] = 5  # |R(i y)|^2 differs from 1 by y^10
    removed: ClassVar[float] = 0.0
