"""Tables as text on a terminal or in a pipe, as Markdown and as CSV."""

import csv
import sys
from collections.abc import Sequence
from html import escape
from io import StringIO
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.atomic_write import whole
from beamfem.extras import needed_for

if TYPE_CHECKING:
    from rich.box import Box
    from rich.table import Table

Rows = Sequence[Sequence[Any]]


_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # what a spreadsheet takes for the begin of a formula


def cell(value: Any) -> str:
    """Return six digits of a number, the shape of an array, nothing for None and nan."""
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return ""
    if isinstance(value, np.ndarray):
        return f"array {value.shape}"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def cells(rows: Rows) -> list[list[str]]:
    """Return the text of every value."""
    return [[cell(value) for value in row] for row in rows]


def as_text(header: Sequence[str], rows: Rows, title: str = "") -> str:
    """Return a table with frames and the width of the terminal, or plain and as wide as it needs to be in a pipe."""
    from rich import box  # slow to import
    from rich.text import Text

    terminal, unicode = sys.stdout.isatty(), (sys.stdout.encoding or "").lower().startswith("utf")
    table = _table(header, rows, box.ROUNDED if terminal else box.SIMPLE_HEAD if unicode else box.ASCII2)
    table.title, table.title_justify = Text(title) if title else None, "left"  # [m] is no markup
    return _printed(table, terminal)


def _printed(table: "Table", terminal: bool = False) -> str:
    """Return a table as text; a pipe has no width, so that nothing is cut there."""
    from rich.console import Console  # slow to import

    out = StringIO()
    Console(file=out, force_terminal=terminal, width=None if terminal else 10_000, legacy_windows=False).print(table)
    return "\n".join(line.rstrip() for line in out.getvalue().splitlines()).strip("\n")


def few(rows: Rows, most: int) -> list[list[Any]]:
    """Return the first and the last of many rows, "..." between them."""
    listed = [list(row) for row in rows]
    if len(listed) <= most:
        return listed
    last = (most - 1) // 2
    return [*listed[: most - 1 - last], ["..."] * len(listed[0]), *listed[-last:]]


def cut(text: str, size: int) -> str:
    """Return a text in one line of at most so many characters."""
    line = " ".join(text.split())
    return line if len(line) <= size else f"{line[: size - 3]}..."


def as_markdown(header: Sequence[str], rows: Rows) -> str:
    """Return a Markdown table."""
    from rich import box  # slow to import

    escaped = [[text.replace("|", "\\|") for text in line] for line in [list(header), *cells(rows)]]
    return _printed(_table(escaped[0], escaped[1:], box.MARKDOWN))


def as_html(header: Sequence[str], rows: Rows) -> str:
    """Return a table for a notebook; no header where it is empty."""
    style = "text-align: left; vertical-align: top"
    head = "".join(f"<th style='{style}'>{escape(name)}</th>" for name in header)
    lines = ("".join(f"<td style='{style}'>{escape(text)}</td>" for text in line) for line in cells(rows))
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f"<table>{f'<tr>{head}</tr>' if head else ''}{body}</table>"


def as_pandas(header: Sequence[str], rows: Rows) -> Any:
    """Return a pandas.DataFrame. Raises MissingPackageError without pandas."""
    with needed_for("to_pandas"):
        import pandas
    return pandas.DataFrame([list(row) for row in rows], columns=list(header))


def write_csv(path: str | PathLike[str], header: Sequence[str], rows: Rows) -> None:
    """Write every digit of the numbers; arrays as nested lists; folders are created."""
    with whole(path) as partial, partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([_cell(name) for name in header])
        writer.writerows([[_cell(value) for value in row] for row in rows])


def _cell(value: Any) -> Any:
    """Return what stands in a cell; text that spreadsheets would compute gets an apostrophe, which they do not show."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def _table(header: Sequence[str], rows: Rows, frame: "Box") -> "Table":
    from rich.box import SIMPLE_HEAD  # slow to import
    from rich.table import Table
    from rich.text import Text

    table = Table(box=frame, pad_edge=frame is not SIMPLE_HEAD)
    for column, title in enumerate(header):
        values = [row[column] for row in rows]
        words = any(isinstance(value, str) and value[:1].isalpha() for value in values)
        table.add_column(Text(title), justify="left" if words else "right", overflow="fold")
    for row in cells(rows):
        table.add_row(*[Text(text) for text in row])
    return table
