"""The table that describes a group of like elements to compiled code, and the space that one solve works in."""

from dataclasses import dataclass

import numpy as np

from beamfem.assembly.routines import Routines, routines
from beamfem.kernels import record
from beamfem.kernels.batch import rows_of
from beamfem.kernels.block import (
    ELASTIC_LINE,
    GRADIENTS,
    ROTATION,
    SHEAR_RIGID,
    STRETCH,
    TURNED_GRADIENTS,
    Block,
    Imposed,
    Law,
    Layout,
    PointLoads,
)
from beamfem.kernels.lanes import WIDTH
from beamfem.kernels.pointers import address_of
from beamfem.kernels.record import LANES, ROW

_CACHE = 400  # rows of work space times elements of a batch, in units of `LANES`, that stay in the cache near the core
_SMALLEST = 16


@dataclass(frozen=True, eq=False)
class Sheet:
    """A group of like elements as compiled code takes it.

    table: see `kernels.record`, without work space; kept: the arrays whose addresses it holds, law: one whose address
    its routines hold; order (N,): nodes of the group as they are stored, None if as they are numbered.
    """

    table: np.ndarray
    kept: tuple[np.ndarray, ...]
    chunks: tuple[int, int, int]
    space: int
    order: np.ndarray | None
    constant: np.ndarray | None
    routines: Routines
    needs: dict[str, tuple[tuple[str, ...], tuple[int, ...]]]
    law: Law | None
    imposed: Imposed | None

    def require(self, *tasks: str) -> None:
        """Have everything compiled that these tasks need: forces, tangent, mass, prediction."""
        for task in tasks:
            self.routines.require(*self.needs[task])

    @property
    def points(self) -> tuple[int, int, int]:
        """Elements, quadrature points and measures."""
        t = self.table
        return int(t[record.ELEMENTS]), int(t[record.POINTS]), int(t[record.MEASURES])


def storage_order(block: Block) -> np.ndarray | None:
    """Return the nodes (N,) of a block as they are stored: those at ends of elements, then the inner ones by place.

    So nodes of the same place in neighbouring elements are neighbours. None if there are no inner ones.
    """
    last = block.node.shape[1] - 1
    if last == 1:
        return None
    place = np.zeros(len(block.node_kind), dtype=np.int64)
    for inner in range(1, last):
        place[block.node[:, inner]] = inner
    return np.argsort(place, kind="stable")


def stored(block: Block, order: np.ndarray | None) -> Block:
    """Return a block with its nodes numbered as they are stored."""
    if order is None:
        return block
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    own = {name: getattr(block, name)[order] for name in ("node_kind", "frame", "dof", "home")}
    return block._replace(node=number[block.node], **own)


