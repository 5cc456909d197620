"""Results so far are kept if a solve ends with an exception."""

from collections.abc import Callable

from beamfem.errors import ConvergenceError
from beamfem.results.solution import Solution


class kept:
    """A context that attaches the results so far as `solution` to any exception inside, KeyboardInterrupt included."""

    def __init__(self, found: Callable[[], Solution | None]) -> None:
        self._found = found

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, traceback: object) -> None:
        if error is None or getattr(error, "solution", None) is not None:
            return
        if (solution := self._found()) is not None:
            error.solution = solution  # type: ignore[attr-defined]
            if not isinstance(error, ConvergenceError):
                error.add_note("What was found before is the `solution` of this exception.")
