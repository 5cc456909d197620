"""Conversion of beam meshes to the arrays that the kernels expect."""

from collections import defaultdict
from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np

from beamfem.element.coordinates import Gradients
from beamfem.element.element import Element
from beamfem.equations.law_pass import LawPass
from beamfem.kernels.block import NO_HISTORY, Block, Imposed
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.beam_mesh import BeamMesh, Classes, join, likenesses
from beamfem.mesh.reference import energy_points, reference_axis
from beamfem.model.along_beam import jumps_along
from beamfem.model.imposed_strains import ImposedStrain, free_strain_of
from beamfem.section.law import THICKNESS

PER_CLASS = tuple(name for name in Classes._fields if name != "kind")


def classes_of(block: Block, elements: slice | np.ndarray) -> dict[str, Any]:
    """Return the classes of some elements of a block, numbered from the first one used, with their data."""
    used, kind = np.unique(block.kind[elements], return_inverse=True)
    data = {} if len(used) == len(block.scale) else {name: getattr(block, name)[used] for name in PER_CLASS}
    return {**data, "kind": kind}


def build_block(
    element: Element, meshes: Sequence[tuple[int, BeamMesh]], imposing: Sequence[tuple[int, ImposedStrain]] = ()
) -> Block:
    """Return the block of all beams (number, mesh) that share an element, a section law and `mass_damping`.

    imposing: loads that impose strains, each with the number of its beam.
    """
    beam_meshes = [mesh for _, mesh in meshes]
    grid = join(beam_meshes)
    first_kind = 0
    known: dict[Hashable, np.ndarray] = {}  # classes of elements, shared by similar beams
    parts: dict[str, list[np.ndarray]] = {name: [] for name in PER_CLASS}
    kinds = []
    for mesh, like in zip(beam_meshes, likenesses(beam_meshes), strict=True):
        if like not in known:
            for name in PER_CLASS:
                parts[name].append(getattr(mesh.classes, name))
            known[like] = mesh.classes.kind + first_kind if first_kind else mesh.classes.kind
            first_kind += len(mesh.classes.scale)
        kinds.append(known[like])
    joined = {name: _joined(values) for name, values in parts.items()}
    home = np.empty((grid.nodes, 2), dtype=np.int64)
    for local_number, numbers in enumerate(grid.node.T):
        home[numbers, 0], home[numbers, 1] = np.arange(grid.elements), local_number
    law = beam_meshes[0].beam.law
    return Block(
        node=grid.node,
        beam=np.array([number for number, _ in meshes]).repeat([mesh.elements for mesh in beam_meshes]),
        node_kind=grid.kinematics.node_kind,
        frame=np.ascontiguousarray(grid.kinematics.frame),
        dof=np.ascontiguousarray(grid.kinematics.dof),
        home=home,
        kind=_joined(kinds),
        measures=element.forces.code,
        director=element.tables.director,
        law=None if law is None else LawPass(law, element.law_points, isinstance(element.coordinates, Gradients)),
        mass_damping=beam_meshes[0].beam.mass_damping,
        imposed=imposed_on(meshes, imposing) if imposing else None,
        history=_joined([mesh.history for mesh in beam_meshes]) if beam_meshes[0].history.size else NO_HISTORY,
        **joined,
    )


def _joined(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Concatenate arrays; a single one is not copied, because it may be large."""
    return np.ascontiguousarray(parts[0]) if len(parts) == 1 else np.concatenate(parts)


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
        free[:, :, THICKNESS] = 0.0
    first, second = element_type.forces.imposed(free, reference)
    shape = grid.elements, -1, first.shape[-1]
    return first.reshape(len(free), *shape), second.reshape(len(free), len(free), *shape)
