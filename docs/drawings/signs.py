"""Section forces on both faces of a cut, and what they do to the beam when they are positive."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Arc, FancyArrowPatch, Polygon

RED, INK = "#CC3311", "#222222"


def arrow(axes, begin, end, colour=RED):
    axes.add_patch(FancyArrowPatch(begin, end, arrowstyle="-|>", mutation_scale=14, color=colour, linewidth=1.8))


def moment(axes, at, sense, side):
    """Draw a moment that turns counter-clockwise (sense 1) or clockwise on the left (-1) or right side of `at`."""
    x, y = at
    middle = 0.0 if side > 0 else np.pi
    first, last = middle - 0.9, middle + 0.9
    axes.add_patch(Arc(at, 0.8, 0.8, theta1=np.degrees(first), theta2=np.degrees(last), color=RED, linewidth=1.8))
    tip, before = (last, last - 0.2) if sense > 0 else (first, first + 0.2)
    arrow(axes, *((x + 0.4 * np.cos(angle), y + 0.4 * np.sin(angle)) for angle in (before, tip)))


def faces(axes):
    for begin, end in ((0.0, 1.6), (2.6, 4.2)):
        axes.add_patch(Polygon([(begin, -0.3), (end, -0.3), (end, 0.3), (begin, 0.3)], fc="#DDE7F0", ec=INK, lw=1.2))
        axes.plot([begin, end], [0.0, 0.0], color=INK, linewidth=0.8, linestyle="-.")
    arrow(axes, (1.6, 0.0), (2.05, 0.0))
    arrow(axes, (2.6, 0.0), (2.15, 0.0))
    arrow(axes, (1.66, -0.25), (1.66, 0.5))
    arrow(axes, (2.54, 0.25), (2.54, -0.5))
    moment(axes, (1.6, 0.0), 1, 1)
    moment(axes, (2.6, 0.0), -1, -1)
    axes.text(2.1, 0.13, "$N$", color=RED, fontsize=13, ha="center")
    labels = {(1.5, 0.58): "Q", (2.6, -0.72): "Q", (1.86, -0.58): "M", (2.2, 0.5): "M"}
    for at, text in labels.items():
        axes.text(*at, f"${text}$", color=RED, fontsize=13)
    arrow(axes, (0.15, -0.95), (0.95, -0.95), INK)
    axes.text(1.0, -1.0, "$s$ grows", fontsize=11)
    arrow(axes, (0.15, -0.95), (0.15, -0.5), INK)
    axes.text(0.22, -0.6, "$y$, $\\mathbf{d}$", fontsize=11)
    axes.set_title("the part of smaller $s$, and what that of larger $s$ does to it", fontsize=11)


def bent(axes):
    angle = np.linspace(-np.pi / 2 - 0.6, -np.pi / 2 + 0.6, 60)
    for radius in (1.75, 2.0, 2.25):
        axes.plot(
            radius * np.cos(angle), radius * np.sin(angle) + 1.9, color=INK, lw=1.2, ls="-." if radius == 2 else "-"
        )
    axes.text(0.0, 0.27, "compressed", ha="center", fontsize=10)
    axes.text(0.0, -0.55, "in tension", ha="center", fontsize=10)
    moment(axes, (1.15, 0.3), 1, 1)
    moment(axes, (-1.15, 0.3), -1, -1)
    axes.text(1.62, 0.3, "$M > 0$", color=RED, fontsize=13)
    axes.set_title("a positive moment bends the beam to its left", fontsize=11)


def main():
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 3.2), layout="constrained", width_ratios=(1.25, 1.0))
    faces(left)
    bent(right)
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.axis("off")
    left.set(xlim=(-0.1, 4.3), ylim=(-1.2, 0.9))
    right.set(xlim=(-2.0, 2.4), ylim=(-0.8, 0.9))
    figure.get_layout_engine().set(h_pad=0.12)
    figure.savefig("signs.png", dpi=110)


if __name__ == "__main__":
    main()
