"""Drawings of models and solutions: shapes, supports, loads and joints in axes of equal scale."""

from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np

from beamfem.equations.callbacks import uninterrupted
from beamfem.equations.system import system_of
from beamfem.errors import InputError
from beamfem.model.beam import beam_in_words
from beamfem.model.model import Model
from beamfem.results import extremes
from beamfem.results.axis_points import AxisPoints
from beamfem.results.extremes import estimate, extreme_of_beams
from beamfem.results.path import Path
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics
from beamfem.units import units_of
from beamfem.validation import count, flag
from beamfem.view.deformed_shapes import FIELD_COLOURS, ORIGINAL, Shapes, draw_undeformed, even, shade
from beamfem.view.frames import axis_of_rows, moment_of, spread_rows
from beamfem.view.load_drawing import draw_loads
from beamfem.view.plots import empty_figure, given_axes, quiet, save_figure
from beamfem.view.support_symbols import draw_joints, supports_of

_COLOUR = "#CC3311"


@dataclass(frozen=True, eq=False)
class _Extreme:
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


def _extreme_of(shapes: Shapes) -> _Extreme:
    """Return the value of largest magnitude of the field of some shapes, at and between the points of their axes."""
    assert shapes.quantity is not None
    along, meshes = shapes.quantity.values, [points.mesh for points in shapes.points]
    fields = [points.by_element(values) for points, values in zip(shapes.points, shapes.values, strict=True)]
    estimates = np.array([estimate(*field, np.abs) for field in fields])

    def of_beam(beam: int) -> extremes.Extreme:
        def at(order: int, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
            return along(AxisPoints(meshes[beam], element, xi), shapes.solution, shapes.rows[[order]])[0]

        return extremes.extreme(*fields[beam], np.abs, at)

    beam, found = extreme_of_beams(estimates, np.abs, of_beam)
    solution, model = shapes.solution, shapes.solution.model
    factor, unit = units_of(model.units).readable(found.value, shapes.quantity.unit)
    value = f"{factor * found.value:.4g}" + ("" if unit == "-" else f" {unit}")
    if even(shapes.values):
        return _Extreme(value, "everywhere", None)
    row = int(shapes.rows[found.row])
    points = AxisPoints(meshes[beam], np.array([found.element]), np.array([found.xi]))
    arc_length = float(meshes[beam].arc_length(points.element, points.xi)[0])
    named = f" of {beam_in_words(model.beams, beam)}" if len(meshes) > 1 else ""
    where = f"at {arc_length:.4g} {model.unit('m')}{named}"
    when = f", {moment_of(solution, row)}" if len(shapes.rows) > 1 else ""
    return _Extreme(f"extreme {value}", where + when, points.positions(solution.p[[row]])[0][0, 0])


_ROOM = 0.45  # [inch] around the shapes for symbols and arrows
_LONGER_SIDE = 5.6  # [inch]
_LEAST = np.array([3.2, 1.3])  # of the axes [inch]
_LEFT, _RIGHT, _BOTTOM, _TOP, _BAR = 0.85, 0.3, 0.55, 0.4, 1.35  # margins, to the right with a colour bar [inch]
_LETTER, _HANDLE, _SMALL = 0.07, 0.6, 9.0  # width of a letter and of a line in a legend [inch], letters [points]
LINE, _FURTHER = 0.3, 0.15  # of a title above a legend, and above a second line of it [inch]
_SEVERAL = 9  # shapes of a motion or a path
_NAMED = 3  # shapes that are named each; above, a bar tells them apart


@uninterrupted
def plot_shapes(
    solution: Solution,
    path: str | PathLike[str] | None = None,
    colour: str | None = None,
    shapes: int | None = None,
    undeformed: bool = True,
    supports: bool = True,
    loads: bool = True,
    ax: Any = None,
    title: str | None = None,
) -> Any:
    """Draw the deformed body at one or several steps, later ones darker; return the figure. See `Solution.plot`."""
    if len(solution) == 0:
        raise InputError("the solution has no rows, so there is nothing to draw")
    for name, value in (("undeformed", undeformed), ("supports", supports), ("loads", loads)):
        flag(name, value)
    several = _SEVERAL if isinstance(solution, Path) or not solution.static else 1
    rows = spread_rows(solution, several if shapes is None else count("shapes", shapes))
    if colour is not None and solution.static and len(rows) > 1:
        rows = rows[1:]  # without load the field is nothing, and its shape would hide the others
    drawn = Shapes(solution, rows, colour)
    extreme = None if colour is None else _extreme_of(drawn)
    dashed, names = [ORIGINAL] if undeformed else [], [moment_of(solution, int(row)) for row in rows]
    width = _inches(drawn.box)[0] + _LEFT + (_RIGHT if extreme is None else _BAR)
    crowded = len(rows) > _NAMED or _wide([*dashed, *names]) > width
    barred = extreme is not None or (crowded and len(rows) > 1)
    lines = 2 if extreme is not None and _wide([*dashed, f"{extreme.value} {extreme.where}"]) > width else 1
    above = 0.0 if extreme is None else LINE + (lines - 1) * _FURTHER
    if ax is None:
        figure, axes = equal_axes(drawn.box, barred, solution.model.unit("m"), above, pyplot=path is None)
    else:
        axes = _equal_scale(given_axes(ax)[0], drawn.box, solution.model.unit("m"))
        figure = axes.figure.figure
    entries = [draw_undeformed(axes, drawn.points)] if undeformed else []
    for order in range(len(rows)):
        drawn.draw(axes, order, (order + 1) / len(rows))
    if supports:
        supports_of(solution, int(rows[-1]), drawn.centre).draw(axes)
    draw_joints(axes, solution, int(rows[-1]))
    if loads:
        draw_loads(axes, solution, rows)
    if extreme is not None:
        bar(axes, drawn, ax is None)
        entries.append(extreme.draw(axes, lines))
    elif barred:
        _bar_of_rows(axes, solution, rows, ax is None)
    elif len(rows) > 1 or undeformed:
        entries += [entry((order + 1) / len(rows), name) for order, name in enumerate(names)]
    legend_above(axes, entries, ax is None)
    if extreme is not None or not (entries or barred):
        axes.set_title(title or _span(solution, rows), fontsize=10, pad=max(6.0, 72.0 * above))
    return save_figure(figure, path)


def equal_axes(
    box: np.ndarray, with_bar: bool, unit: str = "m", above: float = 0.0, pyplot: bool = False
) -> tuple[Any, Any]:
    """Return a figure and axes [unit] of equal scale around a box (2, 2) [m], with room for symbols around it.

    above: room above a title or a legend [inch]; pyplot: see `empty_figure`.
    """
    scale, inches = _LONGER_SIDE / _extent(box), _inches(box)
    right = _BAR if with_bar else _RIGHT
    figure = empty_figure(inches[0] + _LEFT + right, inches[1] + _BOTTOM + _TOP + above, None, pyplot)
    width, height = figure.get_size_inches()
    axes = figure.add_axes((_LEFT / width, _BOTTOM / height, inches[0] / width, inches[1] / height))
    frame(axes, box.mean(axis=0), inches / scale, inches, unit)
    return figure, axes


def _equal_scale(axes: Any, box: np.ndarray, unit: str) -> Any:
    """Return the axes of a user with equal scale around a box (2, 2) [m]."""
    inches = axes.get_window_extent().size / axes.figure.dpi
    size = box[1] - box[0]
    scale = np.min(np.maximum(inches - 2.0 * _ROOM, 0.5 * inches) / np.where(size > 0.0, size, 1e-3 * _extent(box)))
    frame(axes, box.mean(axis=0), inches / scale, inches, unit)
    return axes


def _inches(box: np.ndarray) -> np.ndarray:
    """Width and height (2,) [inch] of the axes around a box (2, 2) [m]."""
    return np.maximum((box[1] - box[0]) * _LONGER_SIDE / _extent(box) + 2.0 * _ROOM, _LEAST)


def _extent(box: np.ndarray) -> float:
    """Longer side of a box [m]; of a point 1."""
    return float(np.max(box[1] - box[0])) or 1.0


def frame(axes: Any, middle: np.ndarray, size: np.ndarray, inches: np.ndarray, unit: str) -> None:
    """Set limits of equal scale around a middle (2,) [unit] and label the axes; size (2,) [unit] takes inches (2,)."""
    quiet(axes)
    axes.set_aspect("equal", adjustable="box")
    (left, bottom), (right, top) = middle - 0.5 * size, middle + 0.5 * size
    axes.set(xlim=(left, right), ylim=(bottom, top), xlabel=f"x [{unit}]", ylabel=f"y [{unit}]")
    for name, length, spacing in (("x", inches[0], 0.8), ("y", inches[1], 0.6)):
        axes.locator_params(axis=name, nbins=int(np.clip(length / spacing, 2, 9)))


def bar(axes: Any, shapes: Shapes, own: bool = True) -> None:
    """Draw the colour bar of a field, in the margin of a figure of our own."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    assert shapes.quantity is not None
    low, high = shapes.limits
    norm = Normalize(shapes.factor * low, shapes.factor * high)
    _add_bar(axes, ScalarMappable(norm, FIELD_COLOURS), shapes.label, own)


def _bar_of_rows(axes: Any, solution: Solution, rows: np.ndarray, own: bool) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, ListedColormap

    values = solution.at[rows]
    name, unit = axis_of_rows(solution)
    colours = [shade((order + 1) / len(rows)) for order in range(len(rows))]
    norm = BoundaryNorm(np.arange(len(rows) + 1) - 0.5, len(rows))
    colour_bar = _add_bar(axes, ScalarMappable(norm, ListedColormap(colours)), f"{name} [{unit}]", own)
    labels = ([f"{value:.{digits}g}" for value in values] for digits in (3, 4, 5, 6))
    colour_bar.set_ticks(np.arange(len(rows)), labels=max(labels, key=lambda found: len(set(found))))
    colour_bar.ax.tick_params(length=0)


def _wide(labels: list[str]) -> float:
    """Return about how wide a legend in one line is [inch]."""
    return sum(_LETTER * len(label) + _HANDLE for label in labels)


def entry(fraction: float, label: str) -> Any:
    """Return an entry of a legend for a shape; fraction: from 0 for pale to 1 for strong."""
    from matplotlib.lines import Line2D

    return Line2D([], [], color=shade(fraction), linewidth=3, label=label)


def legend_above(axes: Any, entries: list[Any], own: bool = True) -> None:
    """Write a legend in a line above the axes, if there is anything to explain; centred on a figure of our own."""
    if entries:
        options = {"ncols": len(entries), "frameon": False, "borderaxespad": 0.1, "fontsize": _SMALL}
        legend, top = (axes.figure.legend, axes.get_position().y1) if own else (axes.legend, 1.0)
        legend(handles=entries, loc="lower center", bbox_to_anchor=(0.5, top), **options)


def _add_bar(axes: Any, colours: Any, label: str, own: bool) -> Any:
    figure, place = axes.figure, {"ax": axes}
    if own:
        width = figure.get_size_inches()[0]
        left, bottom, across, height = axes.get_position().bounds
        place = {"cax": figure.add_axes((left + across + 0.12 / width, bottom, 0.16 / width, height))}
    colour_bar = figure.colorbar(colours, label=label, **place)
    colour_bar.outline.set_visible(False)
    return colour_bar


def _span(solution: Solution, rows: np.ndarray) -> str:
    if len(rows) == 1:
        return moment_of(solution, int(rows[0]))
    name, unit = axis_of_rows(solution)
    first, last = (f"{solution.at[row]:.3g}" for row in (rows[0], rows[-1]))
    return f"{name} {first} to {last}" + (f" {unit}" if unit != "-" else "")


def plot_model(model: Model, path: str | PathLike[str] | None = None, ax: Any = None) -> Any:
    """Draw the undeformed bodies of a model with supports, joints and full loads; return the figure.

    path: file to write (PNG, SVG, PDF; folders are created). Nothing is solved, so models that are mechanisms or are
    loaded beyond their strength can be drawn too. Raises MissingPackageError without matplotlib.
    """
    p = system_of(model, static=True).reference[None]
    rates = np.zeros_like(p)
    at_rest = Solution(model, True, np.ones(1), p, rates, rates, Statistics(0, 0, 0, "the model without stress"))
    return plot_shapes(at_rest, path, undeformed=False, ax=ax, title="reference shape, full loads")
