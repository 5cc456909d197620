"""Curves of quantities: at points against time or load factor, and of any two quantities against each other."""

from collections.abc import Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, beam_in_words
from beamfem.model.contribution import Contribution
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import PointLoad
from beamfem.model.model import Model
from beamfem.parts.motor import Motor
from beamfem.results.axis_fields import AT_POINT, QUANTITIES, UNITS, Quantity, value_of
from beamfem.results.axis_fields import quantity as quantity_along
from beamfem.results.axis_points import AxisPoints
from beamfem.results.envelope import Envelope, along_with
from beamfem.results.path import Path, PathState
from beamfem.results.reactions import force_of_load, tension
from beamfem.results.solution import Solution
from beamfem.solve.linear.linear_model import QUANTITIES as LINEAR
from beamfem.units import units_of
from beamfem.validation import items, number_below, one_of, require_known, shown
from beamfem.view.frames import axis_of_rows, moment_of
from beamfem.view.labels import place, write_labels
from beamfem.view.plots import COLOURS, empty_figure, given_axes, legend_over, new_figure, quiet, save_figure

if TYPE_CHECKING:
    from beamfem.solve.linear.frequency_response import FrequencyResponse

_STYLES = ("-", "--", ":")
# of a point, by name
_LABELS = {
    "ux": "displacement ux",
    "uy": "displacement uy",
    "x": "x",
    "y": "y",
    "rotation": "rotation",
    "vx": "velocity vx",
    "vy": "velocity vy",
    "ax": "acceleration ax",
    "ay": "acceleration ay",
    "fx": "reaction fx",
    "fy": "reaction fy",
    "m": "reaction moment",
}
_OF_LOAD = {"fx": "applied fx", "fy": "applied fy", "m": "applied moment"}
_OF_PART = {"fx": "force fx", "fy": "force fy", "m": "moment", "tension": "tension"}
# what is drawn of a point over time: label and the names of its curves
_HISTORIES = {
    "displacement": ("displacement", ("ux", "uy")),
    **{name: (_LABELS[name], (name,)) for name in ("ux", "uy", "rotation")},
    "position": ("position", ("x", "y")),
    "velocity": ("velocity", ("vx", "vy")),
    "acceleration": ("acceleration", ("ax", "ay")),
    "force": ("reaction force", ("fx", "fy")),
    "reaction_moment": (_LABELS["m"], ("m",)),
}


def plot_history(
    solution: Solution,
    point: Point | Sequence[Point] | None = None,
    quantity: str = "displacement",
    path: str | PathLike[str] | None = None,
    ax: Any = None,
) -> Any:
    """Plot a quantity at points against time [s] or load factor; return the figure. See `Solution.plot_history`."""
    if isinstance(quantity, str) and quantity == "energy":
        energy = solution.energy()
        label, unit, parts = "energy", "J", [{name: getattr(energy, name) for name in ENERGIES}]
    else:
        sentence = f"there is no history of {shown(quantity)}"
        if isinstance(quantity, str) and quantity not in _HISTORIES and quantity in (*_LABELS, *OF_SECTION):
            across = axis_of_rows(solution)[0].replace(" ", "_")
            raise InputError(f'{sentence}; plot_curve("{across}", ("{quantity}", point)) draws it')
        require_known(sentence, quantity, [*_HISTORIES, "energy"])
        label, names = _HISTORIES[quantity]
        unit = UNITS[names[0]]
        points = [point] if isinstance(point, Point) else [] if point is None else items("point", point)
        if not points or not all(isinstance(item, Point) for item in points):
            raise InputError(f"the history of {quantity!r} needs a point such as beam.end, got {shown(point)}")
        parts = [{name: value_of(solution, item, AT_POINT[name][0]) for name in names} for item in points]
        if len(parts) > 1:
            parts = [
                {f"{name} at {place(solution.model, item.reference)}": curve for name, curve in part.items()}
                for item, part in zip(points, parts, strict=True)
            ]
    figure, axes = new_figure(ax=ax, pyplot=path is None)
    several = sum(len(part) for part in parts) > 1
    for number, part in enumerate(parts):
        for order, (name, curve) in enumerate(part.items()):
            colour = COLOURS[(order if len(parts) == 1 else number) % (len(COLOURS) - 1)]
            style = _STYLES[(order if len(parts) > 1 else 0) % len(_STYLES)]
            marker = "o" if len(solution) <= 30 else None
            axes.plot(solution.at, curve, style, color=colour, marker=marker, markersize=4, linewidth=1.5, label=name)
    name, axis_unit = axis_of_rows(solution)
    axes.set(xlabel=f"{name} [{axis_unit}]", ylabel=f"{label} [{solution.model.unit(unit)}]", xmargin=0.02)
    if several:
        legend_over(axes, 4 if len(parts) == 1 else 2)
    return save_figure(figure, path)


