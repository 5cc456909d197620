"""Many calls of one function, here or in the workers of any `concurrent.futures.Executor`.

Failed calls and lost workers are reported, the rest continues.
"""

import multiprocessing
import os
import pickle
import signal
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass, field
from functools import cache, partial
from numbers import Real
from types import TracebackType
from typing import Any

import numpy as np

import beamfem
from beamfem.errors import BeamfemError, InputError
from beamfem.kernels.compiling import seconds_waited
from beamfem.progress import ends_as_a_whole, no_progress
from beamfem.reprs import brief
from beamfem.results.solution import Solution
from beamfem.tables import cut

ExecutorFactory = Callable[[], Executor]
Point = Mapping[str, Any]

_RETURNED = "a number, an array, a Solution or a mapping of named ones"


@dataclass(frozen=True)
class Outcome:
    """Outcome of a call: its value, or the error in a sentence with the traceback; and the time taken [s]."""

    value: Any = None
    seconds: float = 0.0
    error: str | None = None
    traceback: str = ""


def call(function: Callable[..., Any], point: Point) -> Outcome:
    """Call `function` with the parameters of a point; an exception becomes part of the outcome.

    The time in which kernels are compiled or loaded, which the first call in a process would pay, is not that of the
    point.
    """
    start = _clock()
    try:
        with ends_as_a_whole():
            value = _checked(function(**point))
    except Exception as error:
        sentence = f"{type(error).__name__}: {error}"
        return Outcome(None, _clock() - start, sentence, traceback.format_exc())
    return Outcome(value, _clock() - start)


def _clock() -> float:
    """Return a time [s] that stands still while kernels are compiled or loaded."""
    return time.perf_counter() - seconds_waited()


def call_all(function: Callable[..., Any], points: Sequence[Point], home: int, attempt: int) -> list[Outcome]:
    """Run calls one after the other, with one thread and without progress bars.

    home: process number of the caller. attempt: makes a repetition a new task for executors that merge equal ones
    (dask). The package is imported before any call is timed.
    """
    for name in beamfem.__all__:
        getattr(beamfem, name)  # imports it
    if os.getpid() != home:
        end_with_parent()
        _one_thread()
    with no_progress():
        return [call(function, point) for point in points]


def open_executor(factory: ExecutorFactory, function: Callable[..., Any], tasks: int) -> Executor:
    """Create an executor and wait until a worker answers; process pools are spawned, with one thread per worker.

    Raises InputError if the function cannot be sent to a process, BeamfemError if workers do not start.
    """
    executor = _made(factory)
    name = getattr(function, "__qualname__", repr(function))
    if not isinstance(executor, ProcessPoolExecutor):
        try:
            executor.submit(call_all, function, (), os.getpid(), 0).result()
        except Exception as error:
            what = f"{type(error).__name__}: {error}"
            raise BeamfemError(f"the {type(executor).__name__} of executor takes no calls; it raised {what}") from error
        return executor
    try:
        pickle.dumps(function)
    except Exception as error:
        executor.shutdown(wait=False)
        raise InputError(
            f"{name} cannot be sent to a worker process ({error}); define it with def at the top level of a module"
        ) from None
    # a pool starts a process with each task that finds none idle: as many questions start them all at once
    questions = range(min(tasks, workers(executor)))
    answers = [executor.submit(call_all, function, (), os.getpid(), 0) for _ in questions]
    try:
        answers[0].result()
    except BrokenExecutor:
        raise BeamfemError(
            f"the worker processes did not start or could not import {name}; they import the script anew, so that "
            'what it runs must stand below `if __name__ == "__main__":`'
        ) from None
    return executor


def _made(factory: Any) -> Executor:
    """Return the executor that a factory creates. Raises InputError if it creates none."""
    right = "such as ProcessPoolExecutor or functools.partial(ProcessPoolExecutor, 4)"
    if isinstance(factory, Executor) or not callable(factory):
        raise InputError(f"executor must be a class or a function that makes an Executor, {right}, got {factory!r}")
    try:
        executor = _spawning(factory)()
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        raise InputError(f"executor must make an Executor without arguments, {right}; it raised {what}") from error
    if not isinstance(executor, Executor):
        raise InputError(f"executor must make a concurrent.futures.Executor, got {type(executor).__name__}")
    return executor


def workers(executor: Executor) -> int:
    """Return the number of workers of an executor; 500 if it is unknown, which keeps a cluster busy."""
    return int(getattr(executor, "_max_workers", 500))


def _spawning(factory: Callable[..., Executor]) -> ExecutorFactory:
    """Make a process pool spawn, since a fork copies locks of other threads, and its workers end with this process."""
    bare = factory.func if isinstance(factory, partial) else factory
    keywords = factory.keywords if isinstance(factory, partial) else {}
    if not (isinstance(bare, type) and issubclass(bare, ProcessPoolExecutor)):
        return factory
    ours = {"mp_context": multiprocessing.get_context("spawn"), "initializer": end_with_parent}
    return partial(factory, **{name: value for name, value in ours.items() if name not in keywords})


