"""Energy of motions: the balance of work and damping in every row, drift, and whether steps resolve what carries it."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from beamfem.equations.equations import INERTIA, ROUND_OFF, linearise, sizes
from beamfem.equations.system import System, system_of
from beamfem.kernels.motion_record import MotionLimits
from beamfem.linalg.tangent import UNROTATED
from beamfem.model.time_functions import kinks_of
from beamfem.results.energies import (
    Forces,
    exchange,
    forces_without_potential,
    recorded_by_stops,
    with_rows,
)

if TYPE_CHECKING:
    from beamfem.results.energies import Energy
    from beamfem.results.solution import Solution

_FAST = 0.2  # (w h)^4; a vibration that alternates from step to step has 16 times its share of the kinetic energy
_REMOVED = 0.2  # of the energy
_OF_COLLOCATION = 3  # numbers that describe a collocation method, see `Statistics`
_COMPARED = 100  # most steps, at equal distances, whose velocities are compared


def resolved(solution: "Solution") -> bool:
    """Return whether the steps of a scheme can neither add much energy to a motion nor remove much.

    It gains energy only where steps h do not resolve a vibration w that carries energy, of which three successive
    velocities v have a second difference of (w h)^2 v; for what it loses see `removal`. Where not all steps are rows,
    and of collocation methods, which resolve a vibration if its period is long beside the time between stages, (w h)^2
    is that of accelerations and velocities. Laws with history are not judged: their steps dissipate too. Kinks of
    forces may last for less than the time between rows.
    """
    system, rule, steps = system_of(solution.model, static=False), solution.statistics.rule, solution.statistics.steps
    if not rule or system.history.laws:
        return False
    collocates = len(rule) == _OF_COLLOCATION
    if collocates and system.kinked:
        return False
    if len(solution) == steps + 1 and not collocates:
        before, now, after = (solution.v[first : steps - 1 + first : 1 + steps // _COMPARED] for first in range(3))
        squares = np.array((now, before - 2.0 * now + after)) ** 2 @ system.table(masses)
        speed, change = squares.max(axis=1, initial=0.0).tolist()
        if change > _FAST * speed:
            return False
        speed, change = squares.sum(axis=1).tolist()
    else:
        squares = np.array((solution.v, rule[0] * solution.a)) ** 2 @ system.table(masses)
        speed, acceleration = squares.sum(axis=1).tolist()
        change = acceleration**2 / (speed or 1.0)
    mean = change / (speed or 1.0)
    if collocates:
        _, stages, share = rule
        return bool(mean <= _FAST * stages**4 and steps * share * mean ** (0.5 * stages) <= _REMOVED)
    second, fourth = removal(rule)
    return bool(mean <= _FAST and steps * (second * sqrt(mean) + fourth * mean) <= _REMOVED)


def removal(rule: Sequence[float]) -> tuple[float, float]:
    """Return b and c: a step removes the share b (w h)^2 + c (w h)^4 of the energy of a slow vibration w.

    From the odd powers of s in ln((w h)^2 / s^2), where exp(s) is a principal root of the method for x'' + w^2 x = 0.
    Of methods of second order b = 0, and of `GeneralizedAlpha` c = ((1 - rho_inf) / (1 + rho_inf))^3.
    """
    _, alpha_m, alpha_f, gamma, beta = rule
    excess = gamma - 0.5
    means = _third_cumulant(alpha_f) - _third_cumulant(alpha_m)
    return excess + alpha_m - alpha_f, means - excess * (1.0 / 6.0 - beta + excess / 2.0 + excess**2 / 3.0)


def _third_cumulant(alpha: float) -> float:
    """Return the coefficient of s^3 in ln(1 - alpha + alpha exp(s))."""
    return alpha * (1.0 - alpha) * (1.0 - 2.0 * alpha) / 6.0


def masses(system: System) -> np.ndarray:
    """Return the diagonal (n,) of the mass matrix in the reference."""
    p, result = system.reference, np.zeros(system.model.size)
    mass = linearise(system, p, result, result, 0.0, INERTIA)[1]
    result[system.free_dofs] = mass.sparse(UNROTATED).diagonal()
    return result


FIRST = (
    32  # rows in which energies are evaluated in any case: what a sudden start gives rise to may last for a few steps
)


@dataclass(frozen=True)
class EnergyDrift:
    """Change of the total energy over a motion on which no work is done.

    Parameters
    ----------
    change : float, [J]
        Change of the total energy from start to end.
    exchanged : float, [J]
        Largest energy exchanged between its kinetic, strain and potential part.
    unit : str
        Name of the model's unit of energy.
    """

    change: float
    exchanged: float
    unit: str = "J"

    @property
    def digits(self) -> float:
        """Decimal digits of the exchanged energy that the change leaves correct; inf if the change is zero."""
        if self.change == 0.0:
            return np.inf
        return float(np.log10(self.exchanged / abs(self.change))) if self.exchanged > 0.0 else 0.0

    def __str__(self) -> str:
        return f"energy drifts by {self.change:.2g} {self.unit} of {self.exchanged:.3g} {self.unit}"


def energy_drift(solution: "Solution") -> EnergyDrift | None:
    """Return the energy drift of a motion; None if work is done on it.

    Work is done by loads with an amplitude, follower loads and pressures, moving supports and damping.
    """
    if solution.static or solution.loaded is not None or driven(solution):
        return None
    system = system_of(solution.model, static=False)
    if system.damped or system.history.laws:
        return None
    energy = _some_rows(solution).energy()
    exchanged = max(energy.kinetic.max(), np.ptp(energy.strain), np.ptp(energy.potential))
    return EnergyDrift(float(energy.total[-1] - energy.total[0]), float(exchanged), solution.model.unit("J"))


def unseen(solution: "Solution", every: int) -> np.ndarray:
    """Return work and dissipation (m + 1, 2) [J] in a motion beyond what every n-th row tells, at these rows."""
    result = np.zeros(((len(solution) - 1) // every + 1, 2))
    if driven(solution) or system_of(solution.model, static=False).damped:
        some, forces = slice(None, None, every), forces_without_potential(solution)
        fine = exchange(solution, forces)
        coarse = exchange(with_rows(solution, some), Forces(*(values[some] for values in forces)))
        for one, sign, count in ((fine, 1.0, every), (coarse, -1.0, 1)):
            changes = np.stack([one.work + one.given + one.stored, one.lost], axis=1)
            result[1:] += sign * changes.reshape(-1, count, 2).sum(axis=1)
    return result.cumsum(axis=0)


def driven(solution: "Solution") -> bool:
    """Return whether loads or supports may do work on a motion, or connectors dissipate or add energy."""
    system = system_of(solution.model, static=False)
    moved = any(callable(item.value) for item in system.prescribed)
    loaded = any(load.amplitude is not None or not load.conservative for load in solution.model.loads)
    return moved or loaded or not system.connectors.keep_energy


_MUCH = 0.1  # of the exchanged energy; a larger rise makes the results meaningless
_LOST = 0.5  # of the exchanged energy; numerical damping removes less where steps resolve what carries the energy
_SMALL = 1e-3  # of the stored energy, a vibration of which is too small to matter
_ROWS = 100  # spans of rows, in the fastest of which energies are evaluated, which cost more than many time steps
_WORKED = 500  # such rows if work is to be summed over them
_SHARES = np.array([0.21, 0.5, 0.79])  # of the time between rows, at which amplitudes are evaluated
_BULGE = 0.1  # of an amplitude, by which it may differ from a straight line between rows


@dataclass(frozen=True)
class Balance:
    """Energy in rows (rows,) [J] that work does not explain.

    energy: its parts; rise: change of energy less the work done; loss: its negative less what is dissipated, nan if
    that is not known; doubt: how accurately rows give the work; unsure: what they do not tell at all, and round-off;
    work: done since the first row.
    """

    time: np.ndarray
    energy: "Energy"
    rise: np.ndarray
    loss: np.ndarray
    doubt: np.ndarray
    unsure: np.ndarray
    work: np.ndarray
    driven: bool

    @property
    def exchanged(self) -> float:
        """Largest energy [J] exchanged."""
        energy = self.energy
        parts = (energy.kinetic, energy.strain, energy.potential, self.work)
        most = (*(np.ptp(part) for part in parts), energy.kinetic.max(), _SMALL * np.abs(energy.strain).max())
        return float(max(most))


def energy_warnings(solution: "Solution") -> tuple[str, ...]:
    """Return a warning if the energy of a motion rises by more than work, or falls by more than damping, explains.

    The largest difference of all rows counts. Differences below round-off of the strain energy, or below the accuracy
    with which rows give the work of loads that vary between them, are none. Energies are evaluated only where steps
    may not resolve the motion. Where supports move, every step that was not divided has to be a row: reactions may
    alternate from step to step.
    """
    if solution.static or len(solution) < 2 or solution.loaded is not None or resolved(solution):
        return ()
    rule, prescribed = solution.statistics.rule, system_of(solution.model, static=False).prescribed
    every_step = bool(rule) and np.diff(solution.at).max() < 1.5 * rule[0]
    if any(callable(item.value) for item in prescribed) and not every_step:
        return ()
    judged, unit = balance(_some_rows(solution)), solution.model.unit
    exchanged = judged.exchanged
    compared = f"compared with {exchanged:.3g} {unit('J')} exchanged at most"
    cases = (
        (judged.rise, _MUCH, "rises", "more than the work that is done on it" if judged.driven else "",
         "the time steps do not resolve its high-frequency vibration"),
        (judged.loss, _LOST, "falls", "more than work and damping explain",
         "the numerical damping of the time steps removes it"),
    )  # fmt: skip
    for change, share, verb, explained, why in cases:
        beyond = change - share * exchanged - judged.doubt - judged.unsure
        row = int(np.argmax(np.where(np.isfinite(beyond), beyond, -np.inf)))
        if beyond[row] > 0.0:
            explained = explained or "although no work is done on the motion"
            return (
                f"the energy {verb} by {change[row]:.3g} {unit('J')} until {judged.time[row]:.6g} {unit('s')}, "
                f"{compared}, {explained}: {why}. Use smaller steps",
            )
    return ()


def _some_rows(solution: "Solution") -> "Solution":
    """Return all rows, or of many the fastest ones of equal spans, with the first ones and the last."""
    count = _WORKED if driven(solution) else _ROWS
    if len(solution) <= count:
        return solution
    speeds, bounds = np.einsum("sn,sn->s", solution.v, solution.v), np.linspace(0, len(solution), count + 1).astype(int)
    fastest = [a + int(np.argmax(speeds[a:b])) for a, b in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)]
    return with_rows(solution, np.unique([*range(FIRST), *fastest, len(solution) - 1]))


def balance(solution: "Solution", accuracy: float = MotionLimits().tolerance) -> Balance:
    """Return the energy balance of the rows of a motion; accuracy: of coordinates, relative to the model."""
    system, energy = system_of(solution.model, static=False), solution.energy()
    works, none = driven(solution), np.zeros(len(solution))
    unsure = _inaccuracy(system, solution.p, energy.strain, accuracy)
    if not (works or system.damped or energy.recorded.any()):
        rise = np.append(0.0, np.cumsum(np.diff(energy.total)))
        return Balance(solution.at, energy, rise, -rise, none, none + unsure, none, works)
    known, by_stops = _resolved(solution, system), recorded_by_stops(solution)
    driving = np.fmin(energy.recorded - by_stops, 0.0) + by_stops
    forces = forces_without_potential(solution)
    work, given, stored, lost = exchange(solution, forces)
    doubt = _doubt(solution, forces, work + given)
    change = np.diff(energy.total) - stored - work
    rise = _summed(change - np.maximum(given, 0.0) + np.diff(driving), known)
    loss = -_summed(change - given + np.maximum(lost, 0.0) + np.diff(energy.recorded), known)
    unknown = _summed(np.abs(np.diff(energy.total) - stored), ~known)
    return Balance(solution.at, energy, rise, loss, doubt, unknown + unsure, _summed(work, known), works)


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


def _doubt(solution: "Solution", forces: Forces, work: np.ndarray) -> np.ndarray:
    """Return by how much the work until each row (rows,) [J] differs if every second row is left out."""
    if not work.any():
        return np.zeros(len(solution))
    every = slice(None, None, 2)
    half = exchange(with_rows(solution, every), Forces(*(values[every] for values in forces)))
    coarse, fine = np.append(0.0, np.cumsum(half.work + half.given)), np.append(0.0, np.cumsum(work))
    largest = np.maximum.accumulate(np.abs(coarse - fine[::2]))
    return np.asarray(largest[np.minimum((np.arange(len(fine)) + 1) // 2, len(largest) - 1)])


def _inaccuracy(system: System, p: np.ndarray, strain: np.ndarray, accuracy: float) -> float:
    """Return the accuracy of strain energies U [J] for coordinates to round-off and an accuracy.

    The energy u of such differences alone changes U by 2 sqrt(U u) + u (Cauchy and Schwarz).
    """
    size = np.array(sizes(system, np.abs(p).max(axis=0)))
    least = 0.5 * (ROUND_OFF + accuracy) ** 2 * float(size @ system.table(_stiffnesses) @ size)
    return 2.0 * sqrt(float(np.abs(strain).max()) * least) + least


def _stiffnesses(system: System) -> np.ndarray:
    """Return the sums (2, 2) of errors of forces per unit errors, in positions and in directions, over both kinds."""
    return system.residual_errors @ np.column_stack([system.positions, ~system.positions])
