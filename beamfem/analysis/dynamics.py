"""Motion in time."""

import time as clock
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.analysis.band_motion import BandMotion
from beamfem.analysis.entangled_motion import EntangledMotion
from beamfem.analysis.equations import INERTIA, linearise, residual
from beamfem.analysis.initial import RigidVelocity, start_state, start_velocity
from beamfem.analysis.integrators import GeneralizedAlpha
from beamfem.analysis.memory import require_memory
from beamfem.compiled import tell_of_compilation
from beamfem.errors import ConvergenceError, InputError
from beamfem.model.model import Model
from beamfem.model.sampled import Sampled
from beamfem.model.system import System, system_of
from beamfem.progress import progress
from beamfem.solution import Solution, State, Statistics
from beamfem.validation import count, positive

_TOLERANCE = 1e-9
_ITERATIONS = 25
_CHUNK_SECONDS = 0.25
_FIRST_CHUNK = 200_000  # coordinates times steps
# weights of first and second derivative, times 12; a function of time need not exist before the start
_CENTRAL = (np.array([1, -8, 0, 8, -1]), np.array([-1, 16, -30, 16, -1]), (-2, -1, 0, 1, 2))
_FORWARD = (np.array([-25, 48, -36, 16, -3]), np.array([35, -104, 114, -56, 11]), (0, 1, 2, 3, 4))


def simulate(
    model: Model,
    duration: float,
    step: float,
    integrator: GeneralizedAlpha | None = None,
    start: State | None = None,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None = None,
    save_every: int = 1,
) -> Solution:
    """Return the motion over `duration` [s] with a fixed `step` [s]; the last step ends at or just after it.

    start: a state to start from, such as the last of a static solution; velocity: initial velocity field;
    save_every: keep each so many-th step, and the last.
    Raises InputError before, ConvergenceError (with all states so far) where the iteration of a step fails.
    """
    positive("duration", duration)
    positive("step", step)
    count("save_every", save_every)
    if step > duration:
        raise InputError(f"step ({step:g} s) must not exceed duration ({duration:g} s)")
    if integrator is not None and not isinstance(integrator, GeneralizedAlpha):
        raise InputError(f"integrator must be a GeneralizedAlpha(rho_inf=...), got {integrator!r}")
    system = system_of(model, static=False)
    tell_of_compilation()
    require_memory(model.size, duration, step, save_every)
    rule = (integrator or GeneralizedAlpha()).rule(step)
    steps = int(np.ceil(duration / step - 1e-9))
    times = step * np.arange(steps + 1)
    held = HeldMotion.sample(system, times, step)
    n = model.size
    state = np.zeros((4, n))
    state[0] = start_state(system, start)
    state[1] = start_velocity(system, state[0], velocity, start)
    state[:3, system.held_dofs] = held.values[0]
    for dof, normal in system.inclined:
        pair = slice(dof, dof + 2)
        state[0, pair] -= normal * (normal @ (state[0, pair] - system.reference[pair]))
        state[1, pair] -= normal * (normal @ state[1, pair])
    state[2] = initial_acceleration(system, state, times[0])
    state[3] = state[2]
    states = np.empty((-(-steps // save_every) + 1, 3, n))
    states[0] = state[:3]
    statistics = np.array([0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0])
    limits = np.array([_TOLERANCE, _ITERATIONS])
    kind = BandMotion if system.unknowns.pattern is None else EntangledMotion
    motion = kind(system, rule, limits, statistics)
    done, size = 0, max(_FIRST_CHUNK // n, 1)
    with progress("time [s]", times[-1]) as report:
        while done < steps:
            now = min(size, steps - done)
            rows = slice(done + 1, done + now + 1)
            begun = clock.perf_counter()
            completed = motion.advance(state, held.values[rows], times[rows], (states, done + 1, save_every))
            spent = clock.perf_counter() - begun
            done += completed
            if completed and done % save_every:
                states[done // save_every + 1] = state[:3]
            report(times[done])
            if completed < now:
                message = (
                    f"the iteration of the step from {times[done]:.6g} s to {times[done + 1]:.6g} s did not converge: "
                    f"the last correction was {statistics[2]:.2e} of the model after {_ITERATIONS} iterations at most. "
                    "A smaller step may help"
                )
                raise ConvergenceError(message, _solution(system, times, states, done, save_every, statistics))
            if spent < _CHUNK_SECONDS:
                size *= 4
    return _solution(system, times, states, done, save_every, statistics)


def initial_acceleration(system: System, state: np.ndarray, time: float) -> np.ndarray:
    """Return p'' (n,) that satisfies the equations of motion at the start; state: p, p', p'' of held coordinates."""
    p, v, a = state[0].copy(), state[1].copy(), state[2].copy()
    free = system.free_dofs
    a[free] = 0.0
    unbalanced = residual(system, p, v, a, time)
    _, mass = linearise(system, p, np.zeros_like(v), np.zeros_like(a), time, INERTIA)
    a[free] = mass.solve(-unbalanced[free], system.turned)
    return a


@dataclass(frozen=True)
class HeldMotion:
    """Values, velocities and accelerations of the held coordinates (steps + 1, 3, nh)."""

    values: np.ndarray

    @classmethod
    def sample(cls, system: System, times: np.ndarray, step: float) -> "HeldMotion":
        """Sample the prescribed functions; their derivatives are central differences of fourth order."""
        if any(isinstance(item.value, Sampled) for item in system.held):
            raise InputError(
                "a prescribed motion of this model was saved as values, which have no accelerations between them; "
                "give the function again to run it on"
            )
        width = 0.02 * step
        values = np.zeros((len(times), 3, len(system.held)))
        if not any(callable(item.value) for item in system.held):
            values[:, 0] = system.held_values(0.0)
            return cls(values)
        start = system.reference[system.held_dofs]  # differences of displacements, not of positions far away
        for i, now in enumerate(times):
            first, second, offsets = _FORWARD if now == 0.0 else _CENTRAL
            around = np.array([system.held_values(now + k * width) - start for k in offsets])
            values[i, 0] = system.held_values(now)
            values[i, 1] = first @ around / (12.0 * width)
            values[i, 2] = second @ around / (12.0 * width**2)
        return cls(values)


def _solution(
    system: System, times: np.ndarray, states: np.ndarray, done: int, save_every: int, statistics: np.ndarray
) -> Solution:
    kept_steps = np.append(np.arange(0, done, save_every), done)
    kept = states[: len(kept_steps)]
    summary = Statistics(int(statistics[0]), done, 0, f"{done} steps of {times[1]:g} s")
    return Solution(system.model, False, times[kept_steps], kept[:, 0], kept[:, 1], kept[:, 2], summary)
