"""Work and precision: error against CPU time over meshes and step sizes together, beamfem and Exudyn.

The error of the pendulum at one instant passes through zero for some pairs of mesh and step, where that of the mesh
and that of the steps cancel; so a run is judged by the largest error of the tip over ten instants, 0.1 to 1 s, against
the exact solution. beamfem marches by the trapezoidal rule and by methods of stages, Exudyn by the trapezoidal rule;
its explicit methods, which have a limit of their own, are in `integrators`.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

import beamfem as bf
from studies.benchmarks.peer_cases import (
    CANTILEVER,
    DENSE,
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
    tips_of,
)
from studies.benchmarks.peer_clock import in_turns, once
from studies.benchmarks.peer_ratios import LOAD_STEPS, Row, row

STATIC_MESHES = {
    1: (8, 16, 32, 64, 128, 256, 512),
    2: (4, 8, 16, 32, 64, 128),
    3: (3, 4, 5, 6, 7, 8, 10, 12, 16),
    4: (1, 2, 3, 4, 6, 8, 12),
    6: (1, 2, 3, 4),
}
PEER_STATIC_MESHES = {TWO_NODES: (8, 16, 32, 64, 128, 256, 512), THREE_NODES: (4, 8, 12, 14, 16, 24, 32, 64, 128)}
MOTION_MESHES = (
    (STRUCTURAL, (12, 24, 48, 96)),
    (bf.CRBF(2), (6, 8, 10, 12, 14, 16, 24, 32, 48)),
    (bf.CRBF(3), (4, 5, 6, 8, 10, 12, 16, 24, 32)),
    (bf.CRBF(4), (3, 4, 6, 8, 12, 16, 20)),
)
PEER_MOTION_MESHES = {TWO_NODES: (12, 24, 48, 96), THREE_NODES: (6, 8, 10, 12, 14, 16, 24, 32, 48, 96)}
STEPS = (50, 70, 100, 140, 200, 280, 400, 560, 800, 1120, 1600, 2240, 3200, 4480, 6400, 9000)
TRAPEZOIDAL = bf.GeneralizedAlpha(1.0)
WITH_STAGES = {bf.Radau(3): (50, 70, 100, 140, 200, 280), bf.Radau(5): (50, 70, 100), bf.Gauss(3): (100, 140, 200)}


@dataclass(frozen=True)
class Run:
    """One run: name of the element, mesh, steps, CPU time [ms], largest error and that at the end [m], and the task.

    method: of the steps, if it is not the trapezoidal rule.
    """

    peer: bool
    name: str
    elements: int
    steps: int
    milliseconds: float
    error: float
    last_error: float
    element: bf.Element | None
    task: Callable[[], object]
    method: str = ""


def static_runs() -> list[Run]:
    """Return equilibria of the cantilever over meshes; Exudyn over numbers of load steps as well."""
    runs = []
    for order, meshes in STATIC_MESHES.items():
        for count in meshes:
            element = bf.CRBF(order)
            model = cantilever(element, count)
            error = static_error(bf.solve_static(model).position(model.beams[0].end)[-1])
            runs.append(
                _timed(
                    f"beamfem, order {order}",
                    count,
                    1,
                    (error, error),
                    partial(bf.solve_static, model),
                    element,
                )
            )
    for kind, meshes in PEER_STATIC_MESHES.items():
        for count in meshes:
            other = peer(kind, count, CANTILEVER)
            for load_steps in LOAD_STEPS:
                for solver in (DENSE, SPARSE) if count <= 16 else (SPARSE,):
                    other.equilibrium(load_steps, solver)
                    error = static_error(other.tip_position())
                    task = partial(other.equilibrium, load_steps, solver)
                    if error < 0.1:  # else it did not converge
                        runs.append(_timed(f"Exudyn, {kind}", count, load_steps, (error, error), task))
    return runs


def motion_runs(steps: Iterable[int] = STEPS) -> list[Run]:
    """Return motions of the pendulum over 1 s, over meshes and steps."""
    runs, steps = [], tuple(steps)
    for element, meshes in MOTION_MESHES:
        name = "beamfem, bilinear" if element is STRUCTURAL else f"beamfem, order {element.field.degree}"
        for count in meshes:
            model = pendulum(element, count)
            for method, numbers in ({TRAPEZOIDAL: steps} | WITH_STAGES).items():
                for number in numbers:
                    task = partial(swing, model, number, method=method)
                    errors = motion_errors(tips_of(task()), REISSNER_TIPS)
                    of = "" if method is TRAPEZOIDAL else f" of {method}"
                    runs.append(_timed(name, count, number, errors, task, element, of))
    for kind, meshes in PEER_MOTION_MESHES.items():
        for count in meshes:
            other = peer(kind, count, PENDULUM)
            solver = DENSE if count <= 8 else SPARSE
            for number in steps:
                other.motion(number, 1.0, solver)
                errors = motion_errors(other.positions(), REISSNER_TIPS)
                task = partial(other.motion, number, 1.0, solver)
                runs.append(_timed(f"Exudyn, {kind}", count, number, errors, task))
    return runs


def _timed(
    name: str,
    elements: int,
    steps: int,
    errors: tuple[float, float],
    task: Callable[[], object],
    element: bf.Element | None = None,
    method: str = "",
) -> Run:
    return Run(element is None, name, elements, steps, once(task), *errors, element, task, method)


def envelope(runs: Iterable[Run]) -> tuple[np.ndarray, np.ndarray]:
    """Return times [ms] and errors [m] of the runs that no cheaper one is as precise as, the cheapest first."""
    times, errors = [], []
    for run in sorted(runs, key=lambda run: run.milliseconds):
        if np.isfinite(run.error) and (not errors or run.error < 0.9 * errors[-1]):
            times.append(run.milliseconds)
            errors.append(run.error)
    return np.array(times), np.array(errors)


def cheapest(runs: Iterable[Run], of_peer: bool, error: float, at_end: bool = False) -> Run:
    """Return the cheapest run of a code that stays below an error [m], at all instants or at the end only."""
    good = [run for run in runs if run.peer == of_peer and (run.last_error if at_end else run.error) <= error]
    return min(good, key=lambda run: run.milliseconds)


def equal_accuracy(case: str, runs: list[Run], error: float, goal: float, at_end: bool = False) -> Row:
    """Compare the cheapest runs of both codes, in turns."""
    mine, theirs = cheapest(runs, False, error, at_end), cheapest(runs, True, error, at_end)
    assert mine.element is not None
    timings = in_turns([mine.task, theirs.task], 7)
    errors = [run.last_error if at_end else run.error for run in (mine, theirs)]
    left = mine.element, mine.elements, timings[0], errors[0]
    name = f"{theirs.name.removeprefix('Exudyn, ')}, {theirs.steps} steps"
    return row(
        f"{case}{f', {mine.steps} steps{mine.method}' if mine.steps > 1 else ''}",
        left,
        (name, theirs.elements, timings[1], errors[1]),
        goal,
    )
