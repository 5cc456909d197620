"""The free strains that loads impose on the elements of a beam, as polynomials of the loads' factors."""

from collections.abc import Sequence

import numpy as np

from beamfem.element.coordinates import Gradients
from beamfem.model.grid import Grid
from beamfem.model.load import Imposing, jumps_along
from beamfem.model.reference import energy_points, reference_axis

_THICKNESS = 3  # column of the thickness stretch


def free_strains(grid: Grid, loads: Sequence[Imposing]) -> tuple[np.ndarray, np.ndarray]:
    """Return parts (m, ne, nq, ns) and (m, m, ne, nq, ns) of the measures that m loads on a beam impose on elements.

    The measures for factors f are the sum of f_i of the first and f_i f_j of the second, exactly: strain measures are
    linear in the free strains or, of the continuum, quadratic.
    """
    own = grid.beam.element
    element, xi, _ = energy_points(grid)
    reference = reference_axis(grid, element, xi)
    free = np.array([load.free_strain(grid.arc_length_inside(element, xi, jumps_along(load))) for load in loads])
    if not isinstance(own.coordinates, Gradients):
        free[:, :, _THICKNESS] = 0.0

    def measures(strains: np.ndarray) -> np.ndarray:
        found = own.forces.imposed(strains, reference)
        return found.reshape(grid.elements, -1, found.shape[1])

    ahead, behind = (np.array([measures(side * part) for part in free]) for side in (1.0, -1.0))
    first = 0.5 * (ahead - behind)
    second = np.zeros((len(free), *first.shape))
    for i, one in enumerate(free):
        second[i, i] = 0.5 * (ahead[i] + behind[i])
        for j in range(i):
            second[i, j] = second[j, i] = 0.5 * (measures(one + free[j]) - ahead[i] - ahead[j])
    return first, second
