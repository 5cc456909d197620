"""Energy balance of a motion: whether work and damping explain in every row how its energy changes."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from beamfem.assembly.assembler import Assembler
from beamfem.assembly.equations import ROUND_OFF, residual, sizes
from beamfem.assembly.system import System, system_of
from beamfem.kernels.motion_record import MotionLimits
from beamfem.model.time_functions import kinks_of
from beamfem.results.connector_results import kinetic_of_connectors, potential_of_connectors
from beamfem.results.energy_drift import FIRST, driven, with_rows
from beamfem.results.resolution import resolved

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_MUCH = 0.1  # of the exchanged energy; a larger rise makes the results meaningless
_LOST = 0.5  # of the exchanged energy; numerical damping removes less where steps resolve what carries the energy
_SMALL = 1e-3  # of the stored energy, a vibration of which is too small to matter
_ROWS = 100  # spans of rows, in the fastest of which energies are evaluated, which cost more than many time steps
_WORKED = 500  # such rows if work is to be summed over them
_SHARES = np.array([0.21, 0.5, 0.79])  # of the time between rows, at which amplitudes are evaluated
_BULGE = 0.1  # of an amplitude, by which it may differ from a straight line between rows


@dataclass(frozen=True)
class _Forces:
    """Generalized forces in rows that have no potential.

    work (rows, n): of follower loads, pressures and moving supports; connected (rows, n): of connectors that do not
    conserve energy; damping (rows,) [W]: power that materials dissipate.
    """

    work: np.ndarray
    connected: np.ndarray
    damping: np.ndarray

    def of(self, rows: slice) -> "_Forces":
        return _Forces(self.work[rows], self.connected[rows], self.damping[rows])


@dataclass(frozen=True)
class _Balance:
    """What work does not explain in rows (rows,) [J].

    rise: change of energy less the work done; loss: its negative less what is dissipated, nan if that is not known;
    doubt: how accurately rows give the work; exchanged: largest energy exchanged.
    """

    time: np.ndarray
    rise: np.ndarray
    loss: np.ndarray
    doubt: np.ndarray
    exchanged: float
    driven: bool


def energy_warnings(solution: "Solution") -> tuple[str, ...]:
    """Return a warning if the energy of a motion rises by more than work, or falls by more than damping, explains.

    The largest difference of all rows counts. Differences below round-off of the strain energy, or below the accuracy
    with which rows give the work of loads that vary between them, are none. Energies are evaluated only where steps
    may not resolve the motion. Where supports move, every step has to be a row: reactions may alternate from step to
    step.
    """
    if solution.static or len(solution) < 2 or solution.loaded is not None or resolved(solution):
        return ()
    moved = any(callable(item.value) for item in system_of(solution.model, static=False).prescribed)
    if not _takes_amplitudes(solution) or (moved and len(solution) != solution.statistics.steps + 1):
        return ()
    balance, unit = _balance(_some_rows(solution)), solution.model.unit
    compared = f"compared with {balance.exchanged:.3g} {unit('J')} exchanged at most"
    cases = (
        (balance.rise, _MUCH, "rises", "more than the work that is done on it" if balance.driven else "",
         "the time steps do not resolve its high-frequency vibration"),
        (balance.loss, _LOST, "falls", "more than work and damping explain",
         "the numerical damping of the time steps removes it"),
    )  # fmt: skip
    for change, share, verb, explained, why in cases:
        beyond = change - share * balance.exchanged - balance.doubt
        row = int(np.argmax(np.where(np.isfinite(beyond), beyond, -np.inf)))
        if beyond[row] > 0.0:
            explained = explained or "although no work is done on the motion"
            return (
                f"the energy {verb} by {change[row]:.3g} {unit('J')} until {balance.time[row]:.6g} {unit('s')}, "
                f"{compared}, {explained}: {why}. Use smaller steps",
            )
    return ()


def _takes_amplitudes(solution: "Solution") -> bool:
    """Return whether the loads without a potential, whose work is a difference, are dataclasses with an amplitude."""
    loads = [load for load in solution.model.loads if not load.conservative]
    return all("amplitude" in getattr(type(load), "__dataclass_fields__", ()) for load in loads)


def _some_rows(solution: "Solution") -> "Solution":
    """Return all rows, or of many the fastest ones of equal spans, with the first ones and the last."""
    count = _WORKED if driven(solution) else _ROWS
    if len(solution) <= count:
        return solution
    speeds, bounds = np.einsum("sn,sn->s", solution.v, solution.v), np.linspace(0, len(solution), count + 1).astype(int)
    fastest = [a + int(np.argmax(speeds[a:b])) for a, b in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)]
    return with_rows(solution, np.unique([*range(FIRST), *fastest, len(solution) - 1]))


def _balance(solution: "Solution") -> _Balance:
    system, energy = system_of(solution.model, static=False), solution.energy()
    total, forces = energy.total, _forces(solution, system)
    if not system.connectors.keep_energy:
        total = total - kinetic_of_connectors(solution) - potential_of_connectors(solution)
    known, driving = _resolved(solution, system), np.fmin(energy.dissipated, 0.0)
    work, lost, given = _work(solution, forces)
    rise = _summed(np.diff(total) - work - np.maximum(given, 0.0) + np.diff(np.nan_to_num(driving)), known)
    lost = lost + np.diff(energy.dissipated if system.history.laws else np.zeros(len(solution)))
    loss = -_summed(np.diff(total) - work - given + lost, known)
    parts = (energy.kinetic, energy.strain, energy.potential, _summed(work, known))
    exchanged = max(*(np.ptp(part) for part in parts), energy.kinetic.max(), _SMALL * np.abs(energy.strain).max())
    unknown = _summed(np.abs(np.diff(total)), ~known)
    doubt = _doubt(solution, forces, work + given) + unknown + _inaccuracy(system, solution.p, energy.strain)
    return _Balance(solution.at, rise, loss, doubt, float(exchanged), driven(solution))


def _summed(change: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Return the sum (rows,) of changes (rows - 1,) from row to row, without those that rows do not resolve."""
    return np.append(0.0, np.cumsum(np.where(known, change, 0.0)))


