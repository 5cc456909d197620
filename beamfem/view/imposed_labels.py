"""Actuation and temperature in a drawing: text beside the middle of their beams."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.model.load_shapes import Strains
from beamfem.view.frames import one_row

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_APART = 12.0  # of the words from the axis [points of print]
_BENT = 0.02  # of the length: a beam that is bent has its words on its outer side
_MARGIN = 4.0  # between words and the edge of the axes [points of print]
_SLOPED = 0.3  # of a unit normal


def draw_imposed(axes: Any, solution: "Solution", items: list[tuple[Strains, int]], colour: str) -> Any:
    """Draw the strains imposed by loads in a row of a solution as text; yield the artists."""
    beside: dict[int, int] = {}
    for strains, row in items:
        only, beam = one_row(solution, row), strains.beam
        at, along = only.position(beam.at(0.5))[0], only.fields(beam.at(0.5)).r_x[0]
        chord = only.position(beam.at(0.25))[0] + only.position(beam.at(0.75))[0] - 2.0 * at
        outward = np.array([-along[1], along[0]]) / np.linalg.norm(along)
        if chord @ outward > _BENT * beam.curve.length:
            outward = -outward
        # words beside an upright beam take a line each, so that they stay narrow
        sideways = abs(outward[0]) > _SLOPED
        words, before = _words(strains, solution.model.unit), beside.get(id(beam), 0)
        lines = len(words) if sideways else 1
        beside[id(beam)] = before + lines
        offset = _APART * outward - [0.0, before * _APART] if sideways else (before + 1) * _APART * outward
        note = axes.annotate(
            ("\n" if sideways else " ").join(words),
            at,
            offset,
            textcoords="offset points",
            color=colour,
            fontsize=8.0,
            ha="left" if outward[0] > _SLOPED else "right" if outward[0] < -_SLOPED else "center",
            va="top" if sideways else "center",
            zorder=5.0,
        )
        _move_inside(note, axes)
        yield note


def _move_inside(words: Any, axes: Any) -> None:
    """Move text sideways into the axes, or to their left edge if it is wider."""
    extent, room = words.get_window_extent(), axes.get_window_extent()
    points = 72.0 / axes.figure.dpi
    x, y = words.get_position()
    beyond = max(min(0.0, room.x1 - _MARGIN / points - extent.x1), room.x0 + _MARGIN / points - extent.x0)
    if beyond < 0.0 or extent.x0 < room.x0 + _MARGIN / points:
        words.set_position((x + beyond * points, y))


def _words(strains: Strains, named: Callable[[str], str]) -> list[str]:
    parts = [
        f"{name} varies" if value is None else f"{name} {value:.4g} {named(unit)}".rstrip()
        for name, (value, unit) in strains.values.items()
    ]
    return [f"{strains.name}:", *(f"{part}," for part in parts[:-1]), *parts[-1:]]
