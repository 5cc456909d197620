"""Strains that loads impose: what is left of the strains of a point is what its resultants belong to."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.point import STRAIN
from beamfem.kernels.pointers import at
from beamfem.kernels.record import ROW


@routine("iiiiirr")
def release(first, count, points, number, measures, natural, x):
    """Take imposed strains (elements, points, measures) of a batch off those of a point; x: rows of it, see `point`."""
    for i in range(count):
        own = at(natural, ((first + i) * points + number) * measures)
        for row in range(measures):
            x[(STRAIN + row) * ROW + i] -= own[row]
