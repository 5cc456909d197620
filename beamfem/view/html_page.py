"""A page that shows figures with a sentence each; one file, readable offline."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from os import PathLike
from pathlib import Path

from beamfem.atomic_write import path_of, whole
from beamfem.view.notebook_paths import WrittenFile

_WORD = " class='word'"
_LONG = 24  # rows of a table above which it is folded


@dataclass(frozen=True)
class Entry:
    """A figure with a title, the claim of a paper about it (or ""), the finding here, and whether the claim holds."""

    title: str
    picture: Path
    claim: str
    found: str
    holds: bool | None = None


@dataclass(frozen=True)
class Table:
    """A table with a title, a header and rows of text."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    remark: str = ""


@dataclass(frozen=True)
class Part:
    """A part of a page: a heading, a text, figures and tables."""

    heading: str
    text: str
    entries: Sequence[Entry] = ()
    tables: Sequence[Table] = ()


def write_page(path: str | PathLike[str], title: str, parts: Sequence[Part]) -> Path:
    """Write one self-contained HTML file with the SVG figures inside, and a table of contents; return its path."""
    target = path_of(path)
    links = [f"<li><a href='#part{number}'>{escape(part.heading)}</a></li>" for number, part in enumerate(parts)]
    contents = f"<nav><ul>{''.join(links)}</ul></nav>" if len(parts) > 1 else ""
    body = contents + "".join(
        f"<h2 id='part{number}'>{escape(part.heading)}</h2><p>{escape(part.text)}</p>"
        f"{''.join(map(_entry, part.entries))}{''.join(map(_table, part.tables))}"
        for number, part in enumerate(parts)
    )
    template = files("beamfem.view").joinpath("page.html").read_text(encoding="utf-8")
    with whole(target) as partial:
        partial.write_text(template.replace("@TITLE@", escape(title)).replace("@BODY@", body), encoding="utf-8")
    return WrittenFile(target)


def _entry(entry: Entry) -> str:
    data = base64.b64encode(entry.picture.read_bytes()).decode()
    kind = "svg+xml" if entry.picture.suffix == ".svg" else entry.picture.suffix[1:]
    verdict = {None: "", True: "<p class='yes'>The claim holds.</p>", False: "<p class='no'>We find otherwise.</p>"}
    prefix = f"<p>Paper: {escape(entry.claim)}</p><p>Here: " if entry.claim else "<p>"
    words = f"<b>{escape(entry.title)}</b>{prefix}{escape(entry.found)}</p>"
    picture = f'<img alt="{escape(entry.title)}" src="data:image/{kind};base64,{data}">'
    return f"<figure>{picture}<figcaption>{words}{verdict[entry.holds]}</figcaption></figure>"


def _table(table: Table) -> str:
    head = "".join(f"<th>{escape(cell)}</th>" for cell in table.header)
    # a browser would break 1.5e-02 and ANCF-CRBF after the sign
    cells = [[f"<td{'' if ' ' in text else _WORD}>{escape(text)}</td>" for text in row] for row in table.rows]
    rows = "".join(f"<tr>{''.join(row)}</tr>" for row in cells)
    body = f"<div class='wide'><table><tr>{head}</tr>{rows}</table></div>"
    if len(cells) > _LONG:
        body = f"<details><summary>{len(cells)} rows</summary>{body}</details>"
    return f"<h3>{escape(table.title)}</h3>{body}<p>{escape(table.remark)}</p>"
