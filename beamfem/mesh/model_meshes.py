"""The meshes of all beams of a model, and the numbering of its coordinates, which beams share at joints."""

from collections import defaultdict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from itertools import pairwise
from math import prod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from beamfem.cached_properties import cached_property
from beamfem.element.coordinates import labels
from beamfem.element.element import Element
from beamfem.element.fields import cross
from beamfem.errors import InputError
from beamfem.installed_memory import USABLE_FRACTION, in_gib, installed_memory
from beamfem.kernels.block import GRADIENTS, NO_HISTORY, ROTATED_GRADIENTS, ROTATION, STRETCH
from beamfem.mesh.beam_grid import Grid, make_grids
from beamfem.mesh.beam_mesh import BeamMesh, Nodes
from beamfem.mesh.reference import curvature, energy_points, reference_angle, reference_axis, sections_at
from beamfem.model.along_beam import AlongBeam
from beamfem.model.beam import Beam, Point
from beamfem.model.contribution import amplitudes_of, prescribed_by, remembered, uses_rotations
from beamfem.section.protocol import CrossSection, HasParts
from beamfem.value_keys import by_value

if TYPE_CHECKING:
    from beamfem.model.model import Model

_SAMPLES = 33  # along an element


def require_body(grid: Grid, unit: Callable[[str], str]) -> None:
    """Raise InputError if a face of a section of known shape lies at or beyond the centre of curvature.

    The axis and its sections are interpolated between nodes, so elements that turn by too large an angle are refused as
    well. unit: see `Model.unit`.
    """
    if grid.straight:
        return
    element, xi, _ = energy_points(grid)
    faces = np.array([_faces(section, grid) for section in sections_at(grid, element, xi)])
    bend = curvature(grid, element, xi)
    reach = (bend[:, None] * faces).max(axis=1)
    worst = int(np.argmax(reach))
    if reach[worst] >= 1.0:
        at, metre = float(grid.arc_length(element, xi)[worst]), unit("m")
        face = float(np.broadcast_to(faces, (len(bend), 2))[worst, int(bend[worst] > 0.0)])
        raise InputError(
            f"at arc length {at:g} {metre} the axis of {grid.beam!r} has a radius of curvature of "
            f"{1.0 / abs(bend[worst]):g} {metre}, and its section reaches {abs(face):g} {metre} towards the centre: "
            "the body would overlap itself; take a larger radius or a lower section"
        )
    _require_short(grid, element, xi, faces, unit)


def _require_short(
    grid: Grid, element: np.ndarray, xi: np.ndarray, faces: np.ndarray, unit: Callable[[str], str]
) -> None:
    """Raise InputError if the interpolated body has det J = (r0' + y d') x d <= 0.

    This is checked on the axis and, for forces integrated over the body, at its faces (1, 2) or (n, 2).
    """
    axis = reference_axis(grid, element, xi)
    heights = np.zeros((len(xi), 3))  # of both faces and of the axis
    if grid.beam.element.forces.fills_body:
        heights[:, :2] = faces
    volume = (cross(axis.r_s, axis.d)[:, None] + heights * cross(axis.d_s, axis.d)[:, None]).min(axis=1)
    worst = int(np.argmin(volume))
    if volume[worst] <= 0.0:
        elements = np.full(_SAMPLES, element[worst])
        along = np.linspace(0.0, 1.0, _SAMPLES)
        arc = grid.arc_length(elements, along)
        turn = np.degrees(np.abs(np.trapezoid(curvature(grid, elements, along), arc)))
        raise InputError(
            f"elements of {grid.beam!r} are too long: that from arc length {arc[0]:g} {unit('m')} to {arc[-1]:g} "
            f"{unit('m')} turns by {turn:.0f} degrees, and the sections that it interpolates between its nodes "
            "overlap; take more elements"
        )


def _faces(section: CrossSection, grid: Grid) -> tuple[float, float]:
    """Return lower and upper y [m] of a section, zero if its height is unknown and forces do not integrate over it."""
    if grid.beam.element.forces.fills_body:
        return section.bounds
    parts = section.parts(grid.beam.material) if isinstance(section, HasParts) else ()
    if not parts or not all(part.outline.known for part in parts):
        return 0.0, 0.0
    return parts[0].outline.low, parts[-1].outline.high


