"""Cantilevers integrated along their length as initial value problems, to 12 digits; no beam elements."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root_scalar


@dataclass(frozen=True)
class Cantilever:
    """Clamped at s = 0 under a dead tip force, free of moment at its tip.

    shear: k_s G A, or None for the elastic line, whose section stands across r'.
    """

    length: float
    axial: float
    shear: float | None
    bending: float
    curvature: Callable[[float], float] = lambda s: 0.0
    slope: float = 0.0  # angle of the tangent at the clamp
    start: tuple[float, float] = (0.0, 0.0)

    def tip(self, force: tuple[float, float]) -> np.ndarray:
        """Return x, y and rotation at the tip and the moment at the clamp."""
        fx, fy = np.array(force) * self.length**2 / self.bending

        def rates(s, z):
            c, si = np.cos(z[2]), np.sin(z[2])
            normal, shear = fx * c + fy * si, fy * c - fx * si
            scale = self.bending / self.length**2
            along = 1.0 + scale * normal / self.axial
            across = scale * shear / self.shear if self.shear else 0.0
            return [
                along * c - across * si,
                along * si + across * c,
                self.curvature(s) + z[3] / self.length,
                (across * normal - along * shear) / self.length,
            ]

        def shoot(moment):
            z = (*self.start, self.slope, moment)
            return solve_ivp(rates, (0.0, self.length), z, "DOP853", rtol=3e-14, atol=1e-15).y[:, -1]

        guess = 0.0
        for share in np.linspace(0.1, 1.0, 10):  # follow the force, so that the moment is that of the first equilibrium
            full = (fx, fy)
            fx, fy = share * full[0], share * full[1]
            found = root_scalar(lambda m: shoot(m)[3], x0=guess, x1=guess + 1e-3, method="secant", xtol=1e-15)
            guess, (fx, fy) = found.root, full
        end = shoot(guess)
        reference = solve_ivp(
            lambda s, z: [np.cos(z[2]), np.sin(z[2]), self.curvature(s)],
            (0.0, self.length),
            (*self.start, self.slope),
            "DOP853",
            rtol=3e-14,
            atol=1e-15,
        ).y[:, -1]
        return np.array([*end[:2], end[2] - reference[2], guess * self.bending / self.length])
