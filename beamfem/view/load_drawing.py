"""Loads in a drawing: forces and moments as arrows, distributed forces as rows of them, gravity in a corner."""

from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from beamfem.element.coordinates import across
from beamfem.model.load_base import factor
from beamfem.model.load_shapes import Acceleration, Force, ForcesAlong, Moment, Strains
from beamfem.results.solution_system import loading
from beamfem.view import symbols
from beamfem.view.imposed_labels import draw_imposed
from beamfem.view.load_symbols import PlacedRow
from beamfem.view.support_symbols import Stamps

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

FORCE = "#CC3311"
_LONGEST = 30.0  # arrow of the largest force [points of print]
_SHORTEST = 14.0


def draw_loads(axes: Any, solution: "Solution", rows: np.ndarray) -> list[Any]:
    """Draw each load on the row at which it is largest, the last of equals; return the artists."""
    system, at = loading(solution)
    drawn: list[Any] = []
    forces: list[tuple[Force, PlacedRow]] = []
    strains: list[tuple[Strains, int]] = []
    stamps = Stamps()
    for load in solution.model.loads:
        weights = np.array([factor(load, float(at[row]), system.static) for row in rows])
        best = len(rows) - 1 - int(np.abs(weights[::-1]).argmax())
        if not weights[best]:
            continue
        placed = PlacedRow(solution, int(rows[best]))
        for shape in placed.shapes(load, float(weights[best])):
            match shape:
                case Force():
                    forces.append((shape, placed))
                case Moment():
                    _moment(stamps, placed.position(shape.point), shape.moment)
                case ForcesAlong():
                    drawn += _distributed(axes, placed.positions(shape), shape)
                case Acceleration():
                    drawn += _gravity(axes, shape.vector)
                case Strains():
                    strains.append((shape, int(rows[best])))
                case _:
                    assert_never(shape)
    drawn += draw_imposed(axes, solution, strains, FORCE)
    return [*_forces(axes, forces), *drawn, *stamps.draw(axes, 18.0, 5.0)]


def _moment(stamps: Stamps, at: np.ndarray, moment: float) -> None:
    arc, head = symbols.turn(0.25 * np.pi, span=float(1.5 * np.pi * np.sign(moment)))
    stamps.add(at, arc, FORCE, 1.5)
    stamps.add(at, head, FORCE, 0.5, FORCE)


def _arrows(axes: Any, at: np.ndarray, vector: np.ndarray, pivot: str, width: float = 1.5) -> Any:
    """Draw arrows at places (n, 2) [m] of vectors (n, 2) [points of print]."""
    return axes.quiver(
        *at.T,
        *(vector / 72.0).T,
        angles="uv",
        units="inches",
        scale=1.0,
        scale_units="inches",
        width=width / 72.0,
        headwidth=4.5,
        headlength=5.5,
        headaxislength=5.0,
        minlength=0.1,
        color=FORCE,
        pivot=pivot,
        zorder=5.0,
    )


def _forces(axes: Any, items: list[tuple[Force, PlacedRow]]) -> list[Any]:
    items = [(force, placed) for force, placed in items if force.vector.any()]
    if not items:
        return []
    at = np.array([placed.position(force.point) for force, placed in items])
    vector = np.array([force.vector for force, _ in items])
    push = np.array([placed.touches(force) for force, placed in items])
    size = np.linalg.norm(vector, axis=1)
    length = np.maximum(_LONGEST * np.sqrt(size / size.max()), _SHORTEST)
    vector = vector / size[:, None] * length[:, None]
    groups = ((push, "tip"), (~push, "tail"))
    return [_arrows(axes, at[some], vector[some], pivot) for some, pivot in groups if some.any()]


def _distributed(axes: Any, places: np.ndarray, forces: ForcesAlong) -> list[Any]:
    from matplotlib.transforms import ScaledTranslation

    size = np.linalg.norm(forces.vectors, axis=1).max()
    if size == 0.0:
        return []
    vector = 0.7 * _LONGEST * forces.vectors / size
    drawn = [_arrows(axes, places, vector, "tip", 1.0)]
    if forces.even:
        foot = axes.transData + ScaledTranslation(
            -vector[0, 0] / 72.0, -vector[0, 1] / 72.0, axes.figure.dpi_scale_trans
        )
        drawn += axes.plot(*places.T, color=FORCE, linewidth=1.0, transform=foot, zorder=5.0)
    return drawn


def _gravity(axes: Any, vector: np.ndarray) -> list[Any]:
    size = np.linalg.norm(vector)
    if size == 0.0:
        return []
    # to the left of the upper right corner, which is left to the arrow
    at, ahead = np.array([0.955, 0.9]), vector / size
    arrow = axes.quiver(
        *at,
        *(26.0 * ahead / 72.0),
        angles="uv",
        units="inches",
        scale=1.0,
        scale_units="inches",
        width=1.5 / 72.0,
        headwidth=4.5,
        headlength=5.5,
        headaxislength=5.0,
        color=FORCE,
        pivot="mid",
        transform=axes.transAxes,
        zorder=5.0,
    )
    offset = -9.0 * np.abs(across(ahead))
    name = axes.annotate(
        "g",
        at,
        offset,
        xycoords="axes fraction",
        textcoords="offset points",
        ha="center",
        va="center",
        color=FORCE,
        fontstyle="italic",
        zorder=5.0,
    )
    return [arrow, name]
