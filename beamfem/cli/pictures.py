"""Drawings of commands: pictures, pages and films, distinguished by the suffix of the file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

FILMS, PAGE = (".gif", ".mp4"), ".html"

Colour = Annotated[
    str | None,
    typer.Option(
        "--colour", "--color", help="Colour of the body: moment, stress, utilisation, speed ...", show_default=False
    ),
]


def draw(solution: "Solution", target: Path, colour: str | None = None) -> None:
    """Write a picture (.png, .svg, .pdf), a page with a slider (.html) or a film (.gif, .mp4). Raises InputError."""
    from beamfem.errors import InputError

    kind = target.suffix.lower()
    options: dict[str, Any] = {} if colour is None else {"colour": colour}
    if kind == PAGE:
        if options:
            raise InputError("a page has its own choice of colours; --colour is for pictures and films")
        solution.to_html(target)
    elif kind in FILMS:
        solution.animate(target, **options)
    else:
        solution.plot(target, **options)
