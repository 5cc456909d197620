"""Values at the stations of beams that are asked for one after another: those of like beams are computed together."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.joined_mesh import join
from beamfem.model.model import Model
from beamfem.results.solution import Solution

_VALUES = 200_000  # most values that are computed at once
_BEAMS = 64  # most beams; more would hardly save time, but take memory where only a few beams are asked for
_MOST = 1_000_000  # most values that are kept
Values = Callable[[Solution, BeamMesh], np.ndarray]


@dataclass(frozen=True, eq=False)
class _Kept:
    """The values of like beams by the first of them, the latest last, and how many values an element has."""

    per_element: int
    chunks: dict[int, dict[int, np.ndarray]]


def _kept(solution: Solution) -> dict[Values, _Kept]:
    """Return the values that are kept with a solution, none at first."""
    return {}


def of_beam(solution: Solution, number: int, values: Values) -> np.ndarray:
    """Return values (k, steps, stations) of a beam, as many at each element of a kind.

    From the second beam on, those of its neighbours are computed with it and kept, as far as they are few.
    """
    by_values, mesh = solution.computed(_kept), solution.model.meshes[number]
    if values not in by_values:
        result = values(solution, mesh)
        by_values[values] = _Kept(result.size // mesh.elements, {})
        return result
    kept = by_values[values]
    chosen = _neighbours(solution.model, number, _VALUES // max(1, kept.per_element))
    if len(chosen) == 1:
        return values(solution, mesh)
    chunk = kept.chunks.get(chosen[0], {})
    if number not in chunk:
        chunk = _of_beams(solution, chosen, values)
        # a new object, since other threads may be reading the one before
        by_values[values] = _Kept(kept.per_element, _latest({**kept.chunks, chosen[0]: chunk}))
    return chunk[number].copy()  # the user may change what it gets


def _latest(chunks: dict[int, dict[int, np.ndarray]]) -> dict[int, dict[int, np.ndarray]]:
    """Return the latest of some chunks that may be kept, at least one."""
    sizes = [sum(own.size for own in chunk.values()) for chunk in chunks.values()]
    too_old = sum(total > _MOST for total in np.cumsum(sizes[::-1])[1:].tolist())
    return dict(list(chunks.items())[too_old:])


def _of_beams(solution: Solution, numbers: list[int], values: Values) -> dict[int, np.ndarray]:
    """Return the values of like beams by their numbers."""
    meshes = [solution.model.meshes[number] for number in numbers]
    joined = values(solution, join(meshes))
    elements = np.cumsum([mesh.elements for mesh in meshes])
    stations = joined.shape[-1] // int(elements[-1])
    return dict(zip(numbers, np.split(joined, stations * elements[:-1], axis=-1), strict=True))


def _neighbours(model: Model, number: int, elements: int) -> list[int]:
    """Return the numbers of beams like one, with its own, that have up to so many elements, or only one."""
    place = model.numbered.places[number]
    most = max(1, min(_BEAMS, elements // place.largest))
    return place.group[place.at - place.at % most :][:most]
