"""Places at which supports, loads and connectors act on beams, and what they do there in the rows of a solution."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import length_points, reference_position
from beamfem.model.beam import Beam, Point
from beamfem.model.contribution import Contribution
from beamfem.model.load_base import Load, factor
from beamfem.model.model import Model
from beamfem.model.state_protocols import in_plane
from beamfem.model.supports import DIRECTIONS, LineSupport, PointSupport
from beamfem.parts.at_points import PartAlongBeam
from beamfem.results import postprocess
from beamfem.results.reactions import reaction_of
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.results.stations import StationsOfRows
from beamfem.validation import require_known

# values of a vertex by name, and how many components each has
COMPONENTS = {"force": 3, "moment": 1, "line_force": 3, "acceleration": 3, "prescribed": 3, "stiffness": 3}
ROLES = ("support", "load", "connector")
_SUPPORT, _LOAD, _CONNECTOR = range(3)
_ACTION = ("force", "moment")
_Values = dict[str, np.ndarray]


@dataclass(frozen=True, eq=False)
class Vertices:
    """Places (n,) of a beam at which something acts: its class, its role and its values (steps, n, components).

    fields: names of the values.
    """

    kind: str
    role: int
    fields: tuple[str, ...]
    mesh: BeamMesh
    element: np.ndarray
    xi: np.ndarray
    values: Callable[[Solution], _Values]


def vertices(model: Model) -> list[Vertices]:
    """Return the vertices of all that acts on the beams of a model."""
    return [*_supports(model), *_loads(model), *_connectors(model)]


def flat(vectors: np.ndarray) -> np.ndarray:
    """Return vectors of the plane (..., 2) with a third component, zero."""
    return np.pad(vectors, [(0, 0)] * (vectors.ndim - 1) + [(0, 1)])


def _at(model: Model, point: Point) -> tuple[BeamMesh, np.ndarray, np.ndarray]:
    mesh = model.mesh_of(point)
    element, xi = mesh.locate(point.fraction)
    return mesh, np.array([element]), np.array([xi])


def _along(model: Model, beam: Beam) -> tuple[BeamMesh, np.ndarray, np.ndarray]:
    mesh = model.meshes[model.number_of(beam)]
    element, xi, _ = length_points(mesh)
    return mesh, element, xi


def _supports(model: Model) -> Iterator[Vertices]:
    """Yield one vertex for each point that is supported, since its reaction is that of all supports there."""
    at_node: dict[tuple[int, int], list[PointSupport]] = {}
    for support in model.point_supports:
        beam, fraction = support.point.beam, support.point.fraction
        at_node.setdefault((id(beam), model.mesh_of(support.point).node_at(fraction)), []).append(support)
    for supports in at_node.values():
        kind = " + ".join(dict.fromkeys(type(support).__name__ for support in supports))
        fixed = _fixed(supports)
        place = _at(model, supports[0].point)
        yield Vertices(kind, _SUPPORT, (*_ACTION, *fixed), *place, _reaction(supports, fixed))
    for foundation in model.line_supports:
        place = _along(model, foundation.beam)
        yield Vertices(type(foundation).__name__, _SUPPORT, ("line_force",), *place, _of_foundation(foundation, *place))


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


def _reaction(supports: list[PointSupport], fixed: _Values) -> Callable[[Solution], _Values]:
    def values(part: Solution) -> _Values:
        reactions = reaction_of(part, supports)[:, None]
        constant = {name: np.tile(array, (len(part), 1, 1)) for name, array in fixed.items()}
        return {"force": flat(reactions[..., :2]), "moment": reactions[..., 2:], **constant}

    return values


def _of_foundation(
    foundation: LineSupport, mesh: BeamMesh, element: np.ndarray, xi: np.ndarray
) -> Callable[[Solution], _Values]:
    stiffness = np.array(foundation.stiffness)
    start = reference_position(mesh, element, xi)

    def values(part: Solution) -> _Values:
        position = postprocess.axis(mesh, postprocess.nodal_vectors(mesh, part.p), element, xi).r
        return {"line_force": flat(-stiffness * (position - start))}

    return values


def _loads(model: Model) -> Iterator[Vertices]:
    """Yield the vertices of the loads; strains that are imposed act nowhere from outside."""
    named = [(type(load).__name__, part) for load in model.loads for part in load.parts if isinstance(part, Load)]
    for kind, load in named:
        for mesh, element, xi in _loaded(model, load.place):
            acting = load.acting(mesh.arc_length(element, xi))
            for name in acting:
                require_known(f"acting of {kind} has the unknown quantity {name!r}", name, COMPONENTS)
            if acting:
                place = mesh, element, xi
                yield Vertices(kind, _LOAD, tuple(acting), *place, _of_load(load, acting, *place))


def _loaded(model: Model, place: Beam | Point | None) -> list[tuple[BeamMesh, np.ndarray, np.ndarray]]:
    """Return where a load acts: at a point, along a beam, or for all mass in the middle of every beam."""
    if place is None:
        return [_at(model, beam.at(0.5)) for beam in model.beams]
    return [_at(model, place) if isinstance(place, Point) else _along(model, place)]


def _of_load(
    load: Load, acting: Mapping[str, np.ndarray], mesh: BeamMesh, element: np.ndarray, xi: np.ndarray
) -> Callable[[Solution], _Values]:
    def values(part: Solution) -> _Values:
        system, times = loading(part)
        factors = np.array([factor(load, float(time), system.static) for time in times])[:, None, None]
        stations = StationsOfRows(part, mesh, element, xi)
        sized = {name: factors * numbers for name, numbers in acting.items()}
        return {
            name: flat(in_plane(numbers, load.axes, stations)) if numbers.shape[-1] == 2 else numbers
            for name, numbers in sized.items()
        }

    return values


def _connectors(model: Model) -> Iterator[Vertices]:
    for connector in model.at_points:
        if isinstance(connector, PartAlongBeam):
            continue  # acts along a beam
        for number, point in enumerate(connector.points):
            values = _of_connector(connector, number)
            yield Vertices(type(connector).__name__, _CONNECTOR, _ACTION, *_at(model, point), values)


def _of_connector(connector: Contribution, number: int) -> Callable[[Solution], _Values]:
    def values(part: Solution) -> _Values:
        forces = part.connector_force(connector)[:, number : number + 1]
        return {"force": flat(forces[..., :2]), "moment": forces[..., 2:]}

    return values
