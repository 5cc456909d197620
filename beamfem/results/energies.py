"""Energies of a solution, and the work done on a motion and what it dissipates, by the trapezoidal rule."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.equations.connectors import Connectors
from beamfem.equations.equations import energies_of_beams, residuals
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.parts.at_points import ANALYTIC
from beamfem.physics.stations import STATIONS
from beamfem.reprs import brief
from beamfem.results.full_turns import start_rotations
from beamfem.results.postprocess import strain_energies
from beamfem.results.reactions import energies_of_part
from beamfem.results.solution import Solution
from beamfem.results.solution_system import imposed_measures, imposing, loading

_BESIDE = 1e-9  # of the time between rows: distance from a jump at which loads are evaluated


@dataclass(frozen=True)
class PartEnergy:
    """Energies of a beam or part (steps,) [J], and the power [W] that the part exerts on the beams, nan for a beam."""

    kinetic: np.ndarray
    strain: np.ndarray
    potential: np.ndarray
    power: np.ndarray


@dataclass(frozen=True)
class Energy:
    """Energies of a solution (steps,) [J], and the name of the model's unit of energy.

    potential: of gravity, other constant dead loads, springs and foundations; follower forces and pressures have none.
    recorded: dissipated since the start by sections and stops with history; solution: the one over whose rows `work`
    and `dissipated` are integrated.
    """

    kinetic: np.ndarray
    strain: np.ndarray
    potential: np.ndarray
    recorded: np.ndarray
    unit: str = field(default="J", repr=False)
    solution: Solution | None = field(default=None, repr=False)

    __repr__ = brief

    def _unit_of(self, name: str) -> str:
        return self.unit

    def _repr_html_(self) -> str:
        from beamfem.view.summary import energy_table

        return energy_table(self)

    @property
    def total(self) -> np.ndarray:
        """Sum of kinetic, strain and potential energy (steps,) [J]."""
        return self.kinetic + self.strain + self.potential

    def of(self, part: Any) -> PartEnergy:
        """Return the energies of a beam, connector, mass, motor or load, and the power that it exerts on the beams.

        A mass has the potential of gravity; that of beams and other loads is in `potential` as a whole. Raises
        InputError for anything else, such as strains that are imposed, and for energies that are of no solution.
        """
        if self.solution is None:
            raise InputError("these energies are of no solution, of which parts could be known")
        own, none = self.solution, np.zeros(len(self.kinetic))
        if not isinstance(part, Beam):
            kinetic, stored, power = energies_of_part(own, part).T
            return PartEnergy(kinetic, none, stored, power)
        kinetic, strain = _of_beams(own)[0][:, own.model.number_of(part), :2].T
        return PartEnergy(kinetic, strain, none, np.full(len(none), np.nan))

    @cached_property
    def _exchange(self) -> tuple[np.ndarray, np.ndarray]:
        """Work, nan for equilibria, and what rates dissipate since the first row (steps,) [J]."""
        solution = self.solution
        if solution is None or solution.static or solution.loaded is not None or not len(solution):
            return np.full_like(self.kinetic, np.nan), np.zeros_like(self.kinetic)
        own = exchange(solution, forces_without_potential(solution))
        work, lost = (np.append(0.0, np.cumsum(change)) for change in (own.work + own.given + own.stored, own.lost))
        return work, lost

    @property
    def work(self) -> np.ndarray:
        """Work (steps,) [J] done on a motion since its first row; nan for equilibria.

        It is that of moving supports, follower loads and pressures, loads that change with time, imposed strains, and
        connectors that follow time or are not conservative: the mean of the forces in two rows times the displacement
        between them, or the sum of it over steps that were divided; at a declared jump of a load both its values
        count. The work of constant dead loads is in `potential`.
        """
        return self._exchange[0]

    @property
    def dissipated(self) -> np.ndarray:
        """Energy (steps,) [J] dissipated since the start by history, and since the first row by rates.

        Damping of beams and dampers resist rates; the mean of their power in two rows, times the time between them, or
        the sum of it over steps that were divided. In statics, there is only what sections and stops with history have
        recorded, and nan if connectors that are not conservative may dissipate too.
        """
        return self.recorded + self._exchange[1]

    @property
    def error(self) -> np.ndarray:
        """Work less the changes of `total` and of `dissipated` since the first row (steps,) [J]; nan for equilibria.

        It is the error of the time steps, such as numerical damping, and of the integration over the rows.
        """
        return self.work - (self.total - self.total[:1]) - (self.dissipated - self.dissipated[:1])


def energy(solution: Solution) -> Energy:
    """Return the energies of a solution; the potential is zero in the reference."""
    system, times = loading(solution)
    beams, lost, moved = _of_beams(solution)
    moving, stored = system.connectors.energies((solution.p, solution.v, solution.a), times).T
    kinetic, strain = beams[:, :, :2].sum(axis=1).T
    acting = stored + system.springs.potential(solution.p) + _of_frame(solution)
    acting += _of_loads(solution, beams[:, :, 2:6], moved)
    return Energy(kinetic + moving, strain, acting, _recorded(solution, lost), solution.model.unit("J"), solution)


def _of_beams(solution: Solution) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Return the numbers of each beam (steps, beams, 9), and what sections have dissipated (steps,) [J].

    See `kernels.energy_passes`; sums of positions are those since the reference. And the positions of stations
    (steps, nl, 2) [m] of each block.
    """
    system, _ = loading(solution)
    factors = solution.computed(imposing) if system.loads.imposes.any() else np.empty((len(solution), 0))
    result, places = energies_of_beams(system, solution.p, solution.v, factors)
    result[:, :, 2:6] -= system.table(_in_reference)[0][:, 2:6]
    lost = np.zeros(len(solution))
    for number, mesh in enumerate(solution.model.meshes):
        if mesh.beam.law is not None:
            result[:, number, 1], own = strain_energies(mesh, solution.p, imposed_measures(solution, mesh)).T
            lost += own
    return result, lost, places


