"""Points of many beams, evaluated on all beams of a kind at once."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.mesh.beam_mesh import BeamMesh, join
from beamfem.model.model import Model
from beamfem.results.axis_points import AxisPoints
from beamfem.results.solution import Solution

VALUES = 500_000  # most points times rows that are evaluated at once
_KEPT = 1_000_000  # most coordinates in all rows of a solution whose values are kept
_Item = TypeVar("_Item")
Values = Callable[[Solution, BeamMesh], np.ndarray]


@dataclass(frozen=True, eq=False)
class LikeBeams:
    """Points of beams that are alike; numbers: those of the beams in the model; single: the points of each beam."""

    numbers: list[int]
    single: list[AxisPoints]

    @cached_property
    def points(self) -> AxisPoints:
        """The points of all beams, those of one after those of another."""
        if len(self.single) == 1:
            return self.single[0]
        return AxisPoints.spaced(join([points.mesh for points in self.single]), self.single[0].pieces)

    @cached_property
    def counts(self) -> list[int]:
        """Number of points of each beam."""
        return [(points.pieces + 1) * points.mesh.elements for points in self.single]

    def parted(self, values: np.ndarray, over: int) -> list[np.ndarray]:
        """Return values at all points, whose axis is number `over`, as those of each beam."""
        if len(self.single) == 1:
            return [values]
        return np.split(values, np.cumsum(self.counts)[:-1], axis=over)


def equal_beams(model: Model, points: Sequence[AxisPoints], rows: int) -> list[LikeBeams]:
    """Return the points of all beams of a model by groups of like beams, as large as the number of rows allows."""
    result = []
    for numbers in model.numbered.joinable:
        by_pieces = defaultdict[int, list[int]](list)
        for number in numbers:
            by_pieces[points[number].pieces].append(number)
        for pieces, own in by_pieces.items():
            sizes = [(pieces + 1) * points[number].mesh.elements for number in own]
            result += [
                LikeBeams(part, [points[number] for number in part])
                for part in _parts(own, sizes, VALUES // max(rows, 1))
            ]
    return result


def of_each(groups: Iterable[LikeBeams], values: Callable[[AxisPoints], np.ndarray], over: int = 1) -> list[np.ndarray]:
    """Return a function of points as values of each beam, in the order of the beams; over: axis of the points."""
    result: dict[int, np.ndarray] = {}
    for group in groups:
        result.update(zip(group.numbers, group.parted(values(group.points), over), strict=True))
    return [result[number] for number in range(len(result))]


def of_beam(solution: Solution, number: int, values: Values) -> np.ndarray:
    """Return values (k, steps, stations) of a beam, as many at each element of a kind.

    From the second beam on, those of all like beams are computed with it and kept, unless the solution is large.
    """
    meshes, kept = solution.model.meshes, solution.computed(_none)
    if values not in kept or solution.p.size > _KEPT:
        kept.setdefault(values, {})
        return values(solution, meshes[number])
    if number not in kept[values]:
        group = next(numbers for numbers in solution.model.numbered.joinable if number in numbers)
        joined = values(solution, join([meshes[i] for i in group]))
        ends = np.cumsum([meshes[i].elements for i in group])
        parts = np.split(joined, joined.shape[-1] // int(ends[-1]) * ends[:-1], axis=-1)
        kept[values].update(zip(group, parts, strict=True))
    return kept[values][number].copy()  # the user may change what it gets


def _none(solution: Solution) -> dict[Values, dict[int, np.ndarray]]:
    """Return what is kept with a solution by function and beam: nothing at first."""
    return {}


def _parts(items: Sequence[_Item], sizes: Sequence[int], most: int) -> Iterator[list[_Item]]:
    """Yield items in parts whose sizes sum to `most` at most, unless one alone is larger."""
    part: list[_Item] = []
    total = 0
    for item, size in zip(items, sizes, strict=True):
        if part and total + size > most:
            yield part
            part, total = [], 0
        part.append(item)
        total += size
    if part:
        yield part
