"""One long chain cut into two halves with their own numbering, so that two threads can work on them."""

import os
from dataclasses import dataclass

import numpy as np

from beamfem.assembly.assembler import Assembler, Equations
from beamfem.assembly.chain_parts import block_of, is_chain, loads_of
from beamfem.assembly.element_group import make_group
from beamfem.assembly.equations import STATICS
from beamfem.assembly.layout import Mesh, reaches
from beamfem.assembly.system import System
from beamfem.kernels.block import Springs

_LONG = 20_000  # elements; in shorter chains two threads gain little


@dataclass(frozen=True, eq=False)
class Substructure:
    """The elements on one side of the cut: their data, their state and the workspace of a step.

    place: its coordinates among those of the chain; free: its unknown coordinates in the order of elimination, from the
    far end to the node at the cut, whose coordinates come last, from `inner` on; equations: those of this half, under
    its loads; rows (unknown, width): its band; reach (unknown,): see `layout.reaches`.
    """

    place: slice
    free: np.ndarray
    inner: int
    equations: Assembler
    inverse_scale: np.ndarray
    p: np.ndarray
    zeros: np.ndarray
    step: np.ndarray
    residual: np.ndarray
    right: np.ndarray
    rows: np.ndarray
    reach: np.ndarray

    def balance(self, predicted: bool, matrix: np.ndarray) -> None:
        """Fill the residual and, unless it is empty, the matrix; predicted: see `Assembler.balance`."""
        self.equations.balance(self.p, self.zeros, self.zeros, self.residual, matrix, predicted)


def worth_cutting(system: System, elements: int = _LONG) -> bool:
    """Return whether a model is a chain of so many elements that can be cut, and two cores are available."""
    long = is_chain(system) and len(system.blocks[0].node) >= elements
    return long and usable_cores() > 1 and len(_cuts(system)) > 0


def _cuts(system: System) -> np.ndarray:
    """Return the elements of a chain that share their first node with the previous one.

    At a corner of the curve two nodes coincide, and nothing is shared.
    """
    node = system.blocks[0].node
    return 1 + np.flatnonzero(node[1:, 0] == node[:-1, -1])


def usable_cores() -> int:
    """Return the number of cores this process may use, at most OMP_NUM_THREADS as in linear algebra."""
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    limit = os.environ.get("OMP_NUM_THREADS", "")
    return min(allowed, int(limit)) if limit.isdecimal() else allowed


def substructures_of(system: System, start: np.ndarray, load_factor: float) -> tuple[Substructure, Substructure]:
    """Return the halves of a chain in the state `start` (n,), cut at the node nearest to the middle element."""
    (block,), size = system.blocks, len(start)
    cuts = _cuts(system)
    cut = int(cuts[len(cuts) // 2])
    shared = block.dof[block.node[cut, 0]]
    shared = shared[shared >= 0]
    first, end = int(shared.min()), int(shared.max()) + 1
    unknown = int((system.unknowns.free[shared] >= 0).sum())
    # springs of the shared node belong to the second half
    sprung = system.springs.dof < first
    return (
        _half(system, start, load_factor, slice(0, cut), slice(0, end), sprung, unknown),
        _half(system, start, load_factor, slice(cut, len(block.node)), slice(first, size), ~sprung, unknown),
    )


def _half(
    system: System,
    start: np.ndarray,
    load_factor: float,
    elements: slice,
    place: slice,
    sprung: np.ndarray,
    shared: int,
) -> Substructure:
    (whole,), (loads,), (layout,), (values,) = (
        system.blocks,
        system.point_loads,
        system.layouts,
        system.point_values(load_factor),
    )
    block, size, half_width = block_of(whole, elements, place.start), place.stop - place.start, layout.half_width
    order = np.flatnonzero(layout.free[place] >= 0)
    if place.start > 0:
        order = order[::-1].copy()
    free = np.full(size, -1, dtype=np.int64)
    free[order] = np.arange(len(order))
    points, loaded = loads_of(loads, elements)
    dof, stiffness, zeros, _ = (column[sprung] for column in system.springs)
    number = free[dof - place.start]
    diagonal = np.where(number >= 0, number * (2 * half_width + 1) + half_width, -1)
    springs = Springs(dof - place.start, stiffness, zeros, diagonal)
    equations = Assembler(Equations((make_group(block, layout._replace(free=free), points),), springs, size))
    equations.load(system.body(load_factor), (values[loaded],), system.imposing(load_factor))
    equations.weigh(STATICS)
    return Substructure(
        place=place,
        free=order,
        inner=len(order) - shared,
        equations=equations,
        inverse_scale=1.0 / system.scale[place],
        p=start[place].copy(),
        zeros=np.zeros(size),
        step=np.empty(size),
        residual=np.empty(size),
        right=np.empty(len(order)),
        rows=np.empty((len(order), 2 * half_width + 1)),
        reach=reaches((Mesh(block.node, block.dof),), free, len(order))[0],
    )
