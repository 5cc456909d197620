"""The same mesh and steps in beamfem and Exudyn, in turns: times, errors and ratios."""

import os
import time
from collections.abc import Callable
from dataclasses import astuple, dataclass

import numpy as np

import beamfem as bf
from studies.benchmarks.peer_cases import (
    CABLE,
    CANTILEVER,
    DENSE,
    LINEAR_SOLVERS,
    PENDULUM,
    REISSNER_TIPS,
    SPARSE,
    STRUCTURAL,
    THREE_NODES,
    TWO_NODES,
    cantilever,
    motion_errors,
    peer,
    pendulum,
    static_error,
    swing,
    tips_known,
    tips_of,
)
from studies.benchmarks.peer_clock import Timing, fastest, in_turns

Task = Callable[[], object]
LOAD_STEPS = (1, 2, 3, 5, 10)
PAIRS = (
    (STRUCTURAL, TWO_NODES, 0.2),
    (bf.CRBF(2), THREE_NODES, 0.2),
    (bf.ANCF(), CABLE, 0.3),
    (bf.ANCFCRBF(), CABLE, 0.3),
)
MESHES = (6, 12, 24, 100, 1000)
HEADER = (
    "case",
    "elements",
    "beamfem",
    "ms",
    "median",
    "error [m]",
    "Exudyn",
    "elements",
    "ms",
    "median",
    "error [m]",
    "tangents a step",
    "ratio",
    "goal",
)
THREADS_HEADER = (
    "case",
    "elements",
    "beamfem",
    "ms",
    "Exudyn",
    "ms, its default",
    "ms, all cores",
    "ratio to the better",
)


@dataclass(frozen=True)
class Row:
    """A line of the table: CPU time of one second of motion or one equilibrium [ms], error [m]."""

    case: str
    elements: int
    own: str
    own_least: float
    own_median: float
    own_error: float
    peer: str
    peer_elements: int
    peer_least: float
    peer_median: float
    peer_error: float
    tangents: float
    ratio: float
    goal: float


def row(
    case: str,
    own: tuple[bf.Element, int, Timing, float],
    other: tuple[str, int, Timing, float],
    goal: float,
    tangents: float = np.nan,
) -> Row:
    """Return a line; without ratio where the peer took more than a tangent a step: it struggles to converge there."""
    element, elements, mine, error = own
    kind, peer_elements, theirs, peer_error = other
    ratio = np.nan if tangents > 1.0 else round(mine.least / theirs.least, 3)
    name = f"{element.name}, {element.forces.name}"
    left = case, elements, name, mine.least, mine.median, error
    return Row(*left, kind, peer_elements, theirs.least, theirs.median, peer_error, tangents, ratio, goal)


def same_motion(element: bf.Element, kind: str, elements: int, goal: float) -> Row:
    """Compare the pendulum in steps of 1 ms; of long models a part, reckoned as 1000 steps."""
    steps, rounds = (1000, 5) if elements <= 24 else (1000, 3) if elements <= 100 else (200, 3)
    if elements > 100 and kind == CABLE:
        steps, rounds = 20, 2  # each of its steps takes 60 ms
    duration, model, other = 1e-3 * steps, pendulum(element, elements), peer(kind, elements, PENDULUM)
    solvers = LINEAR_SOLVERS if elements <= 24 else (SPARSE,)
    theirs = [lambda solver=solver: other.motion(steps, duration, solver) for solver in solvers]
    timings = [
        timing.times(1.0 / duration) for timing in in_turns([lambda: swing(model, steps, duration), *theirs], rounds)
    ]
    known = tips_known(element)
    own_error = motion_errors(tips_of(swing(model, steps, duration)), known)[1]
    peer_error = motion_errors(other.positions(), None if kind == CABLE else REISSNER_TIPS)[1]
    mine, best = (element, elements, timings[0], own_error), (kind, elements, fastest(timings[1:]), peer_error)
    return row("pendulum, same mesh and steps", mine, best, goal, other.tangents() / steps)


def same_equilibrium(element: bf.Element, kind: str, elements: int, goal: float) -> Row:
    """Compare the cantilever; Exudyn with its best number of load steps."""
    model, other = cantilever(element, elements), peer(kind, elements, CANTILEVER)
    solvers = LINEAR_SOLVERS if elements <= 24 else (SPARSE,)
    choices = [(load_steps, solver) for load_steps in LOAD_STEPS for solver in solvers]
    theirs = [lambda chosen=chosen: other.equilibrium(*chosen) for chosen in choices]
    errors = []
    for task in theirs:
        task()
        errors.append(static_error(other.tip_position()))
    # a number of load steps that does not converge is none
    found = [i for i, error in enumerate(errors) if error < 1.5 * min(errors)]
    timings = in_turns([lambda: bf.solve_static(model), *[theirs[i] for i in found]], 5)
    own_error = static_error(bf.solve_static(model).position(model.beams[0].end)[-1])
    mine, best = (element, elements, timings[0], own_error), (kind, elements, fastest(timings[1:]), min(errors))
    return row("cantilever, same mesh", mine, best, goal)


def same_mesh() -> list[Row]:
    """Return all lines with the same mesh on both sides."""
    rows = [same_motion(element, kind, count, goal) for element, kind, goal in PAIRS for count in MESHES]
    return rows + [
        same_equilibrium(element, kind, count, goal) for element, kind, goal in PAIRS[:2] for count in (12, 100, 1000)
    ]


def default_threads() -> list[tuple[object, ...]]:
    """Return wall times with the threads that each code takes by itself, and Exudyn with all cores as well."""
    motions = ((STRUCTURAL, TWO_NODES, 24), (STRUCTURAL, TWO_NODES, 1000))
    equilibria = ((STRUCTURAL, TWO_NODES, 12), (bf.CRBF(2), THREE_NODES, 1000))
    rows = [_wall("pendulum, 200 steps", *chosen, *_motion_tasks(*chosen)) for chosen in motions]
    return rows + [_wall("cantilever, 5 load steps there", *chosen, *_static_tasks(*chosen)) for chosen in equilibria]


def _motion_tasks(element: bf.Element, kind: str, elements: int) -> tuple[Task, Callable[[int], Task]]:
    model, other = pendulum(element, elements), peer(kind, elements, PENDULUM)
    solver = DENSE if elements <= 24 else SPARSE
    return lambda: swing(model, 200, 0.2), lambda threads: lambda: other.motion(200, 0.2, solver, threads)


def _static_tasks(element: bf.Element, kind: str, elements: int) -> tuple[Task, Callable[[int], Task]]:
    solver = DENSE if elements <= 24 else SPARSE
    model, other = cantilever(element, elements), peer(kind, elements, CANTILEVER)
    return lambda: bf.solve_static(model), lambda threads: lambda: other.equilibrium(5, solver, threads)


def _wall(
    case: str, element: bf.Element, kind: str, elements: int, own: Task, other: Callable[[int], Task]
) -> tuple[object, ...]:
    cores = os.cpu_count() or 1
    mine, single, many = (t.least for t in in_turns([own, other(1), other(cores)], 3, time.perf_counter))
    return case, elements, f"{element.name}, {element.forces.name}", mine, kind, single, many, mine / min(single, many)


def as_tuples(rows: list[Row]) -> list[tuple[object, ...]]:
    """Return lines as tables take them."""
    return [astuple(line) for line in rows]
