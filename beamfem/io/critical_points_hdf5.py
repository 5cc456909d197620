"""Limit points and bifurcations of a path in an HDF5 file."""

from typing import Any

import numpy as np

from beamfem.io.hdf5 import read_checked, write_checked
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.results.solution import Solution

_STATE = ("at", "p")
_CROSSING = ("at", "p", "mode", "tangent")


def load_factors(path: Path) -> np.ndarray:
    """Return the load factors of the critical points of a path (m,), at which its functions are evaluated too."""
    return np.array([state.at for state in (*path.limit_points, *path.bifurcations)])


def save_critical(file: Any, path: Path) -> None:
    """Write the critical points of a path, one per row."""
    for name, states, parts in _groups(path):
        group = file.create_group(name)
        for part in parts:
            write_checked(group, part, np.array([getattr(state, part) for state in states]))
        turned = [state.turned for state in states if state.turned is not None]
        if turned and turned[0].size:
            write_checked(group, "turned", np.array(turned))


def load_path(file: Any, rows: Solution) -> Solution:
    """Return the rows as the saved path with its critical points, or unchanged if no path was saved."""
    if "limit_points" not in file:
        return rows
    model, zeros = rows.model, np.zeros(rows.model.size)
    states = tuple(
        PathState(p, zeros, zeros, float(at), model, stability=False, turned=turned)
        for at, p, turned in _rows(file["limit_points"], _STATE)
    )
    crossings = tuple(
        Bifurcation(p, zeros, zeros, float(at), model, mode, tangent, stability=False, turned=turned)
        for at, p, mode, tangent, turned in _rows(file["bifurcations"], _CROSSING)
    )
    return Path(**_parts(rows), limit_points=states, bifurcations=crossings)


def _parts(solution: Solution) -> dict[str, Any]:
    """Return the members of a solution by name."""
    return {name: getattr(solution, name) for name in Solution.__dataclass_fields__}


def _groups(path: Path) -> tuple[tuple[str, tuple[PathState, ...], tuple[str, ...]], ...]:
    return ("limit_points", path.limit_points, _STATE), ("bifurcations", path.bifurcations, _CROSSING)


def _rows(group: Any, parts: tuple[str, ...]) -> Any:
    """Return the members of each state and its counted rotations, None if no beam needs them or the file is older."""
    turned = read_checked(group, "turned") if "turned" in group else [None] * len(group["at"])
    return zip(*(read_checked(group, part) for part in parts), turned, strict=True)
