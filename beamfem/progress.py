"""Long work: a bar on a terminal or in a notebook, silence in a pipe, and the results so far if it ends early."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from functools import wraps
from importlib.util import find_spec
from typing import Any, ParamSpec, TypeVar

from beamfem.errors import ConvergenceError, LongRunWarning, warn

_Taken = ParamSpec("_Taken")
_Found = TypeVar("_Found")
_SHOWN = 0.5  # seconds of work from which on there is a bar
_WORTH = 5.0  # seconds of work from which on Ctrl-C returns its results; below it is meant for what called it

_held: ContextVar[bool] = ContextVar("_held", default=False)
_part: ContextVar[bool] = ContextVar("_part", default=False)


def in_notebook() -> bool:
    """Return whether this runs in the kernel of a notebook, which shows below a cell what is written to stderr."""
    return type(sys.stderr).__module__ == "ipykernel.iostream"


def no_progress() -> AbstractContextManager[None]:
    """Show no bars inside: in a worker, and within work that shows one already."""
    return _true_inside(_held)


def ends_as_a_whole() -> AbstractContextManager[None]:
    """Let Ctrl-C end the work inside with an exception, as it is part of a larger one."""
    return _true_inside(_part)


@contextmanager
def _true_inside(variable: ContextVar[bool]) -> Iterator[None]:
    token = variable.set(True)
    try:
        yield
    finally:
        variable.reset(token)


def progress(label: str, total: float) -> AbstractContextManager[Callable[[float], None]]:
    """Return a context with a function that takes how much of `total` is done."""
    # rich moves a bar of a notebook by ipywidgets
    moves = sys.stderr.isatty() or (in_notebook() and find_spec("ipywidgets") is not None)
    return nullcontext(lambda done: None) if _held.get() or not moves else _bar(label, total)


@contextmanager
def _bar(label: str, total: float) -> Iterator[Callable[[float], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.3g} / {task.total:.3g}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    bar, begin = Progress(*columns, console=Console(stderr=True), transient=True), time.monotonic()
    task = bar.add_task(label, total=total)

    def show(done: float) -> None:
        if not bar.live.is_started and time.monotonic() - begin > _SHOWN:  # a notebook keeps the place of any bar
            bar.start()
        bar.update(task, completed=done)

    with no_progress():
        try:
            yield show
        finally:
            if bar.live.is_started:
                bar.stop()


@contextmanager
def kept(found: Callable[[], Any]) -> Iterator[None]:
    """Attach the results so far as `solution` to any exception inside, KeyboardInterrupt included."""
    try:
        yield
    except BaseException as error:
        if getattr(error, "solution", None) is None and (solution := found()) is not None:
            error.solution = solution  # type: ignore[attr-defined]
            if not isinstance(error, ConvergenceError):
                error.add_note("What was found before is the `solution` of this exception.")
        raise


def returned_on_interrupt(solve: Callable[_Taken, _Found]) -> Callable[_Taken, _Found]:
    """Return a function that returns the results so far on Ctrl-C, with a warning, if it was long at work."""

    @wraps(solve)
    def called(*arguments: _Taken.args, **keywords: _Taken.kwargs) -> _Found:
        begin = time.monotonic()
        try:
            return solve(*arguments, **keywords)
        except KeyboardInterrupt as error:
            found = getattr(error, "solution", None)
            if found is None or _part.get() or time.monotonic() - begin < _WORTH:
                raise
        warn(
            f"Ctrl-C: the motion ends early, {found.statistics.ended}; press it again to end the program",
            LongRunWarning,
        )
        return found

    return called
