"""The extreme value of a field in a drawing: a mark where it is, and its value with its place for the legend."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.view.frames import moment_of
from beamfem.view.places import place
from beamfem.view.shapes import Shapes, even

_COLOUR = "#CC3311"


@dataclass(frozen=True, eq=False)
class Extreme:
    """What the legend says about the value of largest magnitude, in two parts, and its position (2,) [m].

    at: None if all values are equal.
    """

    value: str
    where: str
    at: np.ndarray | None

    def draw(self, axes: Any, lines: int) -> Any:
        """Mark the value and return an entry for the legend, in one or two lines."""
        from matplotlib.lines import Line2D

        label = f"{self.value}{' ' if lines == 1 else chr(10)}{self.where}"
        if self.at is None:
            return Line2D([], [], linestyle="none", label=label)
        look: dict[str, Any] = {"marker": "D", "markersize": 5.0, "linestyle": "none"}
        look |= {"markerfacecolor": "white", "markeredgecolor": _COLOUR}
        axes.plot(*self.at, zorder=7.0, **look)
        return Line2D([], [], label=label, **look)


def extreme_of(shapes: Shapes) -> Extreme:
    """Return the value of largest magnitude of the field of some shapes."""
    assert shapes.quantity is not None
    sizes = [np.where(np.isfinite(values), np.abs(values), -1.0) for values in shapes.values]
    beam = int(np.argmax([size.max() for size in sizes]))
    order, point = np.unravel_index(int(sizes[beam].argmax()), sizes[beam].shape)
    solution, unit = shapes.solution, shapes.quantity.unit
    value = f"{shapes.values[beam][order, point]:.4g}" + ("" if unit == "-" else f" {solution.model.unit(unit)}")
    if even(shapes.values):
        return Extreme(value, "everywhere", None)
    where = f"at {place(solution.model, shapes.points[beam].reference[point])}"
    when = f", {moment_of(solution, int(shapes.rows[order]))}" if len(shapes.rows) > 1 else ""
    return Extreme(f"extreme {value}", where + when, shapes.axis[beam][order, point])