@cache
def end_with_parent() -> None:
    """End this worker when the process that started it has ended, even if killed; only that process handles Ctrl-C."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    def follow() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=follow, name="end with parent", daemon=True).start()


@cache
def _one_thread() -> None:
    """Limit the BLAS and OpenMP libraries of this worker to one thread permanently; workers share the cores."""
    from threadpoolctl import threadpool_limits

    threadpool_limits(limits=1)


def _checked(value: Any, named: bool = False) -> Any:
    """Return a number, an array of numbers, a Solution or a dict of named ones. Raises InputError."""
    if isinstance(value, Mapping) and value and not named and all(isinstance(name, str) for name in value):
        return {name: _checked(item, named=True) for name, item in value.items()}
    if isinstance(value, Solution | bool | int):
        return value
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "biuf":
        return value if isinstance(value, np.ndarray) and value.ndim else value.item()
    if isinstance(value, Real):
        return float(value)
    raise InputError(f"the function must return {_RETURNED}, got {value!r}")


_LONGEST = 600  # characters of a failure, whose `error` has all


@dataclass(frozen=True)
class Failure:
    """A failed call: its parameters, the same as text, the error in a sentence, and the traceback ("" for none)."""

    parameters: Mapping[str, Any] = field(repr=False)
    label: str
    error: str
    traceback: str = field(default="", repr=False)

    __repr__ = brief

    def __str__(self) -> str:
        return cut(f"failed at {self.label}: {self.error}", _LONGEST)


class TaskRunner:
    """Calls a function at points, in this process or in workers that exist as long as the `with` block."""

    def __init__(self, function: Callable[..., Any], factory: ExecutorFactory | None) -> None:
        self._function = function
        self._factory = factory
        self._executor: Executor | None = None
        self._attempt = 0

    def __enter__(self) -> "TaskRunner":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: TracebackType | None) -> None:
        # nobody waits any more for what a pool computes when an exception has ended the sweep
        ended = dict(getattr(self._executor, "_processes", None) or {}) if kind is not None else {}
        self._close()
        for process in ended.values():
            process.terminate()

    def run(self, points: Sequence[Point]) -> Iterator[tuple[int, Outcome]]:
        """Yield the number and the outcome of each point as it is completed.

        Raises InputError or BeamfemError if no workers can be started.
        """
        if self._factory is None:
            for i, point in enumerate(points):
                yield i, call(self._function, point)
            return
        suspects = yield from self._together(points)
        for i in sorted(suspects):
            yield i, self._alone(points[i])

    def _together(self, points: Sequence[Point]) -> Generator[tuple[int, Outcome], None, list[int]]:
        """Run points in parallel, few at a time; return those that were lost with a worker, or waited beside it."""
        waiting, suspects, broken = deque(range(len(points))), list[int](), False
        running: dict[Future[list[Outcome]], int] = {}
        try:
            while waiting or running:
                executor = self._open(len(waiting) + len(running))
                try:
                    while waiting and len(running) < 2 * workers(executor) + 1:
                        running[self._submit(executor, points[waiting[0]])] = waiting[0]
                        waiting.popleft()
                except BrokenExecutor:
                    broken = True
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in done:
                    number, error = running.pop(future), future.exception()
                    if error is None:
                        yield number, future.result()[0]
                    else:
                        suspects.append(number)
                        broken = broken or isinstance(error, BrokenExecutor)
                if broken and not running:
                    self._close()
                    broken = False
        finally:
            for future in running:
                future.cancel()
        return suspects

    def _alone(self, point: Point) -> Outcome:
        """Run a suspect point alone, so that the death of its worker can be attributed to it."""
        start = time.perf_counter()
        try:
            executor = self._open(1)
            start = time.perf_counter()  # workers need a second to start
            return self._submit(executor, point).result()[0]
        except BrokenExecutor:
            self._close()
            error = "WorkerDied: the worker process ended in this call, which ran alone"
        except Exception as raised:
            error = f"{type(raised).__name__}: {raised}"
        return Outcome(seconds=time.perf_counter() - start, error=error)

    def _submit(self, executor: Executor, point: Point) -> "Future[list[Outcome]]":
        self._attempt += 1
        return executor.submit(call_all, self._function, [point], os.getpid(), self._attempt)

    def _open(self, tasks: int) -> Executor:
        if self._executor is None:
            assert self._factory is not None
            self._executor = open_executor(self._factory, self._function, tasks)
        return self._executor

    def _close(self) -> None:
        if self._executor is not None:
            # a worker needs 0.3 s to end, which nobody has to wait for
            self._executor.shutdown(wait=False)
            self._executor = None
