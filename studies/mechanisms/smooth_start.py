"""A drive that speeds up smoothly."""

import numpy as np


def turned(time: float | np.ndarray, speed: float, ramp: float) -> np.ndarray:
    """Return the angle [rad] at a time [s], of a drive that reaches a speed [rad/s] after a ramp [s]."""
    x = np.minimum(time, ramp) / ramp
    return np.asarray(speed * (ramp * x**4 * (2.5 - 3.0 * x + x**2) + np.maximum(np.asarray(time) - ramp, 0.0)))
