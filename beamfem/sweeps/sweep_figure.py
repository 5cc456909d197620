"""The picture of a sweep: a result over a parameter, a curve for each combination of the others."""

from os import PathLike
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.sweeps.sweep_result import Sweep
from beamfem.validation import require_known, shown
from beamfem.view.plots import COLOURS, new_figure, save_figure

_MARKERS = "osD^vP*X<>"
_NAMED = 12  # curves in a legend
_ABOVE = 50  # characters of all names in a line
_CUT, _WIDEST = 40, 3.2  # characters of the longest name, and their width [inch]


def plot_sweep(
    sweep: Sweep, value: str | None = None, over: str | None = None, path: str | PathLike[str] | None = None
) -> Any:
    """Draw a result over a parameter that varies; return the figure. See `Sweep.plot`."""
    names, texts = list(sweep.labels[0]), sweep.labels
    numeric = [name for name in names if all(_is_number(point[name]) for point in sweep.parameters)]
    results = [name for name in sweep.table()[0] if name not in (*names, "seconds") and _is_row(sweep[name])]
    if not numeric or not results:
        what = "parameter that varies" if not numeric else "result"
        raise InputError(f"the sweep has no {what} whose values are numbers, so there is nothing to draw")
    over, value = numeric[0] if over is None else over, results[0] if value is None else sweep.column(value)
    require_known(f"over is no parameter that varies and is a number, got {shown(over)}", over, numeric)
    require_known(f"value is no result of the sweep that is a number, got {shown(value)}", value, [*results, "seconds"])
    curves: dict[str, list[tuple[float, float]]] = {}
    for point, text, height in zip(sweep.parameters, texts, sweep[value].tolist(), strict=True):
        label = ", ".join(f"{name}={text[name]}" for name in names if name != over)
        curves.setdefault(label, []).append((float(point[over]), height))
    named = 1 < len(curves) <= _NAMED
    # a legend of few short names stands above the axes, a longer one beside them in a wider figure
    legend_beside = named and sum(map(len, curves)) > _ABOVE
    figure, axes = new_figure(6.4 + (_WIDEST * min(1.0, max(map(len, curves)) / _CUT) if legend_beside else 0.0))
    for number, (label, points) in enumerate(curves.items()):
        x, y = np.array(sorted(points)).T
        colour, marker = COLOURS[number % len(COLOURS)], _MARKERS[number % len(_MARKERS)]
        axes.plot(x, y, color=colour, marker=marker, markersize=4, linewidth=1.4, label=_cut(label))
    axes.set_xlabel(over)
    axes.set_ylabel(value)
    axes.margins(0.04)
    if legend_beside:
        figure.legend(frameon=False, fontsize=9, loc="outside right upper")
    elif named:
        figure.legend(frameon=False, fontsize=9, loc="outside upper left", ncols=len(curves))
    return save_figure(figure, path)


def _cut(label: str) -> str:
    return label if len(label) <= _CUT else f"{label[: _CUT - 2]} …"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)


def _is_row(values: np.ndarray) -> bool:
    return values.ndim == 1 and values.dtype.kind in "fiu"
