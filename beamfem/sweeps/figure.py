"""The picture of a sweep: a result over a parameter, a curve for each combination of the others."""

from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import require_known, shown
from beamfem.view.plots import COLOURS, new_figure, save_figure

if TYPE_CHECKING:
    from beamfem.sweeps.sweep import Sweep

_MARKERS = "osD^vP*X<>"
_NAMED = 12  # curves in a legend


def plot_sweep(
    sweep: "Sweep", value: str | None = None, over: str | None = None, path: str | PathLike[str] | None = None
) -> Any:
    """Draw a result over a parameter that varies; return the figure. See `Sweep.plot`."""
    names, texts = list(sweep.labels[0]), sweep.labels
    numeric = [name for name in names if all(_is_number(point[name]) for point in sweep.parameters)]
    results = [name for name in sweep.table()[0] if name not in (*names, "seconds") and _is_row(sweep[name])]
    if not numeric or not results:
        what = "parameter that varies" if not numeric else "result"
        raise InputError(f"the sweep has no {what} whose values are numbers, so there is nothing to draw")
    over, value = numeric[0] if over is None else over, results[0] if value is None else value
    require_known(f"over is no parameter that varies and is a number, got {shown(over)}", over, numeric)
    require_known(f"value is no result of the sweep that is a number, got {shown(value)}", value, [*results, "seconds"])
    curves: dict[str, list[tuple[float, float]]] = {}
    for point, text, height in zip(sweep.parameters, texts, sweep[value].tolist(), strict=True):
        label = ", ".join(f"{name}={text[name]}" for name in names if name != over)
        curves.setdefault(label, []).append((float(point[over]), height))
    figure, axes = new_figure()
    for number, (label, points) in enumerate(curves.items()):
        x, y = np.array(sorted(points)).T
        colour, marker = COLOURS[number % len(COLOURS)], _MARKERS[number % len(_MARKERS)]
        axes.plot(x, y, color=colour, marker=marker, markersize=4, linewidth=1.4, label=label)
    axes.set_xlabel(over)
    axes.set_ylabel(value)
    axes.margins(0.04)
    if 1 < len(curves) <= _NAMED:
        figure.legend(frameon=False, fontsize=9, loc="outside upper left")
    if path is not None:
        save_figure(figure, path)
    return figure


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)


def _is_row(values: np.ndarray) -> bool:
    return values.ndim == 1 and values.dtype.kind in "fiu"
