"""A cantilever under a tip force that stays normal to the tip section, and under a pressure that follows it.

Argyris and Symeonidis, Nonlinear finite element analysis of elastic systems under nonconservative loading, Comput.
Methods Appl. Mech. Eng. 26, 1981, and many after them. Seen from the tip the force is constant, so the elastica is the
solution of an initial value problem: it is integrated here for every load, no elements. L / h = 5000.
"""

import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure

PRINTED = (0.1722778753991, 0.7806901427781, 2.0981572399410)  # x, y, angle of the tip at P L^2 / EI = 5; collocation
OUT = Path("out/follower_cantilever")


def elastica(load: float) -> np.ndarray:
    """Return x, y [L] and angle of the tip under P L^2 / EI, by integration from the tip to the clamp."""

    def slope(s: float, y: np.ndarray) -> tuple[float, float, float, float]:
        # the frame of the tip; the part that is left carries P times the distance along the tip's normal
        return (-np.cos(y[2]), -np.sin(y[2]), -y[3], load * np.cos(y[2]))

    x, y, turn, _ = solve_ivp(slope, (0.0, 1.0), np.zeros(4), method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    c, s = np.cos(-turn), np.sin(-turn)
    return np.array([-(c * x - s * y), -(s * x + c * y), -turn])


def main(load: float = 20.0, elements: int = 16, order: int = 4, slenderness: float = 5000.0) -> bf.Path:
    """Return the equilibrium path; its load factor is P L^2 / EI.

    Parameters
    ----------
    load : float, [-]
        Largest P L^2 / EI.
    elements : int
        Number of elements.
    order : int
        Order of the elements.
    slenderness : float, [-]
        Slenderness L / h.
    """
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    material = bf.Material(1.0 / section.second_moment, 0.3, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order), section, material)
    force = bf.PointForce(beam.end, (0.0, 1.0), follower=True)
    return bf.trace_equilibrium(bf.Model([beam], [bf.Clamp(beam.start)], [force]), until=load)


def tip(path: bf.Path) -> np.ndarray:
    """Return x, y and angle of the tip (points, 3)."""
    end = path.model.beams[0].end
    return np.column_stack([path.position(end), path.rotation(end)])


def draw(path: bf.Path, folder: Path = OUT) -> None:
    """Draw place and angle of the tip over the load, and the shapes."""
    figure, axes = new_figure()
    loads = np.linspace(0.0, path.load_factor[-1], 60)
    exact = np.array([elastica(load) for load in loads])
    for i, label in enumerate(("x / L", "y / L", "angle / pi")):
        scale = np.pi if i == 2 else 1.0
        axes.plot(loads, exact[:, i] / scale, "-", color=COLOURS[i], label=f"{label}, elastica")
        axes.plot(path.load_factor, tip(path)[:, i] / scale, "o", color=COLOURS[i], markersize=4)
    axes.set_xlabel("P L$^2$ / EI")
    axes.legend(frameon=False)
    save_figure(figure, folder / "tip.svg")
    path.plot(folder / "shapes.svg")


if __name__ == "__main__":
    begun = time.perf_counter()
    path = main()
    print("elastica at 5:", elastica(5.0), "printed reference:", np.array(PRINTED))
    print("elements at 5:", tip(main(5.0))[-1])
    for load, found in zip(path.load_factor, tip(path), strict=True):
        print(f"P L^2/EI {load:8.4f}: x, y, angle {found}, error {np.abs(found - elastica(load)).max():.1e}")
    draw(path)
    print(f"{time.perf_counter() - begun:.1f} s; figures in {OUT}")
