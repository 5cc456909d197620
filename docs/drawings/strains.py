"""The strain measures of Reissner's beam at a section: what r0' is along the section's normal and along the section."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import FancyArrowPatch, Polygon

BLUE, RED, GREEN, INK = "#0077BB", "#CC3311", "#228833", "#222222"
HEIGHT = 0.42


def arrow(axes, begin, vector, colour):
    end = begin + vector
    axes.add_patch(
        FancyArrowPatch(
            begin, end, arrowstyle="-|>", mutation_scale=14, color=colour, lw=1.9, shrinkA=0, shrinkB=0, zorder=4
        )
    )


def section(angle):
    """Return normal and direction of a section that is turned by an angle."""
    return np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])


def slab(axes):
    """Draw a thin slice of a beam before and after: it is stretched, sheared and bent."""
    for origin, stretch, shear, bend in (((0.0, 0.0), 0.0, 0.0, 0.0), ((1.35, 0.0), 0.25, 0.22, 0.5)):
        centre = np.array(origin)
        ends = [centre, np.add(centre, (0.55 * (1.0 + stretch), shear * 0.55))]
        corners = []
        for end, turn in zip(ends, (-0.5 * bend, 0.5 * bend), strict=True):
            _, along = section(turn)
            corners.append((end - HEIGHT * along, end + HEIGHT * along))
        (a, b), (c, d) = corners
        axes.add_patch(Polygon([a, c, d, b], fc="#DDE7F0", ec=INK, lw=1.2))
        axes.plot(*np.transpose(ends), color=INK, lw=1.0, ls="-.")
    axes.text(0.275, -0.68, "reference", ha="center", fontsize=10)
    axes.text(1.7, -0.68, "stretched, sheared, bent", ha="center", fontsize=10)
    axes.set(xlim=(-0.2, 2.4), ylim=(-0.85, 0.75))


def measures(axes):
    """Draw r0' and its parts along the normal of the section and along the section."""
    origin, angle, slope, size = np.zeros(2), np.radians(14.0), np.radians(40.0), 1.5
    normal, along = section(angle)
    rate = size * np.array([np.cos(slope), np.sin(slope)])
    parts = rate @ normal, rate @ along
    axes.plot(*np.transpose([-0.55 * along, 1.15 * along]), color=INK, lw=5.0, alpha=0.25, solid_capstyle="butt")
    foot = parts[0] * normal
    axes.plot(*np.transpose([rate, foot]), color="0.5", lw=1.0, ls=":")
    axes.plot(*np.transpose([rate, parts[1] * along]), color="0.5", lw=1.0, ls=":")
    axes.plot(*np.transpose([normal, foot]), color=RED, lw=2.6)
    axes.plot(*np.transpose([origin, parts[1] * along]), color=GREEN, lw=2.6, zorder=5)
    for vector, colour in ((normal, INK), (along, INK), (rate, BLUE)):
        arrow(axes, origin, vector, colour)
    axes.text(*np.add(rate, (0.05, 0.0)), "$\\mathbf{r}_0'$", color=BLUE, fontsize=14)
    axes.text(*(0.6 * normal - 0.17 * along), "$\\mathbf{n}_d$", fontsize=14, ha="center")
    axes.text(*np.add(along, (-0.06, 0.02)), "$\\mathbf{t}_d$", fontsize=14, ha="right")
    axes.text(*(0.5 * (normal + foot) - 0.17 * along), "$\\Gamma_1$", color=RED, fontsize=14, ha="center")
    axes.text(*(0.5 * parts[1] * along + (-0.08, 0.0)), "$\\Gamma_2$", color=GREEN, fontsize=14, ha="right")
    axes.text(*(-0.5 * along + (0.12, -0.05)), "section", fontsize=10, color="0.35")
    axes.plot(*origin, "o", color=INK, ms=6, zorder=6)
    axes.set(xlim=(-0.6, 1.9), ylim=(-0.65, 1.25))


def main():
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 3.4), layout="constrained")
    slab(left)
    measures(right)
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.axis("off")
    figure.savefig("strains.png", dpi=110)


if __name__ == "__main__":
    main()