def plot_load_displacement(
    solution: Solution, point: Point, quantity: str = "uy", path: str | PathLike[str] | None = None, ax: Any = None
) -> Any:
    """Plot the load factor against a motion of a point; return the figure. See `Solution.plot_load_displacement`."""
    one_of("what the load is drawn over", quantity, ("ux", "uy", "rotation"))
    load, (label, curve) = solution.load_factor, _taken(solution, "x", (quantity, point))
    figure, axes = new_figure(ax=ax, pyplot=path is None)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    marker = "." if len(solution) <= 200 else None
    axes.plot(curve, load, color=COLOURS[0], linewidth=1.6, marker=marker, markersize=4, zorder=2)
    marked: list[tuple[float, float]] = []
    colours: list[str] = []
    if isinstance(solution, Path):
        # at one place with a bifurcation both are seen
        ring: dict[str, Any] = {"marker": "o", "markersize": 10, "markerfacecolor": "none", "markeredgewidth": 1.8}
        diamond: dict[str, Any] = {"marker": "D", "markersize": 6, "markeredgecolor": "white"}
        kinds = (("limit point", solution.limit_points, ring), ("bifurcation", solution.bifurcations, diamond))
        for (name, states, look), colour in zip(kinds, COLOURS[1:], strict=False):
            if not states:
                continue
            alone = _together(solution, states)
            x = value_of(alone, point, AT_POINT[quantity][0])
            axes.plot(x, alone.at, linestyle="none", label=name, color=colour, zorder=3, **look)
            marked += zip(x.tolist(), alone.at.tolist(), strict=True)
            colours += len(states) * [colour]
        if solution.limit_points or solution.bifurcations:
            legend_over(axes, 2)
    axes.set(xlabel=label, ylabel="load factor [-]", xmargin=0.06, ymargin=0.1)
    if marked:
        write_labels(axes, marked, [f"{at:.5g}" for _, at in marked], colours, np.column_stack([curve, load]))
    return save_figure(figure, path)


def plot_envelope(
    envelope: Envelope, beam: Beam, name: str, path: str | PathLike[str] | None = None, ax: Any = None
) -> Any:
    """Draw the envelope of a quantity along a beam and return the figure. See `Envelope.plot`."""
    model = next(iter(envelope.cases.values())).model
    curve = along_with(envelope, beam, name, np.linspace(0.0, 1.0, _ALONG + 1))
    drawn = quantity_along(name)
    scale, unit = _readable(model, np.concatenate([curve.smallest, curve.largest]), drawn.unit)
    figure, axes = new_figure(ax=ax, pyplot=path is None)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.fill_between(curve.arc_length, scale * curve.smallest, scale * curve.largest, color="0.88", label="envelope")
    for number, (case, sides) in enumerate(curve.cases.items()):
        for values, label in zip(sides, (case, None), strict=True):
            axes.plot(
                curve.arc_length, scale * values, color=COLOURS[number % len(COLOURS)], linewidth=1.4, label=label
            )
    axes.set(xlabel=f"arc length [{model.unit('m')}]", ylabel=f"{drawn.label} [{unit}]", xmargin=0.02)
    legend_over(axes, 4)
    return save_figure(figure, path)


