"""Marching with user-defined integrators, step by step."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.system import System
from beamfem.errors import ConvergenceError, InputError
from beamfem.results.solution import State
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion, Integrator, driven
from beamfem.solve.motion.stored_states import Saving
from beamfem.validation import shown

_SAME = 1e-6  # of a step: accuracy of the time of the state that it returns


class Memory(NamedTuple):
    """What an integrator keeps besides the coordinates p (n,) at the end of a step: arrays by name."""

    p: np.ndarray
    kept: Mapping[str, np.ndarray]


class OwnSteps:
    """Marches through time with a user-defined integrator; why: the reason of a failure; broken: errors are
    raised where they occur.

    begin [s]: time of the first step; counted (1,): number of solutions of linear systems, the iterations.
    """

    def __init__(self, system: System, integrator: Integrator, begin: float, counted: np.ndarray) -> None:
        run = getattr(integrator, "run", None)
        self._system, self._time, self._counted = system, begin, counted
        self._integrator = run() if callable(run) else integrator
        moved = any(callable(item.value) for item in system.prescribed)
        self._solved = System(system.model, static=False, released=True) if moved else system
        self._at_rest = np.isin(system.prescribed_dofs, self._solved.prescribed_dofs)
        self.why, self.broken = "", False

    def advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        prescribed (steps, 3, nh): prescribed coordinates and their rates at the times (steps,) [s].
        """
        system = self._system
        for number, time in enumerate(times.tolist()):
            before = state.copy()
            found = self._step(before, time)
            if found is None:
                return number
            self._complete(state, found, prescribed[number], time)
            state[0] = system.history.committed((state[0], state[1], state[2]), time, time - self._time)
            saving.keep(number, before, state)
            self._time = time
        return len(times)

    def memory(self, state: np.ndarray) -> Memory | None:
        """Return what the integrator keeps in a state (4, n), None if it keeps nothing."""
        kept = getattr(self._integrator, "memory", None)
        return Memory(state[0].copy(), kept()) if callable(kept) else None

    def recall(self, memory: Memory | None, state: np.ndarray) -> None:
        """Let the integrator recall what it kept in a state (4, n), if it was in this one."""
        if memory is not None and np.array_equal(memory.p, state[0]):
            self._integrator.recall(memory.kept)  # type: ignore[union-attr]

    def raise_error(self) -> None:
        """Raise nothing: an error of an integrator is raised where it occurs."""

    def _step(self, before: np.ndarray, time: float) -> np.ndarray | None:
        """Return p, p', p'' (3, n) at the end of a step from a state (4, n), None if it fails."""
        p, v, a, _ = before.copy()
        begin, name = State(p, v, a, self._time, self._system.model), type(self._integrator).__name__
        try:
            reached = self._integrator.step(EquationsOfMotion(self._solved, self._counted, self._time), begin, time)
        except (ConvergenceError, LinAlgError) as error:
            self.why = str(error)
            return None
        except Exception as error:
            error.add_note(f"raised by step of {name}, in the step to {time:.6g} s")
            raise
        if not isinstance(reached, State) or reached.model is not self._system.model:
            raise InputError(
                f"step of {name} must return a State of the model, such as "
                f"dataclasses.replace(begin, p=p, v=v, a=a, at=end), got {shown(reached)}"
            )
        found = np.array([reached.p, reached.v, reached.a])
        if not np.isfinite(found).all():
            self.why = f"step of {name} returned numbers that are not finite"
            return None
        if abs(reached.at - time) > _SAME * (time - self._time):
            raise InputError(
                f"step of {name} must return the state at its end, {time:.6g}, with dataclasses.replace(..., at=end); "
                f"it is at {shown(reached.at)}"
            )
        return found

    def _complete(self, state: np.ndarray, found: np.ndarray, prescribed: np.ndarray, time: float) -> None:
        """Set the state (4, n) to what was found (3, n), with what an integrator does not determine."""
        system, history = self._system, self._system.history.numbers
        past = state[0, history]
        state[:3] = found
        state[:3, system.prescribed_dofs[self._at_rest]] = prescribed[:, self._at_rest]
        dofs, values = driven(self._solved, time)
        state[0, dofs], state[0, history] = values, past
        state[1:3, system.connectors.multipliers] = 0.0  # multipliers have no rates
        state[3] = state[2]
