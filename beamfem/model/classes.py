"""Classes of identical elements of a beam, and the data of each for the kernels."""

from collections import defaultdict
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.element.fields import d_slots, r_slots
from beamfem.model.damping import retardation_time
from beamfem.model.grid import Grid
from beamfem.model.reference import energy_points, energy_stiffness_at, inertia_points, jacobians, length_points, scales


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
    if grid.straight and grid.beam.prismatic:
        _, first, kind = np.unique(
            np.round(grid.lengths / grid.lengths.max(), 9), return_index=True, return_inverse=True
        )
    else:
        first = kind = np.arange(grid.elements)
    element, xi, weight = energy_points(grid, first)
    count, size = len(first), len(element) // len(first)
    jacobian, jacobian_xi = jacobians(grid, element, xi)
    stiffness, reference = energy_stiffness_at(grid, element, xi)
    scale = scales(grid.beam.element, grid.lengths[first])
    mass, gravity, length = _inertia(grid, first, scale)

    def by_class(values: np.ndarray) -> np.ndarray:
        return values.reshape(count, size, *values.shape[1:])

    return Classes(
        kind.astype(np.int64),
        scale,
        by_class(jacobian),
        by_class(jacobian_xi),
        by_class(weight),
        by_class(stiffness),
        by_class(reference),
        mass,
        gravity,
        length,
        np.full(count, retardation_time(grid.beam.section_at(0.0), grid.beam.material)),
    )


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
    field = grid.beam.element.field
    where, xi, inertia = inertia_points(grid, chosen)
    count = len(chosen)
    r = np.zeros((count, len(where) // count, scale.shape[1]))
    d = np.zeros_like(r)
    r[:, :, r_slots(field)] = field.centreline(xi).reshape(count, r.shape[1], -1)
    d[:, :, d_slots(field)] = field.director(xi).reshape(count, r.shape[1], -1)
    r *= scale[:, None, :]
    mass, first, rotary = np.moveaxis(inertia.reshape(count, r.shape[1], 3), -1, 0)
    mixed = np.einsum("cq,cqi,cqj->cij", first, r, d)
    matrix = np.einsum("cq,cqi,cqj->cij", mass, r, r) + np.einsum("cq,cqi,cqj->cij", rotary, d, d)
    matrix += mixed + np.swapaxes(mixed, 1, 2)
    gravity = np.einsum("cq,cqi->ci", mass, r) + np.einsum("cq,cqi->ci", first, d)
    _, _, weight = length_points(grid, chosen)
    length = np.einsum("cq,cqi->ci", weight.reshape(count, -1), r)
    return matrix, gravity, length
