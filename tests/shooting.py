"""Planar frames solved without finite elements: members integrated along the arc length, ends met by root finding.

A Reissner member (elastica where axial and shear flexibility are 0), stress-free along its own curve: with the angle
phi = phi0(s) + theta, the force n = (nx, ny) that the part behind s is pulled with by the part ahead of it, and M,
    r' = (1 + N / EA) t + (Q / kGA) b,  theta' = M / EI,  n' = -q,  M' = -(r' x n),
where t = (cos phi, sin phi), b = (-sin phi, cos phi), N = n . t, Q = n . b.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve


@dataclass(frozen=True)
class Member:
    """Length, angle at the start and curvature of a circular or straight member, and its flexibilities 1 / E A etc."""

    length: float
    angle: float
    curvature: float = 0.0
    bending: float = 1.0  # E I
    axial: float = 0.0  # 1 / E A
    shear: float = 0.0  # 1 / k_s G A

    def run(self, state, length=None, load=(0.0, 0.0), pressure=0.0):
        """Return x, y, theta, nx, ny, M at the end of a stretch from the same at its start.

        load: dead force per length; pressure: force per length along b, it follows.
        """
        end = self.length if length is None else length

        def slope(s, y):
            phi = self.angle + self.curvature * s + y[2]
            c, d = np.cos(phi), np.sin(phi)
            normal, across = y[3] * c + y[4] * d, y[4] * c - y[3] * d
            e, g = 1.0 + self.axial * normal, self.shear * across
            x_s, y_s = e * c - g * d, e * d + g * c
            force = (-load[0] + pressure * d, -load[1] - pressure * c)
            return (x_s, y_s, y[5] / self.bending, *force, -(x_s * y[4] - y_s * y[3]))

        return solve_ivp(slope, (0.0, end), state, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]

    def after(self, length):
        """Return the rest of the member behind a length."""
        angle = self.angle + self.curvature * length
        return Member(self.length - length, angle, self.curvature, self.bending, self.axial, self.shear)


def solved(conditions, guess):
    """Return the root of the conditions. Fails the test where there is none."""
    x, found, _, message = fsolve(conditions, guess, xtol=1e-13, full_output=True)
    assert np.abs(found["fvec"]).max() < 1e-9, message
    return x


def swept(slope, span, state, axial=0.0, shear=0.0):
    """Return x, y, theta, nx, ny, M at the end of an axis y(x) of E I = 1 from the same at its start, where x = 0.

    slope: y'(x) without stress; axial, shear: 1 / E A and 1 / k_s G A.
    """

    def change(x, y):
        phi = np.arctan(slope(x)) + y[2]
        c, d = np.cos(phi), np.sin(phi)
        e, g = 1.0 + axial * (y[3] * c + y[4] * d), shear * (y[4] * c - y[3] * d)
        x_s, y_s = e * c - g * d, e * d + g * c
        return np.array([x_s, y_s, y[5], 0.0, 0.0, x_s * -y[4] + y_s * y[3]]) * np.hypot(1.0, slope(x))

    return solve_ivp(change, (0.0, span), state, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
