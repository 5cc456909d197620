"""Which rows of a solution are drawn, and how many points of each beam."""

import numpy as np

from beamfem.results.axis_points import AxisPoints
from beamfem.results.path import Path
from beamfem.results.solution import Solution

_POINTS = 4000  # of all beams in a shape
_SMOOTH, _FEWEST = 12, 100  # straight pieces that make an element, and a model of few elements, look curved
_ALIKE = 5e-4  # load factors that three digits do not tell apart


def spread_rows(solution: Solution, most: int) -> np.ndarray:
    """Return up to `most` different rows including first and last: equally spaced in time, in statics by row.

    One is the last.
    """
    if len(solution) <= most:
        return np.arange(len(solution))
    if most == 1:
        return np.array([len(solution) - 1])
    if solution.static:
        return np.unique(np.linspace(0, len(solution) - 1, most).round().astype(int))
    times = np.linspace(solution.at[0], solution.at[-1], most)
    return np.unique(np.abs(solution.at[:, None] - times).argmin(axis=0))


def axis_points(solution: Solution, total: int = _POINTS) -> list[AxisPoints]:
    """Return the points of each beam to draw, about `total` of them if there are few elements."""
    meshes = solution.model.meshes
    elements = sum(mesh.elements for mesh in meshes)
    pieces = int(np.clip(total // elements, 1, max(_SMOOTH, _FEWEST // elements)))
    return [AxisPoints.spaced(mesh, 1 if mesh.beam.element.field.degree == 1 else pieces) for mesh in meshes]


def axis_of_rows(solution: Solution) -> tuple[str, str]:
    """Return name and unit of the variable that identifies rows."""
    return ("load factor", "-") if solution.static else ("time", solution.model.unit("s"))


def moment_of(solution: Solution, row: int) -> str:
    """Return a text that identifies a row."""
    value = float(solution.at[row])
    if not solution.static:
        return f"t = {value:.3g} {solution.model.unit('s')}"
    if isinstance(solution, Path):
        return f"load factor {value:.4g}, row {row}"
    alike = np.sum(np.abs(solution.at - value) <= _ALIKE * abs(value))
    return f"load factor {value:.3g}" + (f", row {row}" if alike > 1 else "")
