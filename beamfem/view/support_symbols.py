"""Supports and joints in a drawing, as engineers draw them; a symbol has the same size in every picture."""

from collections import defaultdict
from typing import Any, assert_never

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.load_shapes import (
    Bar,
    Coil,
    ConnectorShape,
    Constraint,
    Disc,
    JointShape,
    Spiral,
    Springs,
    SpringsAlong,
    SupportShape,
    Wall,
    drawn,
)
from beamfem.model.model import Model
from beamfem.parts.at_points import PartAlongBeam, PartAtPoints
from beamfem.results.solution import Solution
from beamfem.view import symbols

SIZE = 15.0  # of a symbol [points of print]
INK = "0.15"
PRESCRIBED = "#AA3377"
_SPRINGS_OF_FOUNDATION = 12


class Stamps:
    """Outlines to draw at points, collected so that thousands of them are drawn at once."""

    def __init__(self) -> None:
        self.places: dict[tuple[bytes, str, float, str], list[np.ndarray]] = defaultdict(list)
        self.outlines: dict[bytes, np.ndarray] = {}

    def add(
        self, at: np.ndarray, outline: np.ndarray, colour: str = INK, width: float = 1.0, fill: str = "none"
    ) -> None:
        """Add an outline (n, 2) [symbols] at a place (2,) [m]."""
        key = np.round(outline, 6).tobytes()
        self.outlines[key] = outline
        self.places[key, colour, width, fill].append(at)

    def draw(self, axes: Any, size: float = SIZE, layer: float = 4.0) -> list[Any]:
        """Add all to the axes and return them."""
        from matplotlib.collections import PathCollection
        from matplotlib.path import Path
        from matplotlib.transforms import Affine2D

        artists = []
        for (key, colour, width, fill), places in self.places.items():
            drawn = PathCollection(
                [Path(self.outlines[key])],
                offsets=np.array(places),
                offset_transform=axes.transData,
                edgecolors=colour,
                facecolors=fill,
                linewidths=width,
                capstyle="round",
                zorder=layer,
            )
            # inches of the figure, so that a file may be saved at any resolution
            drawn.set_transform(Affine2D().scale(size / 72.0) + axes.figure.dpi_scale_trans)
            axes.add_collection(drawn, autolim=False)
            artists.append(drawn)
        return artists


def supports_of(solution: Solution, row: int, centre: np.ndarray) -> Stamps:
    """Return the symbols of supports in a row: rollers roll, prescribed motions start at their points.

    centre: of all shapes (2,) [m], which decides the side on which a symbol is drawn.
    """
    only, stamps = solution[row : row + 1], Stamps()
    for support in solution.model.supports:
        for shape in drawn(support, support.shapes(), SupportShape):
            match shape:
                case SpringsAlong():
                    _springs_along(stamps, shape)
                case Springs():
                    _springs(stamps, shape)
                case Constraint(normal=None):
                    _constraint(stamps, shape, only.position(shape.point)[0], centre)
                case Constraint():
                    _stamp(stamps, symbols.ROLLER, only.position(shape.point)[0], -np.asarray(shape.normal))
                case _:
                    assert_never(shape)
    return stamps


def draw_joints(axes: Any, solution: Solution, row: int) -> list[Any]:
    """Draw the hinges and connectors of a model in a row; see `joints_of`."""
    return joints_of(solution, row, Stamps()).draw(axes, layer=6.0) + _draw_connectors(axes, solution, row)


def _draw_connectors(axes: Any, solution: Solution, row: int) -> list[Any]:
    """Draw connectors and masses; a user-defined one is a dashed line through its points, which are dots."""
    connectors = solution.model.at_points
    only = solution[row : row + 1] if connectors else solution
    artists, stamps, line = [], Stamps(), {"color": INK, "zorder": 6.0}
    for connector in connectors:
        shapes = connector.shapes() if isinstance(connector, PartAtPoints | PartAlongBeam) else ()
        if not shapes and not isinstance(connector, PartAlongBeam):
            x, y = np.array([only.position(point)[0] for point in connector.points]).T
            artists += axes.plot(x, y, linestyle="--", linewidth=1.0, marker="o", markersize=5.0, **line)
            continue
        for shape in drawn(connector, shapes, ConnectorShape):
            match shape:
                case Disc():
                    centre = _centre(only, shape)
                    x, y = np.array([only.position(shape.point)[0], centre]).T
                    artists += axes.plot(x, y, linewidth=2.5, **line)
                    artists += axes.plot(*centre, marker="o", markersize=9.0, **line)
                case Coil():
                    end = only.position(shape.b)[0] if isinstance(shape.b, Point) else np.asarray(shape.b)
                    if not isinstance(shape.b, Point):
                        _stamp(stamps, symbols.GROUND, end, end - only.position(shape.a)[0])
                    start = only.position(shape.a)[0]
                    outline = np.array([start, end]) if shape.straight else symbols.coil(start, end)
                    artists += axes.plot(*outline.T, linewidth=1.0, **line)
                case Bar():
                    x, y = np.array([only.position(point)[0] for point in (shape.a, shape.b)]).T
                    artists += axes.plot(x, y, linewidth=2.5, marker="o", markersize=5.0, **line)
                case Spiral():
                    _stamp(stamps, symbols.ROTATIONAL_SPRING, only.position(shape.point)[0], np.array([0.0, -1.0]))
                case Wall():
                    _stamp(stamps, symbols.GROUND, np.asarray(shape.place), -np.asarray(shape.normal))
                case _:
                    assert_never(shape)
    return artists + stamps.draw(axes, layer=6.0)


