"""Rows of a motion that are kept: all steps, or states at given times, between the ends of steps as well."""

from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from beamfem.equations.system import System
from beamfem.kernels.motion_steps import count_rotations
from beamfem.results.motion_state import Occurrence
from beamfem.solve.motion.consistent_rows import finished_rows
from beamfem.solve.motion.cut_steps import Rows
from beamfem.solve.motion.dense_output import balanced
from beamfem.solve.motion.events import Watch


@dataclass
class SavedRows:
    """Times, states (3, n), rotations (m,) [rad] and exchanged energies (2,) [J] of the rows so far, and events.

    at (k,) [s]: times of rows, ascending, None for a row at the end of every step; jumps: see `finished_rows`; smooth,
    resolved: see `dense_output`; stopped: whether an event has stopped the motion.
    """

    system: System
    pairs: np.ndarray
    at: np.ndarray | None
    jumps: Collection[float]
    watch: Watch
    smooth: bool = False
    resolved: bool = False
    times: list[float] = field(default_factory=list)
    states: list[np.ndarray] = field(default_factory=list)
    rotations: list[np.ndarray] = field(default_factory=list)
    exchanged: list[np.ndarray] = field(default_factory=list)
    stopped: bool = field(default=False, init=False)

    @property
    def waiting(self) -> np.ndarray:
        """Numbers (2,) of rows and events that were not taken out."""
        return np.array([len(self.times), len(self.watch.found)])

    def begin(self, state: np.ndarray, rotations: np.ndarray) -> None:
        """Take the beginning (3, n) of the motion."""
        self.watch.begin(0.0, state)
        if self.at is None or self.at[0] == 0.0:
            self.times, self.states, self.rotations = [0.0], [state.copy()], [rotations.copy()]
            self.exchanged = [np.zeros(2)]

    def keep(self, times: np.ndarray, rows: Rows) -> None:
        """Take steps that end at times (m + 1,) [s], with the rows at these; the first row is known already."""
        if len(times) < 2:
            return
        try:
            end = self.watch.look(times, rows.states)
        except BaseException:  # of a function, or Ctrl-C: rows before it are kept
            self._keep_at(times, rows, self._inside(times, self.watch.time))
            raise
        self.stopped = end is not None
        if end is not None:
            self._keep_at(times, rows, np.union1d(self._inside(times, end), end))
        elif self.at is None:
            self.times += times[1:].tolist()
            self.states += list(rows.states[1:].copy())
            self.rotations += list(rows.rotations[1:].copy())
            self.exchanged += list(rows.exchanged[1:].copy())
        else:
            self._keep_at(times, rows, self._inside(times, float(times[-1])))

    def take_out(self, before: int) -> tuple[np.ndarray, Rows, tuple[Occurrence, ...]]:
        """Return and forget times (k,), rows (k,) and events; before: number of rows that were taken out."""
        times, found = np.array(self.times), self.watch.found
        rows = before + np.searchsorted(times, [time for _, time in found])
        events = tuple(Occurrence(*each, row) for each, row in zip(found, rows.tolist(), strict=True))
        states = np.array(self.states).reshape(len(times), 3, self.system.model.size)
        states = finished_rows(self.system, self.times, states, self.jumps)
        rotations = np.array(self.rotations).reshape(len(times), len(self.pairs))
        exchanged = np.array(self.exchanged).reshape(len(times), 2)
        self.times, self.states, self.rotations, self.exchanged, self.watch.found = [], [], [], [], []
        return times, Rows(states, rotations, exchanged), events

    def _inside(self, times: np.ndarray, end: float) -> np.ndarray:
        """Return the times of rows [s] in steps that end at times (m + 1,) [s], up to an end [s]."""
        own = times[1:] if self.at is None else self.at
        return own[(own > times[0]) & (own <= end)]

    def _keep_at(self, times: np.ndarray, rows: Rows, at: np.ndarray) -> None:
        if not len(at):
            return
        ends = np.searchsorted(times, at)
        if np.array_equal(times[ends], at):
            self.times += at.tolist()
            self.states += list(rows.states[ends])
            self.rotations += list(rows.rotations[ends])
            self.exchanged += list(rows.exchanged[ends])
            return
        for time, end in zip(at.tolist(), ends.tolist(), strict=True):
            before, exact = max(end - 1, 0), times[end] == time
            state = rows.states[end].copy()
            if not exact:
                state = balanced(self.system, times, rows.states, time, self.smooth, self.resolved)
            turned = rows.rotations[before].copy()
            count_rotations(len(self.pairs), self.pairs, rows.states[before], state, turned)
            self.times.append(time)
            self.states.append(state)
            self.rotations.append(turned)
            self.exchanged.append(rows.exchanged[end if exact else before].copy())
