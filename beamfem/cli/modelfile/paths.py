"""Equilibrium paths of a model file, and the bifurcations at which branches start."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamfem.cli.modelfile.found import Found
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.validation import count, finite, positive


@dataclass(frozen=True)
class Until:
    """End of a path: a displacement [m] or rotation [rad] of a point below or above a value."""

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
    """An equilibrium path, past limit points: from load factor 0, or from a bifurcation of another path."""

    until: float | Callable[[PathState], bool] | None = None
    points: int = 500
    step: float | None = None
    newton: Newton | None = None
    direction: int | None = None
    start: "Crossing | None" = None
    states: bool = field(default=True, init=False)
    moving: bool = field(default=False, init=False)
    span: tuple[float, float] = field(default=(-np.inf, np.inf), init=False)

    def __post_init__(self) -> None:
        _check_path(self)

    def run(self, model: Model, at: Sequence[float]) -> Found:
        path = _followed(self, model)
        return Found(path, critical_points(path))


@dataclass(frozen=True)
class Crossing:
    """A bifurcation, counted from 1, of the path described by its other keys, which are those of an analysis."""

    bifurcation: int = 1
    until: float | Callable[[PathState], bool] | None = None
    points: int = 500
    step: float | None = None
    newton: Newton | None = None
    direction: int | None = None
    start: "Crossing | None" = None

    def __post_init__(self) -> None:
        count("bifurcation", self.bifurcation)
        _check_path(self)

    def of_model(self, model: Model) -> Bifurcation:
        """Return the bifurcation. Raises InputError, ConvergenceError."""
        points = _followed(self, model).bifurcations
        if self.bifurcation > len(points):
            raise InputError(
                f"start is at the bifurcation {self.bifurcation}, but its path has {len(points)}; until or points of "
                "start may end it too early"
            )
        return points[self.bifurcation - 1]


def _check_path(path: Trace | Crossing) -> None:
    if path.until is not None and not callable(path.until):
        finite("until", path.until)
    count("points", path.points)
    if path.step is not None:
        positive("step", path.step)
        if path.start is not None:
            raise InputError("step is the load factor of the second point of a path from 0; a branch finds its own")
    if path.direction is not None and (not isinstance(path.direction, int) or abs(path.direction) != 1):
        raise InputError(f"direction must be 1 or -1, got {path.direction}")


def _followed(path: Trace | Crossing, model: Model) -> Path:
    start = None if path.start is None else path.start.of_model(model)
    options: dict[str, Any] = {"start": start, "direction": path.direction, "step": path.step}
    return trace_equilibrium(model, path.until, points=path.points, newton=path.newton, **options)


def critical_points(path: Path) -> dict[str, Any]:
    """Return the load factors of the limit points and bifurcations of a path."""
    return {
        "limit_points": [point.load_factor for point in path.limit_points],
        "bifurcations": [point.load_factor for point in path.bifurcations],
    }
