"""A spline and the elements on it: by arc length, which interpolate it, and its knot spans, which are the spline."""

import matplotlib.pyplot as plt
import numpy as np

import beamfem as bf

BLUE, RED, INK, GREY = "#0077BB", "#CC3311", "#222222", "0.6"
SPLINE = bf.BSpline(3, (0, 0, 0, 0, 1, 2, 2, 2, 2), ((0, 0), (0.3, 0.9), (1.0, 1.0), (1.5, -0.2), (2.0, 0.5)))
SOFT = bf.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000.0)


def elements(axes, title, mesh, element, ends):
    beam = bf.Beam(SPLINE, mesh, element, bf.Rectangle(0.02, 0.02), SOFT)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))
    curve = SPLINE.position(np.linspace(0.0, SPLINE.length, 200))
    axes.plot(*curve.T, color=GREY, linewidth=5.0, alpha=0.5, label="the curve")
    axis = np.array([solution.position(beam.at(float(fraction)))[0] for fraction in np.linspace(0.0, 1.0, 200)])
    axes.plot(*axis.T, color=BLUE, linewidth=1.6, label="axis of the elements")
    for fraction in ends:
        found = solution.fields(beam.at(float(fraction)))
        place, across = found.position[0], found.r_y[0]
        across = 0.13 * across / np.linalg.norm(across)
        axes.plot(*np.transpose([place - across, place + across]), color=INK, linewidth=1.4)
        axes.plot(*place, "o", color=INK, markersize=5, zorder=5)
    axes.set_title(title, fontsize=11)


def main():
    figure, grid = plt.subplots(1, 3, figsize=(10.5, 3.0), layout="constrained", sharey=True)
    thirds = np.linspace(0.0, 1.0, 4)
    elements(grid[0], "three elements of order 1", 3, bf.CRBF(order=1), thirds)
    elements(grid[1], "three elements of order 3", 3, bf.CRBF(order=3), thirds)
    inner = SPLINE.arc_length(np.array([1.0]))[0] / SPLINE.length
    elements(grid[2], 'elements="knots"', "knots", bf.ANCF(), (0.0, inner, 1.0))
    grid[2].plot(
        *np.transpose(SPLINE.control_points), "s:", color=RED, markersize=4, linewidth=1.0, label="control points"
    )
    for axes in grid:
        axes.set_aspect("equal")
        axes.axis("off")
    handles, labels = grid[2].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    figure.savefig("curved_reference.png", dpi=110)


if __name__ == "__main__":
    main()
