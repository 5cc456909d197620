"""Graded meshes along a beam."""

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import count, positive


def graded(elements: int, ratio: float) -> tuple[float, ...]:
    """Return the ends of elements whose lengths grow geometrically, as fractions for `Beam(elements=...)`.

    Raises InputError if the number or the ratio is not positive, or an element would have no length.

    Parameters
    ----------
    elements : int
        Number of elements.
    ratio : float, [-]
        Length of the last element over that of the first; below 1 the lengths decrease.

    Examples
    --------
    >>> [round(end, 3) for end in bf.graded(3, ratio=4.0)]
    [0.0, 0.143, 0.429, 1.0]
    """
    number, ratio = count("elements", elements), positive("ratio", ratio)
    growth = ratio ** (1.0 / max(number - 1, 1))
    ends = np.cumsum(np.concatenate([[0.0], growth ** np.arange(number)]))
    ends /= ends[-1]
    if not np.all(np.diff(ends) > 0.0):
        raise InputError(f"a ratio of {ratio:g} leaves elements without length; take one closer to 1, or fewer")
    return (*(float(end) for end in ends[:-1]), 1.0)