def _readable(model: Model, values: np.ndarray, unit: str) -> tuple[float, str]:
    """Return a factor and a unit in which values are drawn, see `Units.readable`."""
    return units_of(model.units).readable(float(np.nanmax(np.abs(values))), unit)


def plot_along(
    solution: Solution, beam: Beam, name: str, path: str | PathLike[str] | None = None, row: int = -1, ax: Any = None
) -> Any:
    """Draw a quantity along a beam in a row and return the figure. See `Solution.plot_along`."""
    model, drawn = solution.model, quantity_along(name)
    number = number_below("row", row, len(solution), -len(solution)) % len(solution)
    mesh = model.meshes[model.number_of(beam)]
    points = AxisPoints.spaced(mesh, max(2, _ALONG // mesh.elements))
    values = drawn.values(points, solution, np.array([number]))[0]
    if not np.isfinite(values).any():
        raise InputError(f"this beam has no {drawn.label} to draw: {drawn.unknown_of([beam])}")
    scale, unit = _readable(model, values, drawn.unit)
    figure, axes = new_figure(ax=ax, pyplot=path is None)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    arc_length = mesh.arc_length(points.element, points.xi)
    axes.plot(arc_length, scale * values, color=COLOURS[0], linewidth=1.6)
    axes.fill_between(arc_length, scale * values, color=COLOURS[0], alpha=0.12, linewidth=0.0)
    axes.set(xlabel=f"arc length [{model.unit('m')}]", ylabel=f"{drawn.label} [{unit}]", xmargin=0.02)
    axes.set_title(f"{beam_in_words(model.beams, model.number_of(beam))}, {moment_of(solution, number)}", fontsize=10)
    return save_figure(figure, path)


def _together(path: Solution, states: Sequence[PathState]) -> Solution:
    """Return states of a path as the rows of a solution."""
    at = np.array([state.at for state in states])
    p, v, a = (np.array([getattr(state, name) for state in states]) for name in "pva")
    turned = [state.turned for state in states if state.turned is not None]
    return Solution(path.model, True, at, p, v, a, path.statistics, turned=np.array(turned) if turned else None)


Drawn = str | tuple[str, Any] | np.ndarray
_ALONG = 400  # points of a curve along a beam
_MARKED = 200  # rows up to which each is a dot
OF_SECTION = (
    *("normal", "shear", "moment", "stress", "von_mises", "upper", "lower", "outer"),
    *("tension", "compression", "shear_stress", "utilisation"),
)
ENERGIES = ("kinetic", "strain", "potential", "total")


def plot_curve(solution: Solution, x: Drawn, y: Drawn, path: str | PathLike[str] | None = None, ax: Any = None) -> Any:
    """Plot one quantity against another, one point per row; return the figure. See `Solution.plot_curve`."""
    (across, horizontal), (up, vertical) = (_taken(solution, *pair) for pair in (("x", x), ("y", y)))
    figure, axes = new_figure(ax=ax, pyplot=path is None)
    marker = "." if len(solution) <= _MARKED else None
    axes.plot(horizontal, vertical, color=COLOURS[0], linewidth=1.6, marker=marker, markersize=4)
    axes.set(xlabel=across, ylabel=up, xmargin=0.04, ymargin=0.04)
    return save_figure(figure, path)


def _taken(solution: Solution, which: str, given: Drawn) -> tuple[str, np.ndarray]:
    """Return label and values (steps,) of what is drawn along an axis. Raises InputError."""
    if isinstance(given, str):
        name, unit = axis_of_rows(solution)
        require_known(f"{which} of a curve is no {shown(given)}", given, [name.replace(" ", "_"), *ENERGIES])
        if given in ENERGIES:
            return f"{given} energy [{solution.model.unit('J')}]", getattr(solution.energy(), given)
        return f"{name} [{unit}]", solution.at
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], Point):
        name, point = given
        require_known(f"{which} of a curve is no {shown(name)} of a point", name, [*_LABELS, *OF_SECTION])
        if name in OF_SECTION:
            label, unit, values = _of_section(solution, QUANTITIES[name], point)
        else:
            label, unit = _LABELS[name], UNITS[name]
            values = value_of(solution, point, AT_POINT[name][0])
        scale, unit = _readable(solution.model, values, unit)
        return f"{label} at {place(solution.model, point.reference)} [{unit}]", scale * values
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], PointLoad):
        name, load = given
        require_known(f"{which} of a curve is no {shown(name)} of a load", name, _OF_LOAD)
        part = list(_OF_LOAD).index(name)
        return f"{_OF_LOAD[name]} [{solution.model.unit(UNITS[name])}]", force_of_load(solution, load)[:, part]
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], Joint | Contribution | Motor):
        name, part = given
        require_known(f"{which} of a curve is no {shown(name)} of a {type(part).__name__}", name, _OF_PART)
        if name == "tension":
            unit, values = "N", tension(solution, part)
        else:
            unit, values = UNITS[name], solution.joint_force(part)[:, list(_OF_PART).index(name)]
        return f"{_OF_PART[name]} of {type(part).__name__} [{solution.model.unit(unit)}]", values
    label, numbers = given if isinstance(given, tuple) and len(given) == 2 else ("", given)
    try:
        values = np.asarray(numbers)
        values = values.astype(float) if values.dtype.kind in "fiub" else np.empty(0)
    except (TypeError, ValueError):
        values = np.empty(0)
    if values.shape != (len(solution),) or not isinstance(label, str):
        raise InputError(
            f'{which} of a curve must be a pair such as ("uy", beam.end), "load_factor" or "time", or {len(solution)} '
            f"numbers, one a row, got {shown(given)}"
        )
    return label, values