def required_nodes(model: "Model") -> list[list[tuple[float, str]]]:
    """Return for each beam the fractions of its length [-] at which parts of the model need a node, with their names.

    Jumps of sections belong to the beam itself and have the name "section".
    """
    result: list[list[tuple[float, str]]] = [[] for _ in model.beams]
    points: list[tuple[object, Point]] = [(support, support.point) for support in model.point_supports]
    points += [(joint, point) for joint in model.shared_joints for point in (joint.a, joint.b)]
    points += [(load, load.point) for load in model.point_loads]
    points += [(connector, point) for connector in model.at_points for point in connector.points]
    for part, point in points:
        result[model.number_of(point.beam)].append((point.fraction, model.name_of(part)))
    for beam, nodes in zip(model.beams, result, strict=True):
        nodes += [(jump / beam.curve.length, "section") for jump in beam.jumps]
    lines: tuple[AlongBeam, ...] = (*model.line_loads, *(load for _, load in model.imposing))
    for line in lines:
        kinks = [kink for group in line.kinks_along.values() for kink in group]
        length, name = line.beam.curve.length, type(line).__name__
        result[model.number_of(line.beam)] += [(kink / length, name) for kink in kinks]
    return result


_COORDINATE = 300  # bytes per coordinate; 310 to 370 were measured in statics
_LITTLE = 2**24  # bytes that every computer has


def require_fits_memory(beams: Sequence[Beam]) -> None:
    """Raise InputError if the elements of a model need more memory [bytes] than this computer has."""
    needed = _COORDINATE * sum(map(_coordinates, beams))
    if needed <= _LITTLE:
        return
    memory = installed_memory()
    if memory is None or needed <= USABLE_FRACTION * memory:
        return
    most, elements = max(beams, key=_coordinates), sum(beam.element_count for beam in beams)
    raise InputError(
        f"the {elements:.4g} elements of this model need {in_gib(needed)} at the least, and this "
        f"computer has {in_gib(memory)}; the most are in {most!r}, take fewer"
    )


def _coordinates(beam: Beam) -> int:
    element = beam.element
    names = labels(element.coordinates.code, element.field.vectors)
    return beam.element_count * (len(element.field.nodes) - 1) * len(names)


_ROUND_OFF = 16 * np.finfo(float).eps


def close_gaps(grids: Sequence[Grid], moving: np.ndarray) -> list[Grid]:
    """Return the grids with joined nodes moved to the position of the first of them.

    moving (n, 4): pairs (grid, node, grid, node). Otherwise a solve would strain the element at a gap.
    """
    if not len(moving):
        return list(grids)
    first = np.concatenate([[0], np.cumsum([grid.nodes for grid in grids])])
    position = np.concatenate([grid.position for grid in grids])
    one, other = first[moving[:, 0]] + moving[:, 1], first[moving[:, 2]] + moving[:, 3]
    apart = np.abs(position[one] - position[other]).max(axis=1)
    if not (apart > _ROUND_OFF * np.abs(position).max()).any():
        return list(grids)
    leader = first_of_group(groups(first[-1], first, moving))
    off = np.abs(position - position[leader]).max(axis=1) > _ROUND_OFF * np.abs(position).max()
    closed = np.where(off[:, None], position[leader], position)
    return [
        replace(grid, position=closed[begin:end], moved=True) if off[begin:end].any() else grid
        for grid, begin, end in zip(grids, first[:-1], first[1:], strict=True)
    ]


