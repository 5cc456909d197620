"""Slider-crank: torque of the motor with a stiff and with a flexible rod, against the rigid-body equation.

With the kinetic energy J(t) t'^2 / 2 of crank, rod and slider at the crank angle t, the torque is J t'' + J' t'^2 / 2.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.mechanisms.smooth_start import turned

CRANK, ROD, SLIDER = 0.15, 0.4, 0.5  # [m], [m], [kg]
SECTION, RAMP, SPEED, DURATION = bf.Rectangle(0.02, 0.01), 0.4, 15.0, 0.8
DENSITY = 2700.0


def angle(t: float | np.ndarray) -> np.ndarray:
    """Return the angle [rad] of the crank, which speeds up smoothly within `RAMP`."""
    return turned(t, SPEED, RAMP)


def inertia(turn: np.ndarray) -> np.ndarray:
    """Return J [kg m^2] of rigid parts at angles of the crank."""
    density, radius = DENSITY * SECTION.area, SECTION.second_moment / SECTION.area
    lean = -np.arcsin(CRANK / ROD * np.sin(turn))
    rate = -CRANK * np.cos(turn) / (ROD * np.cos(lean))
    middle = [
        -CRANK * np.sin(turn) - 0.5 * ROD * np.sin(lean) * rate,
        CRANK * np.cos(turn) + 0.5 * ROD * np.cos(lean) * rate,
    ]
    end = -CRANK * np.sin(turn) - ROD * np.sin(lean) * rate
    rod = middle[0] ** 2 + middle[1] ** 2 + (ROD**2 / 12.0 + radius) * rate**2
    return np.asarray(density * (CRANK * (CRANK**2 / 3.0 + radius) + ROD * rod) + SLIDER * end**2)


def rigid_torque(t: np.ndarray) -> np.ndarray:
    """Return the torque [N m] of rigid parts: derivatives by central differences, to 1e-9 of it."""
    h = 1e-4
    rate = (angle(t + h) - angle(t - h)) / (2.0 * h)
    momentum = [inertia(angle(s)) * (angle(s + h) - angle(s - h)) / (2.0 * h) for s in (t - h, t + h)]
    slope = (inertia(angle(t) + h) - inertia(angle(t) - h)) / (2.0 * h)
    return np.asarray((momentum[1] - momentum[0]) / (2.0 * h) - 0.5 * slope * rate**2)


@dataclass(frozen=True)
class Run:
    """A motion and the torque of its motor [N m] over time."""

    motion: bf.Solution
    torque: np.ndarray


def run(modulus: float, step: float = 2.5e-4) -> Run:
    """Return the motion with a rod of a modulus of elasticity [Pa]; the crank is as stiff, or has 7e13 Pa."""
    lines = bf.Line((0, 0), (CRANK, 0)), bf.Line((CRANK, 0), (CRANK + ROD, 0))
    stiff, soft = bf.Material(max(modulus, 7e13), 0.3, DENSITY), bf.Material(modulus, 0.3, DENSITY)
    crank = bf.Beam(lines[0], 2, bf.CRBF(3), SECTION, stiff)
    rod = bf.Beam(lines[1], 4, bf.CRBF(3), SECTION, soft)
    motor = bf.Motor(crank.start, angle=angle)
    model = bf.Model(
        [crank, rod],
        [bf.Pin(crank.start), bf.Roller(rod.end)],
        [motor],
        [bf.Hinge(crank.end, rod.start)],
        masses=[bf.PointMass(rod.end, SLIDER)],
    )
    motion = bf.simulate(model, DURATION, step=step, save_every=round(2.5e-4 / step))
    return Run(motion, motion.joint_force(motor)[:, 2])


def main() -> dict[str, Run]:
    """Return the motions with a stiff rod and with one of soft plastic.

    With 7e13 Pa, the elasticity of the bars changes the torque by 1.5e-5, whatever the steps.
    """
    return {"stiff rod": run(7e14, 1.25e-4), "flexible rod": run(2e8)}


def draw(runs: dict[str, Run], folder: Path) -> Path:
    """Draw the torques over time and return the path of the figure."""
    figure, axes = new_figure()
    for i, (name, found) in enumerate(runs.items()):
        axes.plot(found.motion.time, found.torque, color=COLOURS[i], label=name)
    time = runs["stiff rod"].motion.time
    axes.plot(time, rigid_torque(time), "k:", label="rigid bodies")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("torque of the motor [N m]")
    axes.legend(frameon=False)
    save_figure(figure, folder / "torque.svg")
    return folder / "torque.svg"
