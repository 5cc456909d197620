"""One quantity of a solution against another, such as a reaction against a displacement."""

from collections.abc import Callable
from os import PathLike
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.results.axis_fields import QUANTITIES, PointsAt, Quantity
from beamfem.results.free_bodies import Cuts
from beamfem.results.solution import Solution
from beamfem.validation import require_known, shown
from beamfem.view.frames import axis_of_rows
from beamfem.view.plots import COLOURS, new_figure, save_figure
from beamfem.view.point_text import place

Drawn = str | tuple[str, Any] | np.ndarray
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
OF_SECTION = (
    *("normal", "shear", "moment", "stress", "von_mises", "upper", "lower", "outer"),
    *("tension", "compression", "shear_stress", "utilisation"),
)
ENERGIES = ("kinetic", "strain", "potential", "total")


def plot_curve(solution: Solution, x: Drawn, y: Drawn, path: str | PathLike[str] | None = None) -> Any:
    """Plot one quantity against another, one point per row; return the matplotlib figure.

    x, y: a pair of a name and a point, such as ("uy", beam.end), with the names "ux", "uy", "x", "y" [m], "rotation"
    [rad], "vx", "vy" [m/s], at supports "fx", "fy" [N] and "m" [N m], of the section there "normal", "shear" [N],
    "moment" [N m] and the stresses of `plot` [Pa]; "load_factor" or "time" [s]; "kinetic", "strain", "potential" or
    "total" energy [J]; a pair of a label and numbers (steps,), or numbers. Where two elements meet or a load acts, a
    section is that on the side towards the beam's end. Raises InputError; MissingPackageError without matplotlib.
    """
    (across, horizontal), (up, vertical) = (_taken(solution, *pair) for pair in (("x", x), ("y", y)))
    figure, axes = new_figure()
    marker = "." if len(solution) <= _MARKED else None
    axes.plot(horizontal, vertical, color=COLOURS[0], linewidth=1.6, marker=marker, markersize=4)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.margins(0.04)
    if path is not None:
        save_figure(figure, path)
    return figure


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
        require_known(f"{which} of a curve is no {shown(name)} of a point", name, [*_OF_POINT, *OF_SECTION])
        if name in OF_SECTION:
            label, unit, values = _of_section(solution, QUANTITIES[name], point)
        else:
            label, unit, value = _OF_POINT[name]
            values = value(solution, point)
        return f"{label} at {place(solution.model, point.reference)} [{solution.model.unit(unit)}]", values
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
    at = Cuts(*(np.array([value]) for value in mesh.locate(point.fraction)))
    values = quantity.values(PointsAt(mesh, 0, at), solution, np.arange(len(solution)))[:, 0]
    if not np.isfinite(values).any():
        why = quantity.unknown_of([point.beam])
        raise InputError(f"the section at this point has no {quantity.label} to draw: {why}")
    return quantity.label, quantity.unit, values