_GRID = tuple(each.name for each in fields(Grid))
_NO_PAIRS = np.empty((0, 4), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class NumberedMeshes:
    """The meshes of all beams of a model.

    meshes: that of each beam; groups: the element of each block of beams; coordinates: number of coordinates of the
    beams and, behind them, amplitudes of parts; size: number of all variables of the model.
    """

    meshes: tuple[BeamMesh, ...]
    groups: tuple[Element, ...]
    coordinates: int
    size: int

    @cached_property
    def uncounted(self) -> list[BeamMesh]:
        """The meshes (m,) of the beams without a node whose rotation is a coordinate."""
        return [mesh for mesh in self.meshes if mesh.has_gradients_only]

    @cached_property
    def numbers_uncounted(self) -> dict[BeamMesh, int]:
        """The number of each mesh of `uncounted` in it."""
        return {mesh: number for number, mesh in enumerate(self.uncounted)}

    @cached_property
    def rotation_pairs(self) -> np.ndarray:
        """Coordinates x and y (m, 2) of the vector that determines the rotation at the start of each of `uncounted`."""
        pairs = []
        for mesh in self.uncounted:
            vector = "r_x" if mesh.beam.element.forces.turns_with == "r_x" else "r_y"
            column = mesh.labels(0).index(f"{vector}^x")
            pairs.append(mesh.kinematics.dof[0, column : column + 2])
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    @cached_property
    def joinable(self) -> list[list[int]]:
        """The numbers of the beams of each group whose meshes can be joined, in the order of their first."""
        groups: defaultdict[Hashable, list[int]] = defaultdict(list)
        for number, mesh in enumerate(self.meshes):
            groups[self._kind(mesh)].append(number)
        return list(groups.values())

    def _kind(self, mesh: BeamMesh) -> Hashable:
        """Return a key that meshes share if they can be joined."""
        beam = mesh.beam
        if beam.elements == "knots":  # the mesh coordinate is that of its spline
            return mesh
        counted = mesh not in self.numbers_uncounted
        return mesh.block, mesh.straight, counted, by_value(beam.section), by_value(beam.material), beam.damping


class NodesNeeded(NamedTuple):
    """All that the meshes of a model depend on besides its beams and joints.

    fractions: those of each beam [-] at which there has to be a node; angled: number of the beam and fraction of each
    node that has an angle as a coordinate; further: number of variables that are not coordinates of beams.
    """

    fractions: list[list[float]]
    angled: list[tuple[int, float]]
    further: int


def nodes_needed(model: "Model") -> NodesNeeded:
    """Return the nodes that supports, loads and connectors of a model need."""
    asked = zip(model.beams, required_nodes(model), strict=True)
    fractions = [_inside(beam, {fraction for fraction, _ in requested}) for beam, requested in asked]
    turning = (each for each in model.point_supports if "rotation" in (*each.prescribed(), *each.springs()))
    points = [support.point for support in turning]
    points += [point for connector in model.at_points if uses_rotations(connector) for point in connector.points]
    angled = sorted({(model.number_of(point.beam), point.fraction) for point in points})
    further = sum(
        connector.unknowns + len(prescribed_by(connector)) + len(remembered(connector)) for connector in model.at_points
    )
    return NodesNeeded(fractions, angled, further)


def _inside(beam: Beam, fractions: set[float]) -> list[float]:
    """Return the fractions in ascending order, none if the elements of the beam end at all of them anyway."""
    count = beam.elements
    if isinstance(count, int) and not beam.curve.corners and all((at * count).is_integer() for at in fractions):
        return []
    return sorted(fractions)


def numbered_meshes(model: "Model") -> NumberedMeshes:
    """Return the meshes of a model. Raises InputError for a beam that cannot be meshed."""
    require_fits_memory(model.beams)
    needed = model.nodes_needed
    grids = make_grids(model.beams, needed.fractions)
    places = [(number, grids[number].node_at(fraction)) for number, fraction in needed.angled]
    angled = np.array(places, dtype=np.int64).reshape(-1, 2)
    turning, moving = _joined(model, grids)
    grids = close_gaps(grids, moving)
    for grid in grids:
        require_body(grid, model.unit)
    nodes, size = number_nodes(grids, angled, moving, turning)
    size += sum(map(amplitudes_of, model.at_points))
    groups, blocks = _blocks(model.beams)
    filled, meshes = [0] * len(groups), []
    behind = size + needed.further
    for grid, kinematics, block in zip(grids, nodes, blocks, strict=True):
        parts = {name: getattr(grid, name) for name in _GRID}
        history = _history(grid, behind)
        meshes.append(
            BeamMesh(**parts, kinematics=kinematics, first_element=filled[block], block=block, history=history)
        )
        filled[block] += grid.elements
        behind += history.size
    return NumberedMeshes(tuple(meshes), groups, size, behind)


def _blocks(beams: Sequence[Beam]) -> tuple[tuple[Element, ...], list[int]]:
    """Return the element of each block of beams, in order of appearance, and the number of the block of each beam.

    Beams of one block have the same element, section law and damping of the mass.
    """
    blocks: dict[tuple[Element, Hashable, float], int] = {}
    laws = (None if beam.law is None else (by_value(beam.law.section), by_value(beam.law.material)) for beam in beams)
    keys = ((beam.element, law, beam.mass_damping) for beam, law in zip(beams, laws, strict=True))
    numbers = [blocks.setdefault(key, len(blocks)) for key in keys]
    return tuple(element for element, _, _ in blocks), numbers


def _joined(model: "Model", grids: Sequence[Grid]) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs (grid, node, grid, node) (n, 4) of nodes with a common rotation, and with a common position."""
    cornered = [(i, grid.node) for i, grid in enumerate(grids) if grid.beam.curve.corners]
    corners = [(i, a, i, a + 1) for i, node in cornered for a in node[:-1, -1][node[:-1, -1] != node[1:, 0]].tolist()]
    if not corners and not model.shared_joints:
        return _NO_PAIRS, _NO_PAIRS

    def at(point: Point) -> tuple[int, int]:
        number = model.number_of(point.beam)
        return number, grids[number].node_at(point.fraction)

    joints = sorted(model.shared_joints, key=lambda joint: not joint.keeps_angle)
    moving = np.array([*corners, *((*at(joint.a), *at(joint.b)) for joint in joints)], dtype=np.int64)
    return moving[: len(corners) + sum(joint.keeps_angle for joint in joints)], moving


def _history(grid: Grid, first: int) -> np.ndarray:
    """Return the numbers (ne, nl, k) of the history variables at the points of a beam where its law acts."""
    law = grid.beam.law
    if law is None or not law.remembers:
        return NO_HISTORY
    shape = grid.elements, grid.beam.element.law_points, len(law.start)
    return np.arange(first, first + prod(shape), dtype=np.int64).reshape(shape)


Pairs = Sequence[tuple[int, ...]]
_FEW = 2000  # nodes; the numbering of larger models is not cached


def number_nodes(
    grids: Sequence[Grid],
    angled: np.ndarray,
    moving: np.ndarray,
    turning: np.ndarray,
) -> tuple[list[Nodes], int]:
    """Return the nodes of each grid and the total number of coordinates.

    angled (m, 2): (grid, node) whose rotation is prescribed, has a spring or is that of a connector; such a node has an
    angle as a coordinate.
    moving, turning (n, 4): pairs (grid, node, grid, node) with a common position, and with a common rotation.
    """
    kinds = tuple(
        NodeKinds(element.coordinates.code, element.forces.turns_with == "r_x", element.field.vectors, grid.nodes)
        for element, grid in ((grid.beam.element, grid) for grid in grids)
    )
    pairs = tuple(map(tuple, moving.tolist())), tuple(map(tuple, turning.tolist()))
    number = _number if sum(kind.nodes for kind in kinds) > _FEW else _cached_number
    numbered = number(kinds, tuple(map(tuple, angled.tolist())), *pairs)
    frame = _frames(grids, numbered)
    nodes = [
        Nodes(numbered.node_kind[begin:end], numbered.dof[begin:end, :columns], frame[begin:end])
        for begin, end, columns in numbered.parts
    ]
    return nodes, numbered.size


class NodeKinds(NamedTuple):
    """Data of a grid that determine its numbering.

    code: kind of the nodal coordinates; follows_slope: whether sections rotate with r_x; vectors: names of the nodal
    vectors; nodes: number of nodes.
    """

    code: int
    follows_slope: bool
    vectors: tuple[str, ...]
    nodes: int


@dataclass(frozen=True)
class Numbered:
    """Nodes of all grids: kind (total,), coordinates (total, npn), and the node (total,) that each rotates with.

    turned (k,): the nodes whose r_y is that of another one, rotated by the angle between them; parts: begin and end of
    the nodes of each grid, and its number of columns; size: number of coordinates.
    """

    node_kind: np.ndarray
    dof: np.ndarray
    turns_with: np.ndarray
    turned: np.ndarray
    parts: tuple[tuple[int, int, int], ...]
    size: int


def _number(kinds: Sequence[NodeKinds], angled: Pairs, moving: Pairs, turning: Pairs) -> Numbered:
    """Number the coordinates of grids; see `number_nodes`."""
    first = np.concatenate([[0], np.cumsum([kind.nodes for kind in kinds])])
    owner = np.repeat(np.arange(len(kinds)), np.diff(first))
    total = first[-1]
    own_code = np.array([kind.code for kind in kinds])
    follows_slope = np.array([kind.follows_slope for kind in kinds])
    node_kind = own_code[owner]
    moves = groups(total, first, np.array(moving, dtype=np.int64).reshape(-1, 4))
    turns = groups(total, first, np.array(turning, dtype=np.int64).reshape(-1, 4))

    as_angle = np.zeros(total, dtype=bool)
    grid_of, node_of = np.array(angled, dtype=np.int64).reshape(-1, 2).T
    as_angle[first[grid_of] + node_of] = True
    joined = np.bincount(turns, minlength=total)[turns] > 1
    # if all joined nodes have gradients, they share the vector r_y; otherwise they share an angle
    plain = (node_kind == GRADIENTS) & ~follows_slope[owner] & ~as_angle
    all_plain = np.bincount(turns, weights=~plain, minlength=total)[turns] == 0
    angle = as_angle | (joined & ~all_plain)
    angle = np.bincount(turns, weights=angle, minlength=total)[turns] > 0
    sloped = angle & follows_slope[owner] & ((node_kind == GRADIENTS) | (node_kind == ROTATION))
    node_kind = np.where(sloped, STRETCH, np.where(angle & (node_kind == GRADIENTS), ROTATION, node_kind))

    leader_moves, leader_turns = first_of_group(moves), first_of_group(turns)
    turned = joined & all_plain & (leader_turns != np.arange(total))
    node_kind = np.where(turned, ROTATED_GRADIENTS, node_kind)

    owned, last, turn_size = _ownership(kinds, owner, node_kind)
    follower_moves, follower_turns = leader_moves != np.arange(total), leader_turns != np.arange(total)
    owned[follower_moves, :2] = False
    for offset in (1, 2):
        rows = np.flatnonzero(follower_turns & (turn_size >= offset))
        owned[rows, last[rows] - offset + 1] = False
    dof = np.where(owned, np.cumsum(owned).reshape(owned.shape) - 1, -1)
    dof[follower_moves, :2] = dof[leader_moves[follower_moves], :2]
    for offset in (1, 2):
        rows = np.flatnonzero(follower_turns & (turn_size >= offset))
        leaders = leader_turns[rows]
        dof[rows, last[rows] - offset + 1] = dof[leaders, last[leaders] - offset + 1]

    dof = np.ascontiguousarray(dof[:, : last.max() + 1])
    widest = (np.maximum.reduceat(last, first[:-1]) + 1).tolist()
    parts = tuple((*ends, columns) for ends, columns in zip(pairwise(first.tolist()), widest, strict=True))
    for values in (node_kind, dof, leader_turns):
        values.setflags(write=False)  # models with the same numbering share them
    turned_nodes = np.flatnonzero(node_kind == ROTATED_GRADIENTS)
    return Numbered(node_kind, dof, leader_turns, turned_nodes, parts, int(owned.sum()))


_cached_number = lru_cache(maxsize=64)(_number)  # studies repeatedly make models with the same numbering


def groups(total: int, first: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Return the number of the group (total,) that each node belongs to."""
    if not len(pairs):
        return np.arange(total)
    a, b = first[pairs[:, 0]] + pairs[:, 1], first[pairs[:, 2]] + pairs[:, 3]
    return connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(total, total)), directed=False)[1]


