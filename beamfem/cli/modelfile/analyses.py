"""The analysis of a model file: its parameters, checked before it runs, and its results."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.cli.modelfile.found import Analysis, Found
from beamfem.cli.modelfile.own_parts import build_own, own_code
from beamfem.cli.modelfile.paths import Crossing, Trace, Until
from beamfem.cli.modelfile.places import Places
from beamfem.cli.modelfile.starts import Equilibrium, Start, newton, start, state_of
from beamfem.cli.modelfile.table import Reader, Table, build, build_kind
from beamfem.errors import InputError
from beamfem.model.model import Model
from beamfem.results.checks import warned
from beamfem.solve.modes.modes import solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.equations_of_motion import Integrator
from beamfem.solve.motion.integrators import GeneralizedAlpha, Scheme, is_scheme
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.stability.buckling import solve_buckling
from beamfem.solve.statics.load_steps import SAME, Snap, Unstable
from beamfem.solve.statics.statics import solve_static, solve_through
from beamfem.validation import count, finite, items, one_of, optional, positive


@dataclass(frozen=True)
class Static:
    """Equilibria from load factor 0 to 1; see `solve_static`, also for `at`, the load factors of the states."""

    steps: int = 1
    newton: Newton | None = None
    snap: Snap = "error"
    unstable: Unstable = "keep"
    at: Sequence[float] | None = None
    states: bool = field(default=True, init=False)
    moving: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        count("steps", self.steps)
        one_of("snap", self.snap, ("error", "jump"))
        one_of("unstable", self.unstable, ("keep", "leave"))
        if self.at is not None:
            _check_load_factors(self.at)

    @property
    def span(self) -> tuple[float, float]:
        """Load factors of its start and end."""
        return (0.0, 1.0) if self.at is None else (self.at[0], self.at[-1])

    def run(self, model: Model, at: Sequence[float]) -> Found:
        snap, unstable = self.snap, self.unstable
        if self.at is None:
            return Found(warned(solve_through(model, at, self.steps, self.newton, snap=snap, unstable=unstable)))
        further = [value for value in at if all(abs(value - other) > SAME for other in self.at)]
        load_factors = sorted({*self.at, *further})
        return Found(solve_static(model, self.steps, self.newton, at=load_factors, snap=snap, unstable=unstable))


@dataclass(frozen=True)
class Buckling:
    """Critical load factors; about: start of the path; mode (from 1): the one to save and draw, with amplitude [m]."""

    count: int = 1
    mode: int = 1
    about: Start = None
    amplitude: float | None = None
    states: bool = field(default=False, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(-np.inf, np.inf), init=False)

    def __post_init__(self) -> None:
        _check_mode(self.count, self.mode, self.amplitude)

    def run(self, model: Model, at: Sequence[float]) -> Found:
        buckling = solve_buckling(model, self.count, state_of(self.about, model))
        values = {
            "load_factors": buckling.load_factors.tolist(),
            "kinds": list(buckling.kinds),
            "linearised": buckling.linearised.tolist(),
        }
        return Found(buckling.solution(self.mode - 1, self.amplitude), values, buckling)


@dataclass(frozen=True)
class Modes:
    """Frequencies about a static equilibrium; loaded: the one under the loads; mode (from 1): the one to save and draw.

    amplitude [m] and frames: its largest displacement and number of states.
    """

    count: int = 10
    loaded: bool = False
    mode: int = 1
    about: Start = None
    amplitude: float | None = None
    frames: int = 25
    states: bool = field(default=False, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(-np.inf, np.inf), init=False)

    def __post_init__(self) -> None:
        _check_mode(self.count, self.mode, self.amplitude)
        if count("frames", self.frames) < 2:
            raise InputError("frames must be at least 2")
        if self.loaded and self.about is not None:
            raise InputError('about and loaded are given; loaded = true is short for about = "static"')

    def run(self, model: Model, at: Sequence[float]) -> Found:
        about = Equilibrium() if self.loaded else self.about
        modes = solve_modes(model, self.count, state_of(about, model))
        values: dict[str, Any] = {"frequencies": modes.frequencies.tolist()}
        if np.any(modes.growth):
            values["growth"] = modes.growth.tolist()
        if modes.rigid:
            values["rigid"] = list(modes.rigid)
        return Found(modes.solution(self.mode - 1, self.amplitude, self.frames), values, modes)


@dataclass(frozen=True)
class Dynamics:
    """A motion; start: the initial state; integrator: a user-defined one instead of `rho_inf`."""

    duration: float
    step: float
    rho_inf: float | None = None
    save_every: int = 1
    start: Start = None
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None = None
    integrator: Scheme | Integrator | None = None
    states: bool = field(default=True, init=False)
    moving: bool = field(default=True, init=False)

    def __post_init__(self) -> None:
        positive("duration", self.duration)
        if positive("step", self.step) > self.duration:
            raise InputError(f"step ({self.step:g}) must not exceed duration ({self.duration:g})")
        count("save_every", self.save_every)
        _ = self._rule
        if self.integrator is not None:
            if self.rho_inf is not None:
                raise InputError("integrator and rho_inf are given; rho_inf is that of the generalized-alpha method")
            if not is_scheme(self.integrator) and not callable(getattr(self.integrator, "step", None)):
                raise InputError(
                    "integrator must have step(motion, begin, end), as bf.Integrator describes it, or rule(step) as "
                    "bf.Scheme does"
                )

    @property
    def _rule(self) -> GeneralizedAlpha:
        return GeneralizedAlpha() if self.rho_inf is None else GeneralizedAlpha(self.rho_inf)

    @property
    def span(self) -> tuple[float, float]:
        """Times [s] of its start and end."""
        return 0.0, self.duration

    def run(self, model: Model, at: Sequence[float]) -> Found:
        start = state_of(self.start, model)
        rule = self._rule if self.integrator is None else self.integrator
        return Found(simulate(model, self.duration, self.step, rule, start, self.velocity, self.save_every))


ANALYSES: dict[str, Callable[..., Analysis]] = {
    "static": Static,
    "path": Trace,
    "buckling": Buckling,
    "modes": Modes,
    "dynamics": Dynamics,
}


def analysis(root: Table, places: Places) -> Analysis:
    """Return the analysis of a file, by default a static one. Raises ModelFileError."""

    def until(table: Table, key: str) -> Any:
        value = table.values[key]
        if not isinstance(value, dict):
            return value
        subtable = table.table(key)
        return _function(subtable) if "function" in value else build(subtable, Until, {"point": places.point})

    def velocity(table: Table, key: str) -> Any:
        subtable = table.table(key)
        return _function(subtable) if "function" in subtable.values else build(subtable, RigidVelocity)

    def integrator(table: Table, key: str) -> Any:
        return build_own(table.table(key), {})

    def crossing(table: Table, key: str) -> Crossing:
        result: Crossing = build(table.table(key), Crossing, paths)
        return result

    if "analysis" not in root.values:
        return Static()
    table = root.table("analysis")
    paths: dict[str, Reader] = {"until": until, "newton": newton, "start": crossing}
    readers = {**paths, "velocity": velocity, "integrator": integrator, "about": start}
    if table.values.get("kind") != "path":
        readers["start"] = start
    return build_kind(table, ANALYSES, readers, default="static")


def _function(table: Table) -> Callable[..., Any]:
    """Return the user-defined function that a table names. Raises ModelFileError."""
    table.require_known(("function",))
    return own_code(table, "function")


def _check_mode(number: int, mode: int, amplitude: float | None) -> None:
    if count("mode", mode) > count("count", number):
        raise InputError(f"mode must be at most count, {number}, got {mode}")
    optional(positive)("amplitude", amplitude)


def _check_load_factors(values: Any) -> None:
    load_factors = [finite(f"at[{number}]", value) for number, value in enumerate(items("at", values), 1)]
    rising = all(after - before > SAME for before, after in pairwise(load_factors))
    if not load_factors or not rising or load_factors[0] < 0.0 or load_factors[-1] > 1.0:
        raise InputError(f"at must be load factors that rise within 0 and 1, such as [0.25, 0.5, 1.0], got {values}")
