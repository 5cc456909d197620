"""What a model file asks to print: quantities of points, of beams or of the whole model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamfem.cli.modelfile.actions import Places
from beamfem.cli.modelfile.analyses import Analysis
from beamfem.cli.modelfile.table import Table, build
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.results.path import Path, PathState
from beamfem.results.solution import Solution
from beamfem.validation import finite, nearest

# of a point: method of a Solution and component of what it returns
QUANTITIES = {
    "x": ("position", 0),
    "y": ("position", 1),
    "ux": ("displacement", 0),
    "uy": ("displacement", 1),
    "vx": ("velocity", 0),
    "vy": ("velocity", 1),
    "rotation": ("rotation", None),
    "fx": ("reaction", 0),
    "fy": ("reaction", 1),
    "m": ("reaction", 2),
}
_BEAM = ("normal", "shear", "moment")
_NEAR = 1e-9
_ENERGY = ("kinetic", "strain", "potential", "total")


@dataclass(frozen=True)
class Output:
    """Quantities of a point, of a beam (along its stations), or of the model (energies); at: which states.

    at: "last", "all", or a list of times [s] or load factors: static solves have a state there, motions and paths give
    the nearest one.
    """

    quantities: Sequence[str]
    name: str = ""
    point: Point | None = None
    beam: Beam | None = None
    at: str | Sequence[float] = "last"

    def __post_init__(self) -> None:
        if self.point is not None and self.beam is not None:
            raise InputError("beam and point are given; an output has one of them, or none for the energies")
        known = self.known
        if not isinstance(self.quantities, list) or not self.quantities:
            raise InputError(f"quantities must be a list of some of {', '.join(known)}, got {self.quantities!r}")
        for quantity in self.quantities:
            if quantity not in known:
                raise InputError(f"quantities has no {quantity!r}; {nearest(str(quantity), known)} {self._where}")
        if isinstance(self.at, str):
            if self.at not in ("last", "all"):
                raise InputError(f'at must be "last", "all" or a list of numbers, got "{self.at}"')
        elif not isinstance(self.at, list) or not self.at:
            raise InputError(f'at must be "last", "all" or a list of numbers, got {self.at!r}')
        else:
            for value in self.at:
                finite("at", value)

    @property
    def known(self) -> tuple[str, ...]:
        """Quantities that can be asked here."""
        return tuple(QUANTITIES) if self.point is not None else _BEAM if self.beam is not None else _ENERGY

    @property
    def _where(self) -> str:
        return "at a point" if self.point is not None else "of a beam" if self.beam is not None else "of the model"

    def rows(self, solution: Solution) -> list[dict[str, Any]]:
        """Return a row for each state asked for: its time [s] or load factor, and the quantities."""
        chosen = self._chosen(solution)
        columns = self._columns(solution)
        axis = "load_factor" if solution.static else "time"
        rows = [
            {axis: float(solution.at[row]), **{name: values[row].tolist() for name, values in columns.items()}}
            for row in chosen
        ]
        if self.beam is None:
            return rows
        stations = solution.section_forces(self.beam).arc_length.tolist()
        return [{axis: row.pop(axis), "arc_length": stations, **row} for row in rows]

    @property
    def asked(self) -> list[float]:
        """Times [s] or load factors that are asked for as numbers."""
        return [] if isinstance(self.at, str) else [float(value) for value in self.at]

    def _chosen(self, solution: Solution) -> list[int]:
        if self.at == "all":
            return list(range(len(solution)))
        if self.at == "last":
            return [len(solution) - 1]
        for value in self.asked:
            self._require_within(solution, value)
        return [int(np.abs(solution.at - value).argmin()) for value in self.asked]

    @staticmethod
    def _require_within(solution: Solution, value: float) -> None:
        """Raise InputError where no state is at or near a time [s] or load factor."""
        low, high = float(solution.at.min()), float(solution.at.max())
        what = "load factor" if solution.static else "time"
        if not low - _NEAR <= value <= high + _NEAR:
            raise InputError(f"at asks for the {what} {value:g}, but the states are those from {low:g} to {high:g}")
        missed = float(np.abs(solution.at - value).min())
        if solution.static and not isinstance(solution, Path) and missed > _NEAR:
            raise InputError(f"at asks for the {what} {value:g}, where the structure jumps: it has no state there")

    def _columns(self, solution: Solution) -> dict[str, np.ndarray]:
        if self.point is not None:
            found = {
                method: getattr(solution, method)(self.point) for method in {QUANTITIES[q][0] for q in self.quantities}
            }
            return {
                quantity: found[method] if component is None else found[method][:, component]
                for quantity, (method, component) in ((q, QUANTITIES[q]) for q in self.quantities)
            }
        source = solution.energy() if self.beam is None else solution.section_forces(self.beam)
        return {quantity: np.asarray(getattr(source, quantity)) for quantity in self.quantities}


def outputs(root: Table, places: Places, model: Model, analysis: Analysis) -> list[Output]:
    """Return what a file asks to print. Raises ModelFileError."""
    found = []
    for number, table in enumerate(root.tables("outputs"), 1):
        if not analysis.states:
            raise table.error("this analysis prints what it finds; outputs go with static, path and dynamics")
        output = build(table, _output(number), {"point": places.point, "beam": places.beam})
        low, high = analysis.span
        for value in output.asked:
            if not low <= value <= high:
                raise table.error(f"there is no state at {value:g}, only from {low:g} to {high:g}", "at")
        if output.point is not None:
            require_supported(table, "quantities", model, output.point, output.quantities)
        found.append(output)
    return found


def require_supported(table: Table, key: str, model: Model, point: Point, quantities: Sequence[str]) -> None:
    """Raise ModelFileError where a reaction is asked for at a point without a support."""
    reactions = [quantity for quantity in quantities if QUANTITIES[quantity][0] == "reaction"]
    supported = {(id(support.point.beam), support.point.fraction) for support in model.point_supports}
    if reactions and (id(point.beam), point.fraction) not in supported:
        raise table.error(f"{reactions[0]} is a reaction, but there is no support at {point}", key)


def critical(output: Output, path: Path) -> dict[str, list[dict[str, Any]]]:
    """Return a row of an output at every limit point and bifurcation of a path."""
    result = {}
    for name in ("limit_points", "bifurcations"):
        found = getattr(path, name)
        result[name] = [row for state in found for row in replace(output, at="last").rows(_alone(path, state))]
    return result


def _alone(path: Path, state: PathState) -> Solution:
    """Return one state of a path as a Solution."""
    parts = (np.array([state.at]), state.p[None], state.v[None], state.a[None], path.statistics)
    return Solution(path.model, True, *parts, turned=None if state.turned is None else state.turned[None])


def _output(number: int) -> Any:
    """Return what makes an output; without a name it is called by its number."""

    def make(
        quantities: Sequence[str],
        name: str = f"output {number}",
        point: Point | None = None,
        beam: Beam | None = None,
        at: Any = "last",
    ) -> Output:
        if not isinstance(name, str):
            raise InputError(f"name must be a text, got {name!r}")
        return Output(quantities, name, point, beam, at)

    return make
