"""One quantity of a solution against another, such as a reaction against a displacement."""

from collections.abc import Callable
from os import PathLike
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.results.solution import Solution
from beamfem.validation import require_known, shown
from beamfem.view.frames import axis_of_rows
from beamfem.view.plots import COLOURS, new_figure, save_figure

Quantity = str | tuple[str, Any] | np.ndarray
_MARKED = 200  # rows up to which each is a dot

# of a point: label, unit and value
_OF_POINT: dict[str, tuple[str, str, Callable[[Solution, Point], np.ndarray]]] = {
    "ux": ("displacement ux", "m", lambda s, at: s.displacement(at)[:, 0]),
    "uy": ("displacement uy", "m", lambda s, at: s.displacement(at)[:, 1]),
    "x": ("x", "m", lambda s, at: s.position(at)[:, 0]),
    "y": ("y", "m", lambda s, at: s.position(at)[:, 1]),
    "rotation": ("rotation", "rad", lambda s, at: s.rotation(at)),
    "vx": ("velocity vx", "m/s", lambda s, at: s.velocity(at)[:, 0]),
    "vy": ("velocity vy", "m/s", lambda s, at: s.velocity(at)[:, 1]),
    "fx": ("reaction fx", "N", lambda s, at: s.reaction(at)[:, 0]),
    "fy": ("reaction fy", "N", lambda s, at: s.reaction(at)[:, 1]),
    "m": ("reaction moment", "N m", lambda s, at: s.reaction(at)[:, 2]),
}


def plot_curve(solution: Solution, x: Quantity, y: Quantity, path: str | PathLike[str] | None = None) -> Any:
    """Plot one quantity against another, one point per row; return the matplotlib figure.

    x, y: a pair of a name and a point, such as ("uy", beam.end), with the names "ux", "uy", "x", "y" [m], "rotation"
    [rad], "vx", "vy" [m/s] and, at supports, "fx", "fy" [N] and "m" [N m]; "load_factor" or "time" [s]; a pair of a
    label and numbers (steps,), or numbers. Raises InputError; MissingPackageError without matplotlib.
    """
    (across, horizontal), (up, vertical) = (_taken(solution, *own) for own in (("x", x), ("y", y)))
    figure, axes = new_figure()
    marker = "." if len(solution) <= _MARKED else None
    axes.plot(horizontal, vertical, color=COLOURS[0], linewidth=1.6, marker=marker, markersize=4)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.margins(0.04)
    if path is not None:
        save_figure(figure, path)
    return figure


def _taken(solution: Solution, which: str, given: Quantity) -> tuple[str, np.ndarray]:
    """Return label and values (steps,) of what is drawn along an axis. Raises InputError."""
    if isinstance(given, str):
        name, unit = axis_of_rows(solution)
        require_known(f"{which} of a curve is no {shown(given)}", given, [name.replace(" ", "_")])
        return f"{name} [{unit}]", solution.at
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], Point):
        require_known(f"{which} of a curve is no {shown(given[0])} of a point", given[0], _OF_POINT)
        label, unit, value = _OF_POINT[given[0]]
        at = given[1].reference
        return f"{label} at ({at[0]:.4g}, {at[1]:.4g}) [{solution.model.unit(unit)}]", value(solution, given[1])
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
