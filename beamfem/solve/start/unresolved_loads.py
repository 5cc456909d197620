"""Whether the rows of a solve or the steps of a motion resolve the functions that act on a model."""

import numpy as np

from beamfem.errors import warn
from beamfem.solve.start.functions_of_time import FunctionOfTime


def name_unresolved(functions: list[FunctionOfTime], ends: np.ndarray, side: float, second: str) -> list[str]:
    """Warn of every function that varies more within a step than between its ends (m + 1,) [s]; return their names.

    second: the unit of time.
    """
    names = []
    for function, first, count in _unresolved(functions, ends, side):
        names.append(function.name)
        warn(
            f"the {function.name} varies more within the step from {ends[first]:.6g} {second} to "
            f"{ends[first + 1]:.6g} {second} than between its ends, where steps take it ({count} such steps): what "
            "happens in between is not resolved. Take smaller steps, or let an amplitude declare its kinks, as "
            "Piecewise does",
        )
    return names


def warn_between_rows(functions: list[FunctionOfTime], rows: np.ndarray, side: float) -> None:
    """Warn of every function that varies more between two load factors of rows (m,) than at them."""
    for function, first, _ in _unresolved(functions, rows, side):
        warn(
            f"the {function.name} varies more between load factors {rows[first]:.6g} and {rows[first + 1]:.6g} than at "
            "them, where the solve takes it. Take more steps, or let it declare its kinks, as Piecewise does",
        )


def _unresolved(
    functions: list[FunctionOfTime], ends: np.ndarray, side: float
) -> list[tuple[FunctionOfTime, int, int]]:
    """Return the functions that vary more between `ends` than at them, with the first interval and their number."""
    found = []
    for function in functions:
        bulging, _ = function.look(ends, side)
        if bulging.any():
            found.append((function, int(np.argmax(bulging)), int(bulging.sum())))
    return found
