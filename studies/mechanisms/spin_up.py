"""Spin-up of a flexible arm with a mass at its tip: it lags behind, swings and turns on, stretched by its own inertia.

Turning steadily at w, r'' = -(rho w^2 / E) r along the arm with r(0) = 0 and E A (r'(L) - 1) = m w^2 r(L).
"""

from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.mechanisms.smooth_start import turned

LENGTH, TIP, SPEED, RAMP, DURATION = 1.0, 0.2, 12.0, 2.0, 5.0
SECTION, PLASTIC = bf.Rectangle(0.02, 0.02), bf.Material(2e9, 0.35, 1200.0)


def radius() -> float:
    """Return the radius [m] of the tip of an arm that turns steadily."""
    wave = np.sqrt(PLASTIC.density / PLASTIC.youngs_modulus) * SPEED
    pull = TIP * SPEED**2 / (PLASTIC.youngs_modulus * SECTION.area)
    return float(np.tan(wave * LENGTH) / (wave - pull * np.tan(wave * LENGTH)))


def main(step: float = 5e-4) -> bf.Solution:
    """Return the motion; damping ends the vibrations."""
    arm = bf.Beam(bf.Line((0, 0), (LENGTH, 0)), 4, bf.CRBF(3), SECTION, PLASTIC, damping=bf.Rayleigh(stiffness=0.03))
    motor = bf.Motor(arm.start, angle=lambda time: turned(time, SPEED, RAMP))
    model = bf.Model([arm], [bf.Pin(arm.start)], [motor], masses=[bf.PointMass(arm.end, TIP)])
    return bf.simulate(model, DURATION, step=step)


def lag(motion: bf.Solution) -> np.ndarray:
    """Return how far [m] the tip is ahead of a straight arm."""
    arm = motion.model.beams[0]
    turn = motion.rotation(arm.start)
    return np.asarray(np.sum(motion.position(arm.end) * np.array([-np.sin(turn), np.cos(turn)]).T, axis=1))


def draw(motion: bf.Solution, folder: Path) -> Path:
    """Draw the lag of the tip."""
    figure, axes = new_figure()
    axes.plot(motion.time, lag(motion), color=COLOURS[0])
    axes.set_xlabel("time [s]")
    axes.set_ylabel("tip ahead of a straight arm [m]")
    save_figure(figure, folder / "lag.svg")
    return folder / "lag.svg"
