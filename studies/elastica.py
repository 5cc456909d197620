"""A cantilever under a dead tip force by shooting, without any beam element: Reissner's beam and the elastica.

N = E A (stretch - 1), Q = k_s G A shear, M = E I theta'; without shear (infinite k_s G A) the extensible elastica.
Source: E. Reissner, J. Appl. Math. Phys. 23 (1972) 795-804.
"""

from math import inf, pi

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

DIGITS = 1e-13  # tolerance of the integration; the tip is right to about 1e-12 of the length


def tip_displacement(
    length: float, force: float, bending: float, axial: float = inf, shear: float = inf
) -> tuple[float, float]:
    """Return the tip displacement u, v [m] of a beam along x that is clamped at its start.

    length [m]; force: across the beam [N], below the second branch of equilibria; bending E I [N m^2]; axial E A and
    shear k_s G A [N].
    """

    def rates(_: float, state: np.ndarray) -> list[float]:
        theta, moment = state[:2]
        c, s = np.cos(theta), np.sin(theta)
        along, across = 1.0 + force * s / axial, force * c / shear
        x, y = along * c - across * s, along * s + across * c
        return [moment / bending, -x * force, x, y]

    def backwards(tip_angle: float) -> np.ndarray:
        """State at the clamp of a beam whose tip has this angle, no moment, and stands at the origin."""
        done = solve_ivp(rates, (length, 0.0), [tip_angle, 0.0, 0.0, 0.0], "DOP853", rtol=DIGITS, atol=DIGITS * length)
        return done.y[:, -1]

    angle = brentq(lambda tip_angle: backwards(tip_angle)[0], 0.0, pi / 2, xtol=1e-15, rtol=1e-15)
    x, y = backwards(angle)[2:]
    return float(-x - length), float(-y)