def _resolved(solution: "Solution", system: System) -> np.ndarray:
    """Return whether no function of time varies more between two rows (rows - 1,) than their values tell."""
    begin, end = solution.at[:-1], solution.at[1:]
    result = np.ones(len(begin), dtype=bool)
    functions = [load.amplitude for load in solution.model.loads if load.amplitude is not None]
    functions += [item.value for item in system.prescribed if callable(item.value)]
    for function in {id(function): function for function in functions}.values():
        for kink in kinks_of(function):
            result &= (kink <= begin) | (kink >= end)
        values = np.array([float(function(time)) for time in solution.at.tolist()])
        inner = [[float(function(time)) for time in (begin + share * (end - begin)).tolist()] for share in _SHARES]
        straight = values[:-1] + _SHARES[:, None] * np.diff(values)
        size = np.ptp(np.concatenate([[0.0], values, np.ravel(inner)]))
        result &= np.abs(np.array(inner) - straight).max(axis=0) <= _BULGE * size
    return result


def _work(solution: "Solution", forces: _Forces) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the work between rows (rows - 1,) [J]: of loads and supports, dissipated by materials, of connectors.

    Loads that have a potential at each time, and imposed strains, do the work by which their energy changes with time
    alone.
    """
    moved = np.diff(solution.p, axis=0)
    means = [0.5 * (values[1:] + values[:-1]) for values in (forces.work, forces.connected, forces.damping)]
    work, given = (np.einsum("sn,sn->s", mean, moved) for mean in means[:2])
    if any(load.amplitude is not None for load in solution.model.loads):
        at, energy = solution.at, solution.energy().total
        later = replace(solution, at=np.append(at[1:], at[-1])).energy().total
        earlier = replace(solution, at=np.append(at[0], at[:-1])).energy().total
        work = work + 0.5 * ((later - energy)[:-1] + (energy - earlier)[1:])
    return work, np.maximum(means[2], 0.0) * np.diff(solution.at), given


def _doubt(solution: "Solution", forces: _Forces, work: np.ndarray) -> np.ndarray:
    """Return by how much the work until each row (rows,) [J] differs if every second row is left out."""
    if not work.any():
        return np.zeros(len(solution))
    half, _, given = _work(with_rows(solution, slice(None, None, 2)), forces.of(slice(None, None, 2)))
    coarse, fine = np.append(0.0, np.cumsum(half + given)), np.append(0.0, np.cumsum(work))
    largest = np.maximum.accumulate(np.abs(coarse - fine[::2]))
    return np.asarray(largest[np.minimum((np.arange(len(fine)) + 1) // 2, len(largest) - 1)])


def _forces(solution: "Solution", system: System) -> _Forces:
    """Return the forces without a potential; those of loads as the difference that their absence makes."""
    rows, size = solution.p.shape
    work, connected, damping = np.zeros((rows, size)), np.zeros((rows, size)), np.zeros(rows)
    moving = [item.dof for item in system.prescribed if callable(item.value)]
    following = any(not load.conservative for load in solution.model.loads)
    calm = _undamped(system) if any(block.damping.any() for block in system.blocks) else None
    without = _without_followers(solution) if following else system
    conserved = system.connectors.keep_energy
    if not (moving or following or calm is not None or not conserved):
        return _Forces(work, connected, damping)
    for row, (at, p, v, a) in enumerate(zip(solution.at.tolist(), solution.p, solution.v, solution.a, strict=True)):
        acting = residual(system, p, v, a, at)
        if following:
            work[row] = residual(without, p, v, a, at) - acting
        if calm is not None:
            left = np.empty(size)
            calm.take(system.loads_at(at))
            calm.balance(p, v, a, left, np.empty(0), False)
            system.connectors.add_forces(left, (p, v, a), at)
            damping[row] = v @ (acting - left)
        work[row, moving] += acting[moving]
        if not conserved:
            system.connectors.add_forces(connected[row], (p, v, a), at)
    return _Forces(work, -connected, damping)


def _undamped(system: System) -> Assembler:
    blocks = [block._replace(damping=np.zeros_like(block.damping)) for block in system.blocks]
    result = Assembler(system.equations_of(blocks))
    result.weigh((1.0, 1.0, 1.0))
    return result


def _without_followers(solution: "Solution") -> System:
    """Return the equations with loads that have no potential multiplied by zero, with the same coordinates."""
    model = solution.model
    loads = [load if load.conservative else replace(cast("Any", load), amplitude=_zero) for load in model.loads]
    return system_of(model.with_loads(loads), static=False)


def _zero(time: float) -> float:
    return 0.0


def _inaccuracy(system: System, p: np.ndarray, strain: np.ndarray) -> float:
    """Return the accuracy of strain energies U [J] for coordinates to round-off and the tolerance of time steps.

    The energy u of such differences alone changes U by 2 sqrt(U u) + u (Cauchy and Schwarz).
    """
    reach, turn = sizes(system, np.abs(p).max(axis=0))
    relative = ROUND_OFF + MotionLimits().tolerance
    forces = relative * (reach * system.residual_errors[0] + turn * system.residual_errors[1])
    least = 0.5 * relative * float(forces @ np.where(system.positions, reach, turn))
    return float(2.0 * np.sqrt(np.abs(strain).max() * least) + least)
