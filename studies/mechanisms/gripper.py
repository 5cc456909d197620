"""A compliant gripper: a motor turns the root of one finger, a gear that of the other, and the tips press on a spring.

Reference: by symmetry each finger is an elastica that is turned at its root and pressed across by F = k (2 u) at its
tip, which has moved by u; found by shooting, without elements.
"""

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import beamfem as bf
from studies.paper.elastica import tip_displacement

FINGER, APART, STIFFNESS, TURN = 0.1, 0.06, 60.0, 0.5  # [m], [m], [N/m], [rad]
SECTION, PLASTIC = bf.Rectangle(0.01, 0.002), bf.Material(1e9, 0.35, 1200.0)


def main(rows: int = 31) -> tuple[bf.Solution, bf.Motor]:
    """Return the equilibria while the motor closes the gripper."""
    left, right = (
        bf.Beam(bf.Line((x, 0), (x, FINGER)), 4, bf.CRBF(4), SECTION, PLASTIC) for x in (-APART / 2, APART / 2)
    )
    motor = bf.Motor(left.start, angle=lambda factor: -TURN * factor)
    held = bf.SpringDamper(left.end, right.end, STIFFNESS)
    model = bf.Model(
        [left, right],
        [bf.Pin(left.start), bf.Pin(right.start)],
        [motor],
        connectors=[bf.Gear(left.start, right.start, -1.0), held],
    )
    return bf.solve_static(model, at=np.linspace(0.0, 1.0, rows)), motor


def reference(turn: float) -> tuple[float, float]:
    """Return the force F [N] on the object and the torque [N m] of the motor, of both fingers, at an angle [rad]."""
    rigid = SECTION.rigidity(PLASTIC)

    def tip(force: float) -> tuple[float, float]:
        across, along = -force * np.cos(turn), -force * np.sin(turn)  # in axes of the root: x along, y to the object
        x, y = tip_displacement(FINGER, (along, across), rigid.bending, rigid.axial, rigid.shear)
        s, c = np.sin(turn), np.cos(turn)
        return (FINGER + x) * s + y * c, (FINGER + x) * c - y * s

    force = brentq(lambda f: f - 2.0 * STIFFNESS * tip(f)[0], 0.0, 2.0 * STIFFNESS * FINGER, xtol=1e-12)
    return float(force), float(2.0 * force * tip(force)[1])


def force(gripped: bf.Solution) -> np.ndarray:
    """Return the force [N] on the object."""
    held = gripped.model.connectors[1]
    return np.asarray(np.abs(gripped.connector_force(held)[:, 0, 0]))


def draw(gripped: bf.Solution, folder: Path) -> Path:
    """Draw the fingers while they close."""
    gripped.plot(folder / "shapes.svg", shapes=4, loads=False)
    return folder / "shapes.svg"
