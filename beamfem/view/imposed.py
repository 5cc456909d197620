"""Actuation and heat in a drawing: named beside the middle of their beams."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.model.shapes import Strains
from beamfem.view.frames import one_row

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_APART = 12.0  # of the words from the axis [points of print]
_BENT = 0.02  # of the length: a beam that is bent has its words on its outer side
_SLOPED = 0.3  # of a unit normal


def draw_imposed(axes: Any, solution: "Solution", items: list[tuple[Strains, int]], colour: str) -> Any:
    """Write what loads impose in a row of a solution; yield what was drawn."""
    beside: dict[int, int] = {}
    for strains, row in items:
        only, beam = one_row(solution, row), strains.beam
        at, along = only.position(beam.at(0.5))[0], only.fields(beam.at(0.5)).r_x[0]
        chord = only.position(beam.at(0.25))[0] + only.position(beam.at(0.75))[0] - 2.0 * at
        outward = np.array([-along[1], along[0]]) / np.linalg.norm(along)
        if chord @ outward > _BENT * beam.curve.length:
            outward = -outward
        lines = beside[id(beam)] = beside.get(id(beam), 0) + 1
        yield axes.annotate(
            _words(strains, solution.model.unit),
            at,
            lines * _APART * outward,
            textcoords="offset points",
            color=colour,
            fontsize=8.0,
            ha="left" if outward[0] > _SLOPED else "right" if outward[0] < -_SLOPED else "center",
            va="center",
            zorder=5.0,
        )


def _words(strains: Strains, named: Callable[[str], str]) -> str:
    parts = [
        f"{name} varies" if value is None else f"{name} {value:.4g} {named(unit)}".rstrip()
        for name, (value, unit) in strains.values.items()
    ]
    return f"{strains.name}: {', '.join(parts)}"
