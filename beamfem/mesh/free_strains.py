"""Free strains that loads impose on the elements of a beam, as polynomials of the load factors."""

from collections.abc import Sequence

import numpy as np

from beamfem.element.coordinates import Gradients
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.reference import energy_points, reference_axis
from beamfem.model.along_beam import jumps_along
from beamfem.model.imposed_strains import ImposedStrain, free_strain_of

_THICKNESS = 3  # column of the thickness stretch


def free_strains(grid: Grid, loads: Sequence[ImposedStrain]) -> tuple[np.ndarray, np.ndarray]:
    """Return first (m, ne, nq, ns) and second (m, m, ne, nq, ns) order parts of the measures imposed by m loads.

    For factors f the measures are exactly the sum of f_i times the first and f_i f_j times the second part, because
    strain measures are at most quadratic in the free strains.
    """
    element_type = grid.beam.element
    element, xi, _ = energy_points(grid)
    reference = reference_axis(grid, element, xi)
    free = np.array([free_strain_of(load, grid.arc_length_inside(element, xi, jumps_along(load))) for load in loads])
    if not isinstance(element_type.coordinates, Gradients):
        free[:, :, _THICKNESS] = 0.0
    first, second = element_type.forces.imposed(free, reference)
    shape = grid.elements, -1, first.shape[-1]
    return first.reshape(len(free), *shape), second.reshape(len(free), len(free), *shape)
