"""Analyses of model files, whose keys are parameters of the functions that solve them, and the outputs to print."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from inspect import signature
from typing import Any, Literal

import numpy as np

from beamfem.cli.schema import Keyed, Kinds, Names, build, keys_of, reader, shown
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.results.axis_fields import AT_POINT, OF_BEAM, OF_MODEL, value_of
from beamfem.results.path import Path as EquilibriumPath
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
from beamfem.validation import count, finite, nearest, number_below

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
            keys[name] = None if keys[name] is None else solve_static(model, at=[keys[name]])
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


_until = reader(lambda item, names: build(Until, item, names) if isinstance(item, dict) else finite("until", item))


def _analysis(kind: str, *sources: Callable[..., Any], **hints: Any) -> Keyed:
    """Return an analysis by the parameters of functions; hints: of other keys, None for what is none."""
    keys = {key: item for source in sources for key, item in keys_of(source).items() if key not in ("self", "model")}
    keys |= {key: (hint, None) for key, hint in hints.items()}
    return Keyed(lambda **keys: Analysis(kind, keys), {key: item for key, item in keys.items() if item[0] is not None})


ANALYSES: Kinds = {
    "static": _analysis("static", solve_static),
    "path": _analysis("path", trace_equilibrium, start=None, until=_until),
    "buckling": _analysis("buckling", solve_buckling, Buckling.solution, about=reader(_start), mode=int),
    "modes": _analysis("modes", solve_modes, Modes.solution, about=reader(_start), mode=int),
    "dynamics": _analysis("dynamics", simulate, integrator=None, file=None, start=reader(_start), rho_inf=float),
}


_NEAR = 1e-9


def _states(value: Any, names: Names) -> Any:
    if value in ("last", "all"):
        return value
    if not isinstance(value, list) or not value:
        raise InputError(f'must be "last", "all" or a list of numbers, got {shown(value)}')
    return [finite("at", item) for item in value]


@dataclass(frozen=True)
class Output:
    """Quantities of a point, of a beam (along its stations) or of the model, at the last, all or some states."""

    quantities: list[str]
    name: str = ""
    point: Point | None = None
    beam: Beam | None = None
    at: reader(_states) = "last"  # type: ignore[valid-type]

    def __post_init__(self) -> None:
        if self.point is not None and self.beam is not None:
            raise InputError("beam and point are given; an output has one of them, or none for the model")
        if not self.quantities:
            raise InputError(f"quantities must be some of {', '.join(self.known)}")
        for quantity in self.quantities:
            if quantity not in self.known:
                raise InputError(f"quantities has no {quantity!r} here; {nearest(quantity, self.known)}")

    @property
    def known(self) -> dict[str, list[str]]:
        """Quantities of what the output is of."""
        return AT_POINT if self.point is not None else OF_BEAM if self.beam is not None else OF_MODEL

    @property
    def asked(self) -> list[float]:
        """Times [s] or load factors that are requested as numbers."""
        return [] if isinstance(self.at, str) else list(self.at)

    def require(self, model: Model, analysis: Analysis) -> None:
        """Raise InputError for what the analysis of the model cannot provide."""
        if not analysis.span:
            raise InputError("this analysis prints its own results; outputs go with static, path and dynamics")
        low, high = analysis.span
        for value in self.asked:
            if not low <= value <= high:
                raise InputError(f"at: there is no state at {value:g}, only from {low:g} to {high:g}")
        reactions = [quantity for quantity in self.quantities if quantity in ("fx", "fy", "m")]
        if reactions and self.point not in [support.point for support in model.point_supports]:
            raise InputError(f"quantities has the reaction {reactions[0]}, but there is no support at {self.point}")
        if "stable" in self.quantities and analysis.kind == "dynamics":
            raise InputError("quantities has stable, which is for equilibria, and this analysis is a motion")

    def rows(self, solution: Solution) -> list[dict[str, Any]]:
        """Return a row for each requested state: its time [s] or load factor, and the quantities. Raises InputError."""
        item = self.beam if self.point is None else self.point
        columns = {name: value_of(solution, item, self.known[name][0]) for name in self.quantities}
        axis = "load_factor" if solution.static else "time"
        along = {} if self.beam is None else {"arc_length": solution.section_forces(self.beam).arc_length.tolist()}
        return [
            {axis: float(solution.at[row]), **along, **{name: values[row].tolist() for name, values in columns.items()}}
            for row in self._rows(solution)
        ]

    def _rows(self, solution: Solution) -> list[int]:
        if isinstance(self.at, str):
            return list(range(len(solution))) if self.at == "all" else [len(solution) - 1]
        what, low, high = "load factor" if solution.static else "time", solution.at.min(), solution.at.max()
        for value in self.asked:
            if not low - _NEAR <= value <= high + _NEAR:
                raise InputError(f"at asks for the {what} {value:g}, but the states are those from {low:g} to {high:g}")
            exact = solution.static and not isinstance(solution, EquilibriumPath)
            if exact and np.abs(solution.at - value).min() > _NEAR:
                raise InputError(f"at asks for the {what} {value:g}, where the structure jumps: it has no state there")
        return [int(np.abs(solution.at - value).argmin()) for value in self.asked]

    def critical(self, path: EquilibriumPath) -> dict[str, list[dict[str, Any]]]:
        """Return a row at every limit point and bifurcation of a path."""
        last = replace(self, at="last")
        return {name: [last.rows(state.alone)[0] for state in getattr(path, name)] for name in CRITICAL}
