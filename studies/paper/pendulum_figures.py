"""The figures of the paper's section 5 with what it claims of each and what is found here."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from beamfem.view.html_page import Entry, Table
from beamfem.view.plots import COLOURS, legend_over, new_figure, save_figure
from studies.paper.pendulum import Run

ANCF, CRBF, BILINEAR = "ANCF", "ANCF-CRBF", "bilinear-CRBF"
Runs = dict[tuple[str, int], Run]


@dataclass(frozen=True)
class Figure:
    """A figure of the paper: which runs it shows, of what, and the claim."""

    number: int
    title: str
    curves: tuple[tuple[str, int], ...]
    quantity: str
    label: str
    claim: str


GOOD = 0.05  # rms difference of the last two curves over their range, and of |r_y| from 1, up to which claims hold
TIP = "tip y [m]"
FIGURES = (
    Figure(3, "Tip height, 6 and 12 ANCF/CRBF elements", ((CRBF, 6), (CRBF, 12)), "tip", TIP, "good agreement"),
    Figure(4, "Tip height, 6 elements", ((CRBF, 6), (ANCF, 6)), "tip", TIP, "good agreement"),
    Figure(
        5,
        "|r_y| at the midpoint of element 100",
        ((CRBF, 100), (ANCF, 100)),
        "length_of_r_y",
        "|r_y| [-]",
        "|r_y| of ANCF/CRBF is very close to 1",
    ),
    Figure(
        6,
        "Shear angle at the midpoint of element 100",
        ((CRBF, 100), (ANCF, 100)),
        "shear_angle",
        "shear angle [rad]",
        "good agreement",
    ),
    Figure(
        7,
        "Shear strain at the midpoint of element 100",
        ((CRBF, 100), (ANCF, 100)),
        "shear_strain",
        "Green strain xy [-]",
        "good agreement",
    ),
    Figure(
        8,
        "Tip height, 6, 12 and 24 bilinear elements",
        ((BILINEAR, 6), (BILINEAR, 12), (BILINEAR, 24)),
        "tip",
        TIP,
        "good agreement between 12 and 24; the solution converges with 12 elements",
    ),
    Figure(9, "Tip height, 12 elements", ((BILINEAR, 12), (CRBF, 12)), "tip", TIP, "good agreement"),
    Figure(
        10,
        "|r_y| at the midpoint of element 12",
        ((BILINEAR, 12), (CRBF, 12)),
        "length_of_r_y",
        "|r_y| [-]",
        "close to 1, no significant violation",
    ),
    Figure(
        11,
        "Shear angle at the midpoint of element 100",
        ((BILINEAR, 100), (CRBF, 100)),
        "shear_angle",
        "shear angle [rad]",
        "good agreement",
    ),
    Figure(
        12,
        "Shear strain at the midpoint of element 100",
        ((BILINEAR, 100), (CRBF, 100)),
        "shear_strain",
        "Green strain xy [-]",
        "similar trend, the largest difference is about 0.0005",
    ),
    Figure(13, "|r_x|", ((BILINEAR, 100), (CRBF, 100)), "length_of_r_x", "|r_x| [-]", "good agreement"),
    Figure(
        14,
        "Direction of r_x",
        ((BILINEAR, 100), (CRBF, 100)),
        "direction_of_r_x",
        "angle of r_x [rad]",
        "good agreement",
    ),
    Figure(
        15,
        "Direction of r_y",
        ((BILINEAR, 100), (CRBF, 100)),
        "direction_of_r_y",
        "angle of r_y [rad]",
        "good agreement",
    ),
)


def values(run: Run, quantity: str) -> np.ndarray:
    """Return the curve of a figure (steps,)."""
    if quantity == "tip":
        return run.tip[:, 1]
    if quantity == "shear_angle":
        return run.midpoint.shear_angle
    return getattr(run, quantity)


def difference(figure: Figure, runs: Runs) -> tuple[float, float, float]:
    """Return the largest and the root mean square difference of the last two curves, and the range of the last."""
    first, second = (values(runs[key], figure.quantity) for key in figure.curves[-2:])
    gap = np.abs(first - second)
    return float(gap.max()), float(np.sqrt(np.mean(gap**2))), float(np.ptp(second))


def judge(figure: Figure, runs: Runs) -> tuple[str, bool]:
    """Return what is found, in a sentence, and whether the paper's claim holds."""
    largest, mean, spread = difference(figure, runs)
    if figure.quantity == "length_of_r_y":
        deviations = {key: np.abs(values(runs[key], "length_of_r_y") - 1.0).max() for key in figure.curves}
        found = ", ".join(f"{value:.2g} with {name}" for (name, _), value in deviations.items())
        rotations = [value for (name, _), value in deviations.items() if name != ANCF]
        return f"the largest ||r_y| - 1| is {found}; close to 1 is at most {GOOD:g}.", max(rotations) < GOOD
    if figure.number == 12:
        found = f"the largest difference is {largest:.2g} (range {spread:.2g}); about 0.0005 is 0.00025 to 0.00075."
        return found, 2.5e-4 < largest < 7.5e-4
    share = mean / spread
    found = (
        f"the rms difference is {mean:.2g}, {100 * share:.2g} % of the range, the largest {largest:.2g}; "
        f"good is an rms difference of at most {100 * GOOD:.0f} % of the range."
    )
    return found, share <= GOOD


def draw(figure: Figure, runs: Runs, folder: Path) -> Entry:
    """Draw a figure to PNG and SVG in a folder and return its entry on the page."""
    canvas, axes = new_figure(4.8, 3.4)
    for i, key in enumerate(figure.curves):
        run = runs[key]
        style = ("-", "--", ":")[i]
        axes.plot(run.time, values(run, figure.quantity), style, color=COLOURS[i], label=f"{key[1]} {key[0]}")
    axes.set_xlabel("time [s]")
    axes.set_ylabel(figure.label)
    axes.ticklabel_format(useOffset=False)
    legend_over(axes, 2)
    path = folder / f"figure{figure.number:02d}.svg"
    save_figure(canvas, path)
    save_figure(canvas, path.with_suffix(".png"))
    found, holds = judge(figure, runs)
    return Entry(f"Figure {figure.number}. {figure.title}", path, figure.claim, found, holds)


def table_of_times(runs: Runs, name: str) -> Table:
    """Return Table 1 with own times; the paper's table is lost in its text, its sentences are kept."""
    meshes = sorted({count for _, count in runs})
    rows = [[own, *(f"{1e3 * runs[own, n].seconds:.0f} ms" for n in meshes)] for own in (ANCF, CRBF, BILINEAR)]
    small, large = (runs[ANCF, count].seconds / runs[BILINEAR, count].seconds for count in (meshes[0], meshes[-1]))
    remark = (
        "Paper: the bilinear CRBF element is about five times faster than ANCF on small meshes; on large ones ANCF "
        f"becomes more efficient, because its mass matrix is constant. Here: the bilinear element is {small:.1f} times "
        f"as fast as ANCF with {meshes[0]} elements and {large:.1f} times with {meshes[-1]}. The second sentence "
        f"{'holds' if large < 1.0 else 'does not hold here'}: the mass matrix in terms of rotations costs little where "
        "the reduction is done inside the compiled element loop, and each step is implicit for all of them."
    )
    return Table(
        f"Table 1. Computing times, CPU, {name} section",
        ["element", *(f"{count} elements" for count in meshes)],
        rows,
        remark,
    )
