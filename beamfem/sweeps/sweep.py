"""Parameter sweeps: a function called at every combination of values, in parallel if wanted, with results on disk."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem import tables as tabulate
from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.progress import progress
from beamfem.reprs import brief
from beamfem.results.solution import Solution
from beamfem.sweeps.parameters import assignments, check_call, combinations, labels, name_of, split
from beamfem.sweeps.result_cache import ResultCache
from beamfem.sweeps.workers import ExecutorFactory, Failure, Outcome, TaskRunner
from beamfem.validation import flag, require_known, shown
from beamfem.view.plots import COLOURS, MARKERS, legend_over, new_figure, save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

_ROWS_REPORTED = 40
_ROWS_PRINTED = 6
_WIDTH = 70  # characters of a printed table
_PRINTED = 110  # characters of a failure
_NAMED = 12  # curves in a legend
_ABOVE = 50  # characters of all names in a line
_CUT, _WIDEST = 40, 3.2  # characters of the longest name, and their width [inch]


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
    seconds : array, [s], (n,)
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
        """Return the name of a column of the table: `name`, for "value" that of the function if results have no names.

        Examples
        --------
        >>> def moment(force, length):
        ...     return force * length
        >>> bf.sweep(moment, force=[1.0, 2.0], length=3.0).column("value")
        'moment'
        """
        names = self.table()[0]
        return self.function if name == "value" and name not in names and self.function in names else name

    def _named(self, value: Any) -> Mapping[str, Any]:
        if value is None:
            return {}
        return value if isinstance(value, Mapping) else {self.function: value}

    def _rows(self) -> tuple[list[str], list[list[Any]]]:
        rows = [row | texts for row, texts in zip(self.table(), self._texts(), strict=True)]
        numbers = [name for name in rows[0] if not any(isinstance(row[name], Solution) for row in rows)]
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
        header, rows = self._rows()
        few = tabulate.cells([header, *tabulate.few(rows, _ROWS_PRINTED)])
        lines = [[tabulate.cut(text, _CUT) for text in row] for row in few]
        ends = np.cumsum([3 + max(map(len, column)) for column in zip(*lines, strict=True)])
        fitting = max(1, int(np.sum(ends <= _WIDTH)))
        lines = [[*line[:fitting], *["..."] * (fitting < len(line))] for line in lines]
        return "\n".join([tabulate.as_text(lines[0], lines[1:]), f"{self._note}; all by report()", *failed])

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

    def to_pandas(self) -> "DataFrame":
        """Return the table of all points, without solutions, as a pandas.DataFrame. Raises MissingPackageError."""
        return tabulate.as_pandas(*self._rows())

    def to_xarray(self) -> "Dataset":
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

    def plot(
        self,
        value: str | None = None,
        over: str | None = None,
        path: str | PathLike[str] | None = None,
        *,
        ax: Any = None,
    ) -> "Figure":
        """Plot a result against a parameter, one curve for each combination of the others, without points that failed.

        value: name of the result; over: name of a varied numeric parameter; by default the first of each; path: file to
        write (PNG, SVG, PDF); ax: axes to draw in, see `Solution.plot`. Returns the figure. Raises InputError for an
        unknown name, or if there are no numbers to plot; MissingPackageError without matplotlib.

        Examples
        --------
        >>> results = bf.sweep(lambda force, length: {"moment": force * length}, force=[1.0, 2.0], length=[3.0, 5.0])
        >>> figure = results.plot("moment", over="length", path="sweep.png")
        """
        names, texts = list(self.labels[0]), self.labels
        numeric = [name for name in names if all(_is_number(point[name]) for point in self.parameters)]
        columns = {name: self[name] for name in self.table()[0] if name not in (*names, "seconds")}
        results = [name for name, column in columns.items() if column.ndim == 1 and column.dtype.kind in "fiu"]
        if not numeric or not results:
            what = "parameter that varies" if not numeric else "result"
            raise InputError(f"the sweep has no {what} whose values are numbers, so there is nothing to draw")
        over, value = numeric[0] if over is None else over, results[0] if value is None else self.column(value)
        require_known(f"over is no parameter that varies and is a number, got {shown(over)}", over, numeric)
        what = f"value is no result of the sweep that is a number, got {shown(value)}"
        require_known(what, value, [*results, "seconds"])
        curves: dict[str, list[tuple[float, float]]] = {}
        for point, text, height in zip(self.parameters, texts, self[value].tolist(), strict=True):
            label = ", ".join(f"{name}={text[name]}" for name in names if name != over)
            curves.setdefault(label, []).append((float(point[over]), height))
        named = 1 < len(curves) <= _NAMED
        # a legend of few short names stands above the axes, a longer one beside them in a wider figure
        legend_beside = named and sum(map(len, curves)) > _ABOVE
        width = 6.4 + (_WIDEST * min(1.0, max(map(len, curves)) / _CUT) if legend_beside else 0.0)
        figure, axes = new_figure(width, ax=ax, pyplot=path is None)
        for number, (label, points) in enumerate(curves.items()):
            x, y = np.array(sorted(points)).T
            colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
            label = label if len(label) <= _CUT else f"{label[: _CUT - 2]} …"
            axes.plot(x, y, color=colour, marker=marker, markersize=4, linewidth=1.4, label=label)
        axes.set(xlabel=over, ylabel=value, xmargin=0.04, ymargin=0.04)
        if legend_beside:
            axes.legend(frameon=False, fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        elif named:
            legend_over(axes, len(curves))
        return save_figure(figure, path)

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the table of all points with all digits, without solutions. Raises FileError if it cannot be written.

        Examples
        --------
        >>> results = bf.sweep(lambda force, length: {"moment": force * length}, force=[1.0, 2.0], length=[3.0, 5.0])
        >>> results.to_csv("sweep.csv")
        """
        tabulate.write_csv(path, *self._rows())


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)


