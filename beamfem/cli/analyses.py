"""Analyses of model files: the keys of a kind are parameters of the functions that solve it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from inspect import signature
from typing import Any, Literal

import numpy as np

from beamfem.cli.schema import Kinds, Names, build, reader, shown, with_keys
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.path import PathState
from beamfem.results.solution import Solution, State
from beamfem.results.solution_checks import warned
from beamfem.solve.modes.modes import Modes, solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.integrators import GeneralizedAlpha
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.solve.stability.buckling import Buckling, solve_buckling
from beamfem.solve.statics.load_steps import SAME
from beamfem.solve.statics.statics import solve_static, solve_through
from beamfem.validation import count, finite, number_below


@dataclass(frozen=True)
class Found:
    """States to draw, save and evaluate, and further results of an analysis by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)
    modes: Modes | Buckling | None = None


@dataclass(frozen=True)
class Analysis:
    """An analysis by its kind and keys."""

    kind: str
    keys: dict[str, Any]

    @property
    def span(self) -> tuple[float, ...]:
        """Lowest and highest load factor or time [s] of its states, empty for modes."""
        if self.kind in ("buckling", "modes"):
            return ()
        at = self.keys.get("at") or (0.0, 1.0)
        return {"static": (min(at), max(at)), "path": (-np.inf, np.inf)}.get(
            self.kind, (0.0, self.keys.get("duration", 0.0))
        )

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        """Solve the model; asked: load factors at which outputs need a state. Raises InputError, ConvergenceError."""
        keys: dict[str, Any] = {
            name: state(model, value) if name in ("about", "start") else value for name, value in self.keys.items()
        }
        if self.kind == "static":
            return Found(_static(model, asked, **keys))
        if self.kind == "path":
            path = trace_equilibrium(model, **keys)
            names = ("limit_points", "bifurcations")
            return Found(path, {name: [point.load_factor for point in getattr(path, name)] for name in names})
        if self.kind == "dynamics":
            if (rho_inf := keys.pop("rho_inf", None)) is not None:
                keys["integrator"] = GeneralizedAlpha(rho_inf)
            return Found(simulate(model, **keys))
        solve: Callable[..., Any] = solve_buckling if self.kind == "buckling" else solve_modes
        shown = {name: keys.pop(name) for name in ("mode", "amplitude", "frames") if name in keys}
        number = count("count", keys.get("count", signature(solve).parameters["count"].default))
        shown["mode"] = number_below("mode", shown.get("mode", 1), number + 1, lowest=1) - 1
        modes = solve(model, **keys)
        listed = (
            ("load_factors", "kinds", "linearised") if self.kind == "buckling" else ("frequencies", "growth", "rigid")
        )
        values = {name: list(getattr(modes, name)) for name in listed if np.any(getattr(modes, name))}
        return Found(modes.solution(**shown), values, modes)


def state(model: Model, load_factor: float | None) -> State | None:
    """Return the equilibrium at a load factor to start from, None for the reference."""
    return None if load_factor is None else solve_static(model, at=[load_factor])[-1]


def _static(
    model: Model, asked: Sequence[float], steps: int = 1, newton: Any = None, at: Any = None, **keys: Any
) -> Solution:
    if at is None:
        equal = [k / steps for k in range(1, count("steps", steps))]
        further = [value for value in asked if all(abs(value - other) > SAME for other in equal)]
        return warned(solve_through(model, sorted([*equal, *further]), steps, newton, resolved=True, **keys))
    further = [value for value in asked if all(abs(value - other) > SAME for other in at)]
    return solve_static(model, steps, newton, at=sorted([*at, *further]) if further else at, **keys)


def _start(value: Any, names: Names) -> float | None:
    if value in ("reference", "static"):
        return 1.0 if value == "static" else None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value <= 1.0:
        raise InputError(f'must be "reference", "static" or a load factor from 0 to 1, got {shown(value)}')
    return float(value)


Start = reader(_start)


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


def _analysis(kind: str, *sources: Callable[..., Any], **hints: Any) -> Callable[..., Any]:
    return with_keys(lambda keys: Analysis(kind, keys), sources, **hints)


ANALYSES: Kinds = {
    "static": _analysis("static", solve_static),
    "path": _analysis("path", trace_equilibrium, start=None, until=reader(_until)),
    "buckling": _analysis("buckling", solve_buckling, Buckling.solution, about=Start, mode=int),
    "modes": _analysis("modes", solve_modes, Modes.solution, about=Start, mode=int),
    "dynamics": _analysis("dynamics", simulate, integrator=None, start=Start, rho_inf=float),
}
