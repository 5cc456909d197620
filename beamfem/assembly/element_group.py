"""The table that describes a group of similar elements to compiled code, and the arrays that it points to."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from beamfem.assembly.routines import Routines, routines
from beamfem.kernels import record
from beamfem.kernels.batch import rows_of
from beamfem.kernels.block import (
    ELASTIC_LINE,
    GRADIENTS,
    ROTATED_GRADIENTS,
    ROTATION,
    SHEAR_RIGID,
    STRETCH,
    Block,
    Imposed,
    Law,
    Layout,
    PointLoads,
)
from beamfem.kernels.pointers import address_of
from beamfem.kernels.record import LANES, ROW
from beamfem.kernels.simd import WIDTH

_CACHE = 400  # workspace rows times elements of a batch, in units of `LANES`, that fit into the cache of a core
_SMALLEST = 16
_FEW = 2048  # elements; the structure of larger groups is not cached

Needs = dict[str, tuple[tuple[str, ...], tuple[int, ...]]]


class Sizes(NamedTuple):
    """Sizes of a group that do not follow from its arrays of integers."""

    vectors: int
    points: int
    measures: int
    bends: bool
    damped: bool
    imposed: bool
    half_width: int


class Numbers(NamedTuple):
    """Arrays of integers of a group, see `kernels.block`; free (n,): equation numbers; element: those with loads."""

    node: np.ndarray
    kind: np.ndarray
    beam: np.ndarray
    node_kind: np.ndarray
    dof: np.ndarray
    home: np.ndarray
    free: np.ndarray
    element: np.ndarray


@dataclass(frozen=True, eq=False)
class Structure:
    """The part of a group that identical groups share: see `element_group.ElementGroup`.

    table: see `kernels.record`; kept: the arrays that it points to; dependent, parameters: numbers of components of
    nodal vectors that are no coordinates, and of the coordinates on which they depend; constant: node data with the
    entries that never change in any such group, None if there are none; rotated (k,): nodes with `ROTATED_GRADIENTS`,
    in storage order; used: rows of workspace.
    """

    table: np.ndarray
    kept: tuple[np.ndarray, ...]
    order: np.ndarray | None
    dependent: int
    parameters: int
    constant: np.ndarray | None
    rotated: np.ndarray
    chunks: tuple[int, int, int]
    used: int
    needs: Needs


def structure_of(block: Block, layout: Layout, loads: PointLoads) -> Structure:
    """Return the structure of a block; identical small blocks share one."""
    slots = block.scale.shape[1]
    _, points, measures = block.reference.shape
    sizes = Sizes(
        slots // block.node.shape[1],
        points,
        measures,
        block.measures == ELASTIC_LINE,
        bool(block.damping.any()),
        block.imposed is not None,
        layout.half_width,
    )
    numbers = Numbers(
        block.node, block.kind, block.beam, block.node_kind, block.dof, block.home, layout.free, loads.element
    )
    if len(block.node) > _FEW or len(layout.free) > 10 * _FEW:
        return _structure(numbers, sizes)
    return _shared(tuple((values.tobytes(), values.shape) for values in numbers), sizes)


@lru_cache(maxsize=64)
def _shared(content: tuple[tuple[bytes, tuple[int, ...]], ...], sizes: Sizes) -> Structure:
    return _structure(Numbers(*(np.frombuffer(data, np.int64).reshape(shape) for data, shape in content)), sizes)


def storage_order(node: np.ndarray, nodes: int) -> np.ndarray | None:
    """Return the nodes (N,) of elements (ne, nn) in storage order: end nodes, then inner nodes by local number.

    Nodes with the same local number in adjacent elements are then adjacent in memory. None if there are no inner nodes.
    """
    last = node.shape[1] - 1
    if last == 1:
        return None
    rank = np.zeros(nodes, dtype=np.int64)
    for inner in range(1, last):
        rank[node[:, inner]] = inner
    return np.argsort(rank, kind="stable")


def _structure(given: Numbers, sizes: Sizes) -> Structure:
    """Return the structure of a group; see `element_group.ElementGroup`."""
    order = storage_order(given.node, len(given.node_kind))
    if order is not None:
        number = np.empty_like(order)
        number[order] = np.arange(len(order))
        reordered = {name: getattr(given, name)[order] for name in ("node_kind", "dof", "home")}
        given = given._replace(node=number[given.node], **reordered)
    elements, nodes = given.node.shape
    count, coordinates = given.dof.shape
    size = 2 * sizes.vectors
    kinds = tuple(np.unique(given.node_kind).tolist())
    dependent = 4 if STRETCH in kinds or SHEAR_RIGID in kinds else (0 if set(kinds) <= {GRADIENTS} else 2)
    parameters = coordinates - (size - dependent) if dependent else 0
    table = np.zeros(record.BLOCK_FIELDS, dtype=np.int64)
    table_rows = _table_rows(table, nodes * sizes.vectors, sizes)
    velocity = 2 * size + 2 * dependent * parameters
    gathered = velocity + size * sizes.damped
    chunk_rows = gathered + parameters * parameters + 2 * size
    table[record.ACCELERATION], table[record.TRANSFORM] = size, 2 * size
    table[record.CONVECTIVE] = 2 * size + dependent * parameters
    table[record.VELOCITY], table[record.DAMPED] = velocity, sizes.damped
    table[record.CURVATURE], table[record.FORCE] = gathered, gathered + parameters * parameters
    table[record.PREDICTED_FORCE], table[record.NODE_ROWS] = gathered + parameters * parameters + size, chunk_rows
    used = rows_of(nodes, sizes.vectors, sizes.points, gathered, table_rows)[-1]
    batch = LANES
    while batch > _SMALLEST and used * batch > _CACHE * LANES:
        batch //= 2
    offsets = given.node // LANES * (chunk_rows * ROW) + given.node % LANES
    number = np.where(given.dof >= 0, given.free[given.dof], -1)[given.node].reshape(elements, -1)
    runs = _runs(given.node_kind)
    arrays = {
        record.CLASS: given.kind,
        record.BEAM: given.beam,
        record.PLACE: offsets.T,
        record.DOF: given.dof.T,
        record.SOURCE: np.append(np.maximum(given.dof.T, 0), np.zeros(WIDTH, dtype=np.int64)),
        record.RUNS: runs,
        record.NUMBER: number.T,
        record.FREE: given.free,
        record.HOME: given.home,
        record.LOAD_ELEMENT: given.element,
        record.LOAD_PLACE: offsets[given.element].T,
        record.LOAD_NUMBER: number[given.element].T,
        record.COUNTED: np.arange(elements) if sizes.half_width < 0 else np.empty(0, dtype=np.int64),
    }
    kept = []
    for field, values in arrays.items():
        kept.append(np.ascontiguousarray(values, dtype=np.int64))
        table[field] = address_of(kept[-1])
    table[record.ELEMENTS], table[record.NODES], table[record.NODES_PER_ELEMENT] = elements, count, nodes
    table[record.ORDERED] = (np.diff(given.node, axis=0) > 0).all()
    table[record.VECTORS], table[record.POINTS] = sizes.vectors, sizes.points
    table[record.MEASURES], table[record.BENDS] = sizes.measures, sizes.bends
    table[record.DEPENDENT], table[record.PARAMETERS] = dependent, parameters
    table[record.BATCH], table[record.TABLE_ROWS], table[record.COORDINATES] = batch, table_rows, coordinates
    table[record.RUN_COUNT], table[record.HALF_WIDTH] = len(runs), sizes.half_width
    table[record.LOADS] = len(given.element)
    needs = _needs(kinds, sizes, bool(len(given.element)))
    chunks = -(-count // LANES), chunk_rows, ROW
    rotated, constant = np.flatnonzero(given.node_kind == ROTATED_GRADIENTS), None
    if (dependent and len(kinds) > 1) or len(rotated):
        constant = _constant(given.node_kind, chunks, size, dependent, parameters)
    return Structure(table, tuple(kept), order, dependent, parameters, constant, rotated, chunks, used, needs)


def _constant(
    node_kind: np.ndarray, shape: tuple[int, int, int], size: int, dependent: int, parameters: int
) -> np.ndarray:
    """Return node data with the entries that never change: B of nodes whose coordinates are nodal vectors."""
    chunks = np.zeros(shape)
    for part in range(dependent):
        straight = node_kind == GRADIENTS
        if part < dependent - 2:
            straight |= (node_kind == ROTATION) | (node_kind == ROTATED_GRADIENTS)
        nodes = np.flatnonzero(straight)
        chunks[nodes // LANES, 2 * size + part * parameters + (part if part < parameters else 0), nodes % LANES] = 1.0
    return chunks


def _table_rows(table: np.ndarray, slots: int, sizes: Sizes) -> int:
    """Set the offset of each quantity in the row of a class; return the length of the row."""
    points, measures = sizes.points, sizes.measures
    lengths = {
        record.SLOPE: points * slots,
        record.SECOND: points * slots * sizes.bends,
        record.STIFFNESS: points * measures * (measures + 1) // 2,
        record.REFERENCE: points * measures,
        record.WEIGHT: points,
        record.MASS: slots * slots,
        record.GRAVITY: slots,
        record.LENGTH: slots,
        record.DAMPING: int(sizes.damped),
    }
    first = 0
    for field, length in lengths.items():
        if length or field != record.DAMPING:
            table[field] = first
        first += length
    return first


def _needs(kinds: tuple[int, ...], sizes: Sizes, loads: bool) -> Needs:
    """Return the parts of `Routines` that each task needs, and the kinds of nodes with an angle."""
    angles = tuple(kind - ROTATION for kind in kinds if kind in (ROTATION, STRETCH, SHEAR_RIGID))
    rotated = ("rotated",) if ROTATED_GRADIENTS in kinds else ()
    rotates = bool(angles or rotated)
    forces = ("forces", *(("angles",) if angles else ()), *rotated, *(("loads",) if loads else ()))
    forces += (*(("damping",) if sizes.damped else ()), *(("imposed",) if sizes.imposed else ()))
    tangent = ["tangent", "band" if sizes.half_width >= 0 else "sparse"]
    tangent += ["rotation tangent"] if rotates else []
    tangent += ["load tangent"] if loads else []
    tangent += ["rotation load tangent"] if loads and rotates else []
    parts = {"forces": forces, "tangent": tuple(tangent), "mass": ("mass",), "prediction": ("prediction",)}
    return {task: (names, angles) for task, names in parts.items()}


def _runs(node_kind: np.ndarray) -> np.ndarray:
    """Return kind, first node and number of nodes (runs, run fields) of each run of consecutive nodes of one kind."""
    first = np.flatnonzero(np.diff(node_kind, prepend=-1))
    return np.column_stack([node_kind[first], first, np.diff(first, append=len(node_kind))])


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
    constant, space = _constant_of_nodes(structure, 2 * vectors, frame), structure.used * ROW
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


def _constant_of_nodes(structure: Structure, size: int, frame: np.ndarray) -> np.ndarray | None:
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
