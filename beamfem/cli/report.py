"""Output of commands: results on stdout as text or JSON, errors without a traceback, an exit code."""

import json
import math
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from beamfem.errors import BeamfemError, ConvergenceError, InputError
from beamfem.extras import require_package
from beamfem.progress import no_progress
from beamfem.tables import as_text

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
DRAWN = (".png", ".svg", ".pdf", ".html", ".gif", ".mp4")  # what `draw` writes

AsJson = Annotated[bool, typer.Option("--json", help="Print the result, or an error, as JSON on stdout.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]
Colour = Annotated[
    str | None, typer.Option("--colour", "--color", help="Colour of the body: moment, stress, utilisation, speed ...")
]
_PACKAGES = {".h5": "h5py", ".hdf5": "h5py", ".pvd": "vtkmodules", ".vtkhdf": "vtkmodules", ".mp4": "imageio_ffmpeg"}


@contextmanager
def reported(as_json: bool, quiet: bool = False) -> Iterator[Callable[[Any, str | Callable[[], None]], None]]:
    """Return what prints a result, as JSON or as a text; errors of the library become a message and an exit code."""

    def show(result: Any, text: str | Callable[[], None]) -> None:
        if as_json:
            print_json(result)
        elif not quiet:
            print(text) if isinstance(text, str) else text()

    try:
        with no_progress() if quiet else nullcontext():
            yield show
    except BrokenPipeError:  # the reader has closed the pipe; typer ends the process quietly
        raise
    except (BeamfemError, OSError, KeyboardInterrupt) as error:
        stopped, failed = isinstance(error, KeyboardInterrupt), isinstance(error, ConvergenceError)
        code = INTERRUPTED if stopped else FAILED if failed else BAD_INPUT
        message = "interrupted" if stopped else str(error)
        if as_json:
            names = ("message", "remedy", "file", "line", "key", "__notes__")
            details = {name.strip("_"): value for name in names if (value := getattr(error, name, None))}
            print_json({"error": {"type": type(error).__name__, "message": message, **details}, "exit_code": code})
        else:
            print("\n".join([f"error: {message}", *getattr(error, "__notes__", ())]), file=sys.stderr)
        raise typer.Exit(code) from None


def print_json(value: Any) -> None:
    """Print a value as one JSON document; numbers that are not finite become null."""
    print(json.dumps(plain(value), indent=2, allow_nan=False))


def plain(value: Any) -> Any:
    """Return a value as types of JSON; a solution as its summary, numbers that are not finite as None."""
    from beamfem.results.solution import Solution

    if isinstance(value, Solution):
        return summary(value)
    if isinstance(value, Enum):
        return value.name.lower().replace("_", " ")
    if isinstance(value, Mapping):
        return {", ".join(map(str, key if isinstance(key, tuple) else (key,))): plain(value[key]) for key in value}
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    return value if value is None or isinstance(value, bool | int) else str(value)


def summary(solution: "Solution") -> dict[str, Any]:
    """Return the number of states of a solution, its first and last time or load factor, and its statistics."""
    return {
        "kind": "static" if solution.static else "motion",
        "coordinates": solution.model.size,
        "states": len(solution),
        "load_factor" if solution.static else "time": [float(solution.at[0]), float(solution.at[-1])],
        "statistics": plain(solution.statistics),
    }


def print_table(title: str, rows: Sequence[Mapping[str, Any]], units: Mapping[str, str] | None = None) -> None:
    """Print rows with the same keys as a table; lists in them become several lines. units: of columns, by name."""
    lines = [
        [value[number] if isinstance(value, list) else value for value in row.values()]
        for row in rows
        for number in range(max(len(value) if isinstance(value, list) else 1 for value in row.values()))
    ]
    if lines:
        heads = [f"{name} [{units[name]}]" if units and name in units else name for name in rows[0]]
        print(f"\n{title}" if title else "")
        print(as_text(heads, [[f"{v:.8g}" if isinstance(v, float) else str(v) for v in line] for line in lines]))


def require_target(path: Path, suffixes: Sequence[str]) -> None:
    """Raise InputError for a file that cannot be written: wrong suffix, a folder, a missing package."""
    if (suffix := path.suffix.lower()) not in suffixes:
        right = f"{path.with_suffix(suffixes[0])} would be right" if path.name else ""
        raise InputError(f"{path} must end in {' or '.join(', '.join(suffixes).rsplit(', ', 1))}; {right}")
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the name of a file")
    if not writable(path.parent):
        raise InputError(f"{path} cannot be written: no files can be created in {path.parent}")
    if suffix != ".html":
        require_package(_PACKAGES.get(suffix, "matplotlib"), f"writing {path}")


def writable(folder: Path) -> bool:
    """Return whether a file can be created in a folder, or in its nearest existing parent."""
    while not folder.exists():
        folder = folder.parent
    try:
        with tempfile.NamedTemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def draw(solution: "Solution", path: Path, colour: str | None) -> None:
    """Write a picture, a page with a slider (.html) or a film (.gif, .mp4). Raises InputError."""
    film = solution.animate
    writers: dict[str, Callable[..., object]] = {".html": solution.to_html, ".gif": film, ".mp4": film}
    writers.get(path.suffix.lower(), solution.plot)(path, colour=colour)
