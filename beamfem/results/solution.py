"""A solution: states of a model over load factor or time, and the results derived from them."""

from dataclasses import dataclass, field
from typing import SupportsIndex, overload

import numpy as np

from beamfem.brief import brief
from beamfem.errors import InputError
from beamfem.model.model import Model
from beamfem.once import cached_property
from beamfem.registry import offered
from beamfem.results.checks import findings
from beamfem.results.exports import Exports
from beamfem.results.fitting import made_read_only, require_rows, require_state
from beamfem.results.pictures import Pictures
from beamfem.results.quantities import Quantities
from beamfem.results.status import Statistics, Status, counted
from beamfem.results.turns import start_rotations
from beamfem.validation import shown, whole


@dataclass(frozen=True, eq=False)
class State:
    """Coordinates of a model and their rates at a load factor or a time, such as those of a row of a solution.

    The solution has the results of its rows, such as `solution.displacement(point)[-1]`; a `PathState`, as `until` of
    `trace_equilibrium` gets it, has its own.

    Parameters
    ----------
    p : array, (n,)
        Coordinates.
    v : array, [1/s], (n,)
        Their rates.
    a : array, [1/s^2], (n,)
        Their second derivatives.
    at : float
        Load factor, or time [s].
    model : Model
        The model.
    turned : array, [rad], (m,), optional
        Rotations at the starts of beams, see `turns.start_rotations`; None if not known.

    Examples
    --------
    >>> state = solution[-1]
    >>> state.at
    1.0
    """

    p: np.ndarray
    v: np.ndarray
    a: np.ndarray
    at: float
    model: Model
    turned: np.ndarray | None = field(default=None, kw_only=True)

    __repr__ = brief

    def __post_init__(self) -> None:
        require_state(self)

    def _repr_html_(self) -> str:
        return offered(State._repr_html_)(self)


@dataclass(frozen=True, eq=False)
class Solution(Quantities, Pictures, Exports):
    """States of a model: row 0 is the start, the last row the end.

    Parameters
    ----------
    model : Model
        The model.
    static : bool
        Whether the rows are static equilibria; otherwise they are states of a motion.
    at : array, (steps,)
        Load factors, or times [s].
    p, v, a : array, (steps, n)
        Coordinates and their rates. Like `at`, they are read-only, since what is computed from them is kept; for other
        values, `dataclasses.replace(solution, p=...)` makes another solution.
    statistics : Statistics
        How the solve went.
    stability : array of bool, (steps,), optional
        Whether each row is a stable equilibrium, if the solver knows it.
    turned : array, [rad], (steps, m), optional
        Rotations at the starts of beams, see `turns.start_rotations`, if the solver has counted them between the rows.
    loaded : array, [-], (steps,), optional
        Load factor of the loads in a motion about an equilibrium.

    Examples
    --------
    >>> solution = bf.solve_static(model)
    >>> solution.at
    array([0., 1.])
    """

    model: Model
    static: bool
    at: np.ndarray
    p: np.ndarray
    v: np.ndarray
    a: np.ndarray
    statistics: Statistics
    stability: np.ndarray | None = None
    turned: np.ndarray | None = None
    loaded: np.ndarray | None = None

    def __post_init__(self) -> None:
        require_rows(self)
        made_read_only(self)

    def __repr__(self) -> str:
        what = "load factor" if self.static else "time"
        unit = "" if self.static else f" {self.model.unit('s')}"
        span = f"{what} {self.at[0]:g} to {self.at[-1]:g}{unit}" if len(self.at) else "empty"
        unstable = "" if self.stability is None or self.stability.all() else f"{(~self.stability).sum()} unstable, "
        drift = "" if self.energy_drift is None else f"; {self.energy_drift}"
        return f"{type(self).__name__}({len(self.at)} states, {unstable}{span}, of {self.model!r}{drift}{self._warned})"

    @property
    def _warned(self) -> str:
        """The number of warnings for the text, empty if there are none."""
        return f"; {counted(len(self.warnings), 'warning')}, see its warnings" if self.warnings else ""

    def __len__(self) -> int:
        return len(self.at)

    @overload
    def __getitem__(self, row: SupportsIndex) -> State: ...
    @overload
    def __getitem__(self, row: slice) -> "Solution": ...
    def __getitem__(self, row: SupportsIndex | slice) -> "State | Solution":
        """Return the state of a row, or a Solution of the rows of a slice with the statistics of the whole solve.

        Raises InputError for an empty slice or any other key, IndexError beyond the last row.
        """
        if isinstance(row, slice):
            return self._rows(row)
        number = whole("a row of a solution, or a slice such as solution[2:5],", row)
        if not -len(self) <= number < len(self):
            raise IndexError(f"the solution has {len(self)} rows, so there is no row {number}")
        return self._state(number)

    def _state(self, row: int) -> State:
        turned = start_rotations(self)[row]
        return State(self.p[row], self.v[row], self.a[row], float(self.at[row]), self.model, turned=turned)

    def _rows(self, rows: slice) -> "Solution":
        try:
            chosen = range(len(self))[rows]
        except (TypeError, ValueError) as error:
            raise InputError(f"rows of a solution are selected by whole numbers, got {shown(rows)}: {error}") from None
        if not chosen:
            first, last, stride = ("" if value is None else value for value in (rows.start, rows.stop, rows.step))
            text = f"{first}:{last}" + (f":{stride}" if stride != "" else "")
            raise InputError(f"solution[{text}] selects no row; this solution has rows 0 to {len(self) - 1}")
        parts = (self.at[rows], self.p[rows], self.v[rows], self.a[rows])
        stability, loaded = (None if values is None else values[rows] for values in (self.stability, self.loaded))
        turned = start_rotations(self)[rows]
        return Solution(self.model, self.static, *parts, self.statistics, stability, turned, loaded)

    @property
    def status(self) -> Status:
        """How the solve ended, as a member of `Status`."""
        return self.statistics.status

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings to heed before using the results, in sentences; empty if there are none.

        A solve has issued those of errors of 1 % and more as Python warnings too, each with a category.
        """
        return (*self.statistics.warnings, *(finding.sentence for finding in findings(self)))

    @cached_property
    def stable(self) -> np.ndarray:
        """Whether each row is a stable equilibrium (steps,), about which no small motion grows.

        Without follower loads: the tangent stiffness has no negative eigenvalue (Lagrange-Dirichlet theorem). With
        them: no mode of vibration diverges or flutters. Raises InputError for a motion.
        """
        if not self.static:
            raise InputError("stable is defined for static solutions only; this one is a motion")
        if self.stability is not None:
            return self.stability
        return self._stable_rows()

    @property
    def time(self) -> np.ndarray:
        """Times (steps,) [s]. Raises InputError for a static solution."""
        if self.static:
            raise InputError("a static solution has no time; use load_factor")
        return self.at

    @property
    def load_factor(self) -> np.ndarray:
        """Load factors (steps,) [-]. Raises InputError for a motion."""
        if not self.static:
            raise InputError("a motion has no load factor; use time")
        return self.at

    @property
    def iterations(self) -> int:
        """Total number of Newton iterations."""
        return self.statistics.iterations

    def _repr_html_(self) -> str:
        return offered(Solution._repr_html_)(self)

    def _stable_rows(self) -> np.ndarray:
        return offered(Solution._stable_rows)(self)
