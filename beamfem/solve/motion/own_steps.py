"""Time integrators of one's own: the equations that they step through, and their way into a motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import block_array, block_diag, csc_array, csr_array
from scipy.sparse.linalg import splu

from beamfem.assembly.equations import linearise, residual
from beamfem.assembly.system import System
from beamfem.brief import brief
from beamfem.errors import ConvergenceError, InputError
from beamfem.kernels.motion_steps import count_turns
from beamfem.linalg.tangent import UNROTATED, turning
from beamfem.results.solution import Solution, State
from beamfem.results.status import Statistics
from beamfem.solve.motion.band_motion import Saving
from beamfem.validation import shown


@dataclass(frozen=True, eq=False)
class EquationsOfMotion:
    """M(p) p'' + inertia of first order + elastic forces - loads = 0, for the unknown coordinates.

    free (unknown,): their numbers among all coordinates; scale (unknown,): what a correction of each is measured by;
    counted (1,): how often `solve` was asked, the iterations of the motion.
    """

    system: System
    counted: np.ndarray

    __repr__ = brief

    @property
    def free(self) -> np.ndarray:
        """Numbers (unknown,) of the unknown coordinates among all."""
        return self.system.free_dofs

    @property
    def scale(self) -> np.ndarray:
        """What a correction of each unknown coordinate is measured by (unknown,)."""
        return self.system.scale[self.system.free_dofs]

    def residual(self, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float) -> np.ndarray:
        """Return the left side (unknown,) [N, N m] in a state p, v, a (n,) at a time [s]."""
        return residual(self.system, p, v, a, time)[self.free]

    def tangent(
        self,
        p: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        time: float,
        weights: tuple[float, float, float],
    ) -> csr_array:
        """Return the derivative (unknown, unknown) of the residual where p, v and a change by these weights."""
        return linearise(self.system, p, v, a, time, weights)[1].sparse(UNROTATED)

    def energy(self, p: np.ndarray, time: float) -> float:
        """Return the strain energy and the potential of loads, springs and foundations [J]; see `results.energies`."""
        rest, at = np.zeros((1, len(p))), np.array([time])
        energy = Solution(self.system.model, False, at, p[None], rest, rest, Statistics(0, 0, 0, "")).energy()
        return float(energy.strain[0] + energy.potential[0])

    def solve(self, blocks: Sequence[Sequence[csr_array]], right: np.ndarray) -> np.ndarray:
        """Return x (s, unknown) of a system of s x s tangents and right sides (s, unknown).

        Nothing moves along the normals of inclined rollers. Raises ConvergenceError if it is singular.
        """
        self.counted[0] += 1
        stages, unknown = right.shape
        kept = np.ones(unknown, dtype=bool)
        kept[self.system.rotated[0]] = False
        kept = np.tile(kept, stages)
        turn = csr_array(block_diag([turning(unknown, self.system.rotated)] * stages))
        matrix = csr_array(turn @ block_array(blocks) @ turn.T)[kept][:, kept]
        found = np.zeros(right.size)
        try:
            found[kept] = splu(csc_array(matrix)).solve((turn @ right.ravel())[kept])
        except RuntimeError as error:
            raise ConvergenceError("the tangent of a step is singular") from error
        return np.asarray(turn.T @ found).reshape(right.shape)


class Integrator(Protocol):
    """A time integrator of one's own, such as one with stages, or with forces between two states."""

    def step(self, motion: EquationsOfMotion, begin: State, end: float) -> State:
        """Return the state at a time `end` [s] after that at `begin.at`; prescribed coordinates rest.

        Raises ConvergenceError if it is not found.
        """
        ...


class OwnSteps:
    """Marches with an integrator of one's own; why: it could not go on."""

    def __init__(self, system: System, integrator: Integrator, begin: float, statistics: np.ndarray) -> None:
        self.system, self.integrator, self.time = system, integrator, begin
        self.motion, self.why = EquationsOfMotion(system, statistics[:1]), ""

    def _begin(self, state: np.ndarray) -> State:
        p, v, a, _ = state.copy()
        return State(p, v, a, self.time, self.system.model)

    def advance(self, state: np.ndarray, prescribed: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' (4, n) in place; return how many steps were completed; see `BandMotion.advance`."""
        saved, first, every, counted, turned, saved_turns = saving
        for step, time in enumerate(times.tolist()):
            before = state.copy()
            try:
                reached = self.integrator.step(self.motion, self._begin(before), time)
            except (ConvergenceError, LinAlgError) as error:
                self.why = str(error)
                return step
            if not isinstance(reached, State) or reached.model is not self.system.model:
                raise InputError(
                    f"step of {type(self.integrator).__name__} must return a State of the model, such as "
                    f"dataclasses.replace(begin, p=p, v=v, a=a, at=end), got {shown(reached)}"
                )
            found = np.array([reached.p, reached.v, reached.a])
            if not np.isfinite(found).all():
                self.why = f"step of {type(self.integrator).__name__} returned numbers that are not finite"
                return step
            state[:3] = found
            state[:3, self.system.prescribed_dofs] = prescribed[step]
            state[3] = state[2]
            self.time = time
            state[0] = self.system.connectors.after_step((state[0], state[1], state[2]), time)
            count_turns(len(counted), counted, before, state, turned)
            if (first + step) % every == 0:
                saved[(first + step) // every] = state[:3]
                saved_turns[(first + step) // every] = turned
        return len(times)


def refuse_what_own_steps_lack(system: System) -> None:
    """Raise InputError for models whose motions integrators of one's own do not take."""
    moved = [item for item in system.prescribed if callable(item.value)]
    if moved:
        raise InputError(
            f"{moved[0].point} is moved, which an integrator of one's own does not take: use GeneralizedAlpha, or let "
            "supports rest"
        )
    if len(system.connectors.multipliers):
        raise InputError(
            "connectors with unknowns of their own are there, which an integrator of one's own does not take: use "
            "GeneralizedAlpha"
        )
