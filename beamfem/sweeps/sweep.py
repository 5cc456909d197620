"""Parameter sweeps: a function called at every combination of values, in parallel if wanted, with results on disk."""

from collections.abc import Callable
from contextlib import ExitStack
from os import PathLike
from typing import Any

import numpy as np

from beamfem.progress import progress
from beamfem.sweeps.parameters import assignments, check_call, combinations, labels, name_of, split
from beamfem.sweeps.result_cache import ResultCache
from beamfem.sweeps.sweep_result import Sweep
from beamfem.sweeps.workers import ExecutorFactory, Failure, Outcome, TaskRunner
from beamfem.validation import flag

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
