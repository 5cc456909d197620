"""Newton's steps of one long chain on two threads, by substructuring.

The chain is cut at a node. Each half eliminates its own unknowns, the second from its far end on, so that those of the
node they share stand last in both; the sum of what is left of the two, a few rows, is solved for the shared ones.
"""

import os
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.analysis.equations import point_rows
from beamfem.analysis.tangent import SMALLEST_PIVOT
from beamfem.kernels.balance import balance, smallest_jacobian
from beamfem.kernels.band import factor, solve_upper
from beamfem.kernels.block import PointLoads, Springs
from beamfem.kernels.equilibrate import take
from beamfem.kernels.stress import predict_stress
from beamfem.model.blocks import workspace
from beamfem.model.system import System

_LONG = 20_000  # elements; below, two threads gain little
_STATICS = np.array([1.0, 0.0, 0.0])
_NOTHING = np.empty(0)


@dataclass(frozen=True, eq=False)
class Half:
    """One side of the cut, numbered by itself.

    place: its coordinates among those of the chain; free: its unknown ones among its own, in the order of elimination,
    the shared ones last, from `inner` on; model, actions: what `balance` takes before and behind the state; the rest is
    its state and space for its step.
    """

    place: slice
    free: np.ndarray
    inner: int
    model: tuple[Any, ...]
    actions: tuple[Any, ...]
    scale: np.ndarray
    p: np.ndarray
    rest: np.ndarray
    step: np.ndarray
    residual: np.ndarray
    right: np.ndarray
    rows: np.ndarray

    def balance(self, predicted: bool, matrix: np.ndarray) -> None:
        """Fill the residual and, unless it is empty, the matrix."""
        rest = self.rest
        balance(*self.model, self.p, rest, rest, *self.actions, 0, _STATICS, predicted, self.residual, matrix)


def worth_halving(system: System, elements: int = _LONG) -> bool:
    """Tell whether a model is one chain of so many elements, and two cores may be used."""
    model = system.model
    single = len(model.beams) == 1 and not model.joints and not system.inclined
    return single and system.unknowns.pattern is None and len(system.blocks[0].node) >= elements and _cores() > 1


def _cores() -> int:
    """Cores that this process may use; like the libraries of linear algebra, no more than OMP_NUM_THREADS."""
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    limit = os.environ.get("OMP_NUM_THREADS", "")
    return min(allowed, int(limit)) if limit.isdecimal() else allowed


