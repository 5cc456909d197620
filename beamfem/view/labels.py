"""Numbers beside points of a curve, where they cover neither each other nor the points nor, if possible, the curve."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from beamfem.model.model import Model

_NOTHING = 1e-9  # of the model's size: round-off of a zero


def place(model: Model, at: Sequence[float] | np.ndarray) -> str:
    """Return a point (2,) [m] to four digits, without the round-off of a zero."""
    corners = np.array([end(mesh.position, axis=0) for mesh in model.meshes for end in (np.min, np.max)])
    size = max(float(np.ptp(corners, axis=0).max()), float(np.abs(at).max()))
    x, y = (0.0 if abs(value) <= _NOTHING * size else value for value in at)
    return f"({x:.4g}, {y:.4g})"


_SIZE = 8.0  # of the text [points of print]
_MARK = 5.0  # half of the square that a mark covers [points of print]
_APART = (8.0, 18.0, 30.0, 44.0)  # distances from the point to try [points of print]
_SAME = 6.0  # equal numbers of points nearer than this are written once [points of print]
_STEP = 2.0  # between the points of a curve that are looked at [points of print]
_COVERS, _CROSSES = 1000.0, 1.0  # how bad it is to cover something, or a point of the curve


def write_labels(
    axes: Any,
    points: Sequence[tuple[float, float]],
    texts: Sequence[str],
    colours: Sequence[str],
    curve: np.ndarray,
) -> None:
    """Write a text beside each point; those that stand away from it have a line to it.

    points, curve (n, 2): in numbers of the axes, whose limits are final.
    """
    axes.figure.draw_without_rendering()  # the axes have their place from now on
    points_per_pixel = 72.0 / axes.figure.dpi

    def on_paper(given: Any) -> np.ndarray:
        return np.asarray(axes.transData.transform(np.asarray(given, dtype=float).reshape(-1, 2)) * points_per_pixel)

    # boxes (n, 2, 2): their middles and half of their sides
    places, line = on_paper(points), _dense(on_paper(curve))
    taken = [np.array([at, (_MARK, _MARK)]) for at in places]
    crossed = np.stack([line, np.zeros_like(line)], axis=1)
    frame = axes.get_window_extent()
    low, high = np.array([[frame.x0, frame.y0], [frame.x1, frame.y1]]) * points_per_pixel
    room = np.array([low + high, high - low]) / 2.0

    def badness(box: np.ndarray) -> float:
        """Return how much a text in a box would cover, and whether it is outside of the axes."""
        beyond = np.any(np.abs(box[0] - room[0]) + box[1] > room[1])
        return _COVERS * (_covered(box, np.array(taken)) + bool(beyond)) + _CROSSES * _covered(box, crossed)

    named: list[tuple[str, np.ndarray]] = []
    for point, at, text, colour in zip(points, places, texts, colours, strict=True):
        if any(text == name and np.linalg.norm(at - there) < _SAME for name, there in named):
            continue
        note = axes.annotate(text, point, fontsize=_SIZE, zorder=4, ha="center", va="center", annotation_clip=False)
        extent = note.get_window_extent()
        half = 0.5 * points_per_pixel * np.array([extent.width, extent.height]) + 1.0
        note.remove()
        # the first of equals is the nearest
        best = min((np.array([at + offset, half]) for offset in _offsets(half)), key=badness)
        taken.append(best)
        named.append((text, at))
        offset = best[0] - at
        away = np.any(np.abs(offset) > half + _APART[0] + 1.0)
        arrow = {"arrowstyle": "-", "color": "0.5", "linewidth": 0.6, "shrinkB": 4.0} if away else None
        look = {"fontsize": _SIZE, "color": colour, "zorder": 4, "arrowprops": arrow}
        note_beside(axes, text, point, offset, **look).set_in_layout(False)


def note_beside(axes: Any, text: str, at: Any, offset: Any, **look: Any) -> Any:
    """Write a text whose middle is `offset` (2,) [points of print] away from a point; return the artist."""
    return axes.annotate(text, at, offset, **{"textcoords": "offset points", "ha": "center", "va": "center"} | look)


def _covered(box: np.ndarray, others: np.ndarray) -> int:
    """Return how many of other boxes (n, 2, 2) a box (2, 2) covers."""
    return int(np.sum(np.all(np.abs(others[:, 0] - box[0]) < others[:, 1] + box[1], axis=1)))


def _offsets(half: np.ndarray) -> list[np.ndarray]:
    """Return where the middle of a text may stand, from its point: above, below, beside and across, near ones first."""
    ways = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1))
    return [
        np.array(direction) * (half + gap * (0.7 if all(direction) else 1.0)) for gap in _APART for direction in ways
    ]


def _dense(line: np.ndarray) -> np.ndarray:
    """Return points (m, 2) on a polygon (n, 2) that are near each other."""
    long = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    along = np.linspace(0.0, long[-1], 2 + int(long[-1] / _STEP))
    return np.column_stack([np.interp(along, long, component) for component in line.T])
