"""Columns under a dead load: where they buckle for four pairs of ends, and how they go on.

Euler 1744; Reissner, On one-dimensional finite-strain beam theory, J. Appl. Math. Phys. 23, 1972: with a stretch
1 - P / EA before and shear, EI t'' + P eta t = -V eta with eta = 1 - P / EA + P / GA, and for the cantilever and the
hinged column P eta = EI (pi / (2 L))^2 and EI (pi / L)^2. Post-buckling: the elastica, P L^2 / EI = K(sin(a / 2))^2 for
the cantilever with the tip angle a; elements are compared with it at L / h = 5000.
"""

import time
from pathlib import Path

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipk

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure

SHEAR_FACTOR, POISSON = 5 / 6, 0.3
OUT = Path("out/column")


def supports(ends: str, beam: bf.Beam) -> list[bf.Clamp | bf.Pin | bf.Roller | bf.Prescribed]:
    """Return the supports of a column along x that is free to shorten at its end."""
    first = bf.Pin(beam.start) if ends == "hinged-hinged" else bf.Clamp(beam.start)
    last = {
        "cantilever": [],
        "hinged-hinged": [bf.Roller(beam.end)],
        "clamped-hinged": [bf.Roller(beam.end)],
        "clamped-clamped": [bf.Prescribed(beam.end, uy=0.0, rotation=0.0)],
    }[ends]
    return [first, *last]


def column(ends: str, slenderness: float, elements: int = 12, order: int = 4) -> bf.Model:
    """Return a column with L = EI = 1 under a load of 1."""
    section = bf.Rectangle(1.0, 1.0 / slenderness, SHEAR_FACTOR)
    material = bf.Material(1.0 / section.second_moment, POISSON, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order), section, material)
    return bf.Model([beam], supports(ends, beam), [bf.PointForce(beam.end, (-1.0, 0.0))])


CONDITIONS = {
    "cantilever": (lambda u, q: np.cos(u), 1.2, 2.6),
    "hinged-hinged": (lambda u, q: np.sin(u), 6.0, 12.0),
    "clamped-hinged": (lambda u, q: np.sin(u) - u * (1.0 - q) * np.cos(u), 12.0, 22.0),
    "clamped-clamped": (lambda u, q: np.sin(0.5 * u), 15.0, 50.0),
}


def reissner(ends: str, slenderness: float) -> float:
    """Return the first root of the condition on u = L sqrt(P eta / EI) and q = P / (eta GA)."""
    condition, low, high = CONDITIONS[ends]
    axial = 12.0 * slenderness**2
    shear = axial * SHEAR_FACTOR / (2.0 * (1.0 + POISSON))

    def left(load: float) -> float:
        eta = 1.0 - load / axial + load / shear
        return float(condition(np.sqrt(load * eta), load / (eta * shear)))

    return float(brentq(left, low, high, xtol=1e-13))


def main(slendernesses: tuple[float, ...] = (10.0, 20.0, 50.0, 200.0)) -> dict[tuple[str, float], float]:
    """Return the critical P L^2 / EI for each pair of ends and each slenderness.

    Parameters
    ----------
    slendernesses : tuple of float, [-]
        Slenderness L / h of the columns.
    """
    return {
        (ends, slenderness): float(bf.solve_buckling(column(ends, slenderness)).load_factors[0])
        for ends in CONDITIONS
        for slenderness in slendernesses
    }


def buckled(direction: int = 1, angle: float = 2.6) -> tuple[bf.Path, bf.Path]:
    """Return the straight path of a slender cantilever and its first branch up to a tip angle [rad]."""
    model = column("cantilever", 5000.0)
    end = model.beams[0].end
    straight = bf.trace_equilibrium(model, until=3.0)
    branch = bf.trace_equilibrium(
        model, lambda state: abs(state.rotation(end)) > angle, start=straight.bifurcations[0], direction=direction
    )
    return straight, branch


def draw(branch: bf.Path, folder: Path = OUT) -> None:
    """Draw load against tip angle, and the shapes."""
    angle = np.abs(branch.rotation(branch.model.beams[0].end))
    figure, axes = new_figure()
    exact = np.linspace(0.0, angle.max(), 200)
    axes.plot(exact, ellipk(np.sin(exact / 2) ** 2) ** 2, "-", color=COLOURS[0], label="elastica")
    axes.plot(angle, branch.load_factor, "o", color=COLOURS[1], markersize=4, label="branch")
    axes.set_xlabel("tip angle [rad]")
    axes.set_ylabel("P L$^2$ / EI")
    axes.legend(frameon=False)
    save_figure(figure, folder / "post-buckling.svg")
    branch.plot(folder / "shapes.svg")


if __name__ == "__main__":
    begun = time.perf_counter()
    for (ends, slenderness), load in main().items():
        exact = reissner(ends, slenderness)
        print(f"{ends:16s} L/h {slenderness:5.0f}: {load:.10f}, Reissner {exact:.10f}, error {load / exact - 1:8.1e}")
    straight, branch = buckled()
    print(f"bifurcation {straight.bifurcations[0].load_factor:.10f}, pi^2 / 4 = {np.pi**2 / 4:.10f}")
    for angle, load in zip(np.abs(branch.rotation(branch.model.beams[0].end)), branch.load_factor, strict=True):
        exact = ellipk(np.sin(angle / 2) ** 2) ** 2
        print(f"tip angle {angle:.6f}: P L^2/EI {load:.8f}, elastica {exact:.8f}, error {load / exact - 1:8.1e}")
    draw(branch)
    print(f"{time.perf_counter() - begun:.1f} s; figures in {OUT}")
