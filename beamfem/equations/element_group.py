"""The record that describes a group of similar elements to compiled code."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from beamfem.kernels import linear_law
from beamfem.kernels.batch import rows_of
from beamfem.kernels.block import (
    ELASTIC_LINE,
    GRADIENTS,
    GREEN_LAGRANGE,
    ROTATED_GRADIENTS,
    ROTATION,
    SHEAR_RIGID,
    STRETCH,
    Block,
    Imposed,
    Law,
    Layout,
    Stations,
)
from beamfem.kernels.compiling import Routine
from beamfem.kernels.model_record import LANES, ROW, Group, GroupRoutines, NodePasses, StationPasses
from beamfem.kernels.simd import WIDTH
from beamfem.physics.compiled_connections import passes_of
from beamfem.physics.compiled_elements import MEASURE_PASSES, NODE_PASSES
from beamfem.physics.stations import STATIONS

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
    half_width: int


class Numbers(NamedTuple):
    """Arrays of integers of a group, see `kernels.block`; free (n,): equation numbers; element: those of stations."""

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

    record: without what depends on the numbers of the block; constant: node data with the entries that never change in
    any such group, None if there are none; rotated (k,): nodes with `ROTATED_GRADIENTS`, in storage order.
    """

    record: Group
    order: np.ndarray | None
    constant: np.ndarray | None
    rotated: np.ndarray
    needs: Needs


def structure_of(block: Block, layout: Layout, stations: Stations) -> Structure:
    """Return the structure of a block; identical small blocks share one."""
    slots = block.scale.shape[1]
    _, points, measures = block.reference.shape
    sizes = Sizes(
        slots // block.node.shape[1],
        points,
        measures,
        block.measures == ELASTIC_LINE,
        bool(block.damping.any()),
        layout.half_width,
    )
    numbers = Numbers(
        block.node, block.kind, block.beam, block.node_kind, block.dof, block.home, layout.free, stations.element
    )
    if len(block.node) > _FEW or len(layout.free) > 10 * _FEW:
        return _structure(numbers, sizes, block.imposed is not None)
    content = tuple((values.tobytes(), values.shape) for values in numbers)
    return _shared(content, sizes, block.imposed is not None)


@lru_cache(maxsize=64)
def _shared(content: tuple[tuple[bytes, tuple[int, ...]], ...], sizes: Sizes, imposed: bool) -> Structure:
    arrays = (np.frombuffer(data, np.int64).reshape(shape) for data, shape in content)
    return _structure(Numbers(*arrays), sizes, imposed)


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


