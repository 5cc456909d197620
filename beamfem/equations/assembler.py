"""Evaluation of all equations of a model: residual and tangent in a state, for given weights."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.equations.applied_loads import LoadsAt
from beamfem.equations.callbacks import Deferred
from beamfem.equations.element_group import ElementGroup
from beamfem.kernels import element_passes, model_passes, model_record, node_passes
from beamfem.kernels.records import address_of, aligned
from beamfem.kernels.simd import WIDTH

_NONE = np.empty(0)
_LARGEST_KEPT = 1_000_000  # floats of memory that is kept
_MOST_KEPT = 4


@dataclass(eq=False)
class Scratch:
    """Scratch memory of compiled code, reused by the next solve of any model, and its last user."""

    memory: np.ndarray
    user: object = None


_kept: list[Scratch] = []


def lend_scratch(size: int) -> Scratch:
    """Return memory of at least `size` floats that is not in use; its contents are arbitrary."""
    try:
        scratch = _kept.pop()
    except IndexError:
        return new_scratch(size)
    return scratch if len(scratch.memory) >= size else new_scratch(size)


def new_scratch(size: int) -> Scratch:
    """Return memory (size,) of zeros."""
    return Scratch(np.zeros(size))


def take_back_scratch(scratch: Scratch) -> None:
    """Keep memory for the next solve, if it is small."""
    if len(scratch.memory) <= _LARGEST_KEPT and len(_kept) < _MOST_KEPT:
        _kept.append(scratch)


@dataclass(frozen=True, eq=False)
class Work:
    """A group of elements with a separate workspace, so that solves do not interfere."""

    group: ElementGroup
    record: model_record.Group

    def rows(self, first: int, count: int) -> np.ndarray:
        """Return `count` rows of all nodes from row `first` on (N, count), in the order of node numbers."""
        chunks = self.record.chunks[:, first : first + count, : model_record.LANES]
        values = np.ascontiguousarray(chunks.transpose(0, 2, 1).reshape(-1, count)[: self.record.nodes])
        if self.group.order is None:
            return values
        result = np.empty_like(values)
        result[self.group.order] = values
        return result


class Equations:
    """Groups of elements and parts at points in the form that compiled code expects, without workspace.

    called: what of them calls Python; spare: workspaces that no evaluation uses, if they are not the system's own.
    """

    def __init__(
        self,
        groups: Sequence[ElementGroup],
        size: int,
        parts: Sequence[model_record.Parts] = (),
        called: Sequence[Any] = (),
    ) -> None:
        self.groups, self.size = tuple(groups), size
        self.record = model_record.System(size=size, group_count=len(self.groups), part_kinds=len(parts), parts=parts)
        self.spare: list[Assembler] = []
        self.called = *called, *(group.law for group in groups if group.law is not None and group.law.in_python)


class Assembler:
    """Equations with a workspace: one for each solve and thread.

    shared: whether `work_in` provides scratch memory before each solve; numbers: size of the workspace in floats;
    scratch: the part of it in scratch memory.
    """

    def __init__(self, equations: Equations, shared: bool = False) -> None:
        self.equations, self.size, self.record = equations, equations.size, equations.record.copy()
        self._imposes = any(group.imposed is not None for group in equations.groups)
        self._damped = any(group.record.damped or group.record.mass_damping for group in equations.groups)
        self.works = tuple(Work(group, group.record.copy()) for group in equations.groups)
        self.scratch = self.numbers = 0
        for group, own in ((work.group, work.record) for work in self.works):
            own.fill(**aligned(own.shapes("chunks", "stress")))
            if own.mass_damping:
                own.slowed = np.empty(self.size)
            if group.constant is not None:
                own.chunks[:] = group.constant
            self.scratch += WIDTH + own.space_rows * model_record.ROW
            self.numbers += own.chunks.size + own.stress.size
        self.numbers += self.scratch
        self.record.groups = [work.record for work in self.works]
        self._taken: LoadsAt | None = None
        self._scratch = _NONE
        if not shared:
            self.work_in(new_scratch(self.scratch))

    def work_in(self, scratch: Scratch) -> None:
        """Use scratch memory of at least `scratch` floats; its contents are overwritten."""
        if scratch.user is self and self._scratch is scratch.memory:
            return  # the element tables in it are still valid
        self._scratch, first = scratch.memory, 0
        for own in (work.record for work in self.works):
            first += -(address_of(scratch.memory) // 8 + first) % WIDTH  # lanes must not straddle two cache lines
            size = own.space_rows * model_record.ROW
            own.space = scratch.memory[first : first + size].reshape(-1, model_record.ROW)
            own.filled_count = 0
            first += size
        scratch.user = self

    @property
    def stresses(self) -> tuple[np.ndarray, ...]:
        """Resultants (ne, nq, ns) of each group for the geometric part of the tangent: given, or as last predicted."""
        return tuple(work.record.stress for work in self.works)

    def take_stresses(self, stresses: Sequence[np.ndarray]) -> None:
        """Set `stresses`."""
        for work, stress in zip(self.works, stresses, strict=True):
            work.record.stress = np.ascontiguousarray(stress, dtype=float)

    def take(self, loads: LoadsAt, time: float) -> None:
        """Set the time, or load factor, and the loads, unless they are already set."""
        self.record.time = time
        if loads is not self._taken:
            self.load(loads.body, loads.points, loads.imposing)
            self._taken = loads

    def load(self, body: np.ndarray, values: Sequence[np.ndarray], imposing: np.ndarray = _NONE) -> None:
        """Set body loads (..., beams, 4) and point loads (..., nl, 3) of each group; time steps may be the first axis.

        imposing: see `impose`.
        """
        self.impose(imposing)
        self.record.body, self.record.loaded = np.ascontiguousarray(body), bool(body.any())
        for work, own in zip(self.works, values, strict=True):
            work.record.values = work.record.values_of_steps = np.ascontiguousarray(own)

    def impose(self, factors: np.ndarray) -> None:
        """Set the factors (..., k) of imposed strains."""
        self._taken = None
        if self._imposes:
            for work in self.works:
                imposed = _imposed(work.group, factors)
                work.record.fill(natural=imposed, natural_of_steps=imposed)

    def unload(self) -> None:
        """Let go of the loads, which may be many rows of a motion."""
        self._taken = None
        self.record.forget("body")
        for work in self.works:
            work.record.forget("values", "values_of_steps", "natural", "natural_of_steps")

    def weigh(self, coefficients: Sequence[float], dt: float = 0.0, moving: bool = False) -> None:
        """Set the weights ck, cv, ca of p, p', p'' in the tangent.

        With ca = 0 there are no inertia forces unless `moving` or beams are damped and cv is not 0, with cv = ca = 0
        no damping forces either. dt [s]: time step since the committed history.
        The geometric part of the tangent uses the stresses of the state from now on.
        """
        own = self.record
        own.predicted = 0
        own.weight_p, own.weight_v, own.weight_a = coefficients
        own.since_committed, own.rated = dt, moving or own.weight_a != 0.0 or own.weight_v != 0.0
        own.moving = moving or own.weight_a != 0.0 or (self._damped and own.rated)

    @property
    def weights(self) -> tuple[float, float, float]:
        """Weights ck, cv, ca of p, p', p'' in the tangent."""
        return self.record.weight_p, self.record.weight_v, self.record.weight_a

    def require(self, *tasks: str) -> None:
        """Compile the routines that compiled drivers will call: forces always; tasks: also "tangent", "prediction"."""
        moving = self.record.moving and "tangent" in tasks
        for work in self.works:
            work.group.require("forces", *tasks, *(("mass",) if moving else ()))

    def place(self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray) -> None:
        """Set the arrays (n,) of the state and of the results."""
        own = self.record
        own.p, own.v, own.a, own.residual, own.entries, own.matrix = p, v, a, residual, matrix.size, matrix

    def balance(
        self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray, predicted: bool
    ) -> None:
        """Assemble the residual (n,) and, unless it is empty, the flat matrix, see `prepare`."""
        self.prepare(p, v, a, residual, matrix, predicted)
        self.evaluate()

    def prepare(
        self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray, predicted: bool
    ) -> None:
        """Set the arrays whose numbers each `evaluate` takes and fills.

        predicted: whether the geometric part of the tangent uses `stresses`.
        """
        self.require(*(("tangent",) if matrix.size else ()))
        self.place(p, v, a, residual, matrix)
        self.record.tangent = matrix.size > 0
        self.record.predicted = predicted and matrix.size > 0

    def evaluate(self) -> None:
        """Assemble the residual and the matrix of the state that the arrays of `prepare` have now."""
        self.call(model_passes.balance.compiled, self.record.address)

    def predict(self, p: np.ndarray, step: np.ndarray, v: np.ndarray | None = None) -> None:
        """Predict `stresses` after a linearised step (n,) from p (n,); v: p' (n,), for damping."""
        self.require("prediction")
        self.record.p, self.record.v, self.record.a = p, step, step if v is None else v
        for work in self.works:
            self.call(model_passes.predict_resultants.compiled, work.record.address, self.record.address, 0)

    @property
    def calls_python(self) -> bool:
        """Whether compiled code calls Python."""
        return bool(self.equations.called)

    def call(self, driver: Callable[..., Any], *arguments: Any) -> Any:
        """Call a compiled driver and return its result. Raises the first error in what it has called in Python."""
        if not self.calls_python:
            return driver(*arguments)
        with Deferred() as deferred:
            result = driver(*arguments)
        error = self.take_error()
        deferred.deliver()
        if error is not None:
            raise error
        return result

    def take_error(self) -> BaseException | None:
        """Return the first error in what compiled code has called in Python, if any, and forget all of them."""
        errors = [each.take_error() for each in self.equations.called]
        return next((error for error in errors if error is not None), None)

    def elastic(self, p: np.ndarray, v: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return e, e'' and the elastic and damping forces (N, per_node) of the only group in a state p, p', p''.

        Imposed strains are subtracted.
        """
        (work,), own = self.works, self.record
        self.place(p, v, a, np.zeros(self.size), np.empty(0))
        self.weigh((1.0, 0.0, 0.0))
        own.fill(tangent=0, predicted=0, loaded=0, rated=1)
        self.require()
        node_passes.place_nodes(work.record, own, 1)
        self.call(element_passes.add_elements.compiled, work.record.address, own.address)
        size = 2 * work.record.vectors
        return work.rows(0, size), work.rows(size, size), work.rows(work.record.force, size)

    def nodal_vectors(self, p: np.ndarray) -> list[np.ndarray]:
        """Return the nodal vectors e (N, per_node) of each group in a state (n,)."""
        self.require()
        self.record.p = p
        vectors = []
        for work in self.works:
            node_passes.place_nodes(work.record, self.record, 0)
            vectors.append(work.rows(0, 2 * work.record.vectors))
        return vectors

    def smallest_jacobian(self, p: np.ndarray) -> float:
        """Return the smallest r0' x d of all quadrature points in a state (n,), at most 1; negative if inverted."""
        self.require()
        self.record.p = p
        smallest = 1.0
        for work in self.works:
            node_passes.place_nodes(work.record, self.record, 0)
            smallest = min(smallest, model_passes.smallest_jacobian(work.record))
        return smallest


def _imposed(group: ElementGroup, factors: np.ndarray) -> np.ndarray | None:
    """Return the strains (..., ne, nq, ns) imposed by loads with factors (..., k), None if there are none."""
    if group.imposed is None or not factors.any():
        return None
    if factors.ndim == 1:
        return np.ascontiguousarray(group.imposed.at(factors))
    return np.array([group.imposed.at(row) for row in factors])
