"""A cantilever under a dead tip force by shooting, without any beam element: Reissner's beam and the elastica.

N = E A (stretch - 1), Q = k_s G A shear, M = E I (theta' - curvature); without shear (infinite k_s G A) the extensible
elastica. Source: E. Reissner, J. Appl. Math. Phys. 23 (1972) 795-804.
"""

from functools import cache
from math import inf

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root_scalar

DIGITS = 1e-13  # tolerance of the integration; the tip is right to about 1e-12 of the length
LOAD_STEPS = 5


@cache
def tip_displacement(
    length: float,
    force: tuple[float, float],
    bending: float,
    axial: float = inf,
    shear: float = inf,
    curvature: float = 0.0,
) -> tuple[float, float]:
    """Return the tip displacement u, v [m] of a beam that is clamped at its start, where it runs along x.

    length [m]; force at the tip (2,) [N]; bending E I [N m^2]; axial E A and shear k_s G A [N]; curvature of the
    stress-free beam, a part of a circle [1/m].
    """

    def backwards(tip_angle: float, share: float) -> np.ndarray:
        """Angle, moment, x, y at the clamp of a beam whose tip has this angle, no moment, and stands at the origin."""
        fx, fy = share * force[0], share * force[1]

        def rates(_: float, state: np.ndarray) -> list[float]:
            theta, moment = state[:2]
            c, s = np.cos(theta), np.sin(theta)
            along, across = 1.0 + (fx * c + fy * s) / axial, (fy * c - fx * s) / shear
            x, y = along * c - across * s, along * s + across * c
            return [curvature + moment / bending, y * fx - x * fy, x, y]

        done = solve_ivp(rates, (length, 0.0), [tip_angle, 0.0, 0.0, 0.0], "DOP853", rtol=DIGITS, atol=DIGITS * length)
        return np.asarray(done.y[:, -1])

    angle = curvature * length
    for share in np.linspace(0.0, 1.0, LOAD_STEPS + 1)[1:]:
        found = root_scalar(lambda a, w=share: backwards(a, w)[0], x0=angle, x1=angle + 1e-3, xtol=1e-14)
        angle = found.root
    # integration errors are the same with and without load, and do not stay in the displacement of a curved beam
    start, end = backwards(curvature * length, 0.0)[2:], backwards(angle, 1.0)[2:]
    return float(start[0] - end[0]), float(start[1] - end[1])
