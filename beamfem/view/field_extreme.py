"""The extreme value of a field in a drawing: a mark where it is, and its value with its place for the legend."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.results import extremes
from beamfem.results.axis_fields import AxisPoints, PointsAt
from beamfem.results.extremes import estimate, extreme_of_beams
from beamfem.results.free_bodies import Cuts
from beamfem.view.deformed_shapes import Shapes, even
from beamfem.view.frames import moment_of
from beamfem.view.labels import place

_COLOUR = "#CC3311"


@dataclass(frozen=True, eq=False)
class Extreme:
    """Text of the legend for the value of largest magnitude, in two parts, and its position (2,) [m].

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
    """Return the value of largest magnitude of the field of some shapes, at and between the points of their axes."""
    assert shapes.quantity is not None
    fields = [_by_element(points, values) for points, values in zip(shapes.points, shapes.values, strict=True)]
    estimates = np.array([estimate(*field, np.abs) for field in fields])
    beam, found = extreme_of_beams(estimates, np.abs, lambda number: _of_beam(shapes, number, *fields[number]))
    solution, unit = shapes.solution, shapes.quantity.unit
    value = f"{found.value:.4g}" + ("" if unit == "-" else f" {solution.model.unit(unit)}")
    if even(shapes.values):
        return Extreme(value, "everywhere", None)
    row = int(shapes.rows[found.row])
    points = _points_at(shapes, beam, np.array([found.element]), np.array([found.xi]))
    where = f"at {place(solution.model, points.reference[0])}"
    when = f", {moment_of(solution, row)}" if len(shapes.rows) > 1 else ""
    return Extreme(f"extreme {value}", where + when, points.positions(solution.p[[row]])[0][0, 0])


def _of_beam(shapes: Shapes, beam: int, values: np.ndarray, xi: np.ndarray) -> extremes.Extreme:
    assert shapes.quantity is not None
    along = shapes.quantity.values

    def at(order: int, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
        return along(_points_at(shapes, beam, element, xi), shapes.solution, shapes.rows[[order]])[0]

    return extremes.extreme(values, xi, np.abs, at)


def _by_element(points: AxisPoints, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return values (rows, points) as (rows, elements, points of each), and xi of these."""
    count = points.pieces + 1
    return values.reshape(len(values), points.mesh.elements, count), points.xi[:count]


def _points_at(shapes: Shapes, beam: int, element: np.ndarray, xi: np.ndarray) -> PointsAt:
    return PointsAt(shapes.points[beam].mesh, 0, Cuts(element, xi))
