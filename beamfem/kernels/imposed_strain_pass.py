"""Strains imposed by loads, which are subtracted from the strains of a point before its resultants are computed."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.point import STRAIN
from beamfem.kernels.pointers import at
from beamfem.kernels.record import ROW


@routine("iiiiirr")
def release(first, count, points, number, measures, natural, x):
    """Subtract imposed strains (elements, points, measures) from those of a point of a batch.

    number: of the point; x: rows of the point, see `point`.
    """
    for i in range(count):
        strains = at(natural, ((first + i) * points + number) * measures)
        for row in range(measures):
            x[(STRAIN + row) * ROW + i] -= strains[row]
