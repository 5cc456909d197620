"""Output of commands: results on stdout as text or JSON, errors without a traceback, an exit code."""

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Annotated, Any

import typer

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130

AsJson = Annotated[bool, typer.Option("--json", help="Print the result, or an error, as JSON on stdout.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]


@contextmanager
def reported(as_json: bool, quiet: bool = False) -> Iterator[None]:
    """Turn the errors of the library into a message and an exit code; quiet: show no progress either."""
    from contextlib import nullcontext

    from beamfem.errors import BeamfemError, ConvergenceError
    from beamfem.progress import no_progress

    try:
        with no_progress() if quiet else nullcontext():
            yield
    except BrokenPipeError:  # the reader has closed the pipe; typer ends the process quietly
        raise
    except ConvergenceError as error:
        _fail(error, FAILED, as_json)
    except KeyboardInterrupt as error:
        _fail(error, INTERRUPTED, as_json)
    except (BeamfemError, OSError) as error:
        _fail(error, BAD_INPUT, as_json)


def _fail(error: BaseException, code: int, as_json: bool) -> None:
    notes = list(getattr(error, "__notes__", ()))
    message = "interrupted" if isinstance(error, KeyboardInterrupt) else str(error)
    if as_json:
        details = {name: getattr(error, name) for name in ("message", "file", "line", "key") if hasattr(error, name)}
        fields = {"type": type(error).__name__, "message": message} | details
        print_json({"error": fields | ({"notes": notes} if notes else {}), "exit_code": code})
    else:
        print("\n".join([f"error: {message}", *notes]), file=sys.stderr)
    raise typer.Exit(code) from None


def print_json(value: Any) -> None:
    """Print a value as one JSON document; numbers that are not finite become null."""
    from beamfem.cli.plain import plain

    print(json.dumps(plain(value), indent=2, allow_nan=False))


def print_table(title: str, rows: Sequence[Mapping[str, Any]], units: Mapping[str, str] | None = None) -> None:
    """Print rows with the same keys as a table; lists in them become several lines, side by side.

    units: of columns, by name.
    """
    lines = [line for row in rows for line in _lines(row)]
    if not lines:
        return
    from beamfem.tabulate import as_text

    print(f"\n{title}" if title else "")
    heads = [f"{name} [{units[name]}]" if units and name in units else name for name in lines[0]]
    print(as_text(heads, [[_text(value) for value in line.values()] for line in lines]))


def _lines(row: Mapping[str, Any]) -> list[dict[str, Any]]:
    lists = {name: value for name, value in row.items() if isinstance(value, list)}
    if not lists:
        return [dict(row)]
    longest = max(len(value) for value in lists.values())
    return [{name: value[i] if name in lists else value for name, value in row.items()} for i in range(longest)]


def _text(value: Any) -> str:
    return f"{value:.8g}" if isinstance(value, float) else str(value)
