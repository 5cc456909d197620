"""Values of loads along a beam, of the package or user-defined, as arrays with the required shape."""

from collections.abc import Callable

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import called, number_table


def values_along(
    load: object, member: str, function: Callable[[np.ndarray], np.ndarray], arc_length: np.ndarray, columns: int
) -> np.ndarray:
    """Return the values (n, columns) of a member of a load at arc lengths (n,) [m]. Raises InputError for others."""
    what = f"{member} of {type(load).__name__}"
    table = number_table(what, called(what, function, arc_length), columns)
    if len(table) != len(arc_length):
        raise InputError(
            f"{what} must have a row for each of the {len(arc_length)} requested arc lengths, got {len(table)} rows"
        )
    return table
