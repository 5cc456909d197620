"""What a motion is to do: its steps, its rows, and its loads over time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from beamfem.equations.compilation_notice import announce_compilation
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError
from beamfem.model.model import Model
from beamfem.solve.motion.collocation import Radau
from beamfem.solve.motion.energy_momentum import EnergyMomentum
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.events import Event, Watch
from beamfem.solve.motion.generalized_alpha import GeneralizedAlpha, Scheme, is_scheme, require_rule
from beamfem.solve.motion.saved_rows import SavedRows
from beamfem.solve.motion.stable_step import stable_step
from beamfem.solve.motion.stage_coefficients import Explicit, Staged, has_stages, is_explicit
from beamfem.solve.motion.time_steps import Stretch, stretches
from beamfem.solve.start.functions_of_time import (
    FunctionOfTime,
    functions_of_time,
    sampled,
)
from beamfem.solve.start.start_checks import refuse_frame, require_memory
from beamfem.validation import count, items, positive, shown

AnyIntegrator = Scheme | Integrator | Staged | EnergyMomentum  # as users give it
_LOOSE, _TIGHT = 1e-3, 1e-7  # tolerances from and up to which methods of lower and higher order need less work
_OF_LAWS = 2  # order of any method with sections that have history
_PARTS = 1000  # of a motion whose steps follow a tolerance, within which kinks of loads are found


@dataclass(frozen=True)
class MotionSettings:
    """What `simulate` is asked for, see there."""

    duration: float
    step: float | None
    integrator: Scheme | Integrator
    save_every: int
    tolerance: float | None
    save_at: tuple[float, ...] | None
    events: tuple[Event, ...]
    watch: bool = False


@dataclass(frozen=True)
class MotionPlan:
    """Steps and rows of a motion.

    rule: see `Statistics`; rows_at [s]: time between the multiples of the step, `times` (steps + 1,); ends
    (m + 1,) [s]: of all steps, those at kinks of loads included, in stretches `parts`; wanted (rows,) [s]: times of the
    rows, None for all steps; acting: functions of time.
    """

    system: System
    settings: MotionSettings
    rule: tuple[float, ...]
    rows_at: float
    times: np.ndarray
    ends: np.ndarray
    parts: tuple[Stretch, ...]
    wanted: np.ndarray | None
    acting: list[FunctionOfTime]

    @property
    def jumps(self) -> frozenset[float]:
        """Times [s] at which loads jump."""
        begins = [(part.loads_from, float(part.times[0])) for part in self.parts]
        ends = [(part.loads_to, float(part.times[-1])) for part in self.parts]
        return frozenset(time for inside, time in begins + ends if inside != time)

    def saved_rows(self) -> SavedRows:
        """Return what collects the rows."""
        settings, pairs = self.settings, self.system.model.numbered.rotation_pairs
        smooth, resolved = not is_scheme(settings.integrator), settings.tolerance is not None
        watch = Watch(self.system, settings.events, smooth, resolved)
        return SavedRows(self.system, pairs, self.wanted, self.jumps, watch, smooth, resolved)

    def live_view(self) -> Callable[[float, np.ndarray], None]:
        """Return what shows states (3, n) at times [s] while the motion runs, if it is to be watched."""
        return self._opened_view() if self.settings.watch else lambda time, state: None

    def _opened_view(self) -> Callable[[float, np.ndarray], None]:
        from beamfem.view.live_view import live_view

        return live_view(self.system.model)


def usual_integrator(model: Model, tolerance: float | None) -> AnyIntegrator:
    """Return the integrator that a motion has by default.

    Of random motions Radau's method of three stages meets tolerances from 1e-4 to 1e-6 with the least work, see
    `studies.benchmarks.random_tolerances`; at looser ones its iterations limit the steps, and two stages suffice, while
    four take less time up to 1e-7. Hinges with friction turn back at an instant that vibrations smaller than the
    tolerance decide, which `Radau` damps. But stops, and sliders with friction, need steps that end at their kinks.
    """
    if tolerance is None or _follows_vibrations(system_of(model, static=False)):
        return GeneralizedAlpha()
    tolerance = positive("tolerance", tolerance)
    return Radau(2 if tolerance >= _LOOSE else 3 if tolerance > _TIGHT else 4)


def _follows_vibrations(system: System) -> bool:
    """Return whether there is history, of sections, user-defined parts, or friction with a constant limit alone."""
    if not system.history.compiled:
        return len(system.history.numbers) > 0
    memories = [item.compiled.memory for item in system.connectors.items if item.compiled]
    return all("slip" in memory and "limit" not in memory for memory in memories if memory)


def settings_of(
    duration: float,
    step: float | None,
    integrator: AnyIntegrator,
    save_every: int,
    tolerance: float | None,
    save_at: Sequence[float] | np.ndarray | None,
    events: Sequence[Event],
) -> MotionSettings:
    """Return the settings of a motion. Raises InputError for invalid ones."""
    duration, save_every = positive("duration", duration), count("save_every", save_every)
    if step is None and tolerance is None and not is_explicit(integrator):
        raise InputError("simulate needs a step [s], or a tolerance that steps follow")
    step, tolerance = (None if x is None else positive(n, x) for n, x in (("step", step), ("tolerance", tolerance)))
    if step is not None and step > duration:
        raise InputError(f"step ({step:g}) must not exceed duration ({duration:g})")
    user_defined = not is_scheme(integrator) and not has_stages(integrator)
    steps = any(callable(getattr(integrator, name, None)) for name in ("step", "run"))
    if isinstance(integrator, type) or not (steps or not user_defined or isinstance(integrator, EnergyMomentum)):
        raise InputError(
            "integrator must be a GeneralizedAlpha(rho_inf=...), an object with rule(step) as it has, or one with "
            f"step(motion, begin, end) as bf.Integrator describes it, got {shown(integrator)}"
        )
    events = tuple(items("events", events))
    if not all(isinstance(event, Event) for event in events):
        raise InputError(f"events must be Events, got {shown(events)}")
    if user_defined and tolerance is not None and not isinstance(getattr(integrator, "order", None), int):
        raise InputError(
            f"{type(integrator).__name__} needs an attribute order, of its error, to follow a tolerance; give a step"
        )
    at = None if save_at is None else _rows_at(save_at)
    known = cast(Scheme | Integrator, integrator)  # those with stages have their own loop
    return MotionSettings(duration, step, known, save_every, tolerance, at, events)


def planned(model: Model, settings: MotionSettings, in_memory: bool) -> MotionPlan:
    """Return the plan of a motion; in_memory: whether all rows are kept there.

    Raises InputError for what the model, or the memory, does not allow.
    """
    system = system_of(model, static=False)
    refuse_frame(system, "simulate")
    order = getattr(settings.integrator, "order", 2)
    if settings.tolerance is not None and order > _OF_LAWS and system.history.laws:
        raise InputError(
            f"{type(settings.integrator).__name__} does not follow a tolerance with sections that have history, which "
            f"makes an order of {order} one of {_OF_LAWS}; leave the integrator out, or give a step"
        )
    if is_explicit(settings.integrator):
        settings = _stable(system, settings, settings.integrator)
    step = settings.step
    rows_at = settings.duration / _PARTS if step is None else step
    rule: tuple[float, ...] = ()
    if is_scheme(settings.integrator):
        rule = require_rule(settings.integrator, rows_at)
    elif has_stages(settings.integrator):
        rule = (rows_at, settings.integrator.stages, settings.integrator.removed)
    require_memory(model.size if in_memory else 0, settings.duration, rows_at, settings.save_every)
    announce_compilation()
    times = rows_at * np.arange(int(np.ceil(settings.duration / rows_at - 1e-9)) + 1)
    acting = functions_of_time(system)
    if settings.tolerance is not None:
        acting = [sampled(function, settings.duration) for function in acting]
    parts = stretches(times, [function for function in acting if function.amplitude])
    if settings.tolerance is not None:
        parts = tuple(part.ending_at([at for function in acting for at in function.turns]) for part in parts)
    ends = np.concatenate([times[:1], *(part.times[1:] for part in parts)])
    return MotionPlan(system, settings, rule, rows_at, times, ends, parts, _wanted(settings, times), acting)


def _stable(system: System, settings: MotionSettings, method: Explicit) -> MotionSettings:
    """Return the settings with steps that are stable: longer ones are divided."""
    longest, step = stable_step(system, method), settings.step
    if settings.tolerance is not None:
        return settings
    if step is None:
        return replace(settings, step=settings.duration / np.ceil(settings.duration / longest))
    parts = int(np.ceil(step / longest * (1.0 - 1e-9)))
    return replace(settings, step=step / parts, save_every=settings.save_every * (1 if settings.save_at else parts))


def _rows_at(save_at: Sequence[float] | np.ndarray) -> tuple[float, ...]:
    """Return the times of rows. Raises InputError unless they ascend."""
    at = np.asarray(save_at)
    numbers = at.dtype.kind in "iuf" and at.ndim == 1 and np.isfinite(at).all()
    if not (numbers and len(at) and np.all(np.diff(at) > 0.0)):
        raise InputError(f"save_at must be times in ascending order, got {shown(save_at)}")
    return tuple(at.astype(float).tolist())


def _wanted(settings: MotionSettings, times: np.ndarray) -> np.ndarray | None:
    """Return the times (rows,) [s] at which states are wanted, None for all steps. Raises InputError."""
    if settings.save_at is None:
        if settings.tolerance is not None and settings.step is None:
            if settings.save_every != 1:
                raise InputError("save_every counts fixed steps; give a step or save_at for rows at given times")
            return None
        rows = times[:: settings.save_every]
        return rows if rows[-1] == times[-1] else np.append(rows, times[-1])
    at, near = np.array(settings.save_at), 1e-9 * times[-1]
    if at[0] < -near or at[-1] > times[-1] + near:
        raise InputError(f"save_at must lie within the motion, from 0 to {times[-1]:g}, got {at[0]:g} to {at[-1]:g}")
    if settings.save_every != 1:
        raise InputError("save_every and save_at exclude each other")
    return np.clip(at, 0.0, times[-1])
