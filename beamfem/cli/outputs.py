"""Quantities that model files print, and pictures of the command."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.cli.analyses import Analysis
from beamfem.cli.schema import Names, reader, shown
from beamfem.errors import InputError
from beamfem.io.description import describe
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.path import PathState
from beamfem.results.solution import Solution
from beamfem.validation import finite, nearest

_NEAR = 1e-9
# what a quantity is: the method of a Solution and the attributes or columns of its result; and the unit in SI
_AT_POINT = """
x position.0 m, y position.1 m, ux displacement.0 m, uy displacement.1 m, vx velocity.0 m/s, vy velocity.1 m/s,
rotation rotation rad, fx reaction.0 N, fy reaction.1 N, m reaction.2 N_m, shear_angle fields.shear_angle rad,
strain_xx fields.green_strain.xx, strain_yy fields.green_strain.yy, strain_xy fields.green_strain.xy,
stress_xx fields.stress.xx Pa, stress_yy fields.stress.yy Pa, stress_xy fields.stress.xy Pa
"""
_OF_BEAM = """
normal section_forces.normal N, shear section_forces.shear N, moment section_forces.moment N_m,
lower stresses.lower Pa, upper stresses.upper Pa, tension stresses.tension Pa, compression stresses.compression Pa,
shear_stress stresses.shear Pa, von_mises stresses.von_mises Pa, utilisation stresses.utilisation
"""
_OF_MODEL = """
kinetic energy.kinetic J, strain energy.strain J, potential energy.potential J, total energy.total J,
dissipated energy.dissipated J, px linear_momentum.0 N_s, py linear_momentum.1 N_s,
angular_momentum angular_momentum N_m_s, stable stable
"""


def _table(text: str) -> dict[str, list[str]]:
    """Return what the quantities of a text are, by name."""
    rows = [row.split() for row in text.split(",")]
    return {name: what for name, *what in rows}


AT_POINT, OF_BEAM, OF_MODEL = map(_table, (_AT_POINT, _OF_BEAM, _OF_MODEL))
UNITS = {
    name: what[1].replace("_", " ") for name, what in {**AT_POINT, **OF_BEAM, **OF_MODEL}.items() if len(what) > 1
} | {"time": "s", "arc_length": "m"}


def _value(solution: Solution, item: Any, what: str) -> np.ndarray:
    """Return a quantity of a point, a beam or the model in every state."""
    method, *parts = what.split(".")
    value: Any = getattr(solution, method)
    value = (value() if item is None else value(item)) if callable(value) else value
    for part in parts:
        value = value[:, int(part)] if part.isdigit() else getattr(value, part)
    return np.asarray(value)


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
        columns = {name: _value(solution, item, self.known[name][0]) for name in self.quantities}
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
        last = Output(self.quantities, self.name, self.point, self.beam)
        points = {name: getattr(path, name) for name in ("limit_points", "bifurcations")}
        return {name: [last.rows(_alone(path, state))[0] for state in states] for name, states in points.items()}


def _alone(path: EquilibriumPath, state: PathState) -> Solution:
    """Return one state of a path as a Solution."""
    parts = (np.array([state.at]), state.p[None], state.v[None], state.a[None], path.statistics)
    return Solution(path.model, True, *parts, turned=None if state.turned is None else state.turned[None])


DRAWN = (".png", ".svg", ".pdf", ".html", ".gif", ".mp4")  # what `draw` writes


def draw(solution: Solution, path: Path, **options: Any) -> None:
    """Write a picture, a page with a slider (.html) or a film (.gif, .mp4). Raises InputError."""
    kind = path.suffix.lower()
    if kind == ".html" and options:
        raise InputError("a page has its own choice of colours; --colour is for pictures and films")
    writers: Any = {".html": solution.to_html, ".gif": solution.animate, ".mp4": solution.animate}
    writers.get(kind, solution.plot)(path, **options)


def require_saved(model: Model) -> None:
    """Raise InputError if a model has parts that cannot be saved in a results file."""
    describe(model, np.zeros(1))
