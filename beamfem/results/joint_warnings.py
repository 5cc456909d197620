"""A warning of ends that meet a beam without a joint and move away from it: a joint may have been forgotten."""

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from beamfem.curves import Line
from beamfem.model.missing_joints import in_words, unjoined_ends

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_ROUND_OFF = 1e-6  # of the displacements


def unjoined_warnings(solution: "Solution") -> tuple[str, ...]:
    """Return a warning of the first two points at one place that move apart in the last row, if there are any."""
    model = solution.model
    straight = len(model.beams) == 1 and type(model.beams[0].curve) is Line
    if straight or not len(solution):
        return ()
    tied = [Counter(id(point.beam) for point in connector.points) for connector in model.connectors]
    for pair in unjoined_ends(model):
        if any(Counter(id(point.beam) for point in pair) <= beams for beams in tied):
            continue
        one, other = (solution.displacement(point)[-1] for point in pair)
        apart = float(np.hypot(*(one - other)))
        if apart > _ROUND_OFF * max(np.hypot(*one), np.hypot(*other)):
            moved = f"they move {apart:.3g} {model.unit('m')} apart"
            return (f"{in_words(model, pair)}, and {moved}. If they belong together, add a Rigid or a Hinge",)
    return ()
