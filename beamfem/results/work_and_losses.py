"""Work done on a motion and energy that it dissipates between its rows, by the trapezoidal rule."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from beamfem.equations.connectors import Connectors, follows_time
from beamfem.equations.equations import residual
from beamfem.equations.system import System, system_of
from beamfem.results.reactions import energies_of
from beamfem.results.solution import Solution


class Exchange(NamedTuple):
    """Energy exchanged between rows (rows - 1,) [J].

    work: of loads and moving supports; given: by connectors whose forces do work, those that have no energy or depend
    on time; stored: change of the energy of these; lost: dissipated by all else, but for what has a history.
    """

    work: np.ndarray
    given: np.ndarray
    stored: np.ndarray
    lost: np.ndarray


class Forces(NamedTuple):
    """Generalized forces (rows, n) of follower loads, pressures and moving supports, and of connectors that do work.

    lost (rows,) [W]: power that everything else dissipates, but for what has a history.
    """

    work: np.ndarray
    connected: np.ndarray
    lost: np.ndarray


def exchange(solution: Solution, forces: Forces) -> Exchange:
    """Return the energy exchanged between the rows of a motion; forces: those without a potential in them.

    Loads that have a potential at each time, and imposed strains, do the work by which their energy changes with time
    alone.
    """
    driving, moved, at = _driving(solution), np.diff(solution.p, axis=0), solution.at
    means = [0.5 * (values[1:] + values[:-1]) for values in forces]
    work, given = (np.einsum("sn,sn->s", mean, moved) for mean in means[:2])
    if any(load.amplitude is not None for load in solution.model.loads):

        def energy(times: np.ndarray) -> np.ndarray:
            total = replace(solution, at=times).energy().total
            return np.asarray(total - energies_of(driving, solution, times).sum(axis=1))

        now, later, earlier = map(energy, (at, np.append(at[1:], at[-1]), np.append(at[0], at[:-1])))
        work = work + 0.5 * ((later - now)[:-1] + (now - earlier)[1:])
    stored = np.diff(energies_of(driving, solution, at).sum(axis=1))
    return Exchange(work, given, stored, means[2] * np.diff(at))


def forces_without_potential(solution: Solution) -> Forces:
    """Return the forces without a potential; those of loads as the difference that their absence makes."""
    system, driving, (rows, size) = system_of(solution.model, static=False), _driving(solution), solution.p.shape
    work, connected, lost = np.zeros((rows, size)), np.zeros((rows, size)), np.zeros(rows)
    moving = [item.dof for item in system.prescribed if callable(item.value)]
    following = not system.loads.conserves.all()
    damped = system.damped or (len(driving.items) < len(system.connectors.items) and system.connectors.damp)
    if not (moving or following or damped or driving.items):
        return Forces(work, connected, lost)
    for row, (at, p, v, a) in enumerate(zip(solution.at.tolist(), solution.p, solution.v, solution.a, strict=True)):
        if moving or following:
            acting = residual(system, p, v, a, at)
            work[row, moving] = acting[moving]
        if following:
            left = system.loads.of(at, np.where(system.loads.conserves, system.loads.factors(at), 0.0))
            work[row] += residual(system, p, v, a, at, loads=left) - acting
        driving.add_forces(connected[row], (p, v, a), at)
        if damped:
            lost[row] = _dissipated_power(system, driving, p, v, at)
    return Forces(work, -connected, lost)


def _driving(solution: Solution) -> Connectors:
    """Return the connectors whose forces do work; others conserve energy or dissipate it."""
    items = system_of(solution.model, static=False).connectors.items
    return Connectors(solution.model, False, tuple(item for item in items if _drives(item)))


def _drives(item: Any) -> bool:
    return (not item.item.conservative and not len(item.dissipated)) or any(follows_time(item))


def _dissipated_power(system: System, but: Connectors, p: np.ndarray, v: np.ndarray, time: float) -> float:
    """Return the power [W] that all but some connectors dissipate: of the part of the forces that is odd in p'.

    Inertia forces of p' are even.
    """
    forces, zeros = np.zeros((2, len(p))), np.zeros(len(p))
    for result, rate in zip(forces, (v, -v), strict=True):
        but.add_forces(result, (p, rate, zeros), time)
        result -= residual(system, p, rate, zeros, time)
    return float(0.5 * v @ (forces[1] - forces[0]))
