"""Double pendulum of two stiff beams, against the equations of two rigid bars, integrated by scipy."""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import beamfem as bf

LENGTH, GRAVITY, DURATION = 0.5, 9.81, 1.0
SECTION, STIFF = bf.Rectangle(0.02, 0.02), bf.Material(2e13, 0.3, 7850.0)


def bars(times: np.ndarray) -> np.ndarray:
    """Return both angles [rad] of rigid bars, from the horizontal, that fall from rest along x (2, times)."""
    mass, radius = STIFF.density * SECTION.area * LENGTH, SECTION.second_moment / SECTION.area
    own = mass * (LENGTH**2 / 3.0 + radius)

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        (t1, t2), (w1, w2) = y[:2], y[2:]
        coupling, delta = 0.5 * mass * LENGTH**2, t1 - t2
        matrix = [[own + mass * LENGTH**2, coupling * np.cos(delta)], [coupling * np.cos(delta), own]]
        turning = coupling * np.sin(delta) * np.array([-(w2**2), w1**2])
        weight = -mass * GRAVITY * LENGTH * np.array([1.5 * np.cos(t1), 0.5 * np.cos(t2)])
        return np.concatenate([[w1, w2], np.linalg.solve(matrix, turning + weight)])

    found = solve_ivp(rates, (0.0, times[-1]), np.zeros(4), "DOP853", times, rtol=1e-11, atol=1e-11)
    return np.asarray(found.y[:2])


def main(step: float = 2.5e-4) -> bf.Solution:
    """Return the motion of the beams from rest along x."""
    upper, lower = (bf.Beam(bf.Line((x, 0), (x + LENGTH, 0)), 2, bf.CRBF(3), SECTION, STIFF) for x in (0.0, LENGTH))
    model = bf.Model(
        [upper, lower],
        [bf.Pin(upper.start)],
        [bf.Gravity((0.0, -GRAVITY))],
        [bf.Hinge(upper.end, lower.start)],
    )
    return bf.simulate(model, DURATION, step=step)


def difference(motion: bf.Solution) -> float:
    """Return the largest difference [m] of the tip from that of rigid bars."""
    turn = bars(motion.time)
    tip = LENGTH * np.array([np.cos(turn).sum(axis=0), np.sin(turn).sum(axis=0)]).T
    return float(np.abs(motion.position(motion.model.beams[1].end) - tip).max())


def draw(motion: bf.Solution, folder: Path) -> Path:
    """Draw the bars as they fall."""
    motion.plot(folder / "shapes.svg", shapes=9, loads=False)
    return folder / "shapes.svg"
