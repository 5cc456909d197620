"""Work done on a motion and energy that it dissipates between its rows, by the trapezoidal rule."""

from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from beamfem.equations.connectors import Connectors, follows_time
from beamfem.equations.equations import residual
from beamfem.equations.system import System, system_of
from beamfem.model.load_base import CompositeLoad, Load
from beamfem.results.reactions import energies_of
from beamfem.results.solution import Solution


@dataclass(frozen=True)
class Forces:
    """Generalized forces in rows that have no potential.

    work (rows, n): of follower loads, pressures and moving supports; connected (rows, n): of some connectors; lost
    (rows,) [W]: power that everything else dissipates, but for what has a history.
    """

    work: np.ndarray
    connected: np.ndarray
    lost: np.ndarray

    def of(self, rows: slice) -> "Forces":
        """Return the forces in some rows."""
        return Forces(self.work[rows], self.connected[rows], self.lost[rows])


def exchange(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return the work done on a motion since its first row, and what beams and connectors dissipate (rows,) [J].

    Forces of connectors that have no energy, or depend on time, do work; those with history record what they dissipate.
    """
    system = system_of(solution.model, static=False)
    driving = driving_connectors(solution, system)
    forces = forces_without_potential(solution, system, driving)
    work, lost, given = work_between(solution, forces, driving)
    stored = energies_of(driving, solution, solution.at).sum(axis=1)
    return _since(work + given + np.diff(stored)), _since(lost)


def driving_connectors(solution: "Solution", system: System) -> Connectors:
    """Return the connectors whose forces do work; others conserve energy or dissipate it."""
    return Connectors(solution.model, False, tuple(item for item in system.connectors.items if _drives(item)))


def _drives(item: Any) -> bool:
    """Return whether the force of a connector does work."""
    return (not item.item.conservative and not len(item.dissipated)) or any(follows_time(item))


def _since(change: np.ndarray) -> np.ndarray:
    """Return the sum (rows,) of changes (rows - 1,)."""
    return np.append(0.0, np.cumsum(change))


def forces_without_potential(solution: Solution, system: System, connectors: Connectors) -> Forces:
    """Return the forces without a potential; those of loads as the difference that their absence makes.

    connectors: those whose forces are `connected`.
    """
    rows, size = solution.p.shape
    work, connected, lost = np.zeros((rows, size)), np.zeros((rows, size)), np.zeros(rows)
    moving = [item.dof for item in system.prescribed if callable(item.value)]
    following = any(not load.conservative for load in solution.model.loads)
    without = _without_followers(solution) if following else system
    damped = system.damped or (len(connectors.items) < len(system.connectors.items) and system.connectors.damp)
    if not (moving or following or damped or connectors.items):
        return Forces(work, connected, lost)
    for row, (at, p, v, a) in enumerate(zip(solution.at.tolist(), solution.p, solution.v, solution.a, strict=True)):
        if moving or following:
            acting = residual(system, p, v, a, at)
            work[row, moving] = acting[moving]
        if following:
            work[row] += residual(without, p, v, a, at) - acting
        if connectors.items:
            connectors.add_forces(connected[row], (p, v, a), at)
        if damped:
            lost[row] = _dissipated_power(system, connectors, p, v, at)
    return Forces(work, -connected, lost)


def _dissipated_power(system: System, but: Connectors, p: np.ndarray, v: np.ndarray, time: float) -> float:
    """Return the power [W] that all but some connectors dissipate: of the part of the forces that is odd in p'.

    Inertia forces of p' are even.
    """
    forces, zeros = np.zeros((2, len(p))), np.zeros(len(p))
    for result, rate in zip(forces, (v, -v), strict=True):
        but.add_forces(result, (p, rate, zeros), time)
        result -= residual(system, p, rate, zeros, time)
    return float(0.5 * v @ (forces[1] - forces[0]))


def work_between(
    solution: Solution, forces: Forces, connectors: Connectors
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the work between rows (rows - 1,) [J]: of loads and supports, dissipated, of connectors.

    Loads that have a potential at each time, and imposed strains, do the work by which their energy changes with time
    alone.
    """
    moved = np.diff(solution.p, axis=0)
    means = [0.5 * (values[1:] + values[:-1]) for values in (forces.work, forces.connected, forces.lost)]
    work, given = (np.einsum("sn,sn->s", mean, moved) for mean in means[:2])
    if any(load.amplitude is not None for load in solution.model.loads):
        at = solution.at
        now, later, earlier = (
            _energy_without(solution, connectors, times)
            for times in (at, np.append(at[1:], at[-1]), np.append(at[0], at[:-1]))
        )
        work = work + 0.5 * ((later - now)[:-1] + (now - earlier)[1:])
    return work, means[2] * np.diff(solution.at), given


def _energy_without(solution: Solution, connectors: Connectors, at: np.ndarray) -> np.ndarray:
    """Return the total energy (rows,) [J] without that of some connectors, under the loads at other times (rows,)."""
    energy = replace(solution, at=at).energy().total
    return np.asarray(energy - energies_of(connectors, solution, at).sum(axis=1))


def _without_followers(solution: Solution) -> System:
    """Return the equations with loads that have no potential multiplied by zero, with the same coordinates."""
    model = solution.model
    loads = [load if load.conservative else _without_size(load) for load in model.loads]
    return system_of(model.with_loads(loads), static=False)


def _without_size(load: Load) -> Load:
    if isinstance(load, CompositeLoad):
        return load.changed(lambda value: _zero)
    return replace(cast("Any", load), amplitude=_zero)


def _zero(time: float) -> float:
    return 0.0
