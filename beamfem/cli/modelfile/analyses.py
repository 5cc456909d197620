"""The analysis of a model file: its parameters, checked before it runs, and what it finds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.cli.modelfile.actions import Places
from beamfem.cli.modelfile.table import Table, build, build_kind
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.path import Path, PathState
from beamfem.results.solution import Solution
from beamfem.solve.modes.modes import solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.integrators import GeneralizedAlpha
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.solve.stability.buckling import solve_buckling
from beamfem.solve.statics.load_steps import Snap
from beamfem.solve.statics.statics import solve_static, solve_through
from beamfem.validation import count, finite, one_of, positive


@dataclass(frozen=True)
class Found:
    """States to draw, save and ask, and what the analysis found besides, by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)


class Analysis(Protocol):
    """What every analysis offers; states: whether its states answer the outputs of a file.

    span: lowest and highest load factor or time [s] that it can have states at; at: those that are asked for, which get
    a state where the analysis is free to choose.
    """

    @property
    def states(self) -> bool: ...
    @property
    def moving(self) -> bool: ...
    @property
    def span(self) -> tuple[float, float]: ...
    def run(self, model: Model, at: Sequence[float]) -> Found: ...


@dataclass(frozen=True)
class Static:
    """Equilibria from load factor 0 to 1; snap: what to do at a limit point, "error" or "jump"."""

    steps: int = 1
    newton: Newton | None = None
    snap: Snap = "error"
    states: bool = field(default=True, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(0.0, 1.0), init=False)

    def __post_init__(self) -> None:
        count("steps", self.steps)
        one_of("snap", self.snap, ("error", "jump"))

    def run(self, model: Model, at: Sequence[float]) -> Found:
        return Found(solve_through(model, at, self.steps, self.newton, snap=self.snap))


@dataclass(frozen=True)
class Until:
    """Where a path ends: a displacement [m] or rotation [rad] of a point below or above a value."""

    point: Point
    quantity: str
    below: float | None = None
    above: float | None = None

    def __post_init__(self) -> None:
        if self.quantity not in ("ux", "uy", "rotation"):
            raise InputError(f"quantity must be ux, uy or rotation, got {self.quantity!r}")
        if (self.below is None) == (self.above is None):
            raise InputError("either below or above must be given, and not both")
        finite("below" if self.above is None else "above", self.below if self.above is None else self.above)

    def __call__(self, state: PathState) -> bool:
        if self.quantity == "rotation":
            value = state.rotation(self.point)
        else:
            value = float(state.displacement(self.point)[["ux", "uy"].index(self.quantity)])
        return value < self.below if self.below is not None else value > (self.above or 0.0)


@dataclass(frozen=True)
class Trace:
    """The equilibrium path from load factor 0, past limit points."""

    until: float | Until | None = None
    points: int = 500
    step: float | None = None
    newton: Newton | None = None
    states: bool = field(default=True, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(-np.inf, np.inf), init=False)

    def __post_init__(self) -> None:
        if not isinstance(self.until, Until) and self.until is not None:
            finite("until", self.until)
        count("points", self.points)
        if self.step is not None:
            positive("step", self.step)

    def run(self, model: Model, at: Sequence[float]) -> Found:
        path = trace_equilibrium(model, self.until, step=self.step, points=self.points, newton=self.newton)
        return Found(path, critical_points(path))


@dataclass(frozen=True)
class Buckling:
    """Critical load factors; mode (from 1) is the one to save and draw."""

    count: int = 1
    mode: int = 1
    states: bool = field(default=False, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(-np.inf, np.inf), init=False)

    def __post_init__(self) -> None:
        _check_mode(self.count, self.mode)

    def run(self, model: Model, at: Sequence[float]) -> Found:
        found = solve_buckling(model, self.count)
        values = {
            "load_factors": found.load_factors.tolist(),
            "kinds": list(found.kinds),
            "linearised": found.linearised.tolist(),
        }
        return Found(found.solution(self.mode - 1), values)


@dataclass(frozen=True)
class Modes:
    """Frequencies; loaded: about the static equilibrium under the loads; mode (from 1) is the one to save and draw."""

    count: int = 10
    loaded: bool = False
    mode: int = 1
    states: bool = field(default=False, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(-np.inf, np.inf), init=False)

    def __post_init__(self) -> None:
        _check_mode(self.count, self.mode)

    def run(self, model: Model, at: Sequence[float]) -> Found:
        found = solve_modes(model, self.count, solve_static(model) if self.loaded else None)
        values: dict[str, Any] = {"frequencies": found.frequencies.tolist()}
        if np.any(found.growth):
            values["growth"] = found.growth.tolist()
        if found.rigid:
            values["rigid"] = list(found.rigid)
        return Found(found.solution(self.mode - 1), values)


@dataclass(frozen=True)
class Dynamics:
    """A motion; start: "reference", or "static" for the equilibrium under the loads at load factor 1."""

    duration: float
    step: float
    rho_inf: float = 0.9
    save_every: int = 1
    start: str = "reference"
    velocity: RigidVelocity | None = None
    states: bool = field(default=True, init=False)
    moving: bool = field(default=True, init=False)

    def __post_init__(self) -> None:
        positive("duration", self.duration)
        if positive("step", self.step) > self.duration:
            raise InputError(f"step ({self.step:g} s) must not exceed duration ({self.duration:g} s)")
        GeneralizedAlpha(self.rho_inf)
        count("save_every", self.save_every)
        if self.start not in ("reference", "static"):
            raise InputError(f'start must be "reference" or "static", got {self.start!r}')

    @property
    def span(self) -> tuple[float, float]:
        """Times [s] of its start and end."""
        return 0.0, self.duration

    def run(self, model: Model, at: Sequence[float]) -> Found:
        start = solve_static(model)[-1] if self.start == "static" else None
        rule = GeneralizedAlpha(self.rho_inf)
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
        return build(table.table(key), Until, {"point": places.point})

    def newton(table: Table, key: str) -> Newton:
        return build(table.table(key), Newton)

    def velocity(table: Table, key: str) -> RigidVelocity:
        return build(table.table(key), RigidVelocity)

    if "analysis" not in root.values:
        return Static()
    readers = {"until": until, "newton": newton, "velocity": velocity}
    return build_kind(root.table("analysis"), ANALYSES, readers, default="static")


def critical_points(path: Path) -> dict[str, Any]:
    """Return the load factors of the limit points and bifurcations of a path."""
    return {
        "limit_points": [point.load_factor for point in path.limit_points],
        "bifurcations": [point.load_factor for point in path.bifurcations],
    }


def _check_mode(number: int, mode: int) -> None:
    if count("mode", mode) > count("count", number):
        raise InputError(f"mode must be at most count, {number}, got {mode}")
