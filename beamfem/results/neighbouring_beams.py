"""Values at the stations of beams that are asked for one after another: those of like beams are computed together."""

from collections.abc import Callable

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.joined_mesh import join
from beamfem.results.solution import Solution

_KEPT = 1_000_000  # most coordinates in all rows of a solution whose values are kept
Values = Callable[[Solution, BeamMesh], np.ndarray]


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
        joined, ends = (
            values(solution, join([meshes[i] for i in group])),
            np.cumsum([meshes[i].elements for i in group]),
        )
        parts = np.split(joined, joined.shape[-1] // int(ends[-1]) * ends[:-1], axis=-1)
        kept[values].update(zip(group, parts, strict=True))
    return kept[values][number].copy()  # the user may change what it gets


def _none(solution: Solution) -> dict[Values, dict[int, np.ndarray]]:
    """Return what is kept with a solution by function and beam: nothing at first."""
    return {}