def first_of_group(group: np.ndarray) -> np.ndarray:
    """Return the first node (total,) of the group of each node."""
    leader = np.full(group.max() + 1, len(group))
    np.minimum.at(leader, group, np.arange(len(group)))
    return leader[group]


def _ownership(
    kinds: Sequence[NodeKinds], owner: np.ndarray, node_kind: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the mask of the columns of each node (total, width), its last column, and the number for its rotation."""
    owned = np.zeros((len(owner), max(2 * len(kind.vectors) for kind in kinds)), dtype=bool)
    last, turn_size = np.empty(len(owner), dtype=np.int64), np.empty(len(owner), dtype=np.int64)
    has_slope = np.array([len(kind.vectors) == 3 for kind in kinds])[owner]
    for slope, names in ((False, ("r", "r_y")), (True, ("r", "r_x", "r_y"))):
        for code in range(ROTATED_GRADIENTS + 1):
            rows = (has_slope == slope) & (node_kind == code)
            if not rows.any():
                continue
            own_names = labels(code, names)
            owned[rows, : len(own_names)] = True
            last[rows] = len(own_names) - 1
            turn_size[rows] = 1 if own_names[-1] == "theta" else 2
    return owned, last, turn_size


def _frames(grids: Sequence[Grid], numbered: Numbered) -> np.ndarray:
    """Return cosine and sine of the reference angle, and |r_x|, of each node (total, 3).

    For rotated gradients, the angle is relative to that of the node whose r_y they share.
    """
    turned, leader = numbered.turned, numbered.turns_with
    frame = np.empty((len(leader), 3))
    frame[:, :2] = np.concatenate([grid.tangent for grid in grids])
    frame[:, 2] = np.concatenate([grid.speed for grid in grids])
    if not len(turned):
        return frame
    angle = np.concatenate([reference_angle(grid) for grid in grids])
    between = angle[turned] - angle[leader[turned]]
    frame[turned, 0], frame[turned, 1] = np.cos(between), np.sin(between)
    return frame
