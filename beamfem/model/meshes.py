"""The meshes of all beams of a model, with the numbers of its coordinates."""

from collections.abc import Sequence
from dataclasses import fields
from math import prod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beamfem.element.law_points import law_points
from beamfem.kernels.block import NO_HISTORY
from beamfem.model.beam import Point
from beamfem.model.body import require_body
from beamfem.model.contribution import remembered, uses_rotations
from beamfem.model.gaps import close_gaps
from beamfem.model.grid import Grid
from beamfem.model.grids import make_grids
from beamfem.model.mesh import BeamMesh
from beamfem.model.nodes_asked import nodes_asked
from beamfem.model.numbering import number_nodes
from beamfem.model.size import require_room
from beamfem.model.support import PointSupport

if TYPE_CHECKING:
    from beamfem.model.model import Model

_GRID = tuple(each.name for each in fields(Grid))
_NO_PAIRS = np.empty((0, 4), dtype=np.int64)


class NumberedMeshes(NamedTuple):
    """The mesh of each beam, the number of coordinates of the beams, and that of all variables of the model."""

    meshes: tuple[BeamMesh, ...]
    coordinates: int
    size: int


def numbered_meshes(model: "Model") -> NumberedMeshes:
    """Return the meshes of a model. Raises InputError for a beam that cannot be meshed."""
    require_room(model.beams)
    fractions = [[fraction for fraction, _ in requested] for requested in nodes_asked(model)]
    grids = make_grids(model.beams, fractions)
    turned = [support.point for support in model.point_supports if _turns(support)]
    turned += [point for connector in model.connectors if uses_rotations(connector) for point in connector.points]
    angled = _places(model, grids, turned)
    turning, moving = _joined(model, grids)
    grids = close_gaps(grids, moving)
    for grid in grids:
        require_body(grid, model.unit)
    nodes, size = number_nodes(grids, angled, moving, turning)
    blocks = model.blocks_of_beams
    filled, meshes = [0] * len(model.groups), []
    behind = size + sum(connector.unknowns + len(remembered(connector)) for connector in model.connectors)
    for grid, kinematics, block in zip(grids, nodes, blocks, strict=True):
        parts = {name: getattr(grid, name) for name in _GRID}
        history = _history(grid, behind)
        meshes.append(
            BeamMesh(**parts, kinematics=kinematics, first_element=filled[block], block=block, history=history)
        )
        for values in (history, *parts.values()):
            if isinstance(values, np.ndarray):
                values.setflags(write=False)  # models that are alike share it
        filled[block] += grid.elements
        behind += history.size
    return NumberedMeshes(tuple(meshes), size, behind)


def _joined(model: "Model", grids: Sequence[Grid]) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs (grid, node, grid, node) (n, 4) of nodes with a common rotation, and with a common position."""
    corners = [(i, a, i, a + 1) for i, grid in enumerate(grids) for a in _corners(grid)]
    if not corners and not model.joints:
        return _NO_PAIRS, _NO_PAIRS
    rigid, hinged = (_pairs(model, grids, keeps_angle) for keeps_angle in (True, False))
    turning = np.concatenate([np.array(corners, dtype=np.int64).reshape(-1, 4), rigid])
    return turning, np.concatenate([turning, hinged])


def _pairs(model: "Model", grids: Sequence[Grid], keeps_angle: bool) -> np.ndarray:
    """Return grid and node of both points (n, 4) of the joints that keep the angle, or of those that do not."""
    joints = [joint for joint in model.joints if joint.keeps_angle == keeps_angle]
    a, b = [joint.a for joint in joints], [joint.b for joint in joints]
    return np.hstack([_places(model, grids, a), _places(model, grids, b)])


def _places(model: "Model", grids: Sequence[Grid], points: Sequence[Point]) -> np.ndarray:
    """Return grid and node (n, 2) of points at nodes."""
    if not points:
        return np.empty((0, 2), dtype=np.int64)
    numbers = [model.number_of(point.beam) for point in points]
    pairs = [(i, grids[i].node_at(point.fraction)) for i, point in zip(numbers, points, strict=True)]
    return np.array(pairs, dtype=np.int64)


def _history(grid: Grid, first: int) -> np.ndarray:
    """Return the numbers (ne, nl, k) of the history variables at the points of a beam where its law acts."""
    law = grid.beam.law
    if law is None or not law.remembers:
        return NO_HISTORY
    shape = grid.elements, law_points(grid.beam.element), len(law.start)
    return np.arange(first, first + prod(shape), dtype=np.int64).reshape(shape)


def _turns(support: PointSupport) -> bool:
    """Return whether a support involves the rotation."""
    return "rotation" in support.prescribed() or "rotation" in support.springs()


def _corners(grid: Grid) -> Sequence[int]:
    """Return the first of the two nodes at each corner."""
    if not grid.beam.curve.corners:
        return ()
    return grid.node[:-1, -1][grid.node[:-1, -1] != grid.node[1:, 0]].tolist()
