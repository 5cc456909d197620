"""Analyses of model files: their keys are the fields of a dataclass."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Protocol

import numpy as np

from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.cli.schema import Kinds, Names, build, reader, shown
from beamfem.errors import InputError
from beamfem.io.results import load
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.checks import warned
from beamfem.results.path import Bifurcation, PathState
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.solution import Solution, State
from beamfem.solve.modes.modes import Modes, solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.integrators import GeneralizedAlpha
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.solve.stability.buckling import Buckling, solve_buckling
from beamfem.solve.statics.load_steps import SAME, Snap
from beamfem.solve.statics.statics import solve_static, solve_through
from beamfem.validation import count, finite, one_of

ALL = (-np.inf, np.inf)


@dataclass(frozen=True)
class Found:
    """States to draw, save and evaluate, and further results of an analysis by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)
    modes: Modes | Buckling | None = None


class Analysis(Protocol):
    """An analysis; span: lowest and highest load factor or time [s] of its states, empty if it prints only modes.

    asked: those at which outputs need a state.
    """

    @property
    def span(self) -> tuple[float, float] | tuple[()]: ...
    def run(self, model: Model, asked: Sequence[float]) -> Found: ...


@dataclass(frozen=True)
class Equilibrium:
    """The equilibrium under the loads at a load factor from 0 to 1."""

    load_factor: float = 1.0
    steps: int = 1
    newton: Newton | None = None
    snap: Snap = "error"

    def __post_init__(self) -> None:
        if not 0.0 <= finite("load_factor", self.load_factor) <= 1.0:
            raise InputError(f"load_factor of an equilibrium to start from lies within 0 and 1, got {self.load_factor}")

    def of_model(self, model: Model) -> State:
        """Return the state. Raises InputError, ConvergenceError."""
        return solve_static(model, self.steps, self.newton, at=[self.load_factor], snap=self.snap)[-1]


def _saved(file: Path, row: int | None = None) -> State:
    """Return a state of a results file; row: from 1, by default the last."""
    solution = load(file)
    number = len(solution) if row is None else count("row", row)
    if number > len(solution):
        raise InputError(f"row is {row}, but {file.name} has {len(solution)} rows")
    return solution[number - 1]


def _start(value: Any, names: Names) -> Any:
    if value in ("reference", "static"):
        return Equilibrium() if value == "static" else None
    if isinstance(value, dict):
        make: Callable[..., Any] = _saved if "file" in value else Equilibrium
        return build(make, value, names)
    if isinstance(value, bool | str | list):
        such = '"reference" or "static", a load factor, or a table with load_factor or file'
        raise InputError(f"must be {such}, got {shown(value)}")
    return Equilibrium(value)


Start = reader(_start)


def _state(start: Any, model: Model) -> State | None:
    return start.of_model(model) if isinstance(start, Equilibrium) else start


@dataclass(frozen=True)
class Static:
    """Equilibria from load factor 0 to 1, see `solve_static`."""

    steps: int = 1
    newton: Newton | None = None
    snap: Snap = "error"
    at: Sequence[float] | None = None

    def __post_init__(self) -> None:
        count("steps", self.steps)

    @property
    def span(self) -> tuple[float, float]:
        """Load factors of its start and end."""
        return (min(self.at), max(self.at)) if self.at else (0.0, 1.0)

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        if self.at is None:
            return Found(warned(solve_through(model, asked, self.steps, self.newton, snap=self.snap)))
        further = [value for value in asked if all(abs(value - other) > SAME for other in self.at)]
        at = sorted([*self.at, *further]) if further else self.at
        return Found(solve_static(model, self.steps, self.newton, at=at, snap=self.snap))


@dataclass(frozen=True)
class Until:
    """End of a path: a displacement [m] or rotation [rad] of a point below or above a value."""

    point: Point
    quantity: Literal["ux", "uy", "rotation"]
    below: float | None = None
    above: float | None = None

    def __post_init__(self) -> None:
        if (self.below is None) == (self.above is None):
            raise InputError("either below or above must be given, and not both")

    def __call__(self, state: PathState) -> bool:
        value = state.rotation(self.point)
        if self.quantity != "rotation":
            value = float(state.displacement(self.point)[["ux", "uy"].index(self.quantity)])
        return value < self.below if self.below is not None else value > (self.above or 0.0)


def _until(value: Any, names: Names) -> Any:
    return build(Until, value, names) if isinstance(value, dict) else finite("until", value)


