"""Whether the steps of a motion resolve the functions of time that act on a model."""

import numpy as np

from beamfem.errors import warn
from beamfem.solve.start.functions_of_time import FunctionOfTime


def name_unresolved(functions: list[FunctionOfTime], ends: np.ndarray, side: float, second: str) -> list[str]:
    """Warn of every function that varies more within a step than between its ends (m + 1,) [s]; return their names.

    second: the unit of time.
    """
    names = []
    for function in functions:
        bulging, _ = function.look(ends, side)
        if bulging.any():
            first = int(np.argmax(bulging))
            names.append(function.name)
            warn(
                f"the {function.name} varies more within the step from {ends[first]:.6g} {second} to "
                f"{ends[first + 1]:.6g} {second} than between its ends, where steps take it ({int(bulging.sum())} "
                "such steps): what happens in between is not resolved. Take smaller steps, or let an amplitude declare "
                "its kinks, as Piecewise does",
            )
    return names
