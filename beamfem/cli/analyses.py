"""Analyses of model files: the keys of a kind are parameters of the functions that solve it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from inspect import signature
from typing import Any, Literal

import numpy as np

from beamfem.cli.schema import Keyed, Kinds, Names, build, keys_of, reader, shown
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.path import PathState
from beamfem.results.solution import Solution
from beamfem.results.solution_checks import warned
from beamfem.solve.modes.modes import Modes, solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.generalized_alpha import GeneralizedAlpha
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.solve.stability.buckling import Buckling, solve_buckling
from beamfem.solve.statics.load_steps import SAME
from beamfem.solve.statics.statics import solve_static, solve_through
from beamfem.validation import count, finite, number_below

CRITICAL = ("limit_points", "bifurcations")  # points of a path


@dataclass(frozen=True)
class Found:
    """States to draw, save and evaluate, and further results of an analysis by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Analysis:
    """An analysis by its kind and keys."""

    kind: str
    keys: dict[str, Any]

    @property
    def span(self) -> tuple[float, ...]:
        """Lowest and highest load factor or time [s] of its states, empty for modes."""
        at, duration = self.keys.get("at") or (0.0, 1.0), self.keys.get("duration", 0.0)
        spans = {"static": (min(at), max(at)), "path": (-np.inf, np.inf), "dynamics": (0.0, duration)}
        return spans.get(self.kind, ())

    def run(self, model: Model, asked: Sequence[float]) -> Found:
        """Solve the model; asked: load factors at which outputs need a state. Raises InputError, ConvergenceError."""
        keys: dict[str, Any] = dict(self.keys)
        for name in {"about", "start"}.intersection(keys):
            keys[name] = None if keys[name] is None else solve_static(model, at=[keys[name]])[-1]
        if self.kind == "static":
            return Found(_static(model, asked, **keys))
        if self.kind == "path":
            path = trace_equilibrium(model, **keys)
            return Found(path, {name: [point.load_factor for point in getattr(path, name)] for name in CRITICAL})
        if self.kind == "dynamics":
            if (rho_inf := keys.pop("rho_inf", None)) is not None:
                keys["integrator"] = GeneralizedAlpha(rho_inf)
            return Found(simulate(model, **keys))
        solve: Callable[..., Any] = solve_buckling if self.kind == "buckling" else solve_modes
        shown = {name: keys.pop(name) for name in ("mode", "amplitude", "frames") if name in keys}
        number = count("count", keys.get("count", signature(solve).parameters["count"].default))
        shown["mode"] = number_below("mode", shown.get("mode", 1), number + 1, lowest=1) - 1
        modes = solve(model, **keys)
        listed = {"buckling": ("load_factors", "kinds", "linearised"), "modes": ("frequencies", "growth", "rigid")}
        values = {name: list(getattr(modes, name)) for name in listed[self.kind] if np.any(getattr(modes, name))}
        return Found(modes.solution(**shown), values)


def _static(model: Model, asked: Sequence[float], steps: int = 1, at: Any = None, **keys: Any) -> Solution:
    rows = [k / steps for k in range(1, count("steps", steps))] if at is None else at
    if further := [value for value in asked if all(abs(value - row) > SAME for row in rows)]:
        rows = sorted([*rows, *further])
    wanted = {name: keys.pop(name, None) for name in ("accuracy", "quantity")}
    if wanted["accuracy"] is not None or model.automatic:
        if at is not None or not further:
            return solve_static(model, steps, at=None if at is None else rows, **wanted, **keys)
        model = model.meshed(solve_static(model, steps, **wanted, **keys))
    if at is None:
        return warned(solve_through(model, rows, steps, resolved=True, **keys))
    return solve_static(model, steps, at=rows, **keys)


def _start(value: Any, names: Names) -> float | None:
    if value in ("reference", "static"):
        return 1.0 if value == "static" else None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value <= 1.0:
        raise InputError(f'must be "reference", "static" or a load factor from 0 to 1, got {shown(value)}')
    return float(value)


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
        ux, uy = state.displacement(self.point)
        value = float({"ux": ux, "uy": uy, "rotation": state.rotation(self.point)}[self.quantity])
        return value < self.below if self.below is not None else value > (self.above or 0.0)


def _until(value: Any, names: Names) -> Any:
    return build(Until, value, names) if isinstance(value, dict) else finite("until", value)


def _analysis(kind: str, *sources: Callable[..., Any], **hints: Any) -> Keyed:
    """Return an analysis by the parameters of functions; hints: of other keys, None for what is none."""
    keys = {key: item for source in sources for key, item in keys_of(source).items() if key not in ("self", "model")}
    keys |= {key: (hint, None) for key, hint in hints.items()}
    return Keyed(lambda **keys: Analysis(kind, keys), {key: item for key, item in keys.items() if item[0] is not None})


ANALYSES: Kinds = {
    "static": _analysis("static", solve_static),
    "path": _analysis("path", trace_equilibrium, start=None, until=reader(_until)),
    "buckling": _analysis("buckling", solve_buckling, Buckling.solution, about=reader(_start), mode=int),
    "modes": _analysis("modes", solve_modes, Modes.solution, about=reader(_start), mode=int),
    "dynamics": _analysis("dynamics", simulate, integrator=None, file=None, start=reader(_start), rho_inf=float),
}
