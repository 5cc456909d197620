"""Parameter sweeps: a function called at every combination of values, in parallel if wanted, with results on disk."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

import numpy as np

from beamfem import tabulate
from beamfem.brief import brief
from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.keywords import keywords_checked
from beamfem.progress import progress
from beamfem.sweeps.parameters import assignments, check_call, combinations, is_solution, labels, name_of, split
from beamfem.sweeps.stored import StoredCalls
from beamfem.sweeps.tasks import Failure, TaskRunner
from beamfem.sweeps.workers import ExecutorFactory, Outcome
from beamfem.validation import flag, require_known, shown

_ROWS_REPORTED = 40
_ROWS_PRINTED = 6
_PRINTED = 110  # characters of a failure
_NOT_REACHED = "NotComputed: the sweep was interrupted before"


@dataclass(frozen=True, eq=False)
class Sweep:
    """Results of a sweep, one row per point, the last parameter varying fastest; `sweep[name]` is an array.

    Parameters
    ----------
    parameters : tuple of mapping
        Parameters of each point.
    values : tuple
        What the function returned, None if it failed.
    failures : tuple of Failure
        The calls that failed.
    seconds : array, [s], (points,)
        Duration of each call, without compilation; nan for points without a call.
    shape : tuple of int
        Number of values of each varied parameter; `sweep[name].reshape(sweep.shape)` is the grid.
    computed : int
        Number of points called in this run; the others were read from the store.
    labels : tuple of mapping
        Text of each varied parameter.
    function : str
        Name of the function.

    Examples
    --------
    >>> results = bf.sweep(lambda force, length: {"moment": force * length}, force=[1.0, 2.0], length=[3.0, 5.0])
    >>> results["moment"].reshape(results.shape)
    array([[ 3.,  5.],
           [ 6., 10.]])
    """

    parameters: tuple[Mapping[str, Any], ...]
    values: tuple[Any, ...]
    failures: tuple[Failure, ...]
    seconds: np.ndarray
    shape: tuple[int, ...]
    computed: int
    labels: tuple[Mapping[str, str], ...] = field(repr=False)
    function: str = "value"

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a column (points,), or (points, ...) for arrays of equal shape; nan for points that failed.

        Solutions are returned as an array of objects, None for points that failed.
        """
        rows = self.table()
        name = self.column(name)
        require_known(f"the sweep has no {shown(name)}", name, rows[0])
        column = [row[name] for row in rows]
        valid = [value for value in column if value is not None]
        if not all(isinstance(value, bool | int | float | np.ndarray) for value in valid):
            array = np.empty(len(column), dtype=object)
            for i, value in enumerate(column):  # a solution is a sequence, which numpy would unpack
                array[i] = value
            return array
        shapes = {np.shape(value) for value in valid}
        if len(shapes) > 1:
            raise InputError(f"the arrays of {name!r} have different shapes {sorted(shapes)}; take them from values")
        missing = np.full(shapes.pop() if shapes else (), np.nan)
        return np.array([missing if value is None else value for value in column])

    def table(self) -> list[dict[str, Any]]:
        """Return one mapping per point: varied parameters, named values (None if the call failed) and seconds [s].

        A value with the name of a parameter is listed as `name (result)`, one without a name by the name of the
        function, or as `value` if that has none. Printed and written tables, to_pandas and to_xarray leave out
        solutions, which `values` and `sweep[name]` hold.
        """
        names = dict.fromkeys(name for value in self.values for name in self._named(value))
        varied = list(self.labels[0])
        titles = {name: f"{name} (result)" if name in (*varied, "seconds") else name for name in names}
        return [
            {name: point[name] for name in varied}
            | {titles[name]: self._named(value).get(name) for name in names}
            | {"seconds": float(seconds)}
            for point, value, seconds in zip(self.parameters, self.values, self.seconds, strict=True)
        ]

    def column(self, name: str) -> str:
        """Return the name of a column: `name`, or the name of the function for "value" if results have no names."""
        names = self.table()[0]
        return self.function if name == "value" and name not in names and self.function in names else name

    def _named(self, value: Any) -> Mapping[str, Any]:
        if value is None:
            return {}
        return value if isinstance(value, Mapping) else {self.function: value}

    def _rows(self) -> tuple[list[str], list[list[Any]]]:
        rows = [row | dict(texts) for row, texts in zip(self.table(), self._texts(), strict=True)]
        numbers = [name for name in rows[0] if not any(is_solution(row[name]) for row in rows)]
        return numbers, [[row[name] for name in numbers] for row in rows]

    def _texts(self) -> list[dict[str, Any]]:
        """Return numbers unchanged and the labels of everything else."""
        return [
            {n: point[n] if isinstance(point[n], bool | int | float) else text for n, text in texts.items()}
            for point, texts in zip(self.parameters, self.labels, strict=True)
        ]

    @property
    def _note(self) -> str:
        return f"{len(self)} points, {self.computed} computed now, {len(self.failures)} failed"

    def __str__(self) -> str:
        failed = [tabulate.cut(str(failure), _PRINTED) for failure in self.failures[:1]]
        return "\n".join([tabulate.as_brief(*self._rows(), _ROWS_PRINTED), f"{self._note}; all by report()", *failed])

    def report(self) -> str:
        """Return a table of up to 40 points, without solutions, and every failure, as text."""
        header, rows = self._rows()
        table = tabulate.as_text(header, tabulate.few(rows, _ROWS_REPORTED))
        return "\n".join([table, self._note, *map(str, self.failures)])

    def _repr_html_(self) -> str:
        header, rows = self._rows()
        return f"<b>Sweep</b>{tabulate.as_html(header, tabulate.few(rows, _ROWS_REPORTED))}{self._note}"

    def to_markdown(self) -> str:
        """Return the table of all points, without solutions, as Markdown text."""
        return tabulate.as_markdown(*self._rows())

    def to_pandas(self) -> Any:
        """Return the table of all points, without solutions, as a pandas.DataFrame. Raises MissingPackageError."""
        return tabulate.as_pandas(*self._rows())

    def to_xarray(self) -> Any:
        """Return the numbers of all points as an xarray.Dataset over the varied parameters; nan for points that failed.

        Arrays of equal shape add dimensions of their own; solutions are left out. Raises MissingPackageError without
        xarray, InputError for arrays of different shapes.
        """
        with needed_for("to_xarray"):
            import xarray
        texts = self._texts()
        names = list(self.labels[0])
        step = [int(np.prod(self.shape[axis + 1 :])) for axis in range(len(names))]
        coordinates = {
            name: [texts[i * step[axis]][name] for i in range(self.shape[axis])] for axis, name in enumerate(names)
        }
        data = {}
        for name in self.table()[0]:
            values = None if name in names else self[name]
            if values is not None and values.dtype != object:
                dimensions = [f"{name}_{axis}" for axis in range(values.ndim - 1)]
                data[name] = ((*names, *dimensions), values.reshape(*self.shape, *values.shape[1:]))
        return xarray.Dataset(data, coordinates)

    def plot(self, value: str | None = None, over: str | None = None, path: str | PathLike[str] | None = None) -> Any:
        """Plot a result against a parameter, one curve for each combination of the others, without points that failed.

        Parameters
        ----------
        value : str, optional
            Name of the result, by default the first.
        over : str, optional
            Name of a varied numeric parameter, by default the first.
        path : path, optional
            File to write (PNG, SVG, PDF).

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            For an unknown name, or if there are no numbers to plot.
        MissingPackageError
            Without matplotlib.

        Examples
        --------
        >>> results = bf.sweep(lambda force, length: {"moment": force * length}, force=[1.0, 2.0], length=[3.0, 5.0])
        >>> figure = results.plot("moment", over="length", path="sweep.png")
        """
        from beamfem.sweeps.figure import plot_sweep

        return plot_sweep(self, value, over, path)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the table of all points with all digits, without solutions.

        Parameters
        ----------
        path : path
            File to write.

        Raises
        ------
        FileError
            If it cannot be written.

        Examples
        --------
        >>> results = bf.sweep(lambda force, length: {"moment": force * length}, force=[1.0, 2.0], length=[3.0, 5.0])
        >>> results.to_csv("sweep.csv")
        """
        tabulate.write_csv(path, *self._rows())


@keywords_checked
def sweep(
    function: Callable[..., Any],
    /,
    *,
    executor: ExecutorFactory | None = None,
    store: str | PathLike[str] | None = None,
    keep_stale: bool = False,
    **parameters: Any,
) -> Sweep:
    """Call a function at every combination of the given values and return all results.

    Parameters
    ----------
    function : callable
        Returns a number, an array, a Solution or a mapping of named ones. A store saves solutions as files in a folder
        beside it.
    executor : callable, optional
        A class, or a function without arguments, that creates a `concurrent.futures.Executor`. By default the calls run
        in this process, one after the other.
    store : path, optional
        A file or folder that saves each result as it arrives; the next run of the same function with the same
        parameters reads it.
    keep_stale : bool, default False
        Use stored results even if the code that they depend on has changed since. By default a `ChangedCodeWarning` is
        given and the points are computed again if one of the user files that the function depends on (its constants,
        helpers, and their imports) has changed.
    **parameters
        Arguments of the function. Lists, tuples, ranges and one-dimensional arrays are varied; everything else is
        passed on unchanged.

    Returns
    -------
    Sweep
        One row per point, the last parameter varying fastest.

    Raises
    ------
    InputError
        If the function or the parameters are invalid.
    FileError
        If the store cannot be opened.
    BeamfemError
        If no worker starts.

    Notes
    -----
    A call that fails or kills its worker is listed in `failures` and the sweep continues; the next run tries it again.
    On an interrupt, the KeyboardInterrupt carries the results so far as its `sweep`, and workers are stopped at once.
    If the store can no longer be written, a `NotStoredWarning` is given and the sweep continues.

    Examples
    --------
    >>> results = bf.sweep(lambda force, length: {"moment": force * length}, force=[1.0, 2.0], length=[3.0, 5.0])
    >>> results["moment"]
    array([ 3.,  5.,  6., 10.])
    """
    keep_stale = flag("keep_stale", keep_stale)
    varied, fixed = split(parameters)
    points = combinations(varied, fixed)
    check_call(function, points[0], ("executor", "store", "keep_stale"))
    texts = combinations({name: labels(values) for name, values in varied.items()}, {})
    outcomes: list[Outcome | None] = [None] * len(points)
    with ExitStack() as stack:
        stored = None if store is None else stack.enter_context(StoredCalls(store, function, points))
        if stored is not None:
            outcomes = stored.found(keep_stale)
        todo = [i for i, outcome in enumerate(outcomes) if outcome is None]
        runner = stack.enter_context(TaskRunner(function, executor))
        report = stack.enter_context(progress("points", len(todo)))
        try:
            for done, (number, outcome) in enumerate(runner.run([points[i] for i in todo]), 1):
                i = todo[number]
                outcomes[i] = outcome
                if stored is not None and outcome.error is None:
                    stored.add(i, assignments(texts[i]), outcome)
                report(done)
        except BaseException as error:
            if computed := sum(outcomes[i] is not None for i in todo):
                error.sweep = _result(points, texts, outcomes, varied, computed, name_of(function))  # type: ignore[attr-defined]
                error.add_note(f"The {computed} points computed before are in the `sweep` of this exception.")
            raise
    return _result(points, texts, outcomes, varied, len(todo), name_of(function))


def _result(
    points: list[dict[str, Any]],
    texts: list[dict[str, Any]],
    found: list[Outcome | None],
    varied: Mapping[str, Sequence[Any]],
    computed: int,
    name: str,
) -> Sweep:
    outcomes = [outcome or Outcome(seconds=np.nan, error=_NOT_REACHED) for outcome in found]
    failures = tuple(
        Failure(point, assignments(text), outcome.error, outcome.traceback)
        for point, text, outcome in zip(points, texts, outcomes, strict=True)
        if outcome.error is not None
    )
    return Sweep(
        parameters=tuple(points),
        values=tuple(outcome.value for outcome in outcomes),
        failures=failures,
        seconds=np.array([outcome.seconds for outcome in outcomes]),
        shape=tuple(len(values) for values in varied.values()),
        computed=computed,
        labels=tuple(texts),
        function=name,
    )
