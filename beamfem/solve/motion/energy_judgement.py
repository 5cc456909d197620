"""Judgement of time steps by energy, which must change by the work that is done."""

from collections.abc import Mapping
from functools import lru_cache
from itertools import pairwise
from math import inf, isfinite

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.equations.system import System
from beamfem.results.energies import Energy
from beamfem.results.energy_balance import balance, driven, masses
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics
from beamfem.solve.motion.consistent_rows import on_conditions
from beamfem.solve.motion.time_steps import PARTS

CHUNK = 8  # steps that are judged together
MOST_CUTS = 8  # of a step, to 1 / 65536
_UNRESOLVED = 0.005  # (w h)^6 of vibrations times their share of the kinetic energy; below, energies are not evaluated
_GROWN = 5.0  # times the largest kinetic energy so far, from a chunk to the next: it may not be by work
_ALTERNATING, _UNDAMPED = 1e-4, 0.95  # the same of conditions, and the spectral radius from which on
_SMOOTH = 1e-6  # as _UNRESOLVED, of motions that grow smoothly from rest
_SHARE = 0.01  # of the energy exchanged: what steps may change it by in all
_SHARE_MOVED = 0.1  # the same where supports move, of methods whose work rows do not give
BROKEN = 0.5  # the same of methods that err by their order alone: beyond, steps have found another solution
_DIFFERENCES = 3  # steps needed for third differences
_MOST_DOUBT = 0.1  # of the energy exchanged: in work, which steps that fail do not resolve at all
_SLIGHT, _TINY = 0.01, 1e-300  # of the largest speed of a support: what is no corner of its motion; instead of zero
_ACCURACY = 1e-14  # of coordinates, that of the iterations
_FORGOTTEN = 0.1  # of the energy of a vibration, that numerical damping leaves after a chunk
_FASTER = 1.1  # times the largest speed so far: of a state at which exchanged energies are evaluated anew


