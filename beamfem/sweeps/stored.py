"""The stored calls of a sweep: which exist, by which code, and the new ones."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any

from beamfem.errors import ChangedCodeWarning, InputError, MissingPackageError, NotStoredWarning, warn
from beamfem.sweeps.keys import function_form, point_key
from beamfem.sweeps.sources import SCRIPT, Sources
from beamfem.sweeps.store import Store
from beamfem.sweeps.workers import Outcome

_NAMED = 5


class StoredCalls:
    """Outcomes of a function at points, on disk; a context manager.

    Raises InputError, before any file is created, for a function or parameters that the next run could not recognise.
    """

    def __init__(
        self, path: str | PathLike[str], function: Callable[..., Any], points: Sequence[Mapping[str, Any]]
    ) -> None:
        form, sources = function_form(function), Sources()
        self._keys = [point_key(form, point) for point in points]
        self._code = [sources.behind(function, point) for point in points]
        self._about = {"function": getattr(function, "__qualname__", str(function))}
        self._store = Store(path)
        self._writable = True

    def __enter__(self) -> "StoredCalls":
        self._store.__enter__()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: TracebackType | None) -> None:
        self._store.__exit__(kind, error, trace)

    def found(self, keep_stale: bool) -> list[Outcome | None]:
        """Return the outcome of each point, None if there is none; results of other code only with keep_stale."""
        outcomes = [self._store.find(key, code) for key, code in zip(self._keys, self._code, strict=True)]
        stale, changed = 0, set()
        for i, outcome in enumerate(outcomes):
            other = None if outcome else self._store.find_other(self._keys[i], self._code[i])
            if other is not None:
                stale += 1
                changed |= other[1]
                outcomes[i] = other[0] if keep_stale else None
        if stale:
            warn(_said(stale, len(outcomes), changed, keep_stale), ChangedCodeWarning)
        return outcomes

    def add(self, number: int, parameters: str, outcome: Outcome) -> None:
        """Store the outcome of a point; parameters: as text, for people who read the file."""
        if not self._writable:
            return
        about = self._about | {"parameters": parameters}
        try:
            self._store.add(self._keys[number], self._code[number], about, outcome)
        except (InputError, MissingPackageError) as error:  # of the model of a solution
            warn(f"not kept in the store {self._store.path}: {error}", NotStoredWarning)
        except OSError as error:
            # no more lines: one that was written in part would spoil the next one
            self._writable = False
            warn(
                f"the store {self._store.path} cannot be written any more ({error.strerror or error}): the sweep goes "
                "on, and what it computes from here on is in its result only",
                NotStoredWarning,
            )


def _said(stale: int, points: int, changed: set[str], keep: bool) -> str:
    names = [_title(name) for name in sorted(changed)]
    shown = ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")
    done = "the old results are kept" if keep else "they are computed again; keep_stale=True keeps the old results"
    return f"{stale} of {points} points in the store were computed before {shown} changed: {done}"


def _title(module: str) -> str:
    import __main__

    if module != SCRIPT:
        return module
    return Path(__main__.__file__).name if getattr(__main__, "__file__", None) else "the code in this notebook"
