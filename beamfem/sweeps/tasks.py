"""Many calls of one function, here or in workers; failed calls and lost workers are reported, the rest continues."""

import math
import os
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any

from beamfem.reprs import brief
from beamfem.sweeps.workers import ExecutorFactory, Outcome, Point, call, call_all, end_workers, open_executor, workers
from beamfem.tables import cut

_LONGEST = 600  # characters of a failure, whose `error` has all
_CHUNK_SECONDS = 0.05  # sending a chunk costs about 0.3 ms


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
        if kind is not None and self._executor is not None:
            end_workers(self._executor)  # nobody waits for what they compute any more
        self._close()

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
        """Run chunks in parallel; return the points whose chunk was lost.

        Few chunks are submitted at a time, so that the death of a worker leaves few suspect points.
        """
        waiting = deque(range(len(points)))
        running: dict[Future[list[Outcome]], list[int]] = {}
        suspects: list[int] = []
        seconds = math.inf
        broken = False
        try:
            while waiting or running:
                if broken and not running:
                    self._close()
                    broken = False
                executor = self._open(len(waiting) + len(running))
                while waiting and not broken and len(running) < 2 * workers(executor) + 1:
                    # the last chunks are small, so that no worker is left with a long one
                    fair = math.ceil(len(waiting) / (2 * workers(executor)))
                    chunk = [waiting.popleft() for _ in range(max(1, min(fair, int(_CHUNK_SECONDS / seconds))))]
                    try:
                        running[self._submit(executor, [points[i] for i in chunk])] = chunk
                    except BrokenExecutor:
                        waiting.extendleft(reversed(chunk))
                        broken = True
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in done:
                    chunk = running.pop(future)
                    error = future.exception()
                    if error is not None:
                        suspects += chunk
                        broken = broken or isinstance(error, BrokenExecutor)
                        continue
                    outcomes = future.result()
                    seconds = max(sum(outcome.seconds for outcome in outcomes) / len(chunk), 1e-7)
                    yield from zip(chunk, outcomes, strict=True)
        finally:
            for future in running:
                future.cancel()
        if broken:
            self._close()
        return suspects

    def _alone(self, point: Point) -> Outcome:
        """Run a suspect point alone, so that the death of its worker can be attributed to it."""
        start = time.perf_counter()
        try:
            executor = self._open(1)
            start = time.perf_counter()  # workers need a second to start
            return self._submit(executor, [point]).result()[0]
        except BrokenExecutor:
            self._close()
            error = "WorkerDied: the worker process ended in this call, which ran alone"
        except Exception as raised:
            error = f"{type(raised).__name__}: {raised}"
        return Outcome(seconds=time.perf_counter() - start, error=error)

    def _submit(self, executor: Executor, points: list[Point]) -> "Future[list[Outcome]]":
        self._attempt += 1
        return executor.submit(call_all, self._function, points, os.getpid(), self._attempt)

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
