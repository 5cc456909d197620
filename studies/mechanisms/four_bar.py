"""Four-bar linkage with a flexible rocker: its crank turns once, against a moment on the rocker.

Virtual work: the torque of the crank is -M times the transmission dp/dt of the rigid linkage (Freudenstein 1955). The
rocker is a simply supported beam under the end moment M: its end turns by M L / (3 E I) + M / (k G A L) more.
"""

from pathlib import Path

import numpy as np

import beamfem as bf

GROUND, CRANK, COUPLER, ROCKER = 0.4, 0.1, 0.35, 0.3  # [m]
MOMENT, SECTION = 1e-3, bf.Rectangle(0.01, 0.004)
STIFF, FLEXIBLE = bf.Material(2e12, 0.3, 1000.0), bf.Material(2e9, 0.3, 1000.0)


def rocker(turn: np.ndarray | float) -> np.ndarray:
    """Return the angle [rad] of the rigid rocker at angles of the crank."""
    x, y = CRANK * np.cos(turn) - GROUND, CRANK * np.sin(turn)
    diagonal = np.hypot(x, y)
    return np.asarray(
        np.pi + np.arctan2(-y, -x) - np.arccos((ROCKER**2 + diagonal**2 - COUPLER**2) / (2.0 * ROCKER * diagonal))
    )


def main(rows: int = 61) -> tuple[bf.Solution, bf.Motor]:
    """Return the equilibria over one turn of the crank, and the motor."""
    end = np.array([GROUND, 0.0]) + ROCKER * np.array([np.cos(rocker(0.0)), np.sin(rocker(0.0))])
    places = [((0, 0), (CRANK, 0)), ((CRANK, 0), end), ((GROUND, 0), end)]
    crank, coupler, swing = (
        bf.Beam(bf.Line(*place), 4, bf.CRBF(3), SECTION, material)
        for place, material in zip(places, (STIFF, STIFF, FLEXIBLE), strict=True)
    )
    motor = bf.Motor(crank.start, angle=lambda factor: 2.0 * np.pi * factor)
    model = bf.Model(
        [crank, coupler, swing],
        [bf.Pin(crank.start), bf.Pin(swing.start)],
        [motor, bf.Motor(swing.start, torque=lambda _: MOMENT)],
        [bf.Hinge(crank.end, coupler.start), bf.Hinge(coupler.end, swing.end)],
    )
    return bf.solve_static(model, at=np.linspace(0.0, 1.0, rows)), motor


def differences(turned: bf.Solution, motor: bf.Motor) -> tuple[float, float]:
    """Return the largest differences of the torque over M, and of the rocker's end over its bending."""
    turn, h = 2.0 * np.pi * turned.load_factor, 1e-5
    rate = (rocker(turn + h) - rocker(turn - h)) / (2.0 * h)
    rigidity = SECTION.rigidity(FLEXIBLE)
    bent = MOMENT * (ROCKER / (3.0 * rigidity.bending) + 1.0 / (rigidity.shear * ROCKER))
    end = turned.rotation(turned.model.beams[2].start) - (rocker(turn) - rocker(0.0))
    torque = turned.joint_force(motor)[:, 2]
    return float(np.abs(torque / MOMENT + rate).max()), float(np.abs(end / bent - 1.0).max())


def draw(turned: bf.Solution, folder: Path) -> Path:
    """Draw the linkage over the turn."""
    turned.plot(folder / "shapes.svg", shapes=9, loads=False)
    return folder / "shapes.svg"
