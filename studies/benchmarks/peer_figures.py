"""Cost against elements, and work against precision, of beamfem and Exudyn."""

from pathlib import Path
from typing import Any

import numpy as np

from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.benchmarks.peer_precision import Run, envelope
from studies.benchmarks.peer_ratios import Row

_MARKERS = "osD^vP*"


def draw_cost(rows: list[Row], path: Path) -> None:
    """Draw CPU time of 1000 steps against elements."""
    figure, axes = new_figure(7.0, 4.8)
    motions = [row for row in rows if row.case == rows[0].case]
    own = dict.fromkeys(row.own for row in motions)
    for number, name in enumerate(own):
        line = [(row.elements, row.own_least) for row in motions if row.own == name]
        _line(axes, number, np.array(line).T, f"beamfem, {name}", False)
    for number, name in enumerate(dict.fromkeys(row.peer for row in motions)):
        line = list({row.elements: row.peer_least for row in motions if row.peer == name}.items())
        _line(axes, len(own) + number, np.array(line).T, f"Exudyn, {name}", True)
    axes.set(xscale="log", yscale="log", xlabel="elements", ylabel="CPU time of 1000 steps [ms], one thread")
    axes.set_title("Pendulum, steps of 1 ms, trapezoidal rule", fontsize=10)
    figure.legend(frameon=False, fontsize=8, loc="outside lower center", ncols=2)
    save_figure(figure, path)


def draw_precision(runs: list[Run], title: str, error: str, path: Path) -> None:
    """Draw the error against CPU time: all runs faint, and the best of each element as a line."""
    figure, axes = new_figure(7.4, 5.2)
    for number, name in enumerate(dict.fromkeys(run.name for run in runs)):
        own = [run for run in runs if run.name == name]
        colour, marker = COLOURS[number % len(COLOURS)], _MARKERS[number]
        shown = [run for run in own if run.error < 0.3]
        points = np.array([(run.milliseconds, run.error) for run in shown]).T
        axes.plot(*points, marker, color=colour, markersize=3, alpha=0.25, linestyle="none")
        _line(axes, number, np.array(envelope(shown)), name, own[0].peer)
    axes.set(xscale="log", yscale="log", xlabel="CPU time [ms], one thread", ylabel=error)
    axes.set_title(title, fontsize=10)
    figure.legend(frameon=False, fontsize=8, loc="outside lower center", ncols=2)
    save_figure(figure, path)


def _line(axes: Any, number: int, points: np.ndarray, label: str, dashed: bool) -> None:
    style = "--" if dashed else "-"
    colour, marker = COLOURS[number % len(COLOURS)], _MARKERS[number]
    fill = "white" if dashed else colour
    axes.plot(
        *points, style, marker=marker, color=colour, markersize=5, markerfacecolor=fill, linewidth=1.4, label=label
    )
