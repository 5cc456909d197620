"""Load steps of Lee's frame up to its limit point and over it, on the path that they look for."""

import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import CubicSpline

import beamfem as bf

BLUE, RED, GREY = "#0077BB", "#CC3311", "0.6"


def smooth(x, y):
    """Return a curve through points, by a spline over the chord."""
    chord = np.append(0.0, np.cumsum(np.hypot(np.diff(x) / np.ptp(x), np.diff(y) / np.ptp(y))))
    return CubicSpline(chord, np.column_stack([x, y]))(np.linspace(0.0, chord[-1], 500)).T


def frame(force):
    common = {"element": bf.CRBF(3), "section": bf.Section(6.0, 2.0), "material": bf.Material(7.2e6, 0.3, 2.7e-5)}
    column = bf.Beam(bf.Line((0, 0), (0, 120)), 6, **common)
    bar = bf.Beam(bf.Line((0, 120), (120, 120)), 10, **common)
    supports, joints = [bf.Pin(column.start), bf.Pin(bar.end)], [bf.Rigid(column.end, bar.start)]
    model = bf.Model([column, bar], supports, [bf.PointForce(bar.at(0.2), (0, -force))], joints, units="N, cm")
    return model, bar.at(0.2)


def main():
    model, loaded = frame(1.0)
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(loaded)[1] < -95.0)
    steep, point = frame(30e3)
    steps = bf.solve_static(steep, at=np.linspace(0.0, 1.0, 11), snap="jump")
    down, force = -steps.displacement(point)[:, 1], 30.0 * steps.load_factor
    figure, axes = plt.subplots(figsize=(7.0, 3.6), layout="constrained")
    along = -path.displacement(loaded)[:, 1]
    axes.plot(*smooth(along, 1e-3 * path.load_factor), color=GREY, linewidth=1.4, label="equilibrium path")
    (top, *_) = path.limit_points
    crown, limit = -top.displacement(loaded)[1], 1e-3 * top.load_factor
    axes.plot(down, force, "o", color=BLUE, markersize=5, label="rows of solve_static")
    axes.plot(crown, limit, "s", color=RED, markersize=7, zorder=5, label="limit point")
    rest = down[down > crown + 1.0].min()
    axes.annotate(
        "", (rest, limit), (crown, limit), arrowprops={"arrowstyle": "-|>", "color": RED, "lw": 1.4, "ls": "--"}
    )
    axes.text(0.5 * (crown + rest), limit + 0.8, 'snap="jump"', color=RED, ha="center", family="monospace", fontsize=10)
    axes.set(xlabel="displacement of the loaded point [cm]", ylabel="force [kN]", xlim=(-2, 100), ylim=(-12, 33))
    axes.legend(loc="lower left", fontsize=9)
    axes.grid(True, color="0.9", linewidth=0.6)
    figure.savefig("load_steps.png", dpi=110)


if __name__ == "__main__":
    main()
