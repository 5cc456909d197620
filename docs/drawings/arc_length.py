"""A step along an equilibrium path: predictor along the tangent, corrections in the plane across it."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import FancyArrowPatch
from scipy.interpolate import CubicSpline

import beamfem as bf

BLUE, RED, INK, GREY = "#0077BB", "#CC3311", "#222222", "0.6"


def smooth(x, y):
    """Return a curve through points, by a spline over the chord."""
    chord = np.append(0.0, np.cumsum(np.hypot(np.diff(x) / np.ptp(x), np.diff(y) / np.ptp(y))))
    return CubicSpline(chord, np.column_stack([x, y]))(np.linspace(0.0, chord[-1], 500)).T


def arrow(axes, begin, end, colour):
    axes.add_patch(
        FancyArrowPatch(begin, end, arrowstyle="-|>", mutation_scale=13, color=colour, lw=1.8, shrinkA=0, shrinkB=0)
    )


def step(axes):
    """Draw one step on an arc, and how it ends on the path beyond the limit point."""
    angle, reach = np.radians(118.0), 0.75
    course = np.radians(np.linspace(165.0, 38.0, 200))
    axes.plot(np.cos(course), np.sin(course), color=GREY, lw=1.6)
    begin, tangent = np.array([np.cos(angle), np.sin(angle)]), np.array([np.sin(angle), -np.cos(angle)])
    predicted, across = begin + reach * tangent, np.array([np.cos(angle), np.sin(angle)])
    found = predicted - (1.0 - np.sqrt(1.0 - reach**2)) * across
    axes.plot(*np.transpose([predicted + 0.2 * across, found - 0.25 * across]), color=GREY, lw=1.0, ls=":")
    arrow(axes, begin, predicted, BLUE)
    between = predicted + 0.72 * (found - predicted)
    arrow(axes, predicted, between, RED)
    arrow(axes, between, found, RED)
    axes.plot(*np.transpose([begin, found]), "o", color=INK, ms=6, zorder=5)
    axes.plot(0.0, 1.0, "s", color=INK, ms=6, zorder=5)
    axes.text(*np.add(begin, (-0.06, 0.05)), "$\\mathbf{y}$", fontsize=12, ha="right")
    axes.text(*(begin + 0.45 * reach * tangent + 0.07 * across), "$h\\,\\tau$", color=BLUE, fontsize=12, ha="center")
    axes.text(
        *(predicted + 0.5 * (found - predicted) + (0.06, 0.0)), "corrections", color=RED, fontsize=10, va="center"
    )
    axes.text(0.0, 0.9, "limit point", fontsize=10, ha="center", va="top")
    axes.set(xlabel="$\\mathbf{p}$", ylabel="$\\lambda$", xticks=[], yticks=[], xlim=(-1.1, 1.15), ylim=(0.2, 1.6))
    axes.set_aspect("equal")
    axes.set_title("one step", fontsize=11)


def steps(axes):
    """Draw the rows of a path over two limit points."""
    common = {"element": bf.CRBF(3), "section": bf.Section(6.0, 2.0), "material": bf.Material(7.2e6, 0.3, 2.7e-5)}
    column = bf.Beam(bf.Line((0, 0), (0, 120)), 6, **common)
    bar = bf.Beam(bf.Line((0, 120), (120, 120)), 10, **common)
    loaded = bar.at(0.2)
    supports, joints = [bf.Pin(column.start), bf.Pin(bar.end)], [bf.Rigid(column.end, bar.start)]
    model = bf.Model([column, bar], supports, [bf.PointForce(loaded, (0, -1.0))], joints, units="N, cm")
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(loaded)[1] < -95.0)
    down, force, stable = -path.displacement(loaded)[:, 1], 1e-3 * path.load_factor, path.stable
    axes.plot(*smooth(down, force), color=GREY, lw=1.2)
    axes.plot(down[stable], force[stable], "o", color=BLUE, ms=4, label="stable rows")
    axes.plot(down[~stable], force[~stable], "o", mfc="white", color=BLUE, ms=4, label="unstable rows")
    tops = [(-point.displacement(loaded)[1], 1e-3 * point.load_factor) for point in path.limit_points]
    axes.plot(*np.transpose(tops), "s", color=INK, ms=6, label="limit points")
    axes.set(xlabel="displacement of the loaded point [cm]", ylabel="force [kN]", title="Lee's frame", ylim=(-14, 40))
    axes.title.set_fontsize(11)
    axes.legend(fontsize=9)
    axes.grid(True, color="0.9", linewidth=0.6)


def main():
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 3.6), layout="constrained")
    step(left)
    steps(right)
    figure.savefig("arc_length.png", dpi=110)


if __name__ == "__main__":
    main()
