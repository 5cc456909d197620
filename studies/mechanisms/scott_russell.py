"""Two flexible Scott-Russell linkages side by side, whose ends move straight up, with a telescope between them.

The crank holds the middle of a link twice as long, whose foot slides along x: its head is at (0, 2 a sin t). A small
weight F on the head of one linkage lowers it, with c = cos t, by F (c^2 (2 a^3 / EI + 6 a / kGA) + 6 (1 - c^2) a / EA):
Castigliano, with the moment 2 F a c at the motor. The telescope is as long as the heads are apart.
"""

from pathlib import Path

import numpy as np

import beamfem as bf

CRANK, APART, BEGIN, FORCE = 0.2, 0.7, 0.4, 0.002  # [m], [m], [rad], [N]
SECTION, PLASTIC = bf.Rectangle(0.02, 0.01), bf.Material(2e9, 0.35, 1200.0)
LIFTS = (0.7, 0.2)  # turns of both cranks [rad]


def bar(*ends: tuple[float, float]) -> bf.Beam:
    """Return a bar."""
    return bf.Beam(bf.Line(*ends), 4, bf.CRBF(3), SECTION, PLASTIC)


def main(force: float = FORCE) -> tuple[bf.Solution, list[bf.Motor]]:
    """Return the equilibria while the cranks turn, the right linkage mirrored, and the motors."""
    x, y = CRANK * np.cos(BEGIN), CRANK * np.sin(BEGIN)
    sides = [(0.0, -1.0), (APART, 1.0)]
    cranks = [bar((at, 0), (at + way * x, y)) for at, way in sides]
    links = [bar((at + 2 * way * x, 0), (at, 2 * y)) for at, way in sides]
    rods = bar((0, 2 * y), (0.4, 2 * y)), bar((APART, 2 * y), (APART - 0.5, 2 * y))
    motors = [
        bf.Motor(crank.start, angle=lambda factor, turn=way * lift: turn * factor)
        for crank, (_, way), lift in zip(cranks, sides, LIFTS, strict=True)
    ]
    hinges = [bf.Hinge(crank.end, link.at(0.5)) for crank, link in zip(cranks, links, strict=True)]
    heads = [bf.Hinge(link.end, rod.start) for link, rod in zip(links, rods, strict=True)]
    model = bf.Model(
        [*cranks, *links, *rods],
        [*(bf.Pin(crank.start) for crank in cranks), *(bf.Roller(link.start) for link in links)],
        [*motors, bf.PointForce(links[0].end, (0.0, -force), amplitude=lambda _: 1.0)],
        [*hinges, *heads],
        connectors=[bf.Slider(rods[0].end, rods[1].end, axis=(1, 0))],
    )
    return bf.solve_static(model, at=np.linspace(0.0, 1.0, 31)), motors


def differences(lifted: bf.Solution, unloaded: bf.Solution, motors: list[bf.Motor]) -> dict[str, float]:
    """Return relative differences: of the left head's height by the weight, of its motor, of the telescope's length."""
    turn = BEGIN + np.array(LIFTS)[:, None] * lifted.load_factor
    left, right = (lifted.position(link.end) for link in lifted.model.beams[2:4])
    c2, rigid = np.cos(turn[0]) ** 2, SECTION.rigidity(PLASTIC)
    flexible = c2 * (2 * CRANK**3 / rigid.bending + 6 * CRANK / rigid.shear) + 6 * (1 - c2) * CRANK / rigid.axial
    lowered = unloaded.position(unloaded.model.beams[2].end)[:, 1] - left[:, 1]
    torque = lifted.joint_force(motors[0])[:, 2] + 2 * FORCE * CRANK * np.cos(turn[0])
    apart = np.hypot(APART, 2 * CRANK * (np.sin(turn[0]) - np.sin(turn[1])))
    return {
        "height": float(np.abs(lowered / (FORCE * flexible) - 1.0).max()),
        "torque": float(np.abs(torque).max() / (2 * FORCE * CRANK)),
        "telescope": float(np.abs(np.hypot(*(right - left).T) / apart - 1.0).max()),
    }


def draw(lifted: bf.Solution, folder: Path) -> Path:
    """Draw the linkages while they lift."""
    lifted.plot(folder / "shapes.svg", shapes=4, loads=False)
    return folder / "shapes.svg"
