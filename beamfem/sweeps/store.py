"""Results of calls on disk: a file of JSON lines, one per result, which stays readable if the process is killed.

A row identifies the code that computed it by a digest; another line lists, once, the files of that code. Whole
solutions are separate files in a folder beside it, named after their row.
"""

import hashlib
import json
import os
from collections.abc import Mapping
from errno import ENOSPC
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from beamfem.errors import FileError, InputError
from beamfem.files import path_of
from beamfem.io.results import load
from beamfem.results.solution import Solution
from beamfem.sweeps.workers import Outcome


class Store:
    """Results by key; a context manager that keeps the file open for appending.

    path: a file, or a folder (no suffix), which receives a `results.jsonl`; folders are created.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        given = path_of(path)
        self.path = given / "results.jsonl" if given.is_dir() or not given.suffix else given
        self._known: dict[str, dict[str, tuple[Any, float]]] = {}
        self._sources: dict[str, Mapping[str, str]] = {}

    def __enter__(self) -> "Store":
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
                    self._sources[record["code"]] = record["sources"]
                else:
                    self._keep(record["key"], record["code"], record["value"], record["seconds"])
            except (ValueError, KeyError, TypeError):
                continue
        return self

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: TracebackType | None) -> None:
        self._file.close()

    def find(self, key: str, sources: Mapping[str, str]) -> Outcome | None:
        """Return the outcome stored under a key by the present code."""
        return self._outcome(key, _digest(sources))

    def find_other(self, key: str, sources: Mapping[str, str]) -> tuple[Outcome, set[str]] | None:
        """Return the last outcome stored under a key by other code, and the modules in which the two differ."""
        for code in reversed(self._known.get(key, {})):
            outcome, then = self._outcome(key, code), self._sources.get(code, {})
            if outcome is not None and code != _digest(sources):
                return outcome, {name for name in {*then, *sources} if then.get(name) != sources.get(name)}
        return None

    def add(self, key: str, sources: Mapping[str, str], about: Mapping[str, str], outcome: Outcome) -> None:
        """Write the outcome of a call; about: text for people who read the file."""
        code = _digest(sources)
        if code not in self._sources:
            self._sources[code] = dict(sources)
            self._write({"code": code, "sources": self._sources[code]})
        value = self._encode(outcome.value, f"{key}-{code}")
        self._write({"key": key, "code": code, **about, "value": value, "seconds": outcome.seconds})

    def _write(self, record: Mapping[str, Any]) -> None:
        line = json.dumps(record).encode() + b"\n"
        written = self._file.write(line)
        if written != len(line):
            raise OSError(ENOSPC, os.strerror(ENOSPC))

    def _keep(self, key: str, code: str, value: Any, seconds: float) -> None:
        rows = self._known.setdefault(key, {})
        rows.pop(code, None)  # the last one written stands last
        rows[code] = value, seconds

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


def _digest(sources: Mapping[str, str]) -> str:
    return hashlib.sha256(json.dumps(sorted(sources.items())).encode()).hexdigest()[:24]
