"""Strains that loads impose on the elements of a block."""

from collections.abc import Sequence

import numpy as np

from beamfem.element.coordinates import Gradients
from beamfem.kernels.block import Imposed
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import energy_points, reference_axis
from beamfem.model.along_beam import jumps_along
from beamfem.model.imposed_strains import ImposedStrain, free_strain_of


def imposed_on(meshes: Sequence[tuple[int, BeamMesh]], loads: Sequence[tuple[int, ImposedStrain]]) -> Imposed | None:
    """Return the strains that loads, each with its beam number, impose on a block of beams (number, mesh), or None."""
    by_beam: dict[int, list[int]] = {}
    for number, (beam, _) in enumerate(loads):
        by_beam.setdefault(beam, []).append(number)
    loads_of_mesh = [by_beam.get(beam, []) for beam, _ in meshes]
    most = max(map(len, loads_of_mesh))
    if most == 0:
        return None
    parts = [
        free_strains(mesh, [loads[i][1] for i in numbers]) if numbers else None
        for numbers, (_, mesh) in zip(loads_of_mesh, meshes, strict=True)
    ]
    points, measures = next(part[0].shape[2:] for part in parts if part is not None)
    ends = np.cumsum([mesh.elements for _, mesh in meshes])
    pairs = most if any(part is not None and part[1].any() for part in parts) else 0
    load = np.full((most, ends[-1]), -1)
    first, second = np.zeros((most, ends[-1], points, measures)), np.zeros((pairs, pairs, ends[-1], points, measures))
    for numbers, part, (_, mesh), end in zip(loads_of_mesh, parts, meshes, ends.tolist(), strict=True):
        if part is None:
            continue
        elements, count = slice(end - mesh.elements, end), len(numbers)
        load[:count, elements] = np.array(numbers)[:, None]
        first[:count, elements] = part[0]
        if pairs:
            second[:count, :count, elements] = part[1]
    return Imposed(load, first, second)


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
