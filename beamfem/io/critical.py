"""Limit points and bifurcations of a path in an HDF5 file."""

from typing import Any

import numpy as np

from beamfem.io.hdf5 import read_checked, write_checked
from beamfem.path import Bifurcation, Path, PathState
from beamfem.solution import Solution

_STATE = ("at", "p")
_CROSSING = ("at", "p", "mode", "tangent")


def save_critical(file: Any, path: Path) -> None:
    """Write the critical points of a path, each a row."""
    for name, states, parts in _groups(path):
        group = file.create_group(name)
        for part in parts:
            write_checked(group, part, np.array([getattr(state, part) for state in states]))


def load_path(file: Any, rows: Solution) -> Solution:
    """Return the rows as the path that was saved, with its critical points; as they are where it was none."""
    if "limit_points" not in file:
        return rows
    model, rest = rows.model, np.zeros(rows.model.size)
    states = tuple(
        PathState(p, rest, rest, float(at), model, stability=False) for at, p in _rows(file["limit_points"], _STATE)
    )
    crossings = tuple(
        Bifurcation(p, rest, rest, float(at), model, mode, tangent, stability=False)
        for at, p, mode, tangent in _rows(file["bifurcations"], _CROSSING)
    )
    return Path(**_parts(rows), limit_points=states, bifurcations=crossings)


def _parts(solution: Solution) -> dict[str, Any]:
    """Return what a solution consists of, by name."""
    return {name: getattr(solution, name) for name in Solution.__dataclass_fields__}


def _groups(path: Path) -> tuple[tuple[str, tuple[PathState, ...], tuple[str, ...]], ...]:
    return ("limit_points", path.limit_points, _STATE), ("bifurcations", path.bifurcations, _CROSSING)


def _rows(group: Any, parts: tuple[str, ...]) -> Any:
    return zip(*(read_checked(group, part) for part in parts), strict=True)
