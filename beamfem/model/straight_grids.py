"""The grids of all beams of a model; straight beams with equal divisions are meshed together."""

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beamfem.curves import Line
from beamfem.element.fields import Field
from beamfem.model.beam import Beam
from beamfem.model.beam_grid import Grid, make_grid


def make_grids(beams: Sequence[Beam], fractions: Sequence[Sequence[float]]) -> list[Grid]:
    """Return the grid of each beam with a node at each of its fractions and at each corner of its curve."""
    alike: defaultdict[tuple[int, Field], list[int]] = defaultdict(list)
    grids: dict[int, Grid] = {}
    for number, (beam, beam_fractions) in enumerate(zip(beams, fractions, strict=True)):
        if type(beam.curve) is Line and isinstance(beam.elements, int) and not beam_fractions:
            alike[beam.elements, beam.element.field].append(number)
        else:
            grids[number] = make_grid(beam, beam_fractions)
    for (elements, field), numbers in alike.items():
        grids.update(zip(numbers, _straight_grids([beams[i] for i in numbers], elements, field), strict=True))
    return [grids[number] for number in range(len(beams))]


def _straight_grids(beams: Sequence[Beam], elements: int, field: Field) -> list[Grid]:
    """Return the grids of straight beams with the same number of equal elements of one field."""
    lines = [beam.curve for beam in beams if isinstance(beam.curve, Line)]
    nodes = np.asarray(field.nodes, dtype=float)  # a user's field may return any sequence
    division = _divided(lines, elements, nodes)
    parts = zip(beams, division.vertices, division.arc, division.position, division.tangent, strict=True)
    return [
        Grid(beam, ends, ends, 1.0, division.node, arc, position, tangent, division.speed)
        for beam, ends, arc, position, tangent in parts
    ]


class _Divided(NamedTuple):
    """Straight lines (n,) divided into equal elements: see `Grid`."""

    vertices: np.ndarray
    node: np.ndarray
    arc: np.ndarray
    position: np.ndarray
    tangent: np.ndarray
    speed: np.ndarray


def _divided(lines: Sequence[Line], elements: int, nodes: np.ndarray) -> _Divided:
    """Return straight lines divided into equal elements with nodes (nn,) at these xi in [0, 1]."""
    length = np.array([line.length for line in lines])[:, None]
    start, end = np.array([line.start for line in lines])[:, None], np.array([line.end for line in lines])[:, None]
    last = len(nodes) - 1
    node = last * np.arange(elements)[:, None] + np.arange(last + 1)
    vertices = np.linspace(0.0, 1.0, elements + 1) * length
    arc = np.empty((len(lines), elements * last + 1))
    sizes = vertices[:, 1:] - vertices[:, :-1]
    arc[:, :-1] = (vertices[:, :-1, None] + sizes[:, :, None] * nodes[:-1]).reshape(len(lines), -1)
    arc[:, -1] = vertices[:, -1]
    fraction = (arc / length)[:, :, None]
    position, tangent = (1.0 - fraction) * start + fraction * end, np.empty((*arc.shape, 2))
    tangent[:] = (end - start) / length[:, :, None]
    return _Divided(vertices, node, arc, position, tangent, np.ones(arc.shape[1]))