def make_sheet(block: Block, layout: Layout, loads: PointLoads) -> Sheet:
    """Return the sheet of a block."""
    order = storage_order(block)
    block = stored(block, order)
    elements, nodes = block.node.shape
    count, coordinates = block.dof.shape
    slots = block.scale.shape[1]
    vectors = slots // nodes
    size = 2 * vectors
    classes, points, measures = block.reference.shape
    bends = int(block.measures == ELASTIC_LINE)
    kinds = np.unique(block.node_kind) if len(block.node_kind) else np.empty(0, dtype=int)
    turned = 4 if np.isin(kinds, (STRETCH, SHEAR_RIGID)).any() else (0 if (kinds == GRADIENTS).all() else 2)
    turning = coordinates - (size - turned) if turned else 0
    upper = np.triu_indices(measures)
    parts = {
        record.SLOPE: block.slope.reshape(classes, -1),
        record.SECOND: block.second.reshape(classes, -1) if bends else np.empty((classes, 0)),
        record.STIFFNESS: block.stiffness[:, :, upper[0], upper[1]].reshape(classes, -1),
        record.REFERENCE: block.reference.reshape(classes, -1),
        record.WEIGHT: block.weight,
        record.MASS: block.mass.reshape(classes, -1),
        record.GRAVITY: block.gravity,
        record.LENGTH: block.length,
    }
    damped = bool(block.damping.any())
    if damped:
        parts[record.DAMPING] = block.damping[:, None]
    table, own = np.zeros(record.BLOCK_FIELDS, dtype=np.int64), _routines(block)
    first = 0
    for number, part in parts.items():
        table[number] = first
        first += part.shape[1]
    tables = np.concatenate(list(parts.values()), axis=1)
    velocity = 2 * size + 2 * turned * turning
    gathered = velocity + size * damped
    chunk_rows = gathered + turning * turning + 2 * size
    table[record.ACCELERATION], table[record.TRANSFORM] = size, 2 * size
    table[record.CONVECTIVE] = 2 * size + turned * turning
    table[record.VELOCITY], table[record.DAMPED] = velocity, damped
    table[record.APART] = not block.mass.reshape(classes, nodes, vectors, nodes, vectors)[..., :-1, :, -1].any()
    table[record.CURVATURE], table[record.FORCE] = gathered, gathered + turning * turning
    table[record.PREDICTED_FORCE], table[record.NODE_ROWS] = gathered + turning * turning + size, chunk_rows
    used = rows_of(nodes, vectors, points, gathered, tables.shape[1])[-1]
    batch = LANES
    while batch > _SMALLEST and used * batch > _CACHE * LANES:
        batch //= 2
    place = _places(block.node, chunk_rows)
    number = np.where(block.dof >= 0, layout.free[block.dof], -1)[block.node].reshape(elements, -1)
    arrays = {
        record.TABLES: tables,
        record.DIRECTOR: block.director,
        record.CLASS: block.kind,
        record.BEAM: block.beam,
        record.PLACE: place.T,
        record.DOF: block.dof.T,
        record.SOURCE: np.append(np.maximum(block.dof.T, 0), np.zeros(WIDTH, dtype=np.int64)),
        record.FRAME: np.append(block.frame.T, np.zeros(WIDTH)),  # read in vectors, beyond the last node too
        record.RUNS: _runs(block.node_kind),
        record.NUMBER: number.T,
        record.SLOT: layout.slot,
        record.FREE: layout.free,
        record.HOME: block.home,
        record.LOAD_ELEMENT: loads.element,
        record.POSITION: loads.position.T,
        record.DIRECTION: loads.direction.T,
        record.FOLLOWS: loads.follows.T,
        record.STRETCHES: loads.stretches.astype(float),
        record.SPRING: loads.spring.T,
        record.ANCHOR: loads.anchor.T,
        record.LOAD_PLACE: place[loads.element].T,
        record.LOAD_NUMBER: number[loads.element].T,
        record.COUNTED: np.arange(elements) if layout.half_width < 0 else np.empty(0, dtype=np.int64),
        record.ROUTINES: own.addresses,
        record.HISTORY: block.history,
    }
    kept = []
    for field, values in arrays.items():
        kind = np.int32 if field == record.SLOT else (np.float64 if values.dtype.kind == "f" else np.int64)
        kept.append(np.ascontiguousarray(values, dtype=kind))
        table[field] = address_of(kept[-1])
    table[record.ELEMENTS], table[record.NODES], table[record.NODES_PER_ELEMENT] = elements, count, nodes
    table[record.VARIABLES] = block.history.shape[-1]
    table[record.ORDERED] = (np.diff(block.node, axis=0) > 0).all()
    table[record.VECTORS], table[record.POINTS], table[record.MEASURES] = vectors, points, measures
    table[record.TURNED], table[record.TURNING], table[record.BENDS] = turned, turning, bends
    table[record.BATCH], table[record.TABLE_ROWS], table[record.COORDINATES] = batch, tables.shape[1], coordinates
    table[record.RUN_COUNT], table[record.HALF_WIDTH], table[record.LOADS] = (
        len(arrays[record.RUNS]),
        layout.half_width,
        len(loads.element),
    )
    chunks = -(-count // LANES), chunk_rows, ROW
    constant = (
        _constant(block, chunks, size, turned, turning)
        if (turned and len(kinds) > 1) or TURNED_GRADIENTS in kinds
        else None
    )
    needs = _needs(kinds, layout.half_width >= 0, bool(len(loads.element)), damped, block.imposed is not None)
    return Sheet(table, tuple(kept), chunks, used * ROW, order, constant, own, needs, block.law, block.imposed)


def _routines(block: Block) -> Routines:
    nodes = block.node.shape[1]
    vectors, bends = block.scale.shape[1] // nodes, int(block.measures == ELASTIC_LINE)
    sizes = (("nodes", nodes), ("vectors", vectors), ("bends", bends))
    return routines(block.measures, sizes) if block.law is None else Routines(block.measures, sizes, block.law.address)


def _needs(
    kinds: np.ndarray, band: bool, loads: bool, damped: bool, imposed: bool
) -> dict[str, tuple[tuple[str, ...], tuple[int, ...]]]:
    """Return what each task needs of `Routines`: parts, and kinds of nodes that turn."""
    angles = tuple(int(kind) - ROTATION for kind in kinds if kind in (ROTATION, STRETCH, SHEAR_RIGID))
    rotated = ("rotated",) if TURNED_GRADIENTS in kinds else ()
    turns = bool(angles or rotated)
    forces = ("forces", *(("angles",) if angles else ()), *rotated, *(("loads",) if loads else ()))
    forces += (*(("damping",) if damped else ()), *(("imposed",) if imposed else ()))
    tangent = ["tangent", "band" if band else "sparse"]
    tangent += ["turning tangent"] if turns else []
    tangent += ["load tangent"] if loads else []
    tangent += ["turning load tangent"] if loads and turns else []
    parts = {"forces": forces, "tangent": tuple(tangent), "mass": ("mass",), "prediction": ("prediction",)}
    return {task: (names, angles) for task, names in parts.items()}


def _places(node: np.ndarray, rows: int) -> np.ndarray:
    """Return where the first entry of nodes stands among the chunks."""
    return np.asarray(node // LANES * (rows * ROW) + node % LANES)


def _runs(node_kind: np.ndarray) -> np.ndarray:
    """Return kind, first node and number of nodes (runs, 3) of neighbours of one kind."""
    first = np.flatnonzero(np.diff(node_kind, prepend=-1))
    return np.column_stack([node_kind[first], first, np.diff(first, append=len(node_kind))])


def _constant(block: Block, shape: tuple[int, int, int], size: int, turned: int, turning: int) -> np.ndarray:
    """Return chunks with what does not change in them: B of nodes whose coordinates are nodal vectors."""
    chunks = np.zeros(shape)
    whole = np.zeros((shape[0] * LANES, turned, turning))
    node_kind, linear = block.node_kind, size - turned
    own = np.arange(len(node_kind))
    for part in range(turned):
        straight = node_kind == GRADIENTS
        straight |= np.isin(node_kind, (ROTATION, TURNED_GRADIENTS)) & (linear + part < size - 2)
        whole[own[straight], part, part if part < turning else 0] = 1.0
    turns = own[node_kind == TURNED_GRADIENTS]
    c, s = block.frame[turns, 0], block.frame[turns, 1]
    for part, column, value in ((2, 2, c), (2, 1, -s), (1, 2, s), (1, 1, c)):
        whole[turns, turned - part, turning - column] = value
    rows = whole.reshape(shape[0], LANES, turned * turning).transpose(0, 2, 1)
    chunks[:, 2 * size : 2 * size + turned * turning, :LANES] = rows
    return chunks