def _in_reference(system: System) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the numbers of each beam (beams, 9) in the reference at rest, and positions (nl, 2) [m] of stations."""
    at_rest = system.reference[None]
    none = np.zeros((1, system.loads.imposes.sum()))
    result, places = energies_of_beams(system, at_rest, np.zeros_like(at_rest), none)
    return result[0], [each[0] for each in places]


def momenta(solution: Solution) -> np.ndarray:
    """Return linear momentum [kg m/s] and angular momentum about the origin [kg m^2/s] (steps, 3)."""
    system, times = loading(solution)
    rows = zip(solution.p, solution.v, solution.a, times.tolist(), strict=True)
    parts = np.array([system.connectors.momenta((p, v, a), at) for p, v, a, at in rows]).reshape(-1, 3)
    return np.asarray(_of_beams(solution)[0][:, :, 6:].sum(axis=1) + parts)


def _recorded(solution: Solution, by_sections: np.ndarray) -> np.ndarray:
    """Return what history variables record as dissipated (steps,) [J]; by_sections: by sections with history.

    In statics nan if a connector that is not conservative has no record.
    """
    system = loading(solution)[0]
    items = system.connectors.items
    if system.static and any(not item.item.conservative and not len(item.dissipated) for item in items):
        return np.full(len(solution), np.nan)
    return by_sections + sum(solution.p[:, item.dissipated].sum(axis=1) for item in items)


def recorded_by_stops(solution: Solution) -> np.ndarray:
    """Return what parts whose energy depends on their history, such as stops, record as dissipated (steps,) [J].

    It is what they do not give back. Friction, whose limit varies, records a mean over each step.
    """
    items = (item for item in loading(solution)[0].connectors.items if item.compiled and item.compiled.stored is None)
    own = [item.dissipated for item in items]
    return solution.p[:, np.concatenate([np.empty(0, dtype=np.int64), *own])].sum(axis=1)


def _of_loads(solution: Solution, moments: np.ndarray, places: list[np.ndarray]) -> np.ndarray:
    """Return the potential (steps,) [J] of loads that keep their direction, and of foundations.

    moments (steps, beams, 4): of mass and length of the beams; places: of stations, see `_of_beams`.
    """
    system, times = loading(solution)
    loads, result = system.loads, np.zeros(len(solution))
    if not loads.conserves.any() and not solution.model.line_supports:
        return result
    rows = times if system.static or loads.varying else times[:1]  # one row stands for all of them
    factors = np.array([np.where(loads.conserves, loads.factors(at), 0.0) for at in rows.tolist()])
    factors = factors.reshape(len(rows), -1)
    result -= (loads.even(factors) * moments).sum(axis=(1, 2))
    for r, start, actions in zip(places, system.table(_in_reference)[1], loads.actions, strict=True):
        at = actions.stations
        if actions.unit[:, :2].any():
            own = np.append(factors, np.zeros((len(rows), 1)), axis=1)[:, actions.source]
            result -= np.einsum("sqc,qc,sq->s", r - start, actions.unit[:, :2], own)
        for kind in set(at.kind.tolist()):
            if energy := STATIONS[kind].potential:
                some = at.kind == kind
                data = np.hstack([np.zeros((some.sum(), 3)), at.constants[some]])
                result += energy([tuple(r[:, some].T)], data.T[:, :, None], (), ANALYTIC).sum(axis=0)
    for number, point, moment in loads.turning:
        if factors[:, number].any():
            result -= factors[:, number] * moment * solution.rotation(point)
    return result


def _of_frame(solution: Solution) -> np.ndarray:
    """Return the potential (steps,) [J] of centrifugal forces, less the kinetic energy of the rotation of the frame."""
    frame = solution.model.frame
    if frame is None:
        return np.zeros(len(solution))
    system, times = loading(solution)
    unit = RigidVelocity(angular=1.0, about=frame.about)
    p = np.vstack([solution.p, system.reference])
    spin = np.array([rigid_rates(system, unit, row) for row in p])
    moments = energies_of_beams(system, p, spin, np.empty((len(p), 0)))[0][:, :, 0].sum(axis=1)
    moments += system.connectors.energies((p, spin, np.zeros_like(p)), np.zeros(len(p)))[:, 0]
    factors = times if system.static else np.ones(len(times))
    return -(frame.speed**2) * factors * (moments[:-1] - moments[-1])


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
    """Generalized forces (rows, n) of what has no potential, before and after each row, in which they may jump.

    work: of follower loads, pressures and moving supports; given: of connectors that do work; lost (rows,) [W]: power
    that everything else dissipates, but for what has a history.
    """

    work: np.ndarray
    work_after: np.ndarray
    given: np.ndarray
    given_after: np.ndarray
    lost: np.ndarray


def exchange(solution: Solution, forces: Forces) -> Exchange:
    """Return the energy exchanged between the rows of a motion; forces: those without a potential in them.

    Loads that have a potential at each time, and imposed strains, do the work by which their energy changes with time
    alone.
    """
    driving = system_of(solution.model, static=False).connectors.driving
    moved, at, motion = np.diff(solution.p, axis=0), solution.at, (solution.p, solution.v, solution.a)
    ends = (forces.work, forces.work_after), (forces.given, forces.given_after)
    work, given = (0.5 * np.einsum("sn,sn->s", before[1:] + after[:-1], moved) for before, after in ends)
    if any(load.amplitude is not None for load in solution.model.loads):
        work = work + _of_amplitudes(solution, driving)
    stored = np.diff(driving.energies(motion, at).sum(axis=1))
    lost = 0.5 * (forces.lost[1:] + forces.lost[:-1]) * np.diff(at)
    if solution.exchanged is not None:
        unseen = np.diff(solution.exchanged, axis=0)
        work, lost = work + unseen[:, 0], lost + unseen[:, 1]
    return Exchange(work, given, stored, lost)


def _of_amplitudes(solution: Solution, driving: Connectors) -> np.ndarray:
    """Return the work (rows - 1,) [J] of loads that have a potential at each time, and of imposed strains.

    Displacements are linear between rows; loads are evaluated on both sides of jumps.
    """
    if len(solution) < 2:
        return np.zeros(0)
    jumps = system_of(solution.model, static=False).declared_jumps
    at, steps, size = solution.at, np.arange(len(solution) - 1), np.diff(solution.at)
    touched = [np.searchsorted(at, jumps, side) - 1 for side in ("left", "right")]  # those before and after a row
    near, step = np.tile(jumps, 2), np.concatenate(touched).astype(int)
    inside = (step >= 0) & (step < len(steps))
    near, step = near[inside], step[inside]
    beside = [np.clip(near + side * size[step], at[step], at[step + 1]) for side in (-_BESIDE, _BESIDE)]
    step, time = np.concatenate([steps, steps, step, step]), np.concatenate([at[:-1], at[1:], *beside])
    order = np.lexsort((time, step))
    step, time = step[order], time[order]
    ends = np.stack([np.append(step, step + 1), np.tile(time, 2)])
    pairs, places = np.unique(ends, axis=1, return_inverse=True)
    states = replace(with_rows(solution, pairs[0].astype(int)), at=pairs[1])
    motion = (states.p, states.v, states.a)
    energies = states.energy().total - driving.energies(motion, pairs[1]).sum(axis=1)
    before, after = np.diff(energies[places.ravel()].reshape(2, -1), axis=1)
    share = (time - at[step]) / np.maximum(size[step], np.finfo(float).tiny)
    middle, same = 0.5 * (share[1:] + share[:-1]), step[1:] == step[:-1]
    change = (1.0 - middle) * before + middle * after
    return np.bincount(step[1:][same], change[same], len(steps))


def with_rows(solution: Solution, rows: Any) -> Solution:
    """Return the rows of a motion that an index of arrays selects."""
    at, p, v, a = (values[rows] for values in (solution.at, solution.p, solution.v, solution.a))
    exchanged = None if solution.exchanged is None else solution.exchanged[rows]
    others: dict[str, Any] = {"stability": None, "turned": start_rotations(solution)[rows], "exchanged": exchanged}
    return replace(solution, at=at, p=p, v=v, a=a, **others)


def forces_without_potential(solution: Solution) -> Forces:
    """Return the forces without a potential; those of loads as the difference that their absence makes."""
    system, (rows, size) = system_of(solution.model, static=False), solution.p.shape
    driving = system.connectors.driving
    work, given, lost = np.zeros((rows, size)), np.zeros((rows, size)), np.zeros(rows)
    moving = [item.dof for item in system.prescribed if callable(item.value)]
    following = not system.loads.conserves.all()
    damped = system.damped or (len(driving.items) < len(system.connectors.items) and system.connectors.damp)
    if not (moving or following or damped or driving.items):
        return Forces(work, work, given, given, lost)
    times, states = solution.at.tolist(), list(zip(solution.p, solution.v, solution.a, strict=True))
    if moving:
        work[:, moving] = residuals(system, states, times)[:, moving]
    sides = _beside(solution)
    found = [
        (work + _of_followers(system, states, side) if following else work, _of(driving, states, side))
        for side in (sides[:1] if np.array_equal(*sides) else sides)
    ]
    if damped:
        lost += _dissipated_power(system, driving, states, solution.at)
    (work, given), (work_after, given_after) = found[0], found[-1]
    return Forces(work, work_after, given, given_after, lost)


def _beside(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return times (rows,) [s] before and after each row: beside it if a load jumps there."""
    at, jumps = solution.at, system_of(solution.model, static=False).declared_jumps
    inset = _BESIDE * np.diff(at)
    before, after = at - np.append(0.0, inset), at + np.append(inset, 0.0)
    there = np.searchsorted(jumps, before, "left") < np.searchsorted(jumps, after, "right")
    return np.where(there, before, at), np.where(there, after, at)


