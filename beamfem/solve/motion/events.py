"""Events of a motion: functions of the state that cross zero."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.results.motion_state import MotionState
from beamfem.solve.motion.dense_output import balanced
from beamfem.validation import convert, finite, flag, shown, text

_CLOSE = 1e-12  # of a step: accuracy of the time of an event
_BEGIN = 1e-9  # of a step: an event this close to the beginning is the one with which the motion before has ended


@dataclass(frozen=True)
class Event:
    """A function of the state whose crossing of zero is located and recorded in `solution.events`.

    Raises InputError for invalid arguments.

    Parameters
    ----------
    name : str
        Name of the event.
    function : callable
        Takes a `MotionState`, returns a number. A crossing within a step is found if the function has another sign at
        its end; one at the very beginning of a motion does not count, as with it another one may have ended.
    rising : bool, optional
        Whether only crossings from negative to positive count, or, if False, only those from positive to negative.
    stop : bool, default False
        Whether the motion ends there.

    Examples
    --------
    >>> event = bf.Event("tip turns upwards", lambda state: state.velocity(beam.end)[1], rising=True)
    >>> motion = bf.simulate(model, duration=0.5, step=0.001, events=[event])
    >>> motion.events[0].name
    'tip turns upwards'
    """

    name: str
    function: Callable[[MotionState], float]
    rising: bool | None = None
    stop: bool = False

    def __post_init__(self) -> None:
        convert(self, text, "name")
        convert(self, flag, "stop")
        if not callable(self.function):
            raise InputError(f"function of event {self.name!r} must be callable, got {shown(self.function)}")
        if self.rising is not None:
            convert(self, flag, "rising")


@dataclass
class Watch:
    """Looks for events in steps; found: names and times [s]; values (k,): of functions at the last time [s] looked at.

    smooth, resolved: see `dense_output`.
    """

    system: System
    events: Sequence[Event]
    smooth: bool = False
    resolved: bool = False
    found: list[tuple[str, float]] = field(default_factory=list)
    time: float = 0.0
    values: list[float] = field(default_factory=list)

    def begin(self, time: float, state: np.ndarray) -> None:
        """Evaluate the functions at the beginning (3, n)."""
        self.values = [self._value(event, self._state(time, state)) for event in self.events]

    def look(self, times: np.ndarray, states: np.ndarray) -> float | None:
        """Record events between states (m + 1, 3, n) at times (m + 1,) [s]; return when the motion stops, or None."""
        if not self.events:
            return None
        for number in range(len(times) - 1):
            after = self._state(float(times[number + 1]), states[number + 1])
            now = [self._value(event, after) for event in self.events]
            pair = slice(number, number + 2)
            located = [
                (self._locate(event, times[pair], states[pair]), event)
                for event, before, value in zip(self.events, self.values, now, strict=True)
                if (before < 0.0 <= value and event.rising is not False)
                or (before > 0.0 >= value and event.rising is not True)
            ]
            self.values, self.time = now, after.time
            step = float(times[number + 1] - times[number])
            crossed = sorted([each for each in located if each[0] > _BEGIN * step], key=lambda pair: pair[0])
            stop = min((time for time, event in crossed if event.stop), default=np.inf)
            latest = stop + 2.0 * _CLOSE * step  # at the same instant
            self.found += [(event.name, min(time, stop)) for time, event in crossed if time <= latest]
            if stop < np.inf:
                return stop
        return None

    def _locate(self, event: Event, times: np.ndarray, states: np.ndarray) -> float:
        """Return when a function changes its sign in a step (2,) [s]."""
        from scipy.optimize import brentq  # slow to import and rarely needed

        begin, step = float(times[0]), float(times[1] - times[0])

        def value(share: float) -> float:
            return self._value(event, self._at(begin + share * step, times, states))

        if value(0.0) * value(1.0) >= 0.0:  # it is zero at an end
            return float(times[1])
        return begin + step * float(brentq(value, 0.0, 1.0, xtol=_CLOSE))

    def _at(self, time: float, times: np.ndarray, states: np.ndarray) -> MotionState:
        return self._state(time, balanced(self.system, times, states, time, self.smooth, self.resolved))

    def _state(self, time: float, state: np.ndarray) -> MotionState:
        p, v, a = state[:3].copy()
        return MotionState(p, v, a, time, self.system.model)

    def _value(self, event: Event, state: MotionState) -> float:
        return finite(f"function of event {event.name!r}", event.function(state))
