"""The picture and the page of a convergence study."""

from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from beamfem.convergence.convergence_result import EXPLANATION, Convergence
from beamfem.convergence.refinement_curve import Curve
from beamfem.tables import cells
from beamfem.view.html_page import Entry, Part, Table, write_page
from beamfem.view.plots import COLOURS, MARKERS, new_figure, save_figure


def plot_errors(study: Convergence, path: str | PathLike[str] | None = None) -> Any:
    """Draw one curve a combination, hollow where errors are round-off, and slope triangles; return the figure."""
    figure, axes = new_figure(7.2, 5.0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    # one triangle for each whole order, at the lowest curve, where there is room for it
    triangles: dict[int, tuple[Curve, str]] = {}
    for i, curve in enumerate(study.curves):
        colour, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        x, y = np.array(curve.refinement, dtype=float), curve.error
        positive = y > 0.0
        label = curve.label
        if curve.fit is not None:
            band = "" if np.isnan(curve.fit.band) else f" ± {curve.fit.band:.2f}"
            label = f"{label}: order {curve.fit.order:.2f}{band}"
        axes.plot(x[positive], y[positive], color=colour, marker=marker, markersize=5, linewidth=1.4, label=label)
        if curve.fit is None:
            continue
        noise = positive & (np.arange(len(x)) > curve.fit.last)
        axes.plot(x[noise], y[noise], marker, markersize=5, color=colour, markerfacecolor="white")
        other = triangles.get(round(curve.fit.order))
        if other is None or np.nanmin(y) < np.nanmin(other[0].error):
            triangles[round(curve.fit.order)] = curve, colour
    for curve, colour in triangles.values():
        _triangle(axes, curve, colour)
    axes.set_xlabel(study.refine)
    axes.set_ylabel(f"{study.error_name} of {study.quantity}")
    ticks = sorted({value for curve in study.curves for value in curve.refinement})
    if len(ticks) <= 12:
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
    if study.curves:
        axes.legend(frameon=False, fontsize=9)
    return save_figure(figure, path)


def _triangle(axes: Any, curve: Curve, colour: str) -> None:
    """Below the last fitted interval: its legs are one step of refinement and the fall that the order promises."""
    fit = curve.fit
    assert fit is not None
    left, right = float(curve.refinement[fit.last - 1]), float(curve.refinement[fit.last])
    ratio = (curve.size[fit.last] / curve.size[fit.last - 1]) ** fit.order
    # the middle half of the interval, below the curve
    a, b = left * (right / left) ** 0.25, left * (right / left) ** 0.75
    top = curve.error[fit.last - 1] * ratio**0.25 / 2.0
    bottom = top * ratio**0.5
    axes.fill([a, b, a], [top, bottom, bottom], facecolor=colour, alpha=0.25, edgecolor=colour, linewidth=0.8)
    axes.annotate(
        f"{fit.order:.1f}",
        (a, np.sqrt(top * bottom)),
        (-3, 0),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize=8,
    )


def write_study(study: Convergence, path: str | PathLike[str]) -> Path:
    """Write one self-contained HTML file with the picture and the tables; return its path."""
    with TemporaryDirectory() as folder:
        picture = Path(folder) / "errors.svg"
        plot_errors(study, picture)
        reference = "Richardson extrapolation" if study.reference is None else f"the reference {study.reference!r}"
        found = f"Errors against {reference}. {EXPLANATION}"
        entry = Entry(study.error_name.capitalize(), picture, claim="", found=found)
        named = (("Curves", study.summary()), ("Points", study.points(rounded=True)))
        tables = [Table(title, header, cells(rows)) for title, (header, rows) in named]
        if study.failures:
            rows = [(failure.label, failure.error) for failure in study.failures]
            tables.append(Table("Failed calls", ("parameters", "error"), rows))
        text = f"{study.function}() called with {study.refine} refined; {len(study.failures)} calls failed."
        return write_page(path, study.title, [Part("Picture", text, [entry]), Part("Numbers", "", tables=tables)])