class EnergyJudge:
    """Judges chunks of steps; rule: of the scheme; end [s]: of the motion; start (3, n): its state at first;
    share: of the energy exchanged, what steps may change it by in all; implicit: whether it is the rule of the steps.

    A chunk is refused if it changes the energy less work by more than half of what is left of the share of the energy
    exchanged so far, and by more than its part of that share if it were spread evenly over the motion: so that
    changes add up to twice the share at most. Numerical damping may also remove up to 1 - rho^2 of the kinetic and
    strain energy in each step, with the spectral radius rho at infinite frequency. Energies of steps that were not cut
    are evaluated only where third differences of velocities, (w h)^3 times those of a vibration w, show that steps h do
    not resolve vibrations that matter, or where the next steps fail.
    """

    def __init__(
        self,
        system: System,
        rule: np.ndarray,
        end: float,
        start: np.ndarray,
        share: float = _SHARE,
        implicit: bool = True,
    ) -> None:
        self._system, self._masses, self._radius = system, system.table(masses), radius_at_infinity(rule)
        self._duration, self._shortest = end, float(rule[0]) / PARTS**MOST_CUTS
        self._damps = self._radius < 1.0 - 1e-6
        self._forgets = self._radius ** (2 * CHUNK) < _FORGOTTEN  # the end of a chunk tells nothing of its beginning
        self._first = self._fastest = np.zeros(1), start[None].copy()  # times (1,) [s] and states (1, 3, n)
        # whether the mean of the forces in two rows times the displacement between them is the work of a step
        self._by_means = implicit and not self._damps
        self._moving = [item.dof for item in system.prescribed if callable(item.value)]
        self._share = _SHARE_MOVED if self._moving and not self._by_means else share
        self._abrupt = bool(system.kinked)  # contacts may begin and end within a chunk
        # rates of conditions alternate, and their alternation grows, where hardly anything damps it
        alternates = implicit and self._radius > _UNDAMPED and len(system.connectors.multipliers) > 0
        self._unresolved = _ALTERNATING if alternates else _UNRESOLVED
        self._speed = self._speed_evaluated = 0.0
        self._drift = self._total = 0.0
        self._parts = list[tuple[float, float]]()  # extreme kinetic, strain and potential energies so far

    @property
    def refuses_jumps(self) -> bool:
        """Whether steps that it refuses have found another solution, and are of no use."""
        return self._share >= BROKEN

    def memory(self) -> dict[str, np.ndarray]:
        """Return what `recall` needs to go on with the judgement of the same motion."""
        numbers = [self._speed, self._speed_evaluated, self._drift, self._total]
        result = {"numbers": np.array(numbers), "parts": np.array(self._parts).reshape(3, -1)}
        for name, (times, states) in (("first", self._first), ("fastest", self._fastest)):
            result[f"{name}_time"], result[name] = times, states[0].copy()
        return result

    def recall(self, memory: Mapping[str, np.ndarray]) -> None:
        """Go on with what was kept."""
        self._speed, self._speed_evaluated, self._drift, self._total = memory["numbers"].tolist()
        self._parts = [(low, high) for low, high in memory["parts"].tolist()] if memory["parts"].size else []
        self._first, self._fastest = (
            (memory[f"{name}_time"], memory[name][None].copy()) for name in ("first", "fastest")
        )

    @cached_property
    def conservative(self) -> bool:
        """Whether energies need no work of loads and supports, which is by the reactions at the ends of steps."""
        return not (driven(self._solution(*self._first)) or self._system.damped or self._system.history.laws)

    @cached_property
    def _unavoidable(self) -> float:
        """Kinetic energy [J] by the first accelerations within the shortest step, which no cut avoids.

        It matters where these are the round-off of stiff parts with hardly any mass, such as massless rods.
        """
        return 0.5 * float(np.square(self._shortest * self._first[1][0, 2]) @ self._masses)

    def accept(self, times: np.ndarray, states: np.ndarray, cut: bool, failed: bool, final: bool) -> int:
        """Return how many steps between states (m + 1, 3, n) at times (m + 1,) [s] are good.

        cut: whether they were cut, so that their energies are evaluated in any case; failed: whether the steps after
        them have failed, so that the last ones are suspect; final: whether they cannot be cut any more.
        """
        steps = len(times) - 1
        bounds = np.append(np.arange(0, steps, CHUNK), steps)
        ends = bounds[1:]
        speeds = np.square(states[ends, 1]) @ self._masses
        doubtful = np.full(len(ends), cut)
        doubtful[-2:] |= failed
        doubted = self._abrupt or self._forgets or len(self._parts) > 0
        if steps < _DIFFERENCES:
            doubtful |= doubted
        elif not cut:
            rows = np.maximum(ends, _DIFFERENCES)
            v = [states[3 - n : steps + 1 - n, 1] if doubted else states[rows - n, 1] for n in range(4)]
            change = v[2] - v[1]  # one array, as many of them would not fit into the cache
            change *= 3.0
            change += v[0]
            change -= v[3]
            change = np.square(change, out=change) @ self._masses
            change = np.maximum.reduceat(change, np.maximum(bounds[:-1] - 2, 0)) if doubted else change
            if self._abrupt:  # a contact that begins in the last step of a chunk shows in p'' before it does in p'
                jump = (times[ends] - times[ends - 1])[:, None] * (states[ends, 2] - states[ends - 1, 2])
                change = np.maximum(change, np.square(jump) @ self._masses)
            fastest = np.maximum.accumulate(np.append(self._speed, speeds))
            grown = (speeds > _GROWN * fastest[:-1]) & (fastest[:-1] > 0.0) & (change > _SMOOTH * speeds)
            doubtful |= ~(change <= self._unresolved * fastest[1:]) | grown
        good = steps
        if doubtful.any():
            chunks = [chunk for chunk, judged in zip(pairwise(bounds.tolist()), doubtful, strict=True) if judged]
            good = self._first_refused(times, states, chunks, cut, final)
        number = int(np.argmax(np.where(ends <= good, speeds, -1.0)))
        if ends[number] <= good and speeds[number] > self._speed:
            self._speed, row = float(speeds[number]), ends[number : number + 1]
            self._fastest = times[row], states[row]
        return good

    def _first_refused(
        self, times: np.ndarray, states: np.ndarray, chunks: list[tuple[int, int]], cut: bool, final: bool
    ) -> int:
        """Return where the first chunk of steps begins that is refused, or the number of steps."""
        before = self._not_evaluated()
        if not self.conservative:  # the work between rows is that of steps
            for time, state in before:
                self._exchange(self._solution(time, state).energy(), 1)
            before = []
        for group in [chunks] if self.conservative else _adjacent(chunks):
            rows = sorted({row for first, last in group for row in range(first, last + 1)})
            which = slice(rows[0], rows[-1] + 1) if rows[-1] - rows[0] < len(rows) else rows
            at, some = map(np.concatenate, zip(*before, (times[which], states[which]), strict=True))
            found = balance(self._solution(at, some), _ACCURACY)
            self._exchange(found.energy, len(before))
            energies = found.energy.kinetic, found.energy.strain, found.energy.potential
            doubt = self._doubt(at, some, found.work) if self._by_means else found.doubt
            table = np.array([*energies, found.rise, found.loss, found.time, doubt, found.unsure])
            place = {row: number for number, row in enumerate(rows, len(before))}
            for first, last in group:
                unsure = float(table[-1, 0]) + self._unavoidable
                if not self._passes(table[:, place[first] : place[last] + 1].tolist(), unsure, final):
                    return first
        return len(times) - 1

    def _passes(self, chunk: list[list[float]], unsure: float, final: bool) -> bool:
        """Judge a chunk of steps by the rows of its balance, and take it into account if it is good.

        chunk: kinetic, strain and potential energies, rises, losses, times, doubts and uncertainties of its rows; these
        are few numbers, for which arrays would take longer; unsure: uncertainty of the first row of all chunks.
        """
        kinetic, strain, potential, rise, loss, time, doubts, uncertain = chunk
        if not all(map(isfinite, kinetic + strain + potential)):
            return False
        parts = [(min(low, *own), max(high, *own)) for (low, high), own in zip(self._parts, chunk[:3], strict=True)]
        exchanged = max(parts[0][1], *(high - low for low, high in parts))
        if self.conservative and not self._damps:
            self._drift = kinetic[0] + strain[0] + potential[0] - self._total
        rises, losses = [each - rise[0] for each in rise], [each - loss[0] for each in loss]
        share = self._share * exchanged
        left = max(share - abs(self._drift), 0.0)
        spent = (time[-1] - time[0]) / self._duration
        allowed = max(0.5 * left, spent * share, (2.0 * share - abs(self._drift)) if final else 0.0)
        doubt = doubts[-1] - doubts[0]
        doubt = doubt if final or self._by_means else min(doubt, _MOST_DOUBT * exchanged)
        doubt += uncertain[-1] - uncertain[0] + unsure
        if self._damps:
            stored = kinetic[0] + strain[0]
            losses = [each - (1.0 - self._radius ** (2.0 * step)) * stored for step, each in enumerate(losses)]
        change = rises[-1] if rises[-1] > 0.0 else -max(0.0, losses[-1])
        bound = max(1.5 * share, abs(self._drift) + 0.25 * share) + doubt
        # nan, where a loss is not known, is none
        highest, lowest = (max((each for each in values if each == each), default=-inf) for values in (rises, losses))
        within = max(highest + self._drift, lowest - self._drift) <= bound
        if not within or (abs(change) > allowed + doubt and abs(self._drift + change) > abs(self._drift)):
            return False
        self._drift += change
        if self._damps:
            self._drift = max(self._drift, 0.0)
        self._parts = parts
        return True

    def _doubt(self, times: np.ndarray, states: np.ndarray, work: np.ndarray) -> np.ndarray:
        """Return how accurately the rows of undamped steps give the work until each row (rows,) [J].

        The mean of the forces in two rows times the displacement between them is the work that a step does, but at
        corners of the motion of a support, where its position or velocity changes otherwise than by the mean of its
        rates in two rows: there energy is found in one step for which work is done in the next.
        """
        step, corners = np.diff(times)[:, None], np.zeros(len(times) - 1)
        moved, speed, acceleration = states[:, :, self._moving].swapaxes(0, 1)
        fastest = abs(speed).max(axis=0)
        for value, rate, scale in ((moved, speed, step * fastest), (speed, acceleration, fastest)):
            change, by_rate = np.diff(value, axis=0), 0.5 * step * (rate[1:] + rate[:-1])
            size = np.maximum(abs(change), abs(by_rate)) + _SLIGHT * scale + _TINY
            corners = np.maximum(corners, (abs(change - by_rate) / size).max(axis=1, initial=0.0))
        return np.append(0.0, np.cumsum(corners * abs(np.diff(work))))

    def _not_evaluated(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return times and states of the first and of the fastest state so far, unless their energies are known."""
        first, fastest = [] if self._parts else [self._first], [self._fastest]
        if not first and self._speed <= _FASTER * self._speed_evaluated:
            return []
        self._speed_evaluated = self._speed
        return first + (fastest if self._fastest is not self._first else [])

    def _exchange(self, energy: Energy, count: int) -> None:
        """Take the energies of the first `count` states into account, of which the first may be that of the motion."""
        if count and not self._parts:
            self._total, self._parts = float(energy.total[0]), [(inf, -inf)] * 3
        values = [own[:count].tolist() for own in (energy.kinetic, energy.strain, energy.potential)]
        known = zip(self._parts, values, strict=True)
        self._parts = [(min(low, *own), max(high, *own)) if own else (low, high) for (low, high), own in known]

    def _solution(self, times: np.ndarray, states: np.ndarray) -> Solution:
        return motion_of(self._system, times, states)


def motion_of(system: System, times: np.ndarray, states: np.ndarray) -> Solution:
    """Return states p, p', p'' (rows, 3, n) of steps, put onto the conditions of joints, as a motion."""
    p, v, a = on_conditions(system, states.copy()).swapaxes(0, 1)
    return Solution(system.model, False, times, p, v, a, Statistics(0, 0, 0, ""))


def _adjacent(chunks: list[tuple[int, int]]) -> list[list[tuple[int, int]]]:
    """Return chunks of steps in groups without gaps."""
    groups: list[list[tuple[int, int]]] = []
    for chunk in chunks:
        if groups and groups[-1][-1][1] == chunk[0]:
            groups[-1].append(chunk)
        else:
            groups.append([chunk])
    return groups


def radius_at_infinity(rule: np.ndarray) -> float:
    """Return the spectral radius of a scheme for x'' + w^2 x = 0 as w grows beyond all bounds."""
    return _radius(*rule[2:].tolist())


@lru_cache(maxsize=64)
def _radius(alpha_f: float, gamma: float, beta: float) -> float:
    """Return the spectral radius, see `radius_at_infinity`.

    There x = 0, so that beta r^2 + (1/2 - 2 beta + gamma) r + 1/2 + beta - gamma = 0 and, for p'' by its mean,
    (1 - alpha_f) r + alpha_f = 0.
    """
    roots = np.roots([beta, 0.5 - 2.0 * beta + gamma, 0.5 + beta - gamma])
    return float(np.abs([alpha_f / (1.0 - alpha_f), *roots]).max())
