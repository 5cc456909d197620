"""Initial states of analyses of a model file: equilibria under loads, and states in results files."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beamfem.cli.modelfile.table import Table, build, shown
from beamfem.errors import FileError, InputError
from beamfem.io.results import load
from beamfem.model.model import Model
from beamfem.results.solution import State
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.statics.load_steps import Snap
from beamfem.solve.statics.statics import solve_static
from beamfem.validation import count, finite, one_of


@dataclass(frozen=True)
class Equilibrium:
    """The equilibrium under the loads at a load factor from 0 to 1; the other keys are those of a static analysis."""

    load_factor: float = 1.0
    steps: int = 1
    newton: Newton | None = None
    snap: Snap = "error"

    def __post_init__(self) -> None:
        if not 0.0 <= finite("load_factor", self.load_factor) <= 1.0:
            raise InputError(f"load_factor of an equilibrium to start from lies within 0 and 1, got {self.load_factor}")
        count("steps", self.steps)
        one_of("snap", self.snap, ("error", "jump"))

    def of_model(self, model: Model) -> State:
        """Return the state. Raises InputError, ConvergenceError."""
        return solve_static(model, self.steps, self.newton, at=[self.load_factor], snap=self.snap)[-1]


Start = Equilibrium | State | None


def state_of(start: Start, model: Model) -> State | None:
    """Return the state to start from, None for the reference. Raises InputError, ConvergenceError."""
    return start.of_model(model) if isinstance(start, Equilibrium) else start


def newton(table: Table, key: str) -> Newton:
    """Return the Newton of a table. Raises ModelFileError."""
    result: Newton = build(table.table(key), Newton)
    return result


def start(table: Table, key: str) -> Start:
    """Return the start at a key: "reference", "static", a load factor, or a table. Raises ModelFileError.

    A table has the keys of `Equilibrium`, or `file`, a results file, and `row`, from 1, by default the last.
    """
    value = table.values[key]
    if value in ("reference", "static"):
        return Equilibrium() if value == "static" else None
    if isinstance(value, dict):
        subtable = table.table(key)
        result: Start
        if "file" in value:
            result = build(subtable, _saved, {"file": lambda part, name: part.source.file.parent / part.text(name)})
        else:
            result = build(subtable, Equilibrium, {"newton": newton})
        return result
    if isinstance(value, bool | str | list):
        raise table.error(
            f'{key} must be "reference" or "static", a load factor, or a table with load_factor or file, got '
            f"{shown(value)}",
            key,
        )
    try:
        return Equilibrium(value)
    except InputError as error:
        raise table.error(str(error), key) from None


def _saved(file: Path, row: int | None = None) -> State:
    """Return a state of a results file. Raises InputError."""
    try:
        solution = load(file)
    except FileError as error:
        raise InputError(f"file: {error}") from error
    number: Any = len(solution) if row is None else count("row", row)
    if number > len(solution):
        raise InputError(f"row is {row}, but {file.name} has {len(solution)} rows")
    return solution[number - 1]
