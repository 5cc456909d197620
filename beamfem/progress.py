"""Long work: a bar on a terminal or in a notebook, silence in a pipe, and the results so far if it ends early."""

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from importlib.util import find_spec
from typing import Any

from beamfem.errors import ConvergenceError

_held: ContextVar[bool] = ContextVar("_held", default=False)


def in_notebook() -> bool:
    """Return whether this runs in the kernel of a notebook, which shows below a cell what is written to stderr."""
    return type(sys.stderr).__module__ == "ipykernel.iostream"


@contextmanager
def no_progress() -> Iterator[None]:
    """Show no bars inside: in a worker, and within work that shows one already."""
    token = _held.set(True)
    try:
        yield
    finally:
        _held.reset(token)


def progress(label: str, total: float) -> AbstractContextManager[Callable[[float], None]]:
    """Return a context with a function that takes how much of `total` is done."""
    # rich moves a bar of a notebook by ipywidgets
    moves = sys.stderr.isatty() or (in_notebook() and find_spec("ipywidgets") is not None)
    return _SILENCE if _held.get() or not moves else _bar(label, total)


def _silent(done: float) -> None:
    """Show nothing."""


_SILENCE = nullcontext(_silent)


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
    with no_progress(), Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=total)
        yield lambda done: bar.update(task, completed=done)


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
