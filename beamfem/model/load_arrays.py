"""Values of loads along a beam, of the package or user-defined, as arrays with the required shape."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import called, number_table

if TYPE_CHECKING:
    from beamfem.model.imposed_strains import ImposedStrain
    from beamfem.model.load_base import LineLoad


def forces_of(load: "LineLoad", arc_length: np.ndarray) -> np.ndarray:
    """Return the forces (n, 2) [N/m] of a load at arc lengths (n,) [m]. Raises InputError for any other result."""
    return _table(load, "forces", load.forces, arc_length, 2)


def free_strain_of(load: "ImposedStrain", arc_length: np.ndarray) -> np.ndarray:
    """Return the free strains (n, 4) of a load at arc lengths (n,) [m]. Raises InputError for any other result."""
    return _table(load, "free_strain", load.free_strain, arc_length, 4)


def heat_of(load: "ImposedStrain", arc_length: np.ndarray) -> np.ndarray:
    """Return temperature [K] and gradient [K/m] (n, 2) of a load. Raises InputError for any other result."""
    return _table(load, "heat", load.heat, arc_length, 2)


def _table(
    load: object, member: str, function: Callable[[np.ndarray], np.ndarray], arc_length: np.ndarray, columns: int
) -> np.ndarray:
    what = f"{member} of {type(load).__name__}"
    table = number_table(what, called(what, function, arc_length), columns)
    if len(table) != len(arc_length):
        raise InputError(
            f"{what} must have a row for each of the {len(arc_length)} arc lengths that it is asked for, "
            f"got {len(table)} rows"
        )
    return table
