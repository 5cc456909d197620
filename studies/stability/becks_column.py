"""Beck's column: a cantilever under a compressive force that follows its tip flutters, it never buckles.

Beck, Die Knicklast des einseitig eingespannten, tangential gedrueckten Stabes, Z. angew. Math. Phys. 3, 1952:
P L^2 / EI = 20.05. The tangent is unsymmetric; flutter is where two frequencies meet and become complex.
Shear and rotary inertia lower the load: L / h = 10 and 20 are shown besides the slender column.
"""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure

BECK = 20.0509
OUT = Path("out/becks_column")


@dataclass(frozen=True)
class Branch:
    """Loads P L^2 / EI, two lowest frequencies omega L^2 sqrt(rho A / EI) and growth at each, and the flutter load."""

    loads: np.ndarray
    frequencies: np.ndarray
    growth: np.ndarray
    flutter: float


def column(slenderness: float, elements: int = 8, order: int = 4) -> bf.Model:
    """Return the column with L = EI = rho A = 1, without load."""
    section = bf.Rectangle(1.0, 1.0 / slenderness)
    material = bf.Material(1.0 / section.second_moment, 0.3, slenderness)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order), section, material)
    return bf.Model([beam], [bf.Clamp(beam.start)], [force(beam, 0.0)])


def force(beam: bf.Beam, load: float) -> bf.PointForce:
    """Return the compressive force on the tip, which follows the section there."""
    return bf.PointForce(beam.end, (-load, 0.0), follower=True)


def modes(unloaded: bf.Model, load: float) -> bf.Modes:
    """Return the lowest two modes of the compressed column."""
    model = unloaded.with_loads([force(unloaded.beams[0], load)])
    return bf.solve_modes(model, 2, about=bf.solve_static(model))


def exact(load: float, omega: float) -> float:
    """Return the left side of Beck's frequency equation, 0 at a frequency of the Euler-Bernoulli column."""
    root = np.sqrt(0.25 * load**2 + omega**2)
    a, b = np.sqrt(root - 0.5 * load), np.sqrt(root + 0.5 * load)
    sides = load * omega * np.sinh(a) * np.sin(b) + 2.0 * omega**2 * np.cosh(a) * np.cos(b)
    return float(load**2 + 2.0 * omega**2 + sides)


def flutter_load(unloaded: bf.Model) -> float:
    """Return the load at which two frequencies meet: above it growth^2 rises, below it -(their half difference)^2."""

    def excess(load: float) -> float:
        found = modes(unloaded, load)
        apart = np.pi * (found.frequencies[1] - found.frequencies[0])
        return float(found.growth.max() ** 2 - apart**2)

    return float(brentq(excess, 10.0, 22.0, xtol=1e-7))


def main(slendernesses: tuple[float, ...] = (10.0, 20.0, 1000.0), points: int = 41) -> dict[float, Branch]:
    """Return frequencies and growth over the load for each slenderness.

    Parameters
    ----------
    slendernesses : tuple of float, [-]
        Slenderness L / h of the columns.
    points : int
        Number of loads between P L^2 / EI = 0 and 30.
    """
    result = {}
    for slenderness in slendernesses:
        unloaded, loads = column(slenderness), np.linspace(0.0, 30.0, points)
        found = [modes(unloaded, load) for load in loads]
        frequencies = np.array([2.0 * np.pi * one.frequencies for one in found])
        growth = np.array([one.growth.max() for one in found])
        result[slenderness] = Branch(loads, frequencies, growth, flutter_load(unloaded))
    return result


def draw(branches: dict[float, Branch], folder: Path = OUT) -> None:
    """Draw frequencies and growth over the load."""
    figure, axes = new_figure()
    for i, (slenderness, branch) in enumerate(branches.items()):
        axes.plot(
            branch.loads, branch.frequencies[:, 0], "-", color=COLOURS[i], label=f"frequencies, L/h = {slenderness:g}"
        )
        axes.plot(branch.loads, branch.frequencies[:, 1], "-", color=COLOURS[i])
        axes.plot(branch.loads, branch.growth, "--", color=COLOURS[i], label=f"growth, L/h = {slenderness:g}")
    axes.axvline(BECK, color="0.5", linewidth=0.8)
    axes.set_xlabel("P L$^2$ / EI")
    axes.set_ylabel(r"$\omega$ L$^2$ $\sqrt{\rho A / EI}$")
    axes.legend(frameon=False)
    save_figure(figure, folder / "frequencies.svg")


if __name__ == "__main__":
    begun = time.perf_counter()
    branches = main()
    for slenderness, branch in branches.items():
        print(f"L/h {slenderness:5.0f}: flutter at P L^2/EI = {branch.flutter:.6f}; Beck {BECK}")
    slender = branches[1000.0]
    for load, pair in list(zip(slender.loads, slender.frequencies, strict=True))[1:27:5]:
        roots = [brentq(lambda w, p=load: exact(p, w), w - 0.1, w + 0.1) for w in pair]
        print(f"P {load:6.3f}: omega {pair}, Euler-Bernoulli {np.array(roots)}")
    draw(branches)
    print(f"{time.perf_counter() - begun:.1f} s; figures in {OUT}")
