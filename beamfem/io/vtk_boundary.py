"""Supports, loads and connectors in ParaView files: a vertex for each place, with what acts on the beam there."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from beamfem.equations.connectors import connectors_of
from beamfem.io.vtk_cells import VERTEX, Content, legend_of_beams
from beamfem.mesh.reference import length_points
from beamfem.model.beam import Beam, Point
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load, PointLoad, factor
from beamfem.model.model import Model
from beamfem.model.state_protocols import in_plane
from beamfem.model.supports import DIRECTIONS, LineSupport, PointSupport
from beamfem.parts.at_points import PartAlongBeam
from beamfem.parts.motor import Motor
from beamfem.results.axis_points import AxisPoints
from beamfem.results.full_turns import StationsOfRows
from beamfem.results.reactions import connector_force, force_of_load, is_determined, joint_force, reaction_of
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.validation import require_known

# values of a vertex by name, and how many components each has
_COMPONENTS = {"force": 3, "moment": 1, "line_force": 3, "acceleration": 3, "prescribed": 3, "stiffness": 3}
ROLES = ("support", "load", "connector")
_SUPPORT, _LOAD, _CONNECTOR = range(3)
_ACTION = ("force", "moment")
_Values = dict[str, np.ndarray]


@dataclass(frozen=True, eq=False)
class _Vertices:
    """Places (n,) of a beam at which something acts: its class, its role and its values (steps, n, components).

    fields: names of the values.
    """

    kind: str
    role: int
    fields: tuple[str, ...]
    points: AxisPoints
    values: Callable[[Solution], _Values]


def _flat(vectors: np.ndarray) -> np.ndarray:
    """Return vectors of the plane (..., 2) with a third component, zero."""
    return np.pad(vectors, [(0, 0)] * (vectors.ndim - 1) + [(0, 1)])


def _at(model: Model, point: Point) -> AxisPoints:
    return AxisPoints.at(model.mesh_of(point), [point.fraction])


def _along(model: Model, beam: Beam) -> AxisPoints:
    mesh = model.meshes[model.number_of(beam)]
    return AxisPoints(mesh, *length_points(mesh)[:2])


def _supports(model: Model) -> Iterator[_Vertices]:
    """Yield one vertex for each point that is supported, since its reaction is that of all supports there."""
    at_node: dict[tuple[int, int], list[PointSupport]] = {}
    for support in model.point_supports:
        beam, fraction = support.point.beam, support.point.fraction
        at_node.setdefault((id(beam), model.mesh_of(support.point).node_at(fraction)), []).append(support)
    for supports in at_node.values():
        kind = " + ".join(dict.fromkeys(model.name_of(each) for each in supports))
        fixed = _fixed(supports)
        points = _at(model, supports[0].point)
        yield _Vertices(
            kind, _SUPPORT, (*_ACTION, *fixed), points, partial(_acting, partial(reaction_of, own=supports), fixed)
        )
    for foundation in model.line_supports:
        kind, points = type(foundation).__name__, _along(model, foundation.beam)
        yield _Vertices(kind, _SUPPORT, ("line_force",), points, partial(_of_foundation, foundation, points))


def _fixed(supports: list[PointSupport]) -> _Values:
    """Return which directions the supports of a point prescribe, and the stiffness of their springs (3,), if any."""
    prescribed, stiffness = np.zeros(3), np.zeros(3)
    for support in supports:
        for name in support.prescribed():
            if support.direction is not None and name == "normal":
                prescribed[:2] = support.direction
            else:
                prescribed[DIRECTIONS.index(name)] = 1.0
        for name, value in support.springs().items():
            stiffness[DIRECTIONS.index(name)] += value
    return {name: array for name, array in (("prescribed", prescribed), ("stiffness", stiffness)) if array.any()}


def _of_foundation(foundation: LineSupport, points: AxisPoints, part: Solution) -> _Values:
    moved = points.positions(part.p)[0] - points.reference
    return {"line_force": _flat(-np.array(foundation.stiffness) * moved)}


def _loads(model: Model) -> Iterator[_Vertices]:
    """Yield the vertices of the loads; strains that are imposed act nowhere from outside."""
    for load in (part for whole in model.loads for part in whole.parts if isinstance(part, Load)):
        kind, where = model.name_of(load), load.place
        if where is None:  # all mass, drawn in the middle of every beam
            places = [_at(model, beam.at(0.5)) for beam in model.beams]
        else:
            places = [_at(model, where) if isinstance(where, Point) else _along(model, where)]
        for points in places:
            acting = load.acting(points.arc_length)
            for name in acting:
                require_known(f"acting of {kind} has the unknown quantity {name!r}", name, _COMPONENTS)
            if acting:
                yield _Vertices(kind, _LOAD, tuple(acting), points, partial(_of_load, load, acting, points))


def _of_load(load: Load, acting: Mapping[str, np.ndarray], points: AxisPoints, part: Solution) -> _Values:
    system, times = loading(part)
    factors = np.array([factor(load, float(time), system.static) for time in times])[:, None, None]
    stations, result = StationsOfRows(part, points), {name: factors * numbers for name, numbers in acting.items()}
    for name, numbers in result.items():
        result[name] = _flat(in_plane(numbers, load.axes, stations)) if numbers.shape[-1] == 2 else numbers
    return result


def _connectors(model: Model) -> Iterator[_Vertices]:
    for connector in model.at_points:
        kind, points = model.name_of(connector), list(enumerate(connector.points))
        if isinstance(connector, PartAlongBeam):  # what acts on its nodes, or on the point that slides along the beam
            items = (item.item for item in connectors_of(model, static=True).items if item.given is connector)
            nodes = (point for item in items for point in item.points)
            points = points[1:] if connector.unknowns else list(enumerate(nodes))
        acting = partial(connector_force, connector=connector)
        for number, point in points:

            def force(
                part: Solution, acting: Callable[[Solution], np.ndarray] = acting, at: int = number
            ) -> np.ndarray:
                return part.computed(acting)[:, at]

            yield _Vertices(kind, _CONNECTOR, _ACTION, _at(model, point), partial(_acting, force, {}))


def _joints(model: Model, joints: Iterable[Joint]) -> Iterator[_Vertices]:
    """Yield the vertices of joints at which beams share coordinates."""
    for joint in joints:
        on_b = partial(joint_force, joint=joint)
        for sign, point in ((-1.0, joint.a), (1.0, joint.b)) if is_determined(model, joint) else ():

            def force(part: Solution, sign: float = sign, on_b: Callable[[Solution], np.ndarray] = on_b) -> np.ndarray:
                return sign * part.computed(on_b)

            values = partial(_acting, force, {})
            yield _Vertices(type(joint).__name__, _CONNECTOR, _ACTION, _at(model, point), values)


def _acting(forces: Callable[[Solution], np.ndarray], besides: _Values, part: Solution) -> _Values:
    """Return force and moment of forces (steps, 3), and values (3,) that are the same in each step."""
    both = forces(part)[:, None]
    constant = {name: np.tile(values, (len(part), 1, 1)) for name, values in besides.items()}
    return {"force": _flat(both[..., :2]), "moment": both[..., 2:], **constant}


def _torques(model: Model) -> Iterator[_Vertices]:
    """Yield the vertices of motors whose torque does not depend on the state."""
    for load in (part for motor in model.loads if isinstance(motor, Motor) for part in motor.parts):
        if isinstance(load, PointLoad):
            acting = partial(_acting, partial(force_of_load, load=load), {})
            yield _Vertices(model.name_of(load), _LOAD, _ACTION, _at(model, load.point), acting)


def points_of_forces(model: Model) -> list[_Vertices]:
    """Return a vertex for each point at which a support, motor, connector or joint acts, with force and moment."""
    groups = [*_supports(model), *_torques(model), *_connectors(model), *_joints(model, model.shared_joints)]
    return [each for each in groups if "force" in each.fields]


class Boundary:
    """The vertices of a model, with the attributes of `Cells`."""

    cell_type, degrees = VERTEX, None

    def __init__(self, model: Model, content: Content) -> None:
        self.content, self.beams, self.unit = content, model.beams, model.unit
        self.groups = [*_supports(model), *_loads(model), *_connectors(model)]
        # the section forces of the beams say what rigid ones transmit
        self.groups += _joints(model, (joint for joint in model.shared_joints if not joint.keeps_angle))
        numbers = {id(mesh): number for number, mesh in enumerate(model.meshes)}
        kinds = list(dict.fromkeys(group.kind for group in self.groups))
        self._sizes = [len(group.points.xi) for group in self.groups]
        self.points = sum(self._sizes)
        self.connectivity, self.offsets = np.arange(self.points), np.arange(self.points + 1)
        beam = [numbers[id(group.points.mesh)] for group in self.groups]
        kind, role = [kinds.index(group.kind) for group in self.groups], [group.role for group in self.groups]
        # cell data (cells,) by name, and names of these numbers
        self.numbers = {
            name: np.repeat(np.array(values, dtype=np.int64), self._sizes)
            for name, values in (("beam", beam), ("kind", kind), ("role", role))
        }
        self.legend = {**legend_of_beams(self.beams), "kinds": kinds, "roles": list(ROLES)}

    @property
    def names(self) -> list[str]:
        """The fields that there are."""
        present = {name for group in self.groups for name in group.fields}
        return ["displacement", *(name for name in _COMPONENTS if name in present)]

    def arrays(self, solution: Solution, rows: slice) -> dict[str, np.ndarray]:
        """Return points and fields (steps, points) and (steps, points, 3) of some rows; what nothing has is left out.

        A displacement is that of the axis; what does not apply at a vertex is zero there.
        """
        part, chosen = solution[rows], self.content.chosen(self.names)
        at_rest = _flat(np.concatenate([np.empty((0, 2)), *(group.points.reference for group in self.groups)]))
        moved = [np.empty((len(part), 0, 2)), *(group.points.positions(part.p)[0] for group in self.groups)]
        position = _flat(np.concatenate(moved, axis=1))
        result = {"points": position, "displacement": position - at_rest}
        names = [name for name in chosen if name in _COMPONENTS]
        values = [group.values(part) for group in self.groups] if names else []
        for name in names:
            sizes, shape = zip(values, self._sizes, strict=True), (len(part), _COMPONENTS[name])
            parts = [own[name] if name in own else np.zeros((shape[0], size, shape[1])) for own, size in sizes]
            table = np.concatenate(parts, axis=1)
            result[name] = table if shape[1] == 3 else table[..., 0]
        return self.content.finished({name: result[name] for name in ("points", *chosen)}, at_rest[None])
