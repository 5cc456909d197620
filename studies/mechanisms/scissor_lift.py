"""A scissor lift of 20 stages: the force at its foot carries a weight W on top.

Virtual work: the lift is n L sin t high and L cos t wide, so the foot needs n W cos t / sin t.
"""

from pathlib import Path

import numpy as np

import beamfem as bf

STAGES, LENGTH, BEGIN, END, WEIGHT = 20, 1.0, 0.15, 0.6, 10.0  # [-], [m], [rad], [rad], [N]
SECTION, STIFF = bf.Rectangle(0.03, 0.06), bf.Material(7e13, 0.3, 2700.0)


def lift(stages: int = STAGES) -> bf.Model:
    """Return the lift, whose foot on the right moves inwards until its bars stand at the angle END."""
    x, h = LENGTH * np.cos(BEGIN), LENGTH * np.sin(BEGIN)
    bars, hinges = [], []
    for y in h * np.arange(stages):
        up, down = (bf.Beam(bf.Line((x * a, y), (x - x * a, y + h)), 2, bf.CRBF(2), SECTION, STIFF) for a in (0.0, 1.0))
        hinges.append(bf.Hinge(up.at(0.5), down.at(0.5)))
        if bars:
            hinges += [bf.Hinge(bars[-1].end, up.start), bf.Hinge(bars[-2].end, down.start)]
        bars += [up, down]
    feet = [bf.Pin(bars[0].start), bf.Prescribed(bars[1].start, ux=LENGTH * (np.cos(END) - np.cos(BEGIN)), uy=0.0)]
    tops = [bf.PointForce(bar.end, (0.0, -0.5 * WEIGHT), amplitude=lambda _: 1.0) for bar in bars[-2:]]
    return bf.Model(bars, feet, tops, hinges)


def main(rows: int = 19) -> bf.Solution:
    """Return the equilibria while it rises."""
    return bf.solve_static(lift(), at=np.linspace(0.0, 1.0, rows))


def difference(raised: bf.Solution) -> float:
    """Return the largest relative difference of the force at the foot from that of rigid bars."""
    foot = raised.model.beams[1].start
    angle = np.arccos(raised.position(foot)[:, 0] / LENGTH)
    return float(np.abs(-raised.reaction(foot)[:, 0] * np.tan(angle) / (STAGES * WEIGHT) - 1.0).max())


def draw(raised: bf.Solution, folder: Path) -> Path:
    """Draw the lift as it rises."""
    raised.plot(folder / "shapes.svg", shapes=3, loads=False)
    return folder / "shapes.svg"
