"""Results so far are kept if a solve ends with an exception."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from beamfem.errors import ConvergenceError
from beamfem.results.solution import Solution


@contextmanager
def kept(found: Callable[[], Solution | None]) -> Iterator[None]:
    """Attach the results so far as `solution` to any exception inside, KeyboardInterrupt included."""
    try:
        yield
    except BaseException as error:
        if getattr(error, "solution", None) is None and (solution := found()) is not None:
            error.solution = solution  # type: ignore[attr-defined]
            if not isinstance(error, ConvergenceError):
                error.add_note("What was found before is the `solution` of this exception.")
        raise
