"""Files whose end cannot be missed: some readers of meshio keep asking for the next line there."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_OFTEN = 100  # no reader that stops asks as often behind the end
# by the format's name in meshio, with the mode that its reader opens a file in
_OVERREAD = {"mdpa": "rb", "nastran": "r", "ply": "rb", "tecplot": "r"}


class _Lines:
    """Raises EOFError if lines beyond the end are requested repeatedly."""

    _behind = 0

    def readline(self, size: int = -1, /):  # type: ignore[no-untyped-def]  # text or bytes
        line = super().readline(size)  # type: ignore[misc]
        if not line and size != 0:
            self._behind += 1
            if self._behind > _OFTEN:
                raise EOFError("the file ends early")
        return line


class _Text(_Lines, io.TextIOWrapper):  # type: ignore[misc]
    pass


class _Bytes(_Lines, io.BufferedReader):  # type: ignore[misc]
    pass


@contextmanager
def opened(path: Path, kind: str) -> Iterator[io.IOBase | Path]:
    """Yield the input for meshio to read a file of this format: a file object that raises EOFError, or the path."""
    if kind not in _OVERREAD:
        yield path
        return
    with path.open("rb", buffering=0) as raw:
        yield _Bytes(raw) if _OVERREAD[kind] == "rb" else _Text(io.BufferedReader(raw))