def _of_followers(system: System, states: Sequence[Sequence[np.ndarray]], times: np.ndarray) -> np.ndarray:
    """Return the forces (rows, n) of loads without a potential: the difference that their absence makes."""
    at = times.tolist()
    factors = [np.where(system.loads.conserves, system.loads.factors(time), 0.0) for time in at]
    left = [system.loads.of(time, own) for time, own in zip(at, factors, strict=True)]
    return np.asarray(residuals(system, states, at, left) - residuals(system, states, at))


def _dissipated_power(
    system: System, but: Connectors, states: Sequence[Sequence[np.ndarray]], times: np.ndarray
) -> np.ndarray:
    """Return the power (rows,) [W] that all but some connectors dissipate: of the part of the forces odd in p'.

    Inertia forces of p' are even.
    """
    rates, zeros = np.array([v for _, v, _ in states]), np.zeros(len(system.reference))
    odd = np.zeros_like(rates)
    for sign in (1.0, -1.0):
        moved = [(p, sign * v, zeros) for p, v, _ in states]
        odd += 0.5 * sign * (residuals(system, moved, times.tolist()) + _of(but, moved, times))
    return np.asarray(np.einsum("sn,sn->s", rates, odd))


def _of(connectors: Connectors, states: Sequence[Sequence[np.ndarray]], times: np.ndarray) -> np.ndarray:
    """Return the forces (rows, n) that connectors exert in states p, p' and p'' (rows, n) at times [s]."""
    result = np.zeros((len(times), len(states[0][0])))
    for row, (p, v, a), time in zip(result, states, times.tolist(), strict=True):
        connectors.add_forces(row, (p, v, a), time)
    return -result
