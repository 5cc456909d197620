"""Classes of identical elements of a beam, and the data of each for the kernels."""

from collections import defaultdict
from collections.abc import Hashable, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from beamfem.alike import by_value, lasting
from beamfem.element.element import Element, kept_with_elements
from beamfem.element.fields import d_slots, r_slots
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.material import Material
from beamfem.model.damping import retardation_time
from beamfem.model.grid import Grid
from beamfem.model.reference import (
    energy_points,
    energy_stiffness_at,
    inertia_at,
    jacobians,
    length_points,
    length_rule,
    scales,
)

_FEW = 2000  # elements; the classes of larger grids are not cached
_ALIKE = 1e-9  # of the longest element: elements whose lengths differ by less are in one class


class Classes(NamedTuple):
    """Data of nc classes; kind (ne,) is the class of each element, the rest as in `kernels.block.Block`."""

    kind: np.ndarray
    slope: np.ndarray
    second: np.ndarray
    scale: np.ndarray
    jacobian: np.ndarray
    weight: np.ndarray
    stiffness: np.ndarray
    reference: np.ndarray
    mass: np.ndarray
    gravity: np.ndarray
    length: np.ndarray
    damping: np.ndarray


def element_classes(grid: Grid) -> Classes:
    """Return the classes of a grid: by length on a straight prismatic beam, otherwise one per element."""
    beam, few = grid.beam, grid.elements <= _FEW
    # studies repeatedly make identical beams
    if few and grid.straight and lasting(beam.element, beam.section, beam.material):
        x, y = grid.tangent[0].tolist()
        known = _known(beam.element, by_value(beam.section), beam.material, grid.lengths.tobytes(), x, y)
        if not known:
            known.append(_read_only(_classes(grid)))
        return known[0]
    return _read_only(_classes(grid))


def _read_only(classes: Classes) -> Classes:
    """Return the classes, whose arrays beams that are alike share."""
    for values in classes:
        values.setflags(write=False)
    return classes


@lru_cache(maxsize=64)
def _known(
    element: Element, section: Hashable, material: Material | None, lengths: bytes, x: float, y: float
) -> list[Classes]:
    """Return a list for the classes of straight prismatic beams that are alike in all this, empty at first."""
    return []


def _classes(grid: Grid) -> Classes:
    first, kind = _likes(grid)
    element, xi, weight = energy_points(grid, first)
    count, size = len(first), len(element) // len(first)
    stiffness, reference = energy_stiffness_at(grid, element, xi)
    scale = scales(grid.beam.element, grid.lengths[first])
    mass, gravity, length = _inertia(grid, first, scale)
    damping = np.full(count, retardation_time(grid.beam.section_at(0.0), grid.beam.material))

    def by_class(values: np.ndarray) -> np.ndarray:
        return values.reshape(count, size, *values.shape[1:])

    jacobian, jacobian_xi = map(by_class, jacobians(grid, element, xi))
    slope, second = _derivatives(grid.beam.element, scale, jacobian, jacobian_xi)
    weight, stiffness, reference = map(by_class, (weight, stiffness, reference))
    shapes = kind, slope, second, scale, jacobian
    return Classes(*shapes, weight, stiffness, reference, mass, gravity, length, damping)


def _derivatives(
    element: Element, scale: np.ndarray, jacobian: np.ndarray, jacobian_xi: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return dN/ds (nc, nq, nv) at the points of the energy, and d2N/ds2, empty except for the elastic line.

    scale (nc, nv): scale of the nodal vectors, included in N; jacobian, jacobian_xi (nc, nq): ds/dxi [m] and its
    derivative.
    """
    table, curved = _slopes(element)
    scaled, inverse = scale[:, None, :], 1.0 / jacobian[:, :, None]
    second = np.empty((len(scale), 0, 0))
    if element.forces.code == ELASTIC_LINE:
        second = np.ascontiguousarray((curved - jacobian_xi[:, :, None] * inverse * table) * scaled * inverse**2)
    return np.ascontiguousarray(table * scaled * inverse), second


@kept_with_elements
def _slopes(element: Element) -> tuple[np.ndarray, np.ndarray]:
    """Return dN/dxi (nq, nv) for r0 and d, and d2N/dxi2 for r0, at the points of the energy."""
    basis, (xi, _) = element.field, element.energy_points()
    table, curved = np.zeros((2, len(xi), len(basis.nodes) * len(basis.vectors)))
    table[:, r_slots(basis)], table[:, d_slots(basis)] = basis.centreline(xi, 1), basis.director(xi, 1)
    curved[:, r_slots(basis)] = basis.centreline(xi, 2)
    return table, curved


def _likes(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return the first element (nc,) of each class and the class (ne,) of each element."""
    if not (grid.straight and grid.beam.prismatic):
        every = np.arange(grid.elements)
        return every, every
    lengths = grid.lengths
    longest = lengths.max()
    if lengths.min() >= (1.0 - 0.5 * _ALIKE) * longest:
        return np.zeros(1, dtype=np.int64), np.zeros(grid.elements, dtype=np.int64)
    rounded = np.round(lengths / (_ALIKE * longest))
    _, first, kind = np.unique(rounded, return_index=True, return_inverse=True)
    return first, kind.astype(np.int64)


def likenesses(grids: Sequence[Grid]) -> list[Hashable]:
    """Return for each grid a key that straight prismatic beams of one element share if their classes are equal.

    Lengths are compared to a relative 1e-12. Any other beam has its number as key.
    """
    keys: list[Hashable] = list(range(len(grids)))
    if len(grids) == 1:
        return keys
    sized: defaultdict[int, list[int]] = defaultdict(list)
    for number, grid in enumerate(grids):
        if grid.straight and grid.beam.prismatic:
            sized[len(grid.parameter)].append(number)
    for numbers in sized.values():
        rate = np.array([grids[i].rate for i in numbers])[:, None]
        lengths = rate * np.diff(np.array([grids[i].parameter for i in numbers]), axis=1)
        unit = 2.0 ** np.ceil(np.log2(lengths.max(axis=1)))
        rounded = np.round(lengths / unit[:, None], 12)
        for i, size, row in zip(numbers, unit.tolist(), rounded, strict=True):
            beam = grids[i].beam
            keys[i] = size, row.tobytes(), by_value(beam.section), by_value(beam.material)
    return keys


def _inertia(grid: Grid, chosen: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return mass (nc, nv, nv), load of a uniform acceleration (nc, nv) and load of a uniform force (nc, nv)."""
    tables = _tables(grid.beam.element)
    where, at, weight = length_points(grid, chosen)
    inertia = inertia_at(grid, where, at, weight)
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

    rd: product of those of r0 and d plus its transpose.
    """

    r: np.ndarray
    d: np.ndarray
    rr: np.ndarray
    dd: np.ndarray
    rd: np.ndarray


@kept_with_elements
def _tables(element: Element) -> _Tables:
    basis = element.field
    xi, _ = length_rule(basis)
    r, d = np.zeros((2, len(xi), len(basis.nodes) * len(basis.vectors)))
    r[:, r_slots(basis)], d[:, d_slots(basis)] = basis.centreline(xi), basis.director(xi)
    rr, dd, rd = (one[:, :, None] * other[:, None, :] for one, other in ((r, r), (d, d), (r, d)))
    return _Tables(r, d, *(product.reshape(len(xi), -1) for product in (rr, dd, rd + np.swapaxes(rd, 1, 2))))