def _structure(given: Numbers, sizes: Sizes, imposed: bool) -> Structure:
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
    velocity = 2 * size + 2 * dependent * parameters
    turning = velocity + size * sizes.damped
    gathered = turning + dependent * parameters * sizes.damped
    force = gathered + parameters * parameters
    rows = _table_rows(nodes * sizes.vectors, sizes)
    used = rows_of(nodes, sizes.vectors, sizes.points, gathered, rows["table_rows"])[-1]
    batch = LANES
    while batch > _SMALLEST and used * batch > _CACHE * LANES:
        batch //= 2
    node_rows = force + 2 * size
    offsets = given.node // LANES * (node_rows * ROW) + given.node % LANES
    number = np.where(given.dof >= 0, given.free[given.dof], -1)[given.node].reshape(elements, -1)
    runs = _runs(given.node_kind)
    arrays = {
        "classes": given.kind,
        "beam": given.beam,
        "place": offsets.T,
        "dof": given.dof.T,
        "source": np.append(np.maximum(given.dof.T, 0), np.zeros(WIDTH, dtype=np.int64)),
        "runs": runs,
        "number": number.T,
        "free": given.free,
        "home": given.home,
        "station_element": given.element,
        "station_place": offsets[given.element].T,
        "station_number": number[given.element].T,
        "counted": np.arange(elements) if sizes.half_width < 0 else np.empty(0, dtype=np.int64),
    }
    record = Group(
        elements=elements,
        nodes=count,
        nodes_per_element=nodes,
        dependent=dependent,
        parameters=parameters,
        coordinates=coordinates,
        batch=batch,
        ordered=(np.diff(given.node, axis=0) > 0).all(),
        run_count=len(runs),
        acceleration=size,
        transform=2 * size,
        convective=2 * size + dependent * parameters,
        velocity=velocity,
        turning=turning,
        curvature=gathered,
        force=force,
        predicted_force=force + size,
        node_rows=node_rows,
        chunk_count=-(-count // LANES),
        space_rows=used,
        stations=len(given.element),
        **rows | sizes._asdict(),
        **{name: np.ascontiguousarray(values, dtype=np.int64) for name, values in arrays.items()},
    )
    needs = _needs(kinds, sizes, bool(len(given.element)), imposed)
    rotated, constant = np.flatnonzero(given.node_kind == ROTATED_GRADIENTS), None
    if (dependent and len(kinds) > 1) or len(rotated):
        constant = _constant(given.node_kind, record)
    return Structure(record, order, constant, rotated, needs)


def _constant(node_kind: np.ndarray, record: Group) -> np.ndarray:
    """Return node data with the entries that never change: B of nodes whose coordinates are nodal vectors."""
    dependent, parameters = record.dependent, record.parameters
    chunks = np.zeros((record.chunk_count, record.node_rows, ROW))
    for part in range(dependent):
        straight = node_kind == GRADIENTS
        if part < dependent - 2:
            straight |= (node_kind == ROTATION) | (node_kind == ROTATED_GRADIENTS)
        nodes = np.flatnonzero(straight)
        row = record.transform + part * parameters + (part if part < parameters else 0)
        chunks[nodes // LANES, row, nodes % LANES] = 1.0
    return chunks


def _table_rows(slots: int, sizes: Sizes) -> dict[str, int]:
    """Return the first row of each table of a class, and the number of rows."""
    points, measures = sizes.points, sizes.measures
    lengths = {
        "slope": points * slots,
        "second": points * slots * sizes.bends,
        "stiffness": points * measures * (measures + 1) // 2,
        "reference": points * measures,
        "weight": points,
        "mass": slots * slots,
        "gravity": slots,
        "length": slots,
        "damping": int(sizes.damped),
    }
    ends = np.cumsum([0, *lengths.values()]).tolist()
    return dict(zip((*lengths, "table_rows"), ends, strict=True))


def _needs(kinds: tuple[int, ...], sizes: Sizes, stations: bool, imposed: bool) -> Needs:
    """Return the parts of `Routines` that each task needs, and the kinds of nodes with an angle."""
    angles = tuple(kind - ROTATION for kind in kinds if kind in (ROTATION, STRETCH, SHEAR_RIGID))
    rotated = ("rotated",) if ROTATED_GRADIENTS in kinds else ()
    rotates = bool(angles or rotated)
    forces = ("forces", *(("angles",) if angles else ()), *rotated, *(("stations",) if stations else ()))
    forces += (*(("damping",) if sizes.damped else ()), *(("imposed",) if imposed else ()))
    tangent = ["tangent", "band" if sizes.half_width >= 0 else "sparse"]
    tangent += ["damping tangent"] if sizes.damped else []
    tangent += ["rotation tangent"] if rotates else []
    tangent += ["station tangent"] if stations else []
    tangent += ["rotation station tangent"] if stations and rotates else []
    parts = {"forces": forces, "tangent": tuple(tangent), "mass": ("mass",), "prediction": ("prediction",)}
    return {task: (names, angles) for task, names in parts.items()}


def _runs(node_kind: np.ndarray) -> np.ndarray:
    """Return kind, first node and number of nodes (runs, run fields) of each run of consecutive nodes of one kind."""
    first = np.flatnonzero(np.diff(node_kind, prepend=-1))
    return np.column_stack([node_kind[first], first, np.diff(first, append=len(node_kind))])


_PADDING = np.zeros(WIDTH)  # vectors of lanes read beyond the last node
_UPPER = {measures: np.flatnonzero(np.triu(np.ones((measures, measures)))) for measures in (4, 6)}


class Routines:
    """The compiled functions for a strain measure, each set when a task first needs it.

    nodes, vectors: of an element and of a node, constants for the compiler since they are the same for all elements;
    law: address of the section law that replaces the linear one, 0 for none.
    """

    def __init__(self, measures: int, nodes: int, vectors: int, law: int = 0) -> None:
        self.record = GroupRoutines(nodes=[NodePasses() for _ in NODE_PASSES])
        self._sizes = {"nodes": nodes, "vectors": vectors, "bends": int(measures == ELASTIC_LINE)}
        self._measures, self._law = measures, law
        self._ready = set[tuple[tuple[str, ...], tuple[int, ...]]]()

    def require(self, tasks: tuple[str, ...], kinds: tuple[int, ...]) -> None:
        """Compile or load the routines of tasks; kinds: nodes with an angle, indices in `physics.kinematics.KINDS`."""
        if (tasks, kinds) in self._ready:
            return
        for task in tasks:
            for name, called in GroupRoutines.called.items():
                if task in called.tasks:
                    setattr(self.record, name, self._own(name))
            for name, called in NodePasses.called.items():
                for kind in kinds if task in called.tasks else ():
                    setattr(self.record.nodes[kind], name, NODE_PASSES[kind][name])
        self._ready.add((tasks, kinds))

    def _own(self, name: str) -> Routine | int:
        """Return the routine of these elements, or its address."""
        if name == "law" and (self._law or self._measures == GREEN_LAGRANGE):
            return self._law or linear_law.six_resultants
        own = MEASURE_PASSES[self._measures].get(name)
        return own or GroupRoutines.called[name].routine.fixed(**self._sizes)


_known_routines = lru_cache(maxsize=None)(Routines)


@dataclass(frozen=True, eq=False)
class ElementGroup:
    """A group of similar elements in the form that compiled code expects.

    record: without workspace; order (N,): node numbers in storage order, None if they are stored as numbered; constant:
    node data with the entries that never change, None if there are none; needs: routines of each task; law: section law
    that the routines call, None if it is linear.
    """

    record: Group
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


def stored(block: Block, order: np.ndarray | None) -> Block:
    """Return a block with its nodes numbered in storage order (N,)."""
    if order is None:
        return block
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    reordered = {name: getattr(block, name)[order] for name in ("node_kind", "frame", "dof", "home")}
    return block._replace(node=number[block.node], **reordered)


def make_group(block: Block, layout: Layout, stations: Stations) -> ElementGroup:
    """Return the group of a block."""
    structure, element_routines = structure_of(block, layout, stations), _routines(block)
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
        *((block.damping[:, None],) if structure.record.damped else ()),
    ]
    frame = block.frame if order is None else block.frame[order]
    mixed = block.mass.reshape(classes, nodes, vectors, nodes, vectors)[..., :-1, :, -1]
    arrays = {
        "tables": np.concatenate(parts, axis=1),
        "director": block.director,
        "frame": np.concatenate((frame.T.ravel(), _PADDING)),
        "position": stations.position.T,
        "direction": stations.direction.T,
        "constants": stations.constants,
    }
    kinds, number = np.unique(stations.kind, return_inverse=True)
    passes = [passes_of(STATIONS[kind]) for kind in kinds.tolist()]
    record = structure.record.copy()
    record.fill(
        station_kind=number,
        kinds=[StationPasses(force=own.force, tangent=own.tangent) for own in passes],
        mass_damping=block.mass_damping,
        apart=not mixed.any(),
        law_points=block.history.shape[1],
        variables=block.history.shape[2],
        history=np.ascontiguousarray(block.history) if block.history.size else None,
        slot=np.ascontiguousarray(layout.slot, dtype=np.int32),
        routines=element_routines.record,
        **(block.law.fields if block.law is not None else {}),
        **{name: np.ascontiguousarray(values, dtype=float) for name, values in arrays.items()},
    )
    constant = _constant_of_nodes(structure, frame)
    return ElementGroup(record, order, constant, element_routines, structure.needs, block.law, block.imposed)


def _routines(block: Block) -> Routines:
    nodes = block.node.shape[1]
    of = block.measures, nodes, block.scale.shape[1] // nodes
    return _known_routines(*of) if block.law is None else Routines(*of, block.law.address)


def _constant_of_nodes(structure: Structure, frame: np.ndarray) -> np.ndarray | None:
    """Return node data with the entries that never change; frame (N, 3): of nodes in storage order."""
    rotated, own = structure.rotated, structure.record
    if structure.constant is None or not len(rotated):
        return structure.constant
    chunks = structure.constant.copy()
    c, s = frame[rotated, 0], frame[rotated, 1]
    for part, column, value in ((2, 2, c), (2, 1, -s), (1, 2, s), (1, 1, c)):
        row = own.transform + (own.dependent - part) * own.parameters + own.parameters - column
        chunks[rotated // LANES, row, rotated % LANES] = value
    return chunks
