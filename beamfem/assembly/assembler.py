"""Evaluation of all equations of a model: residual and tangent in a state, for given weights."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.assembly.applied_loads import LoadsAt
from beamfem.assembly.callbacks import Deferred
from beamfem.assembly.connection_table import ConnectionTable
from beamfem.assembly.element_group import ElementGroup
from beamfem.assembly.scratch_memory import Arena, Scratch, new
from beamfem.kernels import element_passes, model_passes, node_passes, record
from beamfem.kernels.block import Springs
from beamfem.kernels.connection_passes import add_connections
from beamfem.kernels.pointers import address_of
from beamfem.kernels.simd import WIDTH

Stresses = Sequence[np.ndarray]
_NONE = np.empty(0)


@dataclass(frozen=True, eq=False)
class Work:
    """A group of elements with a separate workspace, so that solves do not interfere."""

    group: ElementGroup
    table: np.ndarray
    address: int
    chunks: np.ndarray
    stress: np.ndarray

    def rows(self, first: int, count: int) -> np.ndarray:
        """Return `count` rows of all nodes from row `first` on (N, count), in the order of node numbers."""
        nodes = int(self.table[record.NODES])
        chunks = self.chunks[:, first : first + count, : record.LANES]
        values = np.ascontiguousarray(chunks.transpose(0, 2, 1).reshape(-1, count)[:nodes])
        if self.group.order is None:
            return values
        result = np.empty_like(values)
        result[self.group.order] = values
        return result


class Equations:
    """Groups of elements, springs and parts at points in the form that compiled code expects, without workspace.

    table: see `kernels.record`; springs: the arrays that the table points to.
    """

    def __init__(
        self, groups: Sequence[ElementGroup], springs: Springs, size: int, connections: ConnectionTable | None = None
    ) -> None:
        self.groups, self.size = tuple(groups), size
        kinds = (np.int64, float, float, np.int64)
        self.springs = tuple(
            np.ascontiguousarray(values, dtype=kind) for values, kind in zip(springs, kinds, strict=True)
        )
        self.table = np.zeros(record.SYSTEM_FIELDS, dtype=np.int64)
        self.table[record.GROUPS], self.table[record.SIZE] = len(self.groups), size
        self.table[record.SPRINGS] = len(self.springs[0])
        for number, values in enumerate(self.springs):
            self.table[record.SPRING_DOF + number] = address_of(values)
        self.connections = connections
        if connections is not None:
            self.table[record.CONNECTIONS] = len(connections.table)
            self.table[record.CONNECTION_TABLES] = address_of(connections.table)
            self.table[record.ADD_CONNECTIONS] = add_connections.address


class Assembler:
    """Equations with a workspace: one for each solve and thread.

    stresses: resultants (ne, nq, ns) of each group for the geometric part of the tangent; shared: whether `work_in`
    provides scratch memory before each solve; numbers: size of the workspace in floats; scratch: the part of it in
    scratch memory.
    """

    def __init__(self, equations: Equations, stresses: Stresses | None = None, shared: bool = False) -> None:
        self.equations, self.size, groups = equations, equations.size, equations.groups
        self._imposes = any(group.imposed is not None for group in groups)
        self._laws = tuple(group.law for group in groups if group.law is not None)
        count = len(groups)
        tables, lists = np.array([group.table for group in groups]), np.zeros((5, count), dtype=np.int64)
        addresses, self._values, self._filled = lists[0], lists[1], lists[2:].reshape(count, 3)
        size, at_tables, at_lists = lists.itemsize, address_of(tables), address_of(lists)
        shapes: dict[object, Sequence[int]] = {"factors": (record.FACTOR_COUNT,)}
        for number, group in enumerate(groups):
            shapes["chunks", number] = group.chunks
            if stresses is None:
                shapes["stress", number] = group.points
        room = Arena(shapes)
        self.works: list[Work] = []
        for number, group in enumerate(groups):
            table = tables[number]
            addresses[number] = at_tables + size * record.BLOCK_FIELDS * number
            if stresses is None:
                stress, stress_address = room.arrays["stress", number], room.addresses["stress", number]
            else:
                stress = np.ascontiguousarray(stresses[number], dtype=float)
                stress_address = address_of(stress)
            rows = room.arrays["chunks", number]
            if group.constant is not None:
                rows[:] = group.constant
            table[record.CHUNKS], table[record.STRESS] = room.addresses["chunks", number], stress_address
            table[record.FILLED] = at_lists + size * (2 * count + 3 * number)
            self.works.append(Work(group, table, int(addresses[number]), rows, stress))
        self.scratch = sum(WIDTH + group.space for group in groups)
        self.numbers = self.scratch + sum(array.size for array in room.arrays.values())
        self._room, self._factors, self._acting = room, room.arrays["factors"], (np.empty(0),)
        self._natural: tuple[np.ndarray, ...] = ()
        self._taken: LoadsAt | None = None
        self.table = equations.table.copy()
        self.address = address_of(self.table)
        self.table[record.GROUP_RECORDS], self.table[record.VALUES] = at_lists, at_lists + size * count
        self.table[record.FACTORS] = room.addresses["factors"]
        self._tables = self.table, tables, lists
        self._scratch = _NONE
        if not shared:
            self.work_in(new(self.scratch))

    def work_in(self, scratch: Scratch) -> None:
        """Use scratch memory of at least `scratch` floats; its contents are overwritten."""
        if scratch.user is self and self._scratch is scratch.memory:
            return  # the element tables in it are still valid
        self._scratch, address = scratch.memory, scratch.address
        for work in self.works:
            address += -address % (8 * WIDTH)  # vectors of lanes must not straddle two cache lines
            work.table[record.SPACE] = address
            address += 8 * work.group.space
        self._filled[:] = 0
        scratch.user = self

    @property
    def stresses(self) -> tuple[np.ndarray, ...]:
        """Resultants (ne, nq, ns) of each group for the geometric part of the tangent: given, or as last predicted."""
        return tuple(work.stress for work in self.works)

    @property
    def memory(self) -> tuple[np.ndarray, ...]:
        """The arrays that compiled code reads and writes, except those set by `place`."""
        kept = [array for group in self.equations.groups for array in group.kept]
        acting = (self._scratch, *self._acting, *self._natural)
        return (*kept, *self.equations.springs, *self._tables, *self._room.arrays.values(), *acting)

    def take(self, loads: LoadsAt) -> None:
        """Set the loads, unless they are already set."""
        if loads is not self._taken:
            self.load(loads.body, loads.points, loads.imposing)
            self._taken = loads

    def load(self, body: np.ndarray, values: Sequence[np.ndarray], imposing: np.ndarray = _NONE) -> list[int]:
        """Set body loads (..., beams, 4) and point loads (..., nl, 3) of each group; time steps may be the first axis.

        imposing: see `impose`. Return the addresses of body and point loads.
        """
        self.impose(imposing)
        parts = (body, *values)
        self._acting = (np.concatenate([part.ravel() for part in parts]),)
        addresses, address = [], address_of(self._acting[0])
        for part in parts:
            addresses.append(address)
            address += 8 * part.size
        self.table[record.BODY], self.table[record.LOADED] = addresses[0], int(body.any())
        self._values[:] = addresses[1:]
        return addresses

    def impose(self, factors: np.ndarray) -> list[int]:
        """Set the factors (..., k) of imposed strains; return the address of the strains of each group, 0 for none."""
        self._taken = None
        if not self._imposes:
            return [0] * len(self.works)
        strains = [_imposed(work.group, factors) for work in self.works]
        self._natural = tuple(strain for strain in strains if strain is not None)
        addresses = [0 if strain is None else address_of(strain) for strain in strains]
        for work, address in zip(self.works, addresses, strict=True):
            work.table[record.NATURAL] = address
        return addresses

    def unload(self) -> None:
        """Let go of the loads, which may be many rows of a motion."""
        self._acting, self._natural, self._taken = (_NONE,), (), None

    def weigh(self, coefficients: Sequence[float], dt: float = 0.0, moving: bool = False) -> None:
        """Set the weights ck, cv, ca of p, p', p'' in the tangent.

        With ca = 0 there are no inertia forces unless `moving`, with cv = ca = 0 no damping forces either. dt [s]: time
        step since the committed history.
        """
        self._factors[:] = *coefficients, dt
        moving, rated = moving or coefficients[record.WEIGHT_A] != 0.0, coefficients[record.WEIGHT_V] != 0.0
        self.table[record.MOVING], self.table[record.RATED] = int(moving), int(moving or rated)

    @property
    def weights(self) -> tuple[float, float, float]:
        """Weights ck, cv, ca of p, p', p'' in the tangent."""
        ck, cv, ca = self._factors[: record.SINCE_COMMITTED].tolist()
        return ck, cv, ca

    def require(self, *tasks: str) -> None:
        """Compile the routines that compiled drivers will call: forces always; tasks: also "tangent", "prediction"."""
        moving = self.table[record.MOVING] != 0 and "tangent" in tasks
        for work in self.works:
            work.group.require("forces", *tasks, *(("mass",) if moving else ()))

    def place(self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray) -> None:
        """Set the arrays (n,) of the state and of the results; the caller must keep them alive."""
        states = [_address(values, self.size) for values in (p, v, a, residual)]
        self.place_at((states[0], states[1], states[2]), states[3], _address(matrix), matrix.size)

    def place_at(self, states: tuple[int, int, int], residual: int, matrix: int, entries: int) -> None:
        """Set the addresses of state and results (see `place`), and the number of entries of the matrix."""
        table = self.table
        table[record.COORDINATES_P], table[record.COORDINATES_V], table[record.COORDINATES_A] = states
        table[record.RESIDUAL], table[record.MATRIX], table[record.ENTRIES] = residual, matrix, entries

    def balance(
        self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray, predicted: bool
    ) -> None:
        """Assemble the residual (n,) and, unless it is empty, the flat matrix.

        predicted: whether the geometric part of the tangent uses `stresses`.
        """
        self.require(*(("tangent",) if matrix.size else ()))
        self.place(p, v, a, residual, matrix)
        self.table[record.TANGENT] = int(matrix.size > 0)
        self.table[record.PREDICTED] = int(predicted and matrix.size > 0)
        self.call(model_passes.balance.compiled, self.address)

    def predict(self, p: np.ndarray, step: np.ndarray, v: np.ndarray | None = None) -> None:
        """Predict `stresses` after a linearised step (n,) from p (n,); v: p' (n,), for damping."""
        self.require("prediction")
        states = [_address(values, self.size) for values in (p, step, step if v is None else v)]
        fields = record.COORDINATES_P, record.COORDINATES_V, record.COORDINATES_A
        for field, address in zip(fields, states, strict=True):
            self.table[field] = address
        for work in self.works:
            self.call(model_passes.predict_resultants.compiled, work.address, self.address, 0)

    @property
    def calls_python(self) -> bool:
        """Whether compiled code calls section laws in Python."""
        return bool(self._laws)

    def call(self, driver: Callable[..., Any], *arguments: Any) -> Any:
        """Call a compiled driver and return its result. Raises the error of a section law in it, if there is one."""
        if not self._laws:
            return driver(*arguments)
        with Deferred() as deferred:
            result = driver(*arguments)
        error = self.take_error()
        deferred.deliver()
        if error is not None:
            raise error
        return result

    def take_error(self) -> BaseException | None:
        """Return the first error of a section law in compiled code, if any, and forget all of them."""
        errors = [law.take_error() for law in self._laws]
        return next((error for error in errors if error is not None), None)

    def elastic(self, p: np.ndarray, v: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return e, e'' and the elastic and damping forces (N, per_node) of the only group in a state p, p', p''.

        Imposed strains are subtracted.
        """
        (work,), table, nothing = self.works, self.table, np.zeros(self.size)
        self.place(p, v, a, nothing, np.empty(0))
        self.weigh((1.0, 0.0, 0.0))
        table[[record.TANGENT, record.PREDICTED, record.LOADED]], table[record.RATED] = 0, 1
        self.require()
        node_passes.place_nodes(work.address, self.address, 1)
        self.call(element_passes.add_elements.compiled, work.address, self.address)
        size, force = 2 * int(work.table[record.VECTORS]), int(work.table[record.FORCE])
        return work.rows(0, size), work.rows(size, size), work.rows(force, size)

    def nodal_vectors(self, p: np.ndarray) -> list[np.ndarray]:
        """Return the nodal vectors e (N, per_node) of each group in a state (n,)."""
        self.require()
        self.table[record.COORDINATES_P] = _address(p, self.size)
        vectors = []
        for work in self.works:
            node_passes.place_nodes(work.address, self.address, 0)
            vectors.append(work.rows(0, 2 * int(work.table[record.VECTORS])))
        return vectors

    def smallest_jacobian(self, p: np.ndarray) -> float:
        """Return the smallest r0' x d of all quadrature points in a state (n,), at most 1; negative if inverted."""
        self.require()
        self.table[record.COORDINATES_P] = _address(p, self.size)
        smallest = 1.0
        for work in self.works:
            node_passes.place_nodes(work.address, self.address, 0)
            smallest = min(smallest, model_passes.smallest_jacobian(work.address))
        return smallest


def _imposed(group: ElementGroup, factors: np.ndarray) -> np.ndarray | None:
    """Return the strains (..., ne, nq, ns) imposed by loads with factors (..., k), None if there are none."""
    if group.imposed is None or not factors.any():
        return None
    if factors.ndim == 1:
        return np.ascontiguousarray(group.imposed.at(factors))
    return np.array([group.imposed.at(row) for row in factors])


def _address(values: np.ndarray, size: int | None = None) -> int:
    """Return the address of a contiguous array of floats (size,)."""
    if values.dtype != np.float64 or not values.flags.c_contiguous or (size is not None and values.size != size):
        raise ValueError(f"compiled code takes {size} contiguous floats, got {values.dtype} {values.shape}")
    return address_of(values)
