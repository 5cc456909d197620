"""Time steps one by one, of schemes whose steps are not taken many at once in compiled code."""

from typing import Protocol

import numpy as np

from beamfem.assembly.system import System
from beamfem.solve.motion.saving import Saving


class Step(Protocol):
    """What takes a step; dt [s]: time step since the committed history."""

    dt: float

    @property
    def why(self) -> str:
        """Why the last step has failed."""
        ...

    def take(self, state: np.ndarray, before: np.ndarray, prescribed: np.ndarray, time: float) -> bool:
        """Change the state (4, n) at the beginning of a step to that at its end; return whether one was found.

        before (4, n): a copy of it; prescribed (3, nh): prescribed coordinates, their rates and second derivatives at
        the end; time [s]: the end.
        """
        ...


class SingleSteps:
    """Marches through time by single steps."""

    def __init__(self, system: System, step: Step) -> None:
        self._system, self._step = system, step

    @property
    def why(self) -> str:
        """Why a step has failed."""
        return self._step.why

    def advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        prescribed (steps, 3, nh): prescribed coordinates and their rates at the times (steps,) [s].
        """
        for number, time in enumerate(times.tolist()):
            before = state.copy()
            if not self._step.take(state, before, prescribed[number], time):
                state[:] = before
                return number
            motion = state[0], state[1], state[2]
            imposing = self._system.imposing(time)
            state[0] = self._system.history.committed(motion, time, imposing, self._step.dt)
            saving.keep(number, before, state)
        return len(times)
