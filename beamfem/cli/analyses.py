"""Analyses of model files: the keys of a kind are the keyword parameters of its function."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import wraps
from typing import Any, Literal

import numpy as np

from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.cli.schema import Kinds, Names, build, reader, shown
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.checks import warned
from beamfem.results.path import PathState
from beamfem.results.solution import Solution, State
from beamfem.solve.modes.modes import Modes, solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.integrators import GeneralizedAlpha
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.solve.stability.buckling import Buckling, solve_buckling
from beamfem.solve.statics.load_steps import SAME, Snap
from beamfem.solve.statics.statics import solve_static, solve_through
from beamfem.validation import finite, number_below


@dataclass(frozen=True)
class Found:
    """States to draw, save and evaluate, and further results of an analysis by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)
    modes: Modes | Buckling | None = None


@dataclass(frozen=True)
class Analysis:
    """An analysis that is ready to run on a model; asked: load factors or times [s] at which outputs need a state.

    span: lowest and highest load factor or time of its states, empty for modes; moving: whether it has times.
    """

    run: Callable[[Model, Sequence[float]], Found]
    span: tuple[float, ...] = (-np.inf, np.inf)
    moving: bool = False


def _start(value: Any, names: Names) -> float | None:
    """Return the load factor of an equilibrium to start from, None for the reference."""
    if value in ("reference", "static"):
        return 1.0 if value == "static" else None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value <= 1.0:
        raise InputError(f'must be "reference", "static" or a load factor from 0 to 1, got {shown(value)}')
    return float(value)


Start = reader(_start)


def _state(model: Model, load_factor: float | None) -> State | None:
    return None if load_factor is None else solve_static(model, at=[load_factor])[-1]


def _static(
    model: Model,
    asked: Sequence[float],
    steps: int = 1,
    newton: Newton | None = None,
    snap: Snap = "error",
    at: Sequence[float] | None = None,
) -> Found:
    if at is None:
        return Found(warned(solve_through(model, asked, steps, newton, snap=snap)))
    further = [value for value in asked if all(abs(value - other) > SAME for other in at)]
    return Found(solve_static(model, steps, newton, at=sorted([*at, *further]) if further else at, snap=snap))


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


def _path(
    model: Model,
    asked: Sequence[float],
    until: reader(_until) = None,  # type: ignore[valid-type]
    points: int = 500,
    step: float | None = None,
    newton: Newton | None = None,
    direction: int | None = None,
) -> Found:
    path = trace_equilibrium(model, until, direction=direction, step=step, points=points, newton=newton)
    names = ("limit_points", "bifurcations")
    return Found(path, {name: [point.load_factor for point in getattr(path, name)] for name in names})


def _buckling(
    model: Model,
    asked: Sequence[float],
    count: int = 1,
    mode: int = 1,
    about: Start = None,  # type: ignore[valid-type]
    amplitude: float | None = None,
) -> Found:
    number_below("mode", mode, count + 1, lowest=1)
    buckling = solve_buckling(model, count, _state(model, about))
    values = {name: list(getattr(buckling, name)) for name in ("load_factors", "kinds", "linearised")}
    return Found(buckling.solution(mode - 1, amplitude), values, buckling)


def _modes(
    model: Model,
    asked: Sequence[float],
    count: int = 10,
    mode: int = 1,
    about: Start = None,  # type: ignore[valid-type]
    amplitude: float | None = None,
    frames: int = 25,
) -> Found:
    number_below("mode", mode, count + 1, lowest=1)
    modes = solve_modes(model, count, _state(model, about))
    values: dict[str, Any] = {"frequencies": modes.frequencies.tolist(), "rigid": list(modes.rigid)}
    values |= {"growth": modes.growth.tolist()} if np.any(modes.growth) else {}
    return Found(modes.solution(mode - 1, amplitude, frames), values, modes)


def _dynamics(
    model: Model,
    asked: Sequence[float],
    duration: float,
    step: float,
    rho_inf: float | None = None,
    save_every: int = 1,
    start: Start = None,  # type: ignore[valid-type]
    velocity: RigidVelocity | None = None,
) -> Found:
    rule = GeneralizedAlpha() if rho_inf is None else GeneralizedAlpha(rho_inf)
    return Found(simulate(model, duration, step, rule, _state(model, start), velocity, save_every))


@dataclass(frozen=True)
class Imperfection:
    """The largest displacement of an axis, `size` [m], by a mode, counted from 1, of the perfect model."""

    size: float
    mode: int = 1
    of: Literal["buckling", "modes"] = "buckling"
    about: Start = None  # type: ignore[valid-type]

    def of_model(self, model: Model) -> Model:
        """Return the imperfect model. Raises InputError, ConvergenceError."""
        solve: Callable[..., Any] = solve_buckling if self.of == "buckling" else solve_modes
        return model.with_imperfection(solve(model, self.mode, _state(model, self.about)), self.size, self.mode - 1)


def _ready(solve: Callable[..., Found], span: Callable[..., tuple[float, ...]], moving: bool = False) -> Any:
    """Return a function that makes an analysis of the keys of a table."""

    @wraps(solve)
    def make(**keys: Any) -> Analysis:
        return Analysis(lambda model, asked: solve(model, asked, **keys), span(**keys), moving)

    return make


ANALYSES: Kinds = {
    "static": _ready(_static, lambda at=(0.0, 1.0), **_: (min(at), max(at))),
    "path": _ready(_path, lambda **_: (-np.inf, np.inf)),
    "buckling": _ready(_buckling, lambda **_: ()),
    "modes": _ready(_modes, lambda **_: ()),
    "dynamics": _ready(_dynamics, lambda duration, **_: (0.0, duration), moving=True),
}
