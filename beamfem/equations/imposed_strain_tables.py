"""Strains that loads impose on the elements of a block."""

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from beamfem.element.coordinates import Gradients
from beamfem.kernels.block import Imposed
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import energy_points, reference_axis
from beamfem.model.along_beam import jumps_along
from beamfem.model.imposed_strains import ImposedStrain, free_strain_of


def imposed_on(meshes: Sequence[tuple[int, BeamMesh]], imposing: Sequence[tuple[int, ImposedStrain]]) -> Imposed | None:
    """Return the strains that loads, each with its beam number, impose on beams (number, mesh)."""
    terms, end, shape, by_beam = [], 0, (), defaultdict[int, list[int]](list)
    for number, (beam, _) in enumerate(imposing):
        by_beam[beam].append(number)
    for beam, mesh in meshes:
        elements, loads = slice(end, end + mesh.elements), by_beam[beam]
        end += mesh.elements
        if loads:
            first, second = free_strains(mesh, [imposing[number][1] for number in loads])
            shape = first.shape[2:]
            for number, values, products in zip(loads, first, second, strict=True):
                terms.append(([number], elements, values))
                pairs = zip(loads, products, strict=True)
                terms += [([number, other], elements, product) for other, product in pairs if product.any()]
    return Imposed(tuple(terms), (end, *shape)) if terms else None


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