def halves_of(system: System, start: np.ndarray, load_factor: float) -> tuple[Half, Half]:
    """Return the halves of a chain in the state `start` (n,), cut at a node near its middle."""
    node, dof = system.blocks[0].node, system.blocks[0].dof
    # at a corner of the curve two nodes stand at the same place
    cuts = 1 + np.flatnonzero(node[1:, 0] == node[:-1, -1])
    cut = int(cuts[len(cuts) // 2])
    shared = dof[node[cut, 0]]
    shared = shared[shared >= 0]
    first, end = int(shared.min()), int(shared.max()) + 1
    unknown = int((system.unknowns.free[shared] >= 0).sum())
    return (
        _half(system, start, load_factor, slice(0, cut), slice(0, end), first, unknown),
        _half(system, start, load_factor, slice(cut, len(node)), slice(first, len(start)), len(start), unknown),
    )


def _half(
    system: System, start: np.ndarray, load_factor: float, elements: slice, place: slice, sprung_to: int, shared: int
) -> Half:
    """Return a half of its elements and coordinates; springs of the shared node belong to the second one."""
    (whole,), (loads,), (layout,), (values,) = (
        system.blocks, system.point_loads, system.layouts, point_rows(system, load_factor),
    )  # fmt: skip
    own = whole.node[elements]
    nodes = slice(int(own[0, 0]), int(own[-1, -1]) + 1)
    dof = whole.dof[nodes]
    block = whole._replace(
        node=own - nodes.start,
        dof=np.where(dof >= 0, dof - place.start, -1),
        **{name: getattr(whole, name)[elements] for name in ("kind", "beam")},
        **{name: getattr(whole, name)[nodes] for name in ("carrier", "frame", "home")},
    )
    known = layout.free[place] < 0
    order = np.flatnonzero(~known)
    if place.start > 0:
        order = order[::-1].copy()
    free = np.full(len(known), -1, dtype=np.int64)
    free[order] = np.arange(len(order))
    width = 2 * layout.half_width + 1
    loaded = (loads.element >= elements.start) & (loads.element < elements.stop)
    parts = {name: value[loaded] for name, value in loads._asdict().items()}
    parts["element"] -= elements.start
    sprung = (system.springs.dof >= place.start) & (system.springs.dof < sprung_to)
    where, stiffness, rest, _ = (value[sprung] for value in system.springs)
    number = free[where - place.start]
    springs = Springs(
        where - place.start, stiffness, rest, np.where(number < 0, -1, number * width + layout.half_width)
    )
    stress = np.empty((len(own), *block.reference.shape[1:]))
    return Half(
        place,
        order,
        len(order) - shared,
        (
            system.forms,
            (block,),
            (workspace(block, stress),),
            (PointLoads(**parts),),
            springs,
            (layout._replace(free=free),),
        ),
        (system.body(load_factor), (np.ascontiguousarray(values[:, loaded]),)),
        system.scale[place],
        start[place].copy(),
        np.zeros(len(known)),
        np.empty(len(known)),
        np.empty(len(known)),
        np.empty(len(order)),
        np.empty((len(order), width)),
    )


def correct(
    halves: tuple[Half, Half], pool: Executor, predicts: bool, change: tuple[np.ndarray, np.ndarray] | None
) -> tuple[float, int]:
    """Take one step of Newton's method; return its relative size and how many pivots were negative.

    predicts: take predicted stresses for the geometric tangent; change: on the first step that of the held coordinates
    (n,) and what it changes in the residual (n,). Raises LinAlgError where pivots are needed.
    """
    later = predicts and change is None
    left = list(pool.map(lambda half: _eliminate(half, later, change), halves))
    # in the second half the shared unknowns stand in reversed order
    schur, right, size = (a + np.flip(b) for a, b in zip(*left, strict=True))
    if change is not None:
        right -= change[1][halves[0].free[halves[0].inner :]]
    if not np.isfinite(schur).all():
        return np.nan, 0
    if not (size > 0.0).all():
        raise LinAlgError("the tangent is singular")
    pivots = np.linalg.eigvals(schur / size[:, None]).real
    if not np.abs(pivots).min(initial=1.0) > SMALLEST_PIVOT:
        raise LinAlgError("the tangent is singular")
    shared = np.linalg.solve(schur, right)
    both = zip(halves, (shared, shared[::-1]), strict=True)
    sizes = pool.map(lambda own: _advance(*own, predicts, change), both)
    diagonals = (half.rows[: half.inner, half.rows.shape[1] // 2] for half in halves)
    negative = int((pivots < 0.0).sum()) + sum(int((inverse < 0.0).sum()) for inverse in diagonals)
    return float(np.max(list(sizes))), negative


def _eliminate(
    half: Half, predicted: bool, change: tuple[np.ndarray, np.ndarray] | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return what is left for the shared unknowns (s,): matrix, right-hand side and the diagonal before."""
    rows, right, inner, middle = half.rows, half.right, half.inner, half.rows.shape[1] // 2
    half.balance(predicted, rows.reshape(-1))
    np.negative(np.take(half.residual, half.free, out=right, mode="clip"), out=right)
    if change is not None:
        right[:inner] -= change[1][half.place][half.free[:inner]]
    diagonal = np.abs(rows[inner:, middle])
    if not factor(rows, right, half.step[:inner], half.model[0][0].window) > SMALLEST_PIVOT:
        raise LinAlgError("a pivot is tiny")
    i, j = np.ogrid[: len(diagonal), : len(diagonal)]
    return rows[inner + i, middle + j - i], right[inner:].copy(), diagonal


def _advance(half: Half, shared: np.ndarray, predicts: bool, change: tuple[np.ndarray, np.ndarray] | None) -> float:
    """Take the step whose shared unknowns are known; return its relative size."""
    forms, (block,), (work,) = half.model[:3]
    half.right[half.inner :] = shared
    solve_upper(half.rows[: half.inner], half.right, forms[0].window)
    half.step[:] = 0.0 if change is None else change[0][half.place]
    half.step[half.free] = half.right
    if predicts:
        predict_stress(forms[0], block, work, half.p, half.step, work.stress)
    return float(take(half.step, half.p, half.scale))


def joined(halves: tuple[Half, Half], pool: Executor) -> tuple[np.ndarray, np.ndarray, float]:
    """Return state (n,), residual (n,) and the smallest r0' x d of the chain."""
    smallest = min(pool.map(_balanced, halves))
    state, residual = np.zeros((2, halves[1].place.stop))
    for half in halves:
        state[half.place] = half.p
        residual[half.place] += half.residual
    return state, residual, smallest


def _balanced(half: Half) -> float:
    half.balance(False, _NOTHING)
    return float(smallest_jacobian(*half.model[:3]))
