"""Results of a sweep on disk: a file of JSON lines, one per result, which stays readable if the process is killed.

A row identifies the code that computed it by a digest; another line lists, once, the modules of that code and the
global variables that it uses. Whole solutions are separate files in a folder beside it, named after their row.
"""

import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from errno import ENOSPC
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

import __main__
from beamfem.atomic_write import path_of
from beamfem.errors import ChangedCodeWarning, FileError, InputError, MissingPackageError, NotStoredWarning, warn
from beamfem.io.results_hdf5 import load
from beamfem.results.solution import Solution
from beamfem.sweeps.keys import code_digests, global_digests, point_key
from beamfem.sweeps.workers import Outcome

_NAMED = 5  # modules in a warning


class ResultCache:
    """Results of a function at points, by the present code; a context manager that keeps the file open for appending.

    path: a file, or a folder (no suffix), which receives a `results.jsonl`; folders are created. Raises InputError,
    before any file is created, for a function or parameters that the next run could not recognise.
    """

    def __init__(
        self, path: str | PathLike[str], function: Callable[..., Any], points: Sequence[Mapping[str, Any]]
    ) -> None:
        self._keys = [point_key(function, point) for point in points]
        self._modules = {**code_digests(), **global_digests(function)}
        self._code = hashlib.sha256(json.dumps(sorted(self._modules.items())).encode()).hexdigest()[:24]
        self._function = getattr(function, "__qualname__", str(function))
        given = path_of(path)
        self.path = given / "results.jsonl" if given.is_dir() or not given.suffix else given
        self._known: dict[str, dict[str, tuple[Any, float]]] = {}
        self._modules_of: dict[str, Mapping[str, str]] = {}
        self._writable = True

    def __enter__(self) -> "ResultCache":
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            # unbuffered: each line reaches the system in one write and survives this process
            self._file = self.path.open("ab+", buffering=0)
        except OSError as error:
            raise FileError(f"the store {self.path} cannot be written: {error.strerror}") from error
        self._file.seek(0)
        data = self._file.readall()
        if data and not data.endswith(b"\n"):
            self._file.write(b"\n")  # the writer was killed within its last line
        for line in data.splitlines():
            try:
                record = json.loads(line)
                if "sources" in record:
                    self._modules_of[record["code"]] = record["sources"]
                else:
                    rows = self._known.setdefault(record["key"], {})
                    found = record["value"], record["seconds"]
                    rows.pop(record["code"], None)  # the last one written stands last
                    rows[record["code"]] = found
            except (ValueError, KeyError, TypeError):
                continue
        return self

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: TracebackType | None) -> None:
        self._file.close()

    def found(self, keep_stale: bool) -> list[Outcome | None]:
        """Return the outcome of each point, None if there is none; results of other code only with keep_stale."""
        outcomes = [self._outcome(key, self._code) for key in self._keys]
        stale, changed = 0, set[str]()
        for i, key in enumerate(self._keys):
            if outcomes[i] is None and (other := self._of_other_code(key)) is not None:
                stale += 1
                changed |= other[1]
                outcomes[i] = other[0] if keep_stale else None
        if stale:
            warn(_message(stale, len(outcomes), changed, keep_stale), ChangedCodeWarning)
        return outcomes

    def _of_other_code(self, key: str) -> tuple[Outcome, set[str]] | None:
        """Return the last outcome stored under a key by other code, and the modules and variables that differ."""
        for code in reversed(self._known.get(key, {})):
            outcome, then = self._outcome(key, code), self._modules_of.get(code, {})
            if outcome is not None:
                changed = {n for n in {*then, *self._modules} if then.get(n) != self._modules.get(n)}
                return outcome, {n for n in changed if n.partition(" of ")[2] not in changed}
        return None

    def add(self, number: int, parameters: str, outcome: Outcome) -> None:
        """Store the outcome of a point; parameters: as text, for people who read the file.

        Warns where that is not possible.
        """
        if not self._writable:
            return
        try:
            self._add(number, parameters, outcome)
        except (InputError, MissingPackageError) as error:  # of the model of a solution
            warn(f"not kept in the store {self.path}: {error}", NotStoredWarning)
        except OSError as error:
            # no more lines: one that was written in part would spoil the next one
            self._writable = False
            warn(
                f"the store {self.path} cannot be written any more ({error.strerror or error}): the sweep goes on, and "
                "what it computes from here on is in its result only",
                NotStoredWarning,
            )

    def _add(self, number: int, parameters: str, outcome: Outcome) -> None:
        key, code = self._keys[number], self._code
        if code not in self._modules_of:
            self._modules_of[code] = self._modules
            self._write({"code": code, "sources": self._modules})
        about = {"function": self._function, "parameters": parameters}
        value = self._encode(outcome.value, f"{key}-{code}")
        self._write({"key": key, "code": code, **about, "value": value, "seconds": outcome.seconds})

    def _write(self, record: Mapping[str, Any]) -> None:
        line = json.dumps(record).encode() + b"\n"
        written = self._file.write(line)
        if written != len(line):
            raise OSError(ENOSPC, os.strerror(ENOSPC))

    def _outcome(self, key: str, code: str) -> Outcome | None:
        if code not in self._known.get(key, {}):
            return None
        value, seconds = self._known[key][code]
        try:
            return Outcome(self._decode(value), seconds)
        except (FileError, InputError):  # the file of a solution is gone or damaged
            return None

    def _encode(self, value: Any, row: str) -> Any:
        """Return a mapping unchanged and a single value as a list of one, so that the two cannot be confused."""
        if isinstance(value, dict):
            return {name: self._item(item, f"{row}-{number}") for number, (name, item) in enumerate(value.items())}
        return [self._item(value, row)]

    def _item(self, value: Any, name: str) -> Any:
        if isinstance(value, np.ndarray):
            return {"dtype": value.dtype.str, "shape": value.shape, "data": value.ravel().tolist()}
        if isinstance(value, Solution):
            value.save(self._solutions / f"{name}.h5")
            return {"solution": name}
        return value

    def _decode(self, value: Any) -> Any:
        if isinstance(value, dict):
            return {name: self._value(item) for name, item in value.items()}
        return self._value(value[0])

    def _value(self, item: Any) -> Any:
        if not isinstance(item, dict):
            return item
        if "solution" in item:
            return load(self._solutions / f"{item['solution']}.h5")
        return np.array(item["data"], dtype=item["dtype"]).reshape(item["shape"])

    @property
    def _solutions(self) -> Path:
        """The folder of whole solutions."""
        return self.path.with_suffix("")


def _message(stale: int, points: int, changed: set[str], keep: bool) -> str:
    script = Path(getattr(__main__, "__file__", None) or "__main__").name
    names = sorted(script if name == "__main__" else name for name in changed)
    shown = ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")
    done = "the old results are kept" if keep else "they are computed again; keep_stale=True keeps the old results"
    return f"{stale} of {points} points in the store were computed before {shown} changed: {done}"
