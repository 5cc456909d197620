"""Loads of the rows of a page: where arrows stand, and how long they are on the screen."""

from typing import Any, assert_never

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.load_base import factor
from beamfem.model.load_shapes import Acceleration, Force, ForcesAlong, Moment, Strains
from beamfem.results.solution_system import loading
from beamfem.view.deformed_shapes import Shapes
from beamfem.view.load_symbols import PlacedRow

_LONGEST, _SHORTEST, _SPREAD = 40.0, 18.0, 26.0  # [pixels]: the largest force, a small one, loads along beams
_MOST = 40_000  # numbers of arrows on a page


def loads_of(shapes: Shapes) -> list[dict[str, Any]]:
    """Return for each row forces [x, y, across, up, tip], moments [x, y, sense] and gravity [across, up].

    x, y [m]; across, up [pixels]: the arrow, with its tip at x, y if `tip` is 1, else its tail. For models with many
    loads or rows, the loads of the last row are used for all.
    """
    solution, rows = shapes.solution, [int(row) for row in shapes.rows]
    system, at = loading(solution)
    loads = [_row(shapes, row, float(at[row]), system.static) for row in _chosen(shapes, rows)]
    forces = [force for row in loads for force in row["points"]]
    largest = max((float(np.linalg.norm(vector)) for _, vector, _ in forces), default=0.0) or 1.0
    dense = max((float(np.abs(vector).max()) for row in loads for _, vector in row["lines"]), default=0.0) or 1.0
    return [
        {
            "forces": [
                *(_arrow(place, _scaled(vector, largest), tip) for place, vector, tip in row["points"] if vector.any()),
                *(
                    _arrow(place, _SPREAD * vector / dense, True)
                    for places, vectors in row["lines"]
                    for place, vector in zip(places, vectors, strict=True)
                    if vector.any()
                ),
            ],
            "moments": row["moments"],
            "gravity": row["gravity"],
        }
        for row in loads
    ]


def _chosen(shapes: Shapes, rows: list[int]) -> list[int]:
    loads = shapes.solution.model.loads
    arrows = sum(55 if isinstance(load.place, Beam) else 5 for load in loads)
    return rows if arrows * len(rows) <= _MOST else rows[-1:] if arrows <= _MOST else []


def _row(shapes: Shapes, row: int, at: float, static: bool) -> dict[str, list[Any]]:
    placed = PlacedRow(shapes.solution, row)
    result: dict[str, list[Any]] = {"points": [], "lines": [], "moments": [], "gravity": []}
    for load in shapes.solution.model.loads:
        for shape in placed.shapes(load, factor(load, at, static)):
            match shape:
                case Force():
                    result["points"].append((placed.position(shape.point), shape.vector, placed.touches(shape)))
                case ForcesAlong():
                    result["lines"].append((placed.positions(shape), shape.vectors))
                case Moment():
                    if shape.moment != 0.0:
                        result["moments"].append([*_short(placed.position(shape.point)), float(np.sign(shape.moment))])
                case Acceleration():
                    if shape.vector.any():
                        result["gravity"] = _short(shape.vector / np.linalg.norm(shape.vector) * _LONGEST)
                case Strains():
                    pass  # pages have arrows only
                case _:
                    assert_never(shape)
    return result


def _scaled(vector: np.ndarray, largest: float) -> np.ndarray:
    """Return an arrow [pixels]: small forces are longer than to scale, so that they are seen."""
    size = float(np.linalg.norm(vector))
    return np.asarray(vector / size * max(_LONGEST * np.sqrt(size / largest), _SHORTEST))


def _arrow(place: np.ndarray, vector: np.ndarray, tip: bool) -> list[float]:
    return [*_short(place), *(round(float(part), 1) for part in vector), int(tip)]


def _short(values: np.ndarray) -> list[float]:
    return [float(f"{value:.6g}") for value in values]
