"""Conditions that depend on each other, or on supports and joints: which they are, and multipliers of least norm."""

from typing import NamedTuple

import numpy as np

from beamfem.equations.bound_connector import Connector
from beamfem.equations.connectors import Connectors
from beamfem.linalg.lapack import qr, solve_triangular, svd
from beamfem.model.contribution import is_one_sided

_DEPENDENT = 1e-10  # of a condition of unit size: its part that is independent of all others
_SHARE = 1e-6  # of another condition in one that depends on it
_MET = 1e-8  # of the size of the model: gap of a condition that is left out


class Coordinates(NamedTuple):
    """Natural units (n,) of all coordinates, which of them supports hold, and normals of inclined rollers."""

    scale: np.ndarray
    held: np.ndarray
    inclined: tuple[tuple[int, np.ndarray], ...]


class Gradients(NamedTuple):
    """Gradients (k, n) of conditions along what supports leave free, and of unit size; the others are zero.

    numbers (k,): their multipliers; owners: their parts; angles (k,): whether each is an angle, not a length.
    """

    rows: np.ndarray
    sizes: np.ndarray
    numbers: np.ndarray
    owners: tuple[Connector, ...]
    angles: np.ndarray


def gradients_of(connectors: Connectors, p: np.ndarray, given: Coordinates) -> Gradients:
    """Return the gradients of all conditions that do not come and go, in a state p (n,)."""
    zeros, rows, numbers, owners = np.zeros(len(p)), [], [], []
    angles: list[bool] = []
    for item in connectors.items:
        first, count = len(item.dofs), len(item.multipliers)
        if not count or is_one_sided(item.item):
            continue
        tangent = item.tangent((p, zeros, zeros), 0.0, np.zeros(2), (1.0, 0.0, 0.0))[first : first + count, :first]
        gradients = np.zeros((count, len(p)))
        np.add.at(gradients.T, item.dofs, (tangent * given.scale[item.dofs]).T)
        rows.append(gradients)
        numbers += item.multipliers.tolist()
        owners += [item] * count
        angles += [not row.any() for row in tangent[:, ~item.turns]]
    whole = np.vstack([np.empty((0, len(p))), *rows])
    free = whole.copy()
    free[:, given.held] = 0.0
    for first, normal in given.inclined:
        free[:, first : first + 2] -= np.outer(free[:, first : first + 2] @ normal, normal)
    sizes = np.linalg.norm(free, axis=1)
    stopped = sizes <= _DEPENDENT * np.linalg.norm(whole, axis=1)
    sizes = np.where(stopped, 0.0, sizes)
    free[stopped] = 0.0
    free /= np.where(stopped, 1.0, sizes)[:, None]
    return Gradients(free, sizes, np.array(numbers, dtype=np.int64), tuple(owners), np.array(angles, dtype=bool))


def dependent_on_others(given: Gradients) -> tuple[np.ndarray, list[Connector]]:
    """Return the multipliers (d,) of conditions without which the others are independent, and all parts involved."""
    if not len(given.rows):
        return given.numbers, []
    touched = np.append(True, given.rows[:, 1:].any(axis=0))  # at least one: LAPACK refuses empty matrices
    triangle, order = qr(given.rows[:, touched].T, mode="r", pivoting=True)
    rank = int(np.count_nonzero(np.abs(np.diagonal(triangle)) > _DEPENDENT))
    involved = order[rank:].tolist()
    if 0 < rank < len(order):
        shares = np.abs(solve_triangular(triangle[:rank, :rank], triangle[:rank, rank:])).max(axis=1)
        involved += order[:rank][shares > _SHARE].tolist()
    parts = {id(given.owners[number]) for number in involved}
    return given.numbers[order[rank:]], list({id(item): item for item in given.owners if id(item) in parts}.values())


def with_least_norm(connectors: Connectors, p: np.ndarray, given: Coordinates, extent: float) -> np.ndarray:
    """Return a state p (n,) with the multipliers of least norm that exert the same forces; moments over the extent."""
    found, result = gradients_of(connectors, p, given), p.copy()
    if not len(connectors.left_out):
        return result
    lengths = np.where(found.angles, extent, 1.0)
    rows = found.rows * (found.sizes * lengths)[:, None]
    left = svd(rows, full_matrices=False)[0][:, : len(found.numbers) - len(connectors.left_out)]
    result[found.numbers] = lengths * (left @ (left.T @ (p[found.numbers] / lengths)))
    return result


def unmet(connectors: Connectors, p: np.ndarray, time: float, extent: float) -> list[Connector]:
    """Return the parts with conditions that are left out and that a state p (n,) at a time does not satisfy."""
    gaps = connectors.conditions(p, np.zeros(len(p)), time)[0]
    first = connectors.model.coordinates
    off = [number for number in connectors.left_out.tolist() if not abs(gaps[number - first]) <= _MET * extent]
    return [item for item in connectors.items if np.isin(item.multipliers, off).any()]


def in_words(parts: list[Connector]) -> str:
    """Return the names and places of parts."""
    places = (" and ".join("({:g}, {:g})".format(*point.reference) for point in item.given.points) for item in parts)
    return ", ".join(dict.fromkeys(f"{item.name} at {place}" for item, place in zip(parts, places, strict=True)))