def _of_section(solution: Solution, quantity: Quantity, point: Point) -> tuple[str, str, np.ndarray]:
    """Return label, unit and values (steps,) of a quantity along the axis at a point. Raises InputError."""
    mesh = solution.model.mesh_of(point)
    values = quantity.values(AxisPoints.at(mesh, [point.fraction]), solution, np.arange(len(solution)))[:, 0]
    if not np.isfinite(values).any():
        why = quantity.unknown_of([point.beam])
        raise InputError(f"the section at this point has no {quantity.label} to draw: {why}")
    return quantity.label, quantity.unit, values


def plot_response(response: "FrequencyResponse", path: str | PathLike[str] | None = None, ax: Any = None) -> Any:
    """Draw amplitude, on a logarithmic axis, and phase [deg] against frequency [Hz]; return the matplotlib figure.

    ax: axes of the amplitude and of the phase. Raises MissingPackageError without matplotlib.
    """
    if ax is None:
        figure = empty_figure(6.4, 5.4, pyplot=path is None)
        amplitude, phase = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    else:
        amplitude, phase = given_axes(ax, 2)
    model, (name, point) = response.model, response.quantity
    label, unit = LINEAR[name]
    order = np.argsort(response.frequencies, kind="stable")
    for axes, values in ((amplitude, response.amplitude), (phase, np.degrees(response.phase))):
        quiet(axes)
        axes.plot(response.frequencies[order], values[order], color=COLOURS[0], linewidth=1.5)
    if response.amplitude.any():
        amplitude.set_yscale("log")
    amplitude.set_ylabel(f"{label} at {place(model, point.reference)} [{model.unit(unit)}]")
    phase.set(xlabel=f"frequency [{model.unit('Hz')}]", ylabel="phase [deg]", yticks=[-180, -90, 0, 90, 180])
    phase.margins(x=0.02)
    return save_figure(phase.figure.figure, path)
