"""Plots with matplotlib, drawn without a window."""

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem import postprocess
from beamfem.model.reference import faces
from beamfem.validation import count

if TYPE_CHECKING:
    from beamfem.solution import Solution

# Paul Tol's bright palette: told apart by the colour-blind and in grey print
COLOURS = ("#4477AA", "#EE6677", "#228833", "#CCBB44", "#66CCEE", "#AA3377", "#BBBBBB")


def new_figure(width: float = 6.4, height: float = 4.2) -> tuple[Any, Any]:
    """Return a figure [inch] and its axes with quiet spines and a light grid; needs no display."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    axes.grid(True, color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure, axes


def save_figure(figure: Any, path: str | PathLike[str]) -> None:
    """Write a figure to PNG, SVG or PDF by the suffix of `path`; folders are made."""
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(target, dpi=160)


def plot_shapes(solution: "Solution", path: str | PathLike[str] | None = None, shapes: int = 9) -> Any:
    """Draw the outline of the deformed body at some steps, the last one dark; return the figure.

    shapes: how many steps are drawn. Written to `path` where one is given.
    """
    count("shapes", shapes)
    figure, axes = new_figure()
    rows = np.unique(np.linspace(0, len(solution) - 1, min(shapes, len(solution))).astype(int))
    for mesh in solution.model.meshes:
        element = np.repeat(np.arange(mesh.elements), 9)
        xi = np.tile(np.linspace(0.0, 1.0, 9), mesh.elements)
        low, high = faces(mesh, element, xi).T[:, :, None]
        now = postprocess.axis(mesh, postprocess.nodal_vectors(mesh, solution.p[rows]), element, xi)
        for order, row in enumerate(rows):
            top, bottom = now.r[order] + high * now.d[order], now.r[order] + low * now.d[order]
            outline = np.concatenate([top, bottom[::-1]])
            share = (order + 1) / len(rows)
            axes.fill(*outline.T, color=COLOURS[0], alpha=0.15 + 0.35 * share, linewidth=0)
            value = solution.at[row]
            label = f"load factor {value:.3g}" if solution.static else f"t = {value:.3g} s"
            ends = len(rows) > 1 and order in (0, len(rows) - 1) and mesh is solution.model.meshes[0]
            axes.plot(*now.r[order].T, color=str(0.7 * (1 - share)), linewidth=1.2, label=label if ends else None)
    for support in solution.model.point_supports:
        axes.plot(*support.point.reference, "^", color="black", markersize=8)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    if len(rows) > 1:
        axes.legend(frameon=False)
    if path is not None:
        save_figure(figure, path)
    return figure