@dataclass(frozen=True)
class Trace:
    """An equilibrium path, past limit points, see `trace_equilibrium`; start: a bifurcation of another path."""

    until: reader(_until) = None  # type: ignore[valid-type]
    points: int = 500
    step: float | None = None
    newton: Newton | None = None
    direction: int | None = None
    start: "Crossing | None" = None
    span = ALL

    def __post_init__(self) -> None:
        count("points", self.points)
        if self.direction is not None:
            one_of("direction", str(self.direction), ("1", "-1"))
        if self.step is not None and self.start is not None:
            raise InputError("step is the load factor of the second point of a path from 0; a branch finds its own")

    def path(self, model: Model) -> EquilibriumPath:
        """Return the path. Raises InputError, ConvergenceError."""
        start = None if self.start is None else self.start.of_model(model)
        options: Any = {name: getattr(self, name) for name in ("direction", "step", "points", "newton")}
        return trace_equilibrium(model, self.until, start=start, **options)

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        path = self.path(model)
        values = {name: [point.load_factor for point in getattr(path, name)] for name in ("limit_points", "bifurcations")}
        return Found(path, values)


@dataclass(frozen=True)
class Crossing(Trace):
    """A bifurcation, counted from 1, of the path that its other keys describe."""

    bifurcation: int = 1

    def of_model(self, model: Model) -> Bifurcation:
        """Return the bifurcation. Raises InputError, ConvergenceError."""
        points = self.path(model).bifurcations
        if count("bifurcation", self.bifurcation) > len(points):
            short = f"start is at the bifurcation {self.bifurcation}, but its path has {len(points)}"
            raise InputError(f"{short}; until or points of start may end it too early")
        return points[self.bifurcation - 1]


@dataclass(frozen=True)
class BucklingTable:
    """Critical load factors; mode (from 1): the one to save and draw, with its largest displacement amplitude [m]."""

    count: int = 1
    mode: int = 1
    about: Start = None  # type: ignore[valid-type]
    amplitude: float | None = None
    span = ()

    def __post_init__(self) -> None:
        _require_mode(self.count, self.mode)

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        buckling = solve_buckling(model, self.count, _state(self.about, model))
        values = {
            "load_factors": buckling.load_factors.tolist(),
            "kinds": list(buckling.kinds),
            "linearised": buckling.linearised.tolist(),
        }
        return Found(buckling.solution(self.mode - 1, self.amplitude), values, buckling)


@dataclass(frozen=True)
class ModesTable:
    """Frequencies about a static equilibrium; loaded: that under the loads; frames: number of states of a mode."""

    count: int = 10
    loaded: bool = False
    mode: int = 1
    about: Start = None  # type: ignore[valid-type]
    amplitude: float | None = None
    frames: int = 25
    span = ()

    def __post_init__(self) -> None:
        _require_mode(self.count, self.mode)
        if self.loaded and self.about is not None:
            raise InputError('about and loaded are given; loaded = true is short for about = "static"')

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        modes = solve_modes(model, self.count, _state(Equilibrium() if self.loaded else self.about, model))
        values: dict[str, Any] = {"frequencies": modes.frequencies.tolist()}
        values |= {"growth": modes.growth.tolist()} if np.any(modes.growth) else {}
        values |= {"rigid": list(modes.rigid)} if modes.rigid else {}
        return Found(modes.solution(self.mode - 1, self.amplitude, self.frames), values, modes)


@dataclass(frozen=True)
class Dynamics:
    """A motion, see `simulate`."""

    duration: float
    step: float
    rho_inf: float | None = None
    save_every: int = 1
    start: Start = None  # type: ignore[valid-type]
    velocity: RigidVelocity | None = None

    def __post_init__(self) -> None:
        if finite("step", self.step) > finite("duration", self.duration):
            raise InputError(f"step ({self.step:g}) must not exceed duration ({self.duration:g})")
        _ = self._rule

    @property
    def _rule(self) -> GeneralizedAlpha:
        return GeneralizedAlpha() if self.rho_inf is None else GeneralizedAlpha(self.rho_inf)

    @property
    def span(self) -> tuple[float, float]:
        """Times [s] of its start and end."""
        return 0.0, self.duration

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        start = _state(self.start, model)
        return Found(simulate(model, self.duration, self.step, self._rule, start, self.velocity, self.save_every))


@dataclass(frozen=True)
class Imperfection:
    """The largest displacement of an axis, `size` [m], by a mode, counted from 1, of the perfect model."""

    size: float
    mode: int = 1
    of: Literal["buckling", "modes"] = "buckling"
    about: Start = None  # type: ignore[valid-type]

    def __post_init__(self) -> None:
        count("mode", self.mode)

    def of_model(self, model: Model) -> Model:
        """Return the imperfect model. Raises InputError, ConvergenceError."""
        solve: Callable[..., Any] = solve_buckling if self.of == "buckling" else solve_modes
        return model.with_imperfection(solve(model, self.mode, _state(self.about, model)), self.size, self.mode - 1)


ANALYSES: Kinds = {
    "static": Static,
    "path": Trace,
    "buckling": BucklingTable,
    "modes": ModesTable,
    "dynamics": Dynamics,
}


def _require_mode(number: int, mode: int) -> None:
    if count("mode", mode) > count("count", number):
        raise InputError(f"mode must be at most count, {number}, got {mode}")
