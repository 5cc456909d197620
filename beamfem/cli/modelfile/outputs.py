"""Outputs to print for a model file: quantities of points, beams, connectors or the whole model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamfem.cli.modelfile.found import Analysis
from beamfem.cli.modelfile.places import Places
from beamfem.cli.modelfile.quantities import AT_POINT, OF_BEAM, OF_CONNECTOR, OF_MODEL, QUANTITIES
from beamfem.cli.modelfile.table import Table, build
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.contribution import Contribution
from beamfem.model.model import Model
from beamfem.results.path import Path, PathState
from beamfem.results.solution import Solution
from beamfem.validation import finite, nearest

_NEAR = 1e-9


@dataclass(frozen=True)
class Output:
    """Quantities of a point, of a beam (along its stations), of a connector, or of the model; at: which states.

    at: "last", "all", or a list of times [s] or load factors: static solves have a state at each, motions and paths use
    the nearest one.
    """

    quantities: Sequence[str]
    name: str = ""
    point: Point | None = None
    beam: Beam | None = None
    at: str | Sequence[float] = "last"
    connector: Contribution | None = None

    def __post_init__(self) -> None:
        given = [name for name in ("beam", "point", "connector") if getattr(self, name) is not None]
        if len(given) > 1:
            raise InputError(f"{' and '.join(given)} are given; an output has one of them, or none for the model")
        known = self.known
        if not isinstance(self.quantities, list) or not self.quantities:
            raise InputError(f"quantities must be a list of some of {', '.join(known)}, got {self.quantities!r}")
        for quantity in self.quantities:
            if quantity not in known:
                raise InputError(f"quantities has no {quantity!r}; {nearest(str(quantity), known)} {self._where}")
        if "multiplier" in self.quantities and len(self.quantities) > 1:
            raise InputError(
                "quantities has multiplier, of which there is not one a point: ask for it in another output"
            )
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
        """Quantities available here."""
        return self._kind[0]

    @property
    def _where(self) -> str:
        return self._kind[1]

    @property
    def _kind(self) -> tuple[tuple[str, ...], str]:
        if self.point is not None:
            return tuple(AT_POINT), "at a point"
        if self.beam is not None:
            return tuple(OF_BEAM), "of a beam"
        return (tuple(OF_MODEL), "of the model") if self.connector is None else (tuple(OF_CONNECTOR), "of a connector")

    def rows(self, solution: Solution) -> list[dict[str, Any]]:
        """Return a row for each requested state: its time [s] or load factor, and the quantities."""
        chosen = self._chosen(solution)
        columns = self._columns(solution)
        axis = "load_factor" if solution.static else "time"
        rows = [
            {axis: float(solution.at[row]), **{name: values[row].tolist() for name, values in columns.items()}}
            for row in chosen
        ]
        if self.beam is not None:
            stations = {"arc_length": solution.section_forces(self.beam).arc_length.tolist()}
        elif self.connector is not None and self.quantities != ["multiplier"]:
            stations = {"point": list(range(1, len(self.connector.points) + 1))}
        else:
            stations = {}
        return [{axis: row.pop(axis), **stations, **row} for row in rows]

    @property
    def asked(self) -> list[float]:
        """Times [s] or load factors that are requested as numbers."""
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
        """Raise InputError if no state is at or near a time [s] or load factor."""
        low, high = float(solution.at.min()), float(solution.at.max())
        what = "load factor" if solution.static else "time"
        if not low - _NEAR <= value <= high + _NEAR:
            raise InputError(f"at asks for the {what} {value:g}, but the states are those from {low:g} to {high:g}")
        missed = float(np.abs(solution.at - value).min())
        if solution.static and not isinstance(solution, Path) and missed > _NEAR:
            raise InputError(f"at asks for the {what} {value:g}, where the structure jumps: it has no state there")

    def _columns(self, solution: Solution) -> dict[str, np.ndarray]:
        item = next((item for item in (self.point, self.beam, self.connector) if item is not None), None)
        tables = {
            "at a point": AT_POINT,
            "of a beam": OF_BEAM,
            "of a connector": OF_CONNECTOR,
            "of the model": OF_MODEL,
        }
        return {quantity: np.asarray(tables[self._where][quantity](solution, item)) for quantity in self.quantities}


def outputs(
    root: Table, places: Places, model: Model, analysis: Analysis, connectors: Mapping[str, Contribution]
) -> list[Output]:
    """Return the outputs of a file; connectors: by name. Raises ModelFileError."""

    def connector(table: Table, key: str) -> Contribution:
        name = table.text(key)
        if name not in connectors:
            raise table.error(f"there is no connector {name!r}; {nearest(name, connectors)}", key)
        return connectors[name]

    result = []
    for number, table in enumerate(root.tables("outputs"), 1):
        if not analysis.states:
            raise table.error("this analysis prints what it finds; outputs go with static, path and dynamics")
        output = build(table, _output(number), {"point": places.point, "beam": places.beam, "connector": connector})
        low, high = analysis.span
        for value in output.asked:
            if not low <= value <= high:
                raise table.error(f"there is no state at {value:g}, only from {low:g} to {high:g}", "at")
        if output.point is not None:
            require_supported(table, "quantities", model, output.point, output.quantities)
        if analysis.moving and output.known == tuple(OF_MODEL) and "stable" in output.quantities:
            raise table.error("stable is asked of equilibria, and this analysis is a motion", "quantities")
        result.append(output)
    return result


def require_supported(table: Table, key: str, model: Model, point: Point, quantities: Sequence[str]) -> None:
    """Raise ModelFileError if a reaction is requested at a point without a support."""
    reactions = [quantity for quantity in quantities if QUANTITIES.get(quantity, ("",))[0] == "reaction"]
    supported = {(id(support.point.beam), support.point.fraction) for support in model.point_supports}
    if reactions and (id(point.beam), point.fraction) not in supported:
        raise table.error(f"{reactions[0]} is a reaction, but there is no support at {point}", key)


def critical(output: Output, path: Path) -> dict[str, list[dict[str, Any]]]:
    """Return a row of an output at every limit point and bifurcation of a path."""
    result = {}
    for name in ("limit_points", "bifurcations"):
        states = getattr(path, name)
        result[name] = [row for state in states for row in replace(output, at="last").rows(_alone(path, state))]
    return result


def _alone(path: Path, state: PathState) -> Solution:
    """Return one state of a path as a Solution."""
    parts = (np.array([state.at]), state.p[None], state.v[None], state.a[None], path.statistics)
    return Solution(path.model, True, *parts, turned=None if state.turned is None else state.turned[None])


def _output(number: int) -> Any:
    """Return a function that makes an output, named by its number by default."""

    def make(
        quantities: Sequence[str],
        name: str = f"output {number}",
        point: Point | None = None,
        beam: Beam | None = None,
        at: Any = "last",
        connector: Contribution | None = None,
    ) -> Output:
        if not isinstance(name, str):
            raise InputError(f"name must be a text, got {name!r}")
        return Output(quantities, name, point, beam, at, connector)

    return make
