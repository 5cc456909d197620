"""Values at the stations of beams that are asked for one after another: those of like beams are computed together."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from beamfem.model.joined_mesh import alike, join
from beamfem.model.mesh import BeamMesh
from beamfem.model.model import Model
from beamfem.once import kept_with

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_VALUES = 200_000  # most values that are kept
Values = Callable[["Solution", BeamMesh], np.ndarray]


@dataclass(frozen=True, eq=False)
class _Kept:
    """The values of the beams computed last, by number, and how many numbers there are of an element."""

    per_element: int
    beams: dict[int, np.ndarray]


_KEPT = WeakKeyDictionary[Any, dict[Values, _Kept]]()  # of each solution


def of_beam(solution: "Solution", number: int, values: Values) -> np.ndarray:
    """Return values (k, steps, stations) of a beam, as many at each element of a kind.

    From the second beam on, those of its neighbours are computed with it and kept, as far as they are few.
    """
    kept = _KEPT.setdefault(solution, {})
    mesh = solution.model.meshes[number]
    if values not in kept:
        result = values(solution, mesh)
        kept[values] = _Kept(result.size // mesh.elements, {})
        return result
    per_element = kept[values].per_element
    if number not in kept[values].beams:
        chosen = _neighbours(solution.model, number, max(1, _VALUES // max(1, per_element * mesh.elements)))
        if len(chosen) == 1:
            return values(solution, mesh)
        kept[values] = _Kept(per_element, _of_beams(solution, chosen, values))
    return kept[values].beams[number].copy()  # the user may change what it gets


def _of_beams(solution: "Solution", numbers: list[int], values: Values) -> dict[int, np.ndarray]:
    """Return the values of like beams by their numbers."""
    meshes = [solution.model.meshes[number] for number in numbers]
    joined = values(solution, join(meshes))
    elements = np.cumsum([mesh.elements for mesh in meshes])
    stations = joined.shape[-1] // int(elements[-1])
    return dict(zip(numbers, np.split(joined, stations * elements[:-1], axis=-1), strict=True))


def _neighbours(model: Model, number: int, most: int) -> list[int]:
    """Return the numbers of up to `most` beams like one, with its own."""
    group, place = _places(model)[number]
    return group[place - place % most :][:most]


@kept_with
def _places(model: Model) -> dict[int, tuple[list[int], int]]:
    """Return the numbers of the beams that are like each beam, and its place among them."""
    return {number: (group, place) for group in alike(model) for place, number in enumerate(group)}
