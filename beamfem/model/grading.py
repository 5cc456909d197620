"""Graded meshes along a beam."""

import numpy as np

from beamfem.errors import InputError
from beamfem.keywords import keywords_checked
from beamfem.memory import SHARE, in_gib, installed_memory
from beamfem.validation import count, positive

_ELEMENT = 64  # bytes of an element: its fraction as a float in a tuple, and in arrays on the way


@keywords_checked
def graded(elements: int, ratio: float) -> tuple[float, ...]:
    """Return the fractions from 0 to 1 (elements + 1,) of element ends whose lengths grow geometrically.

    ratio: length of the last element over that of the first; below 1 they decrease. For `Beam(elements=...)`.
    Raises InputError.
    """
    number, ratio = count("elements", elements), positive("ratio", ratio)
    memory = installed_memory()
    if memory is not None and number * _ELEMENT > SHARE * memory:
        raise InputError(
            f"{number:.3g} elements need {in_gib(number * _ELEMENT)} at the least, and this computer has "
            f"{in_gib(memory)}; take fewer"
        )
    growth = ratio ** (1.0 / max(number - 1, 1))
    ends = np.cumsum(np.concatenate([[0.0], growth ** np.arange(number)]))
    ends /= ends[-1]
    if not np.all(np.diff(ends) > 0.0):
        raise InputError(f"a ratio of {ratio:g} leaves elements without length; take one closer to 1, or fewer")
    return (*(float(end) for end in ends[:-1]), 1.0)