def grounds(model: Model) -> list[np.ndarray]:
    """Return the places (2,) [m] on the ground at which springs of a model end, and of walls."""
    shapes = [shape for item in model.at_points if isinstance(item, PartAtPoints) for shape in item.shapes()]
    ends = [coil.b for coil in shapes if isinstance(coil, Coil) and not isinstance(coil.b, Point)]
    return [np.asarray(place) for place in [*ends, *(wall.place for wall in shapes if isinstance(wall, Wall))]]


def _centre(only: Solution, disc: Disc) -> np.ndarray:
    """Return the centre (2,) of a mass in the only row of a solution."""
    (x, y), at = disc.offset, only.position(disc.point)[0]
    if x == 0.0 == y:
        return np.asarray(at)
    angle = float(only.rotation(disc.point)[0])
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(at + np.array([c * x - s * y, s * x + c * y]))


def joints_of(solution: Solution, row: int, stamps: Stamps) -> Stamps:
    """Add the hinges of a model in a row as circles."""
    rings = [shape for joint in solution.model.shared_joints for shape in drawn(joint, joint.shapes(), JointShape)]
    for ring in rings:
        stamps.add(solution[row : row + 1].position(ring.point)[0], symbols.HINGE, INK, 1.1, "white")
    return stamps


def _stamp(stamps: Stamps, symbol: list[np.ndarray], at: np.ndarray, down: np.ndarray, width: float = 1.0) -> None:
    for outline in symbol:
        closed = len(outline) > 2 and np.allclose(outline[0], outline[-1])
        stamps.add(at, symbols.turned(outline, down), INK, width, "white" if closed else "none")


def _away(point: Any) -> np.ndarray:
    """Direction away from the beam at its ends; below it elsewhere."""
    curve = point.beam.curve
    along = curve.tangent(np.array([point.fraction * curve.length]))[0]
    if point.fraction == 0.0:
        return -along
    return along if point.fraction == 1.0 else np.array([along[1], -along[0]])


def _springs(stamps: Stamps, spring: Springs) -> None:
    (kx, ky), at = spring.stiffness, spring.point.reference
    if kx:
        side = 1.0 if spring.point.fraction > 0.5 else -1.0
        _stamp(stamps, symbols.SPRING, at, np.array([side, 0.0]))
    if ky:
        _stamp(stamps, symbols.SPRING, at, np.array([0.0, -1.0]))
    if spring.rotational:
        _stamp(stamps, symbols.ROTATIONAL_SPRING, at, np.array([0.0, -1.0]))


def _springs_along(stamps: Stamps, foundation: SpringsAlong) -> None:
    curve = foundation.beam.curve
    kx, ky = foundation.stiffness
    for at in curve.position(np.linspace(0.0, curve.length, _SPRINGS_OF_FOUNDATION)):
        for stiffness, down in ((kx, (-1.0, 0.0)), (ky, (0.0, -1.0))):
            if stiffness:
                _stamp(stamps, symbols.SPRING, at, np.array(down), 0.7)


def _constraint(stamps: Stamps, support: Constraint, now: np.ndarray, centre: np.ndarray) -> None:
    """Draw directions prescribed as zero as a support, and prescribed motions as arrows."""
    prescribed, at = support.prescribed, support.point.reference
    fixed = {name for name, value in prescribed.items() if not callable(value) and value == 0.0}
    if fixed == {"ux", "uy", "rotation"}:
        _stamp(stamps, symbols.CLAMP, at, _away(support.point), 1.2)
    elif {"ux", "uy"} <= fixed:
        hangs = at[1] - centre[1] > abs(centre[0] - at[0])
        _stamp(stamps, symbols.PIN, at, np.array([0.0, 1.0 if hangs else -1.0]))
    else:
        for name, down in (("ux", (-1.0, 0.0)), ("uy", (0.0, -1.0))):
            if name in fixed:
                _stamp(stamps, symbols.ROLLER, now, np.array(down))
    if "rotation" in fixed and not fixed >= {"ux", "uy"}:
        _stamp(stamps, symbols.NO_TURN, now, np.array([0.0, -1.0]), 1.2)
    moved = {name: value for name, value in prescribed.items() if name not in fixed}
    signs = {name: 1.0 if callable(value) or value > 0.0 else -1.0 for name, value in moved.items()}
    for name, direction in (("ux", (1.0, 0.0)), ("uy", (0.0, 1.0))):
        if name in signs:
            _moved(stamps, now, signs[name] * np.array(direction))
    if "rotation" in signs:
        arc, head = symbols.turn(0.5 * np.pi, 1.1, 1.4 * np.pi * signs["rotation"])
        stamps.add(now, arc, PRESCRIBED, 1.4)
        stamps.add(now, head, PRESCRIBED, 0.5, PRESCRIBED)


def _moved(stamps: Stamps, at: np.ndarray, direction: np.ndarray) -> None:
    """Draw an arrow with a bar at its foot: a displacement, not a force."""
    across = np.array([-direction[1], direction[0]])
    foot, tip = 0.0 * direction, 1.6 * direction
    for outline in ([foot - 0.3 * across, foot + 0.3 * across], [foot, tip]):
        stamps.add(at, np.array(outline), PRESCRIBED, 1.4)
    head = np.array([tip, tip - 0.45 * direction + 0.2 * across, tip - 0.45 * direction - 0.2 * across])
    stamps.add(at, head, PRESCRIBED, 0.5, PRESCRIBED)
