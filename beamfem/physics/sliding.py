"""The definition of a point that slides on an element of a beam, by compiled functions."""

from functools import cache

from beamfem.errors import InputError
from beamfem.kernels.sliding_passes import MOST, sliding_force, sliding_root, sliding_tangent
from beamfem.physics.connections import Connection


@cache
def sliding(vectors: int) -> Connection:
    """Return the definition for an element whose axis has vectors (m,) and degree m - 1. Raises InputError.

    Its points are the one that slides and the vectors; for its data see `kernels.sliding_passes`.
    """
    if vectors > MOST:
        raise InputError(f"a SliderOnBeam needs elements of order {MOST - 1} or less")
    names = ("vectors", *(f"coefficient {i}" for i in range(vectors**2)), "distance")
    addresses = sliding_force.address, sliding_tangent.address, sliding_root.address
    return Connection(f"sliding_{vectors}", vectors + 1, 2, names, multipliers=1, compiled=addresses)
