"""Loads in a drawing: forces and moments as arrows, distributed forces as rows of them, text for imposed strains."""

from collections.abc import Callable
from typing import Any, assert_never

import numpy as np

from beamfem.element.coordinates import across
from beamfem.mesh.reference import length_points
from beamfem.model.beam import Beam, Point
from beamfem.model.load_base import Load, factor
from beamfem.model.load_shapes import Acceleration, Force, ForcesAlong, LoadShape, Moment, Strains, drawn
from beamfem.results.axis_points import AxisPoints
from beamfem.results.full_turns import StationsOfRows
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.view import symbols
from beamfem.view.support_symbols import Stamps


class PlacedRow:
    """A row of a solution, with the members that shapes need."""

    def __init__(self, solution: Solution, row: int) -> None:
        self.only = solution[row : row + 1]

    @property
    def time(self) -> float:
        """Time [s] or load factor of the loads."""
        return float(loading(self.only)[1][0])

    def position(self, point: Point) -> np.ndarray:
        """Return the position of a point (2,) [m]."""
        return self.only.position(point)[0]

    def at(self, point: Point) -> StationsOfRows:
        """Return the state at a point."""
        return self._stations(point.beam, [point.fraction])

    def along(self, beam: Beam, arc_length: np.ndarray) -> StationsOfRows:
        """Return the state at arc lengths (n,) [m] of a beam."""
        return self._stations(beam, (arc_length / beam.curve.length).tolist())

    def _stations(self, beam: Beam, fractions: list[float]) -> StationsOfRows:
        return StationsOfRows(self.only, AxisPoints.at(self.only.model.mesh_of(beam.start), fractions))

    def stations(self, beam: Beam) -> np.ndarray:
        """Return the arc lengths (n,) [m] at which loads along a beam are integrated."""
        mesh = self.only.model.mesh_of(beam.start)
        return mesh.arc_length(*length_points(mesh)[:2])

    def shapes(self, load: Load, weight: float) -> tuple[LoadShape, ...]:
        """Return the shapes of a load, times a weight. Raises InputError for an unknown shape."""
        return drawn(load, load.shapes(weight, self), LoadShape)

    def positions(self, forces: ForcesAlong) -> np.ndarray:
        """Return the positions of forces along a beam (n, 2) [m]."""
        length = forces.beam.curve.length
        return np.array([self.position(forces.beam.at(fraction)) for fraction in forces.arc_length / length])

    def touches(self, force: Force) -> bool:
        """Return whether the arrow's tip touches the beam: inside the beam, and at ends if the force pushes."""
        fraction = force.point.fraction
        if 0.0 < fraction < 1.0:
            return True
        slope = self.at(force.point).slope[0, 0]
        outward = slope if fraction == 1.0 else -slope
        return bool(force.vector @ outward < -0.3 * np.linalg.norm(force.vector) * np.linalg.norm(slope))


_APART = 12.0  # of the words from the axis [points of print]
_BENT = 0.02  # of the length: a beam that is bent has its words on its outer side
_MARGIN = 4.0  # between words and the edge of the axes [points of print]
_SLOPED = 0.3  # of a unit normal


def _imposed(axes: Any, solution: Solution, items: list[tuple[Strains, int]]) -> Any:
    """Draw the strains imposed by loads in a row of a solution as text; yield the artists."""
    beside: dict[int, int] = {}
    for strains, row in items:
        only, beam = solution[row : row + 1], strains.beam
        at, along = only.position(beam.at(0.5))[0], only.fields(beam.at(0.5)).r_x[0]
        chord = only.position(beam.at(0.25))[0] + only.position(beam.at(0.75))[0] - 2.0 * at
        outward = np.array([-along[1], along[0]]) / np.linalg.norm(along)
        if chord @ outward > _BENT * beam.curve.length:
            outward = -outward
        # words beside an upright beam take a line each, so that they stay narrow
        sideways = abs(outward[0]) > _SLOPED
        words, before = _words(strains, solution.model.unit), beside.get(id(beam), 0)
        lines = len(words) if sideways else 1
        beside[id(beam)] = before + lines
        offset = _APART * outward - [0.0, before * _APART] if sideways else (before + 1) * _APART * outward
        note = axes.annotate(
            ("\n" if sideways else " ").join(words),
            at,
            offset,
            textcoords="offset points",
            color=FORCE,
            fontsize=8.0,
            ha="left" if outward[0] > _SLOPED else "right" if outward[0] < -_SLOPED else "center",
            va="top" if sideways else "center",
            zorder=5.0,
        )
        _move_inside(note, axes)
        yield note


def _move_inside(words: Any, axes: Any) -> None:
    """Move text sideways into the axes, or to their left edge if it is wider."""
    extent, room = words.get_window_extent(), axes.get_window_extent()
    points = 72.0 / axes.figure.dpi
    x, y = words.get_position()
    beyond = max(min(0.0, room.x1 - _MARGIN / points - extent.x1), room.x0 + _MARGIN / points - extent.x0)
    if beyond < 0.0 or extent.x0 < room.x0 + _MARGIN / points:
        words.set_position((x + beyond * points, y))


def _words(strains: Strains, named: Callable[[str], str]) -> list[str]:
    parts = [
        f"{name} varies" if value is None else f"{name} {value:.4g} {named(unit)}".rstrip()
        for name, (value, unit) in strains.values.items()
    ]
    return [f"{strains.name}:", *(f"{part}," for part in parts[:-1]), *parts[-1:]]


FORCE = "#CC3311"
_LONGEST = 30.0  # arrow of the largest force [points of print]
_SHORTEST = 14.0


def draw_loads(axes: Any, solution: Solution, rows: np.ndarray) -> list[Any]:
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
                    arc, head = symbols.turn(0.25 * np.pi, span=float(1.5 * np.pi * np.sign(shape.moment)))
                    stamps.add(placed.position(shape.point), arc, FORCE, 1.5)
                    stamps.add(placed.position(shape.point), head, FORCE, 0.5, FORCE)
                case ForcesAlong():
                    drawn += _distributed(axes, placed.positions(shape), shape)
                case Acceleration():
                    drawn += _gravity(axes, shape.vector)
                case Strains():
                    strains.append((shape, int(rows[best])))
                case _:
                    assert_never(shape)
    drawn += _imposed(axes, solution, strains)
    return [*_forces(axes, forces), *drawn, *stamps.draw(axes, 18.0, 5.0)]


def _arrows(axes: Any, at: np.ndarray, vector: np.ndarray, pivot: str, width: float = 1.5, **options: Any) -> Any:
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
        **options,
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
    arrow = _arrows(axes, at[None], 26.0 * ahead[None], "mid", transform=axes.transAxes)
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
