"""A model as steps that conserve energy and momenta need it: vectors z, by which all nodal vectors are linear."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, dia_array, kron

from beamfem.equations.assembler import Equations
from beamfem.equations.bound_connector import Connector
from beamfem.equations.element_group import make_group
from beamfem.equations.system import System
from beamfem.kernels.block import (
    ELASTIC_LINE,
    ROTATED_GRADIENTS,
    ROTATION,
    SHEAR_RIGID,
    STRETCH,
    Block,
)
from beamfem.kernels.conserving_step import Conserving, Strained
from beamfem.linalg.lapack import lapack_address
from beamfem.physics.connections import BODY, MASS
from beamfem.physics.discrete_gradients import DISCRETE_GRADIENTS
from beamfem.physics.stations import DEAD, FOLLOWING, GROUNDED, STRETCHING

_BODIES = (MASS, BODY)
_WIDEST = 60  # half width of a matrix that is stored as a band
_TURNING = {ROTATION: 1, SHEAR_RIGID: 2, STRETCH: 2}  # number of the nodal vectors that turn with the angle of a node


class Vectors(NamedTuple):
    """Numbers z (m,): p (n,) where nodal vectors are linear in it, (cos t, sin t) of angles t, and s (cos t, sin t).

    linear (n,): mask of the first; angles (k,), stretches (j,): numbers of t and s in p; angle_of (j,).
    """

    linear: np.ndarray
    angles: np.ndarray
    stretches: np.ndarray
    angle_of: np.ndarray

    @property
    def size(self) -> int:
        """Number m of them."""
        return len(self.linear) + 2 * len(self.angles) + 2 * len(self.stretches)

    def units(self, angles: np.ndarray) -> np.ndarray:
        """Return the numbers (..., 2) in z of the unit vectors of some angles, given by their numbers in p."""
        first = len(self.linear) + 2 * np.searchsorted(self.angles, angles)
        return np.stack([first, first + 1], axis=-1)

    def stretched(self, stretches: np.ndarray) -> np.ndarray:
        """Return the numbers (..., 2) in z of s (cos t, sin t)."""
        first = len(self.linear) + 2 * len(self.angles) + 2 * np.searchsorted(self.stretches, stretches)
        return np.stack([first, first + 1], axis=-1)

    def coordinates(self) -> np.ndarray:
        """Return the coordinates (m, 2) on which each of them depends, -1 for none."""
        result = np.full((self.size, 2), -1)
        plain = np.flatnonzero(self.linear)
        result[plain, 0] = plain
        result[self.units(self.angles), 0] = self.angles[:, None]
        both = np.stack([self.angles[self.angle_of], self.stretches], axis=-1)
        result[self.stretched(self.stretches)] = both[:, None]
        return result


class ConservingModel(NamedTuple):
    """A model in two states, or in any.

    nodal (2 vectors, m): nodal vectors of each block from z; masses (m, 2) [kg]: of parts at points, on which gravity
    acts; fixed (m,): forces that depend on neither time nor state; others: equations of the forces that are not in z,
    None if there are none; record: of steps; matrix: view of the derivative of both their equations by p and p', sparse
    unless it is a band.
    """

    nodal: tuple[csr_array, ...]
    masses: np.ndarray
    fixed: np.ndarray
    others: Equations | None
    record: Conserving
    matrix: csc_array | np.ndarray

    @property
    def banded(self) -> bool:
        """Whether the matrix is a band as of LAPACK's dgbsv."""
        return isinstance(self.matrix, np.ndarray)

    def forces(self, system: System, time: float) -> np.ndarray:
        """Return the forces (m,) on z at a time."""
        loads = system.loads.at(time)
        result = self.fixed.copy()
        result += self.masses @ loads.gravity
        for block, at, values, nodal in zip(system.blocks, system.stations, loads.points, self.nodal, strict=True):
            force = np.zeros((nodal.shape[0] // 2, 2))
            tables = (block.gravity, loads.body[:, :2]), (block.length, loads.body[:, 2:])
            along = sum(table[block.kind][:, :, None] * acting[block.beam, None] for table, acting in tables)
            np.add.at(force, _numbers(block), along)
            dead = at.kind == DEAD
            own = at.position[dead][:, :, None] * values[dead][:, None, :2]
            np.add.at(force, _numbers(block)[at.element[dead]], own)
            result += nodal.T @ force.ravel()
        return result


def conserving_model(system: System) -> ConservingModel:
    """Return the tables of a model."""
    vectors = _vectors(system)
    size = vectors.size
    nodal = tuple(_nodal(block, vectors) for block in system.blocks)
    masses, mass, ground, fixed = np.zeros((size, 2)), csr_array((size, size)), csr_array((size, size)), np.zeros(size)
    gathers = []
    for block, at, own in zip(system.blocks, system.stations, nodal, strict=True):
        mass = mass + own.T @ _mass(block, own.shape[0] // 2) @ own
        gathers.append(csr_array(_interpolation(block) @ own))
        some = at.kind == GROUNDED
        r = csr_array(_plane(_numbers(block)[at.element[some]], at.position[some], own.shape[0] // 2) @ own)
        stiffness = at.constants[some, :2].ravel()
        ground = ground + r.T @ csr_array(r * stiffness[:, None])
        fixed += r.T @ (stiffness * at.constants[some, 2:4].ravel())
    for item in system.connectors.items:
        if item.compiled in _BODIES:
            centre, rotary = _centre_of_mass(item, vectors)
            mass = mass + item.data[0] * (centre.T @ centre) + rotary
            masses += item.data[0] * centre.T.toarray()
    springs, stiffness = system.springs.numbers[:, 0], system.springs.data[:, 0]
    plain = bool(vectors.linear[springs].all())
    if plain:
        ground = ground + csr_array(coo_array((stiffness, (springs, springs)), shape=(size, size)))
        np.add.at(fixed, springs, stiffness * system.springs.data[:, 1])
    others = _others(system, plain)
    tables = _record(system, vectors, (csr_array(mass), csr_array(ground)), gathers, others)
    return ConservingModel(nodal, masses, fixed, others, *tables)


def not_conserved(system: System) -> str | None:
    """Return the name of what steps cannot conserve in a model, None if there is nothing."""
    zeros = np.zeros(system.model.size)
    if any(block.law is not None or block.imposed is not None for block in system.blocks):
        return "a section law or imposed strains"
    if any(block.damping.any() or block.mass_damping for block in system.blocks):
        return "damping of beams"
    if any(callable(item.value) for item in system.prescribed) or system.driven:
        return "supports that move"
    if len(system.connectors.multipliers):
        return "conditions with multipliers"
    for item in system.connectors.items:
        inertia = item.tangent((system.reference, zeros, zeros), 0.0, np.zeros(2), (0.0, 0.0, 1.0))
        if item.compiled not in _BODIES and inertia.any():
            return f"the inertia of {item.name}"
    return None


def _others(system: System, springs_known: bool) -> Equations | None:
    """Return the equations of the forces that are not in z: loads that turn, moments, and parts at points."""
    parts = [
        each
        for each in system.parts
        if getattr(each, "connection", None) not in _BODIES and not (springs_known and each is system.springs)
    ]
    turning = any(np.isin(at.kind, (FOLLOWING, STRETCHING)).any() for at in system.stations)
    if not parts and not turning and not any(actions.unit[:, 2].any() for actions in system.loads.actions):
        return None
    groups = []
    for block, layout, at in zip(system.blocks, system.layouts, system.stations, strict=True):
        known = np.isin(at.kind, (DEAD, GROUNDED))[:, None]
        bare = block.resisting(np.zeros_like(block.stiffness))
        bare = bare._replace(gravity=np.zeros_like(block.gravity), length=np.zeros_like(block.length))
        groups.append(make_group(bare, layout, at._replace(position=np.where(known, 0.0, at.position))))
    return Equations(groups, system.model.size, [each.record for each in parts], system.called)


def _centre_of_mass(item: Connector, vectors: Vectors) -> tuple[csr_array, csr_array]:
    """Return the centre of mass (2, m) of a part at a point from z, and the mass matrix (m, m) of its rotation."""
    rows, columns, weights, turning = [0, 1], item.all[:2].tolist(), [1.0, 1.0], np.zeros(vectors.size)
    if item.compiled == BODY:
        (x, y), (_, inertia, along, across, *_) = vectors.units(item.all[2]).tolist(), item.data.tolist()
        rows, columns = [*rows, 0, 0, 1, 1], [*columns, x, y, x, y]
        weights += [along, -across, across, along]
        turning[[x, y]] = inertia
    centre = coo_array((weights, (rows, columns)), shape=(2, vectors.size))
    return csr_array(centre), csr_array(dia_array((turning[None], [0]), shape=(vectors.size,) * 2))


def _vectors(system: System) -> Vectors:
    """Return the vectors of a model."""
    linear, angle_of = np.ones(system.model.size, dtype=bool), dict[int, int]()
    for block in system.blocks:
        for kind, turning in _TURNING.items():
            dof = block.dof[block.node_kind == kind]
            if len(dof):
                angles = dof[:, _angle(block, kind)]
                linear[angles] = False
                if kind == STRETCH:
                    stretches = dof[:, 2 * (_per_node(block) - turning)]
                    angle_of.update(zip(stretches.tolist(), angles.tolist(), strict=True))
    angles, stretches = np.flatnonzero(~linear), np.array(sorted(angle_of), dtype=np.int64)
    linear[stretches] = False
    own = np.searchsorted(angles, [angle_of[each] for each in stretches.tolist()]).astype(np.int64)
    return Vectors(linear, angles, stretches, own)


def _per_node(block: Block) -> int:
    """Return the number of nodal vectors of a node."""
    return block.scale.shape[1] // block.node.shape[1]


def _angle(block: Block, kind: int) -> int:
    """Return the number of the angle among the coordinates of a node."""
    return 2 * (_per_node(block) - _TURNING[kind]) + (kind == STRETCH)


def _numbers(block: Block) -> np.ndarray:
    """Return the numbers (ne, nv) of the nodal vectors of each element."""
    vectors = _per_node(block)
    return (block.node[:, :, None] * vectors + np.arange(vectors)).reshape(len(block.node), -1)


def _plane(numbers: np.ndarray, weights: np.ndarray, count: int) -> csr_array:
    """Return the matrix (2 k, 2 count) of sums of vectors, given by numbers (k, i) and weights (k, i)."""
    rows = np.repeat(np.arange(len(numbers)), numbers.shape[1])
    sums = coo_array((weights.ravel(), (rows, numbers.ravel())), shape=(len(numbers), count))
    return csr_array(kron(csr_array(sums), np.eye(2)))


def _nodal(block: Block, vectors: Vectors) -> csr_array:
    """Return the nodal vectors of a block as a matrix (2 vectors, m) of z."""
    per, entries = _per_node(block), list[tuple[np.ndarray, ...]]()

    def add(nodes: np.ndarray, slot: int, of: np.ndarray, cosine: np.ndarray, sine: np.ndarray) -> None:
        """Let a nodal vector be a vector of z (nodes, 2), turned by an angle."""
        row = 2 * (per * nodes + slot)
        for i, j, value in ((0, 0, cosine), (0, 1, -sine), (1, 0, sine), (1, 1, cosine)):
            entries.append((row + i, of[:, j], value))

    for kind in np.unique(block.node_kind).tolist():
        nodes = np.flatnonzero(block.node_kind == kind)
        dof, (c, s, length), turning = block.dof[nodes], block.frame[nodes].T, _TURNING.get(kind, 0)
        for slot in range(per - turning):
            turned = kind == ROTATED_GRADIENTS and slot == per - 1
            of = dof[:, 2 * slot : 2 * slot + 2]
            add(nodes, slot, of, c if turned else np.ones_like(c), s if turned else np.zeros_like(s))
        if turning:
            u = vectors.units(dof[:, _angle(block, kind)])
            add(nodes, per - 1, u, -s, c)
        if kind == SHEAR_RIGID:
            add(nodes, per - 2, u, length * c, length * s)
        elif kind == STRETCH:
            add(nodes, per - 2, vectors.stretched(dof[:, 2 * (per - turning)]), c, s)
    rows, columns, values = (np.concatenate(each) for each in zip(*entries, strict=True))
    return csr_array(coo_array((values, (rows, columns)), shape=(2 * per * len(block.dof), vectors.size)))


def _mass(block: Block, count: int) -> csr_array:
    """Return the mass matrix (2 count, 2 count) of the nodal vectors of a block."""
    numbers, mass = _numbers(block), block.mass[block.kind]
    width = numbers.shape[1]
    rows, columns = np.repeat(numbers, width, axis=1), np.tile(numbers, (1, width))
    whole = coo_array((mass.ravel(), (rows.ravel(), columns.ravel())), shape=(count, count))
    return csr_array(kron(csr_array(whole), np.eye(2)))


def _interpolation(block: Block) -> csr_array:
    """Return the matrix (6 points, 2 vectors) that gives r', d and the third vector at all quadrature points."""
    slope, vectors = block.slope[block.kind], _per_node(block)
    elements, count, width = slope.shape
    last = np.arange(width) % vectors == vectors - 1
    weights = np.zeros((elements, count, 3, width))
    weights[:, :, 0, ~last], weights[:, :, 1, last] = slope[:, :, ~last], block.director
    if block.measures == ELASTIC_LINE:
        weights[:, :, 2, ~last] = block.second[block.kind][:, :, ~last]
    else:
        weights[:, :, 2, last] = slope[:, :, last]
    numbers = np.repeat(_numbers(block), 3 * count, axis=0)
    return _plane(numbers, weights.reshape(-1, width), vectors * len(block.dof))


def _strained(block: Block, gather: csr_array) -> tuple[dict[str, np.ndarray | int], np.ndarray]:
    """Return fields of the quadrature points of a block, and the numbers (ne, k) of z on which each element depends."""
    elements, points, measures = len(block.node), *block.reference.shape[1:]
    table = coo_array(gather)
    table.eliminate_zeros()
    owner = table.row // (6 * points)
    keys, place = np.unique(owner.astype(np.int64) * gather.shape[1] + table.col, return_inverse=True)
    of = keys // gather.shape[1]
    first = np.searchsorted(of, np.arange(elements))
    local = np.arange(len(keys)) - first[of]
    size = int(local.max()) + 1
    numbers = np.repeat(
        (keys % gather.shape[1])[first][:, None], size, axis=1
    )  # of what is left over: any, weight zero
    numbers[of, local] = keys % gather.shape[1]
    weights = np.zeros((elements, points, 6, size))
    weights.reshape(-1, size)[table.row, local[place]] = table.data
    kinds = block.kind
    fields = {"elements": elements, "points": points, "size": size, "measures": measures, "gather": weights}
    tables = {name: np.ascontiguousarray(getattr(block, name)[kinds]) for name in ("weight", "stiffness", "reference")}
    return {**fields, **tables, "numbers": numbers, "moved": np.zeros(size)}, numbers


class _Storage(NamedTuple):
    """Where entries by p in the first equations are stored among `values`, and the others relative to them."""

    places: np.ndarray
    below: np.ndarray
    by_rates: int
    values: np.ndarray
    matrix: csc_array | np.ndarray


def _banded(row: np.ndarray, column: np.ndarray, unknown: int, half: int) -> _Storage:
    """Return the band of LAPACK's dgbsv, for p' and p of a coordinate, and its first and second equation, in turn."""
    height = 3 * half + 1
    columns = np.zeros((2 * unknown, height))
    places = 2 * half + 2 * row - (2 * column + 1) + (2 * column + 1) * height
    return _Storage(places, np.ones(unknown, dtype=np.int64), 1 - height, columns.ravel(), columns.T)


def _sparse(row: np.ndarray, column: np.ndarray, unknown: int) -> _Storage:
    """Return a sparse matrix, with all first equations before the second ones and p before p'."""
    start, count = np.searchsorted(column, np.arange(unknown + 1)), len(row)
    below, places = np.diff(start), np.arange(count) + start[column]
    indices, values = np.empty(4 * count, dtype=np.int32), np.zeros(4 * count)
    for shift in (0, 2 * count):
        indices[shift + places], indices[shift + places + below[column]] = row, row + unknown
    pointers = np.concatenate([2 * start, 2 * count + 2 * start[1:]]).astype(np.int32)
    matrix = csc_array((values, indices, pointers), shape=(2 * unknown, 2 * unknown), copy=False)
    return _Storage(places, below, 2 * count, values, matrix)


def _record(
    system: System,
    vectors: Vectors,
    matrices: tuple[csr_array, csr_array],
    gathers: list[csr_array],
    others: Equations | None,
) -> tuple[Conserving, csc_array | np.ndarray]:
    """Return the record of a model, and a view of its matrix: sparse, or a band as of LAPACK's dgbsv."""
    size, unknown, free = vectors.size, len(system.free_dofs), system.unknowns.free
    groups = [_strained(*each) for each in zip(system.blocks, gathers, strict=True)]
    keys = [(numbers[:, :, None] * size + numbers[:, None, :]).ravel() for _, numbers in groups]
    given = [coo_array(matrix) for matrix in matrices]
    keys += [each.row.astype(np.int64) * size + each.col for each in given]
    known = np.unique(np.concatenate(keys))
    rows, columns = known // size, known % size
    coordinates = vectors.coordinates()
    equations = np.where(coordinates >= 0, free[coordinates], -1)
    pairs = equations[columns][:, None, :] * unknown + equations[rows][:, :, None]
    outside = (equations[columns][:, None, :] < 0) | (equations[rows][:, :, None] < 0)
    entries = np.unique(pairs[~outside])
    column, row = entries // unknown, entries % unknown
    half = 2 * int(np.abs(row - column).max(initial=0)) + 1
    plain = half <= _WIDEST and not system.inclined and others is None
    stored = _banded(row, column, unknown, half) if plain else _sparse(row, column, unknown)

    def placed(rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Return the places of entries by p in the first equations, -1 for none."""
        inside = (rows >= 0) & (columns >= 0)
        found = np.searchsorted(entries, np.where(inside, columns * unknown + rows, 0))
        return np.where(inside, np.append(stored.places, -1)[found], -1)

    stretches, angles = free[vectors.stretches], free[vectors.angles]
    of = angles[vectors.angle_of]
    mass, ground = (np.zeros(len(known)) for _ in matrices)
    for values, each in zip((mass, ground), given, strict=True):
        values[np.searchsorted(known, each.row.astype(np.int64) * size + each.col)] = each.data
    own = Conserving.usual(
        dgbsv=lapack_address("dgbsv"),
        size=size,
        coordinates=system.model.size,
        angle_count=len(vectors.angles),
        stretch_count=len(vectors.stretches),
        linear=vectors.linear.astype(np.int64),
        angles=vectors.angles,
        stretches=vectors.stretches,
        angle_of=vectors.angle_of,
        equations=equations,
        unknown=unknown,
        rows=np.searchsorted(rows, np.arange(size + 1)),
        entries=len(known),
        columns=columns,
        mass=mass,
        ground=ground,
        places=placed(equations[rows][:, :, None], equations[columns][:, None, :]),
        angle_places=placed(angles, angles),
        stretch_places=np.stack([placed(of, stretches), placed(stretches, of)], axis=-1),
        below=stored.below,
        by_rates=stored.by_rates,
        filled=len(stored.values),
        matrix=stored.values,
        group_count=len(groups),
        groups=[
            Strained(
                places=np.searchsorted(known, numbers[:, :, None] * size + numbers[:, None, :]),
                between=DISCRETE_GRADIENTS[block.measures],
                **fields,
            )
            for block, (fields, numbers) in zip(system.blocks, groups, strict=True)
        ],
    )
    names = "stiffness", "left", "p", "v", "vectors", "rates", "lost", "force", "slopes", "right"
    own.fill(**{name: np.zeros(shape) for name, shape in own.shapes(*names).items()})
    sizes = [2 * unknown, half, 1, 3 * half + 1, 0]
    own.fill(sizes=np.array(sizes, dtype=np.int32), exchanged=np.zeros(2 * unknown, dtype=np.int32))
    return own, stored.matrix