_NOT_REACHED = "NotComputed: the sweep was interrupted before"


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
        Use stored results even if the code has changed since. By default any edit of the script, of a module of the
        user that is loaded or imported by these, or another version of beamfem computes the points again, with a
        `ChangedCodeWarning`.
    **parameters
        Arguments of the function. Lists, tuples, ranges and one-dimensional arrays are varied; everything else is
        passed on unchanged.

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

    def result(computed: int) -> Sweep:
        found = [outcome or Outcome(seconds=np.nan, error=_NOT_REACHED) for outcome in outcomes]
        failures = tuple(
            Failure(point, assignments(text), outcome.error, outcome.traceback)
            for point, text, outcome in zip(points, texts, found, strict=True)
            if outcome.error is not None
        )
        return Sweep(
            parameters=tuple(points),
            values=tuple(outcome.value for outcome in found),
            failures=failures,
            seconds=np.array([outcome.seconds for outcome in found]),
            shape=tuple(len(values) for values in varied.values()),
            computed=computed,
            labels=tuple(texts),
            function=name_of(function),
        )

    with ExitStack() as stack:
        cache = None if store is None else stack.enter_context(ResultCache(store, function, points))
        if cache is not None:
            outcomes = cache.found(keep_stale)
        todo = [i for i, outcome in enumerate(outcomes) if outcome is None]
        runner = stack.enter_context(TaskRunner(function, executor))
        report = stack.enter_context(progress("points", len(todo)))
        try:
            for done, (number, outcome) in enumerate(runner.run([points[i] for i in todo]), 1):
                i = todo[number]
                outcomes[i] = outcome
                if cache is not None and outcome.error is None:
                    cache.add(i, assignments(texts[i]), outcome)
                report(done)
        except BaseException as error:
            if computed := sum(outcomes[i] is not None for i in todo):
                error.sweep = result(computed)  # type: ignore[attr-defined]
                error.add_note(f"The {computed} points computed before are in the `sweep` of this exception.")
            raise
    return result(len(todo))
