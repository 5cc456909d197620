"""Quantities that model files print."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamfem.cli.analyses import CRITICAL, Analysis
from beamfem.cli.schema import Names, reader, shown
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.quantities import AT_POINT, OF_BEAM, OF_MODEL, value_of
from beamfem.results.solution import Solution
from beamfem.validation import finite, nearest

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
