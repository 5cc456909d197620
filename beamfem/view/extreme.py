"""The extreme value of a field in a drawing: a mark where it is, and its value with its place for the legend."""

from typing import Any

import numpy as np

from beamfem.view.frames import moment_of
from beamfem.view.places import place
from beamfem.view.shapes import Shapes, even

_MARK: dict[str, Any] = {
    "marker": "D",
    "markersize": 5.0,
    "markerfacecolor": "white",
    "markeredgecolor": "#CC3311",
    "linestyle": "none",
}


def mark_extreme(axes: Any, shapes: Shapes) -> Any:
    """Mark the value of largest magnitude and return an entry for the legend; nothing to mark if all are equal."""
    from matplotlib.lines import Line2D

    assert shapes.quantity is not None
    sizes = [np.where(np.isfinite(values), np.abs(values), -1.0) for values in shapes.values]
    beam = int(np.argmax([size.max() for size in sizes]))
    order, point = np.unravel_index(int(sizes[beam].argmax()), sizes[beam].shape)
    solution, unit = shapes.solution, _unit(shapes)
    value = f"{shapes.values[beam][order, point]:.4g}{unit}"
    if even(shapes.values):
        return Line2D([], [], linestyle="none", label=f"{value} everywhere")
    axes.plot(*shapes.axis[beam][order, point], zorder=7.0, **_MARK)
    where = place(solution.model, shapes.points[beam].reference[point])
    when = f", {moment_of(solution, int(shapes.rows[order]))}" if len(shapes.rows) > 1 else ""
    return Line2D([], [], label=f"extreme {value} at {where}{when}", **_MARK)


def _unit(shapes: Shapes) -> str:
    """Return the unit of the field after a blank; nothing for numbers without one."""
    assert shapes.quantity is not None
    return "" if shapes.quantity.unit == "-" else f" {shapes.solution.model.unit(shapes.quantity.unit)}"
