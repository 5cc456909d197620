"""Classes of identical elements of a beam, and the data of each for the kernels."""

from collections import defaultdict
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from beamfem.element.element import Element
from beamfem.element.fields import d_slots, r_slots
from beamfem.model.damping import retardation_time
from beamfem.model.grid import Grid
from beamfem.model.reference import (
    energy_points,
    energy_stiffness_at,
    inertia_points,
    jacobians,
    length_points,
    length_rule,
    scales,
)

_ALIKE = 1e-9  # of the longest element: lengths that differ by less are those of one class


@dataclass(frozen=True)
class Classes:
    """nc classes; kind (ne,) is the class of an element, the rest as in `kernels.block.Block`."""

    kind: np.ndarray
    scale: np.ndarray
    jacobian: np.ndarray
    jacobian_xi: np.ndarray
    weight: np.ndarray
    stiffness: np.ndarray
    reference: np.ndarray
    mass: np.ndarray
    gravity: np.ndarray
    length: np.ndarray
    damping: np.ndarray


def element_classes(grid: Grid) -> Classes:
    """Return the classes of a grid: by length on a straight prismatic beam, otherwise one per element."""
    first, kind = _likes(grid)
    element, xi, weight = energy_points(grid, first)
    count, size = len(first), len(element) // len(first)
    jacobian, jacobian_xi = jacobians(grid, element, xi)
    stiffness, reference = energy_stiffness_at(grid, element, xi)
    scale = scales(grid.beam.element, grid.lengths[first])
    mass, gravity, length = _inertia(grid, first, scale)
    damping = np.empty(count)
    damping[:] = retardation_time(grid.beam.section_at(0.0), grid.beam.material)

    def by_class(values: np.ndarray) -> np.ndarray:
        return values.reshape(count, size, *values.shape[1:])

    return Classes(
        kind,
        scale,
        by_class(jacobian),
        by_class(jacobian_xi),
        by_class(weight),
        by_class(stiffness),
        by_class(reference),
        mass,
        gravity,
        length,
        damping,
    )


def _likes(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return the first element (nc,) of each class and the class (ne,) of each element."""
    if not (grid.straight and grid.beam.prismatic):
        every = np.arange(grid.elements)
        return every, every
    longest = grid.lengths.max()
    if grid.lengths.min() >= (1.0 - 0.5 * _ALIKE) * longest:
        return np.zeros(1, dtype=np.int64), np.zeros(grid.elements, dtype=np.int64)
    lengths = np.round(grid.lengths / (_ALIKE * longest))
    _, first, kind = np.unique(lengths, return_index=True, return_inverse=True)
    return first, kind.astype(np.int64)


def likenesses(grids: Sequence[Grid]) -> list[Hashable]:
    """Return a key that straight prismatic beams of one element share if their classes are equal.

    Lengths are equal within a relative 1e-12. A beam unlike any other has its number as key.
    """
    found: list[Hashable] = list(range(len(grids)))
    if len(grids) == 1:
        return found
    sized: defaultdict[int, list[int]] = defaultdict(list)
    for number, grid in enumerate(grids):
        if grid.straight and grid.beam.prismatic:
            sized[len(grid.parameter)].append(number)
    for numbers in sized.values():
        rate = np.array([grids[i].rate for i in numbers])[:, None]
        lengths = rate * np.diff(np.array([grids[i].parameter for i in numbers]), axis=1)
        unit = 2.0 ** np.ceil(np.log2(lengths.max(axis=1)))
        rounded = np.round(lengths / unit[:, None], 12)
        for i, size, own in zip(numbers, unit.tolist(), rounded, strict=True):
            beam = grids[i].beam
            found[i] = size, own.tobytes(), by_value(beam.section), by_value(beam.material)
    return found


def by_value(item: object) -> Hashable:
    """Return the item itself, or its identity if it cannot be compared by value."""
    try:
        hash(item)
    except TypeError:
        return id(item)
    return item


def _inertia(grid: Grid, chosen: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass (nc, nv, nv), its sum against a uniform acceleration (nc, nv) and the loaded length (nc, nv)."""
    tables = _tables(grid.beam.element)
    _, _, inertia = inertia_points(grid, chosen)
    _, _, weight = length_points(grid, chosen)
    count, points = len(chosen), len(tables.r)
    mass, first, rotary = inertia.reshape(count, points, 3).transpose(2, 0, 1)
    matrix, gravity = mass @ tables.rr + rotary @ tables.dd, mass @ tables.r
    if first.any():
        matrix += first @ tables.rd
        gravity += first @ tables.d
    matrix = matrix.reshape(count, *scale.shape[1:], -1) * (scale[:, :, None] * scale[:, None, :])
    return matrix, gravity * scale, weight.reshape(count, points) @ tables.r * scale


class _Tables(NamedTuple):
    """Shape functions of r0 and d at the points that integrate mass (points, nv), and their products (points, nv nv).

    rd: of one with the other, and the transpose.
    """

    r: np.ndarray
    d: np.ndarray
    rr: np.ndarray
    dd: np.ndarray
    rd: np.ndarray


@lru_cache(maxsize=32)
def _tables(element: Element) -> _Tables:
    field = element.field
    xi, _ = length_rule(field)
    r, d = np.zeros((2, len(xi), len(field.nodes) * len(field.vectors)))
    r[:, r_slots(field)], d[:, d_slots(field)] = field.centreline(xi), field.director(xi)
    rr, dd, rd = (one[:, :, None] * other[:, None, :] for one, other in ((r, r), (d, d), (r, d)))
    return _Tables(r, d, *(product.reshape(len(xi), -1) for product in (rr, dd, rd + np.swapaxes(rd, 1, 2))))
