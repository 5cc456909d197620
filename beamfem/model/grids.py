"""The grids of all beams of a model; straight beams with equal divisions are meshed at once."""

from collections import defaultdict
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from beamfem.curves import Line
from beamfem.element.fields import Field
from beamfem.model.beam import Beam
from beamfem.model.grid import Grid, make_grid


def make_grids(beams: Sequence[Beam], fractions: Sequence[Sequence[float]]) -> list[Grid]:
    """Return the grid of each beam with a node at each of its fractions and at each corner of its curve."""
    alike: defaultdict[tuple[int, Field], list[int]] = defaultdict(list)
    grids: dict[int, Grid] = {}
    for number, (beam, own) in enumerate(zip(beams, fractions, strict=True)):
        if isinstance(beam.curve, Line) and isinstance(beam.elements, int) and _at_ends(own, beam.elements):
            alike[beam.elements, beam.element.field].append(number)
        else:
            grids[number] = make_grid(beam, own)
    for (elements, field), numbers in alike.items():
        grids.update(zip(numbers, _straight_grids([beams[i] for i in numbers], elements, field), strict=True))
    return [grids[number] for number in range(len(beams))]


def _at_ends(fractions: Sequence[float], elements: int) -> bool:
    """Return whether ends of equal elements coincide with each of the fractions."""
    return all((fraction * elements).is_integer() for fraction in fractions)


def _straight_grids(beams: Sequence[Beam], elements: int, field: Field) -> list[Grid]:
    """Return the grids of straight beams with the same number of equal elements of one field."""
    curves = [beam.curve for beam in beams]
    length = np.array([curve.length for curve in curves])[:, None]
    start, end = (np.array([getattr(curve, name) for curve in curves])[:, None] for name in ("start", "end"))
    last = len(field.nodes) - 1
    fractions, node = _divided(elements, last)
    vertices = fractions * length
    arc = np.empty((len(beams), elements * last + 1))
    sizes = vertices[:, 1:] - vertices[:, :-1]
    arc[:, :-1] = (vertices[:, :-1, None] + sizes[:, :, None] * field.nodes[:-1]).reshape(len(beams), -1)
    arc[:, -1] = vertices[:, -1]
    fraction = (arc / length)[:, :, None]
    position, tangent = (1.0 - fraction) * start + fraction * end, np.empty((*arc.shape, 2))
    tangent[:] = (end - start) / length[:, :, None]
    speed = np.ones(arc.shape[1])
    parts = zip(beams, vertices, arc, position, tangent, strict=True)
    return [Grid(beam, ends, ends, 1.0, node, own, at, along, speed) for beam, ends, own, at, along in parts]


@lru_cache(maxsize=16)
def _divided(elements: int, last: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of equal elements as fractions (elements + 1,), and their nodes (elements, last + 1)."""
    found = np.linspace(0.0, 1.0, elements + 1), last * np.arange(elements)[:, None] + np.arange(last + 1)
    for values in found:
        values.setflags(write=False)
    return found
