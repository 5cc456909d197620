"""Loads in a drawing: forces and moments as arrows, distributed forces as rows of them, text for imposed strains."""

from collections.abc import Callable
from dataclasses import dataclass, field
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
from beamfem.view.labels import note_beside
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


@dataclass(frozen=True, eq=False)
class PlacedLoads:
    """Loads where they act in rows of a solution; what is zero is left out.

    forces: place (2,) [m], vector (2,) [N] and whether the arrow's tip touches the beam; lines: places (n, 2) [m] of
    forces along beams; moments: place and moment [N m]; gravity: accelerations (2,) [m/s^2]; strains: imposed ones, and
    their row.
    """

    forces: list[tuple[np.ndarray, np.ndarray, bool]] = field(default_factory=list)
    lines: list[tuple[np.ndarray, ForcesAlong]] = field(default_factory=list)
    moments: list[tuple[np.ndarray, float]] = field(default_factory=list)
    gravity: list[np.ndarray] = field(default_factory=list)
    strains: list[tuple[Strains, Solution]] = field(default_factory=list)

    def add(self, placed: PlacedRow, load: Load, weight: float) -> None:
        """Add a load in a row, times a weight. Raises InputError for an unknown shape."""
        for shape in drawn(load, load.shapes(weight, placed), LoadShape):
            match shape:
                case Force():
                    if shape.vector.any():
                        self.forces.append((placed.position(shape.point), shape.vector, placed.touches(shape)))
                case Moment():
                    if shape.moment != 0.0:
                        self.moments.append((placed.position(shape.point), shape.moment))
                case ForcesAlong():
                    if shape.vectors.any():
                        self.lines.append((placed.positions(shape), shape))
                case Acceleration():
                    if shape.vector.any():
                        self.gravity.append(shape.vector)
                case Strains():
                    self.strains.append((shape, placed.only))
                case _:
                    assert_never(shape)


_APART = 12.0  # of the words from the axis [points of print]
_BENT = 0.02  # of the length: a beam that is bent has its words on its outer side
_MARGIN = 4.0  # between words and the edge of the axes [points of print]
_SLOPED = 0.3  # of a unit normal


def _imposed(axes: Any, items: list[tuple[Strains, Solution]]) -> Any:
    """Draw the strains imposed by loads as text; yield the artists."""
    beside: dict[int, int] = {}
    for strains, only in items:
        beam = strains.beam
        at, along = only.position(beam.at(0.5))[0], only.fields(beam.at(0.5)).r_x[0]
        chord = only.position(beam.at(0.25))[0] + only.position(beam.at(0.75))[0] - 2.0 * at
        outward = np.array([-along[1], along[0]]) / np.linalg.norm(along)
        if chord @ outward > _BENT * beam.curve.length:
            outward = -outward
        # words beside an upright beam take a line each, so that they stay narrow
        sideways = abs(outward[0]) > _SLOPED
        words, before = _words(strains, only.model.unit), beside.get(id(beam), 0)
        lines = len(words) if sideways else 1
        beside[id(beam)] = before + lines
        offset = _APART * outward - [0.0, before * _APART] if sideways else (before + 1) * _APART * outward
        side = "left" if outward[0] > _SLOPED else "right" if outward[0] < -_SLOPED else "center"
        look = {"color": FORCE, "fontsize": 8.0, "zorder": 5.0, "ha": side, "va": "top" if sideways else "center"}
        note = note_beside(axes, ("\n" if sideways else " ").join(words), at, offset, **look)
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
    loads, stamps = PlacedLoads(), Stamps()
    for load in solution.model.loads:
        weights = np.array([factor(load, float(at[row]), system.static) for row in rows])
        best = len(rows) - 1 - int(np.abs(weights[::-1]).argmax())
        if weights[best]:
            loads.add(PlacedRow(solution, int(rows[best])), load, float(weights[best]))
    for place, moment in loads.moments:
        arc, head = symbols.turn(0.25 * np.pi, span=float(1.5 * np.pi * np.sign(moment)))
        stamps.add(place, arc, FORCE, 1.5)
        stamps.add(place, head, FORCE, 0.5, FORCE)
    drawn: list[Any] = []
    for places, forces in loads.lines:
        drawn += _distributed(axes, places, forces)
    for vector in loads.gravity:
        drawn += _gravity(axes, vector)
    drawn += _imposed(axes, loads.strains)
    return [*_forces(axes, loads.forces), *drawn, *stamps.draw(axes, 18.0, 5.0)]


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


def _forces(axes: Any, items: list[tuple[np.ndarray, np.ndarray, bool]]) -> list[Any]:
    if not items:
        return []
    at, vector, push = map(np.array, zip(*items, strict=True))
    size = np.linalg.norm(vector, axis=1)
    length = np.maximum(_LONGEST * np.sqrt(size / size.max()), _SHORTEST)
    vector = vector / size[:, None] * length[:, None]
    groups = ((push, "tip"), (~push, "tail"))
    return [_arrows(axes, at[some], vector[some], pivot) for some, pivot in groups if some.any()]


def _distributed(axes: Any, places: np.ndarray, forces: ForcesAlong) -> list[Any]:
    from matplotlib.transforms import ScaledTranslation

    vector = 0.7 * _LONGEST * forces.vectors / np.linalg.norm(forces.vectors, axis=1).max()
    drawn = [_arrows(axes, places, vector, "tip", 1.0)]
    if forces.even:
        foot = axes.transData + ScaledTranslation(
            -vector[0, 0] / 72.0, -vector[0, 1] / 72.0, axes.figure.dpi_scale_trans
        )
        drawn += axes.plot(*places.T, color=FORCE, linewidth=1.0, transform=foot, zorder=5.0)
    return drawn


def _gravity(axes: Any, vector: np.ndarray) -> list[Any]:
    # to the left of the upper right corner, which is left to the arrow
    at, ahead = np.array([0.955, 0.9]), vector / np.linalg.norm(vector)
    arrow = _arrows(axes, at[None], 26.0 * ahead[None], "mid", transform=axes.transAxes)
    offset = -9.0 * np.abs(across(ahead))
    look = {"color": FORCE, "fontstyle": "italic", "zorder": 5.0}
    return [arrow, note_beside(axes, "g", at, offset, xycoords="axes fraction", **look)]
