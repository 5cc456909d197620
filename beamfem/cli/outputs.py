"""What a model file asks for: outputs to print, and files to write."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.cli.analyses import Analysis, Found
from beamfem.cli.report import require_target
from beamfem.cli.schema import KeyFault, Kinds, Names, reader, shown, with_keys
from beamfem.errors import InputError
from beamfem.io.description import describe
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.results.axis_fields import QUANTITIES as COLOURS
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.path import PathState
from beamfem.results.solution import Solution
from beamfem.solve.modes.modes import Modes
from beamfem.validation import count, finite, nearest, require_known

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


def draw(solution: Solution, path: Path, **options: Any) -> None:
    """Write a picture, a page with a slider (.html) or a film (.gif, .mp4). Raises InputError."""
    kind = path.suffix.lower()
    if kind == ".html" and options:
        raise InputError("a page has its own choice of colours; --colour is for pictures and films")
    writers: Any = {".html": solution.to_html, ".gif": solution.animate, ".mp4": solution.animate}
    writers.get(kind, solution.plot)(path, **options)


# the method that writes a file, and its suffixes
_PICTURE, _FILM = (".png", ".svg", ".pdf"), (".gif", ".mp4")
WRITERS: dict[str, tuple[Callable[..., Any], tuple[str, ...]]] = {
    "results": (Solution.save, (".h5", ".hdf5")),
    "vtk": (Solution.to_vtk, (".pvd", ".vtkhdf")),
    "plot": (Solution.plot, _PICTURE),
    "film": (Solution.animate, _FILM),
    "page": (Solution.to_html, (".html",)),
    "body": (Solution.picture, (".png",)),
    "history": (Solution.plot_history, _PICTURE),
    "load-displacement": (Solution.plot_load_displacement, _PICTURE),
    "mode-shapes": (Modes.plot, _PICTURE),
    "model": (Model.plot, _PICTURE),
}


def require_saved(model: Model) -> None:
    """Raise InputError if a model has parts that cannot be saved in a results file."""
    describe(model, np.zeros(1))


DRAWN = (*_PICTURE, ".html", *_FILM)  # what `draw` writes


@dataclass(frozen=True)
class OutputFile:
    """A file to write after the solve, with the options of a method of results."""

    kind: str
    file: Path
    options: dict[str, Any] = field(default_factory=dict)

    def require(self, model: Model, analysis: Analysis) -> None:
        """Raise InputError or KeyFault for what cannot be written."""
        try:
            require_target(self.file, WRITERS[self.kind][1])
        except InputError as error:
            raise KeyFault.of(error, "file") from None
        if "colour" in self.options:
            require_known(f"colour has no {self.options['colour']!r}", self.options["colour"], COLOURS)
        if self.kind == "results":
            require_saved(model)
        if self.kind in ("history", "load-displacement") and not analysis.span:
            raise InputError("this analysis has no states to draw; these go with static, path and dynamics")
        if self.kind == "load-displacement" and analysis.kind == "dynamics":
            raise InputError("a motion has no load factor to draw; these go with static and path")
        if self.kind == "mode-shapes" and analysis.span:
            raise InputError("this analysis finds no modes; these go with buckling and modes")

    def write(self, found: Found) -> None:
        """Write the file. Raises InputError, FileError."""
        options = self.options | ({"row": count("row", self.options["row"]) - 1} if "row" in self.options else {})
        source = {"mode-shapes": found.modes, "model": found.solution.model}.get(self.kind, found.solution)
        getattr(source, WRITERS[self.kind][0].__name__)(path=self.file, **options)


FILES: Kinds = {
    kind: with_keys(
        lambda keys, kind=kind: OutputFile(kind, keys["file"], {name: keys[name] for name in keys if name != "file"}),
        [method],
        needed=["file"],
        file=Path,
    )
    for kind, (method, _) in WRITERS.items()
}
