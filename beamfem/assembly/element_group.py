"""The table that describes a group of similar elements to compiled code, and the arrays that it points to."""

from dataclasses import dataclass

import numpy as np

from beamfem.assembly.group_structure import Needs, Structure, structure_of
from beamfem.assembly.routines import Routines, routines
from beamfem.kernels import record
from beamfem.kernels.block import (
    ELASTIC_LINE,
    Block,
    Imposed,
    Law,
    Layout,
    PointLoads,
)
from beamfem.kernels.pointers import address_of
from beamfem.kernels.record import LANES, ROW
from beamfem.kernels.simd import WIDTH

_PADDING = np.zeros(WIDTH)  # vectors of lanes read beyond the last node
_UPPER = {measures: np.flatnonzero(np.triu(np.ones((measures, measures)))) for measures in (4, 6)}


@dataclass(frozen=True, eq=False)
class ElementGroup:
    """A group of similar elements in the form that compiled code expects.

    table: see `kernels.record`, without workspace; kept: the arrays that it points to; chunks: shape of the node data;
    space: floats of scratch memory; order (N,): node numbers in storage order, None if they are stored as numbered;
    constant: node data with the entries that never change, None if there are none; needs: routines of each task; law:
    section law that the routines call, None if it is linear.
    """

    table: np.ndarray
    kept: tuple[np.ndarray, ...]
    chunks: tuple[int, int, int]
    space: int
    order: np.ndarray | None
    constant: np.ndarray | None
    routines: Routines
    needs: Needs
    law: Law | None
    imposed: Imposed | None

    def require(self, *tasks: str) -> None:
        """Compile the routines of tasks: "forces", "tangent", "mass" or "prediction"."""
        for task in tasks:
            self.routines.require(*self.needs[task])

    @property
    def points(self) -> tuple[int, int, int]:
        """Numbers of elements, quadrature points and strain measures."""
        t = self.table
        return int(t[record.ELEMENTS]), int(t[record.POINTS]), int(t[record.MEASURES])


def stored(block: Block, order: np.ndarray | None) -> Block:
    """Return a block with its nodes numbered in storage order (N,)."""
    if order is None:
        return block
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    reordered = {name: getattr(block, name)[order] for name in ("node_kind", "frame", "dof", "home")}
    return block._replace(node=number[block.node], **reordered)


def make_group(block: Block, layout: Layout, loads: PointLoads) -> ElementGroup:
    """Return the group of a block."""
    structure, element_routines = structure_of(block, layout, loads), _routines(block)
    classes, nodes = len(block.scale), block.node.shape[1]
    vectors, order = block.scale.shape[1] // nodes, structure.order
    upper = _UPPER[block.reference.shape[2]]
    parts = [
        block.slope.reshape(classes, -1),
        block.second.reshape(classes, -1) if block.second.size else np.empty((classes, 0)),
        block.stiffness.reshape(*block.stiffness.shape[:2], -1).take(upper, axis=2).reshape(classes, -1),
        block.reference.reshape(classes, -1),
        block.weight,
        block.mass.reshape(classes, -1),
        block.gravity,
        block.length,
        *((block.damping[:, None],) if structure.table[record.DAMPED] else ()),
    ]
    table, frame = structure.table.copy(), block.frame if order is None else block.frame[order]
    mixed = block.mass.reshape(classes, nodes, vectors, nodes, vectors)[..., :-1, :, -1]
    table[record.APART] = not mixed.any()
    arrays = {
        record.TABLES: np.concatenate(parts, axis=1),
        record.DIRECTOR: block.director,
        record.FRAME: np.concatenate((frame.T.ravel(), _PADDING)),
    }
    slot, history = np.ascontiguousarray(layout.slot, dtype=np.int32), np.ascontiguousarray(block.history)
    kept = [*structure.kept, slot, element_routines.addresses, history]
    table[record.SLOT], table[record.ROUTINES], table[record.HISTORY] = (address_of(array) for array in kept[-3:])
    table[record.VARIABLES] = history.shape[-1]
    for field, values in arrays.items():
        kept.append(np.ascontiguousarray(values, dtype=float))
        table[field] = address_of(kept[-1])
    if len(loads.element):
        kept.append(_add_loads(table, loads))
    constant, space = _constant(structure, 2 * vectors, frame), structure.used * ROW
    needs, law = structure.needs, block.law
    return ElementGroup(
        table, tuple(kept), structure.chunks, space, order, constant, element_routines, needs, law, block.imposed
    )


def _add_loads(table: np.ndarray, loads: PointLoads) -> np.ndarray:
    """Set the addresses of the tables of point loads; return the memory that they share."""
    arrays = {
        record.POSITION: loads.position,
        record.DIRECTION: loads.direction,
        record.FOLLOWS: loads.follows,
        record.STRETCHES: loads.stretches,
        record.SPRING: loads.spring,
        record.ANCHOR: loads.anchor,
    }
    memory = np.concatenate([values.T.ravel() for values in arrays.values()], dtype=float)
    address = address_of(memory)
    for field, values in arrays.items():
        table[field] = address
        address += memory.itemsize * values.size
    return memory


def _routines(block: Block) -> Routines:
    nodes = block.node.shape[1]
    vectors, bends = block.scale.shape[1] // nodes, int(block.measures == ELASTIC_LINE)
    sizes = (("nodes", nodes), ("vectors", vectors), ("bends", bends))
    return routines(block.measures, sizes) if block.law is None else Routines(block.measures, sizes, block.law.address)


def _constant(structure: Structure, size: int, frame: np.ndarray) -> np.ndarray | None:
    """Return node data with the entries that never change; frame (N, 3): of nodes in storage order."""
    rotated, dependent, parameters = structure.rotated, structure.dependent, structure.parameters
    if structure.constant is None or not len(rotated):
        return structure.constant
    chunks = structure.constant.copy()
    c, s = frame[rotated, 0], frame[rotated, 1]
    for part, column, value in ((2, 2, c), (2, 1, -s), (1, 2, s), (1, 1, c)):
        chunks[rotated // LANES, 2 * size + (dependent - part) * parameters + parameters - column, rotated % LANES] = (
            value
        )
    return chunks
