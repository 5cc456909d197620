"""The nodes that the parts of a model act on, and the numbers of their coordinates, multipliers and history."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.element.fields import r_slots, rule_of
from beamfem.equations.bound_connector import Connector
from beamfem.equations.connector_traits import TIMES, gravity_of, somewhere_near
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import jacobians, length_points, reference_vectors, scales
from beamfem.model.beam import Point
from beamfem.model.contribution import Contribution, amplitudes_of, prescribed_by, remembered, uses_rotations
from beamfem.model.model import Model
from beamfem.parts.at_points import AxisRows, PartAlongBeam, PartAtPoints, Station
from beamfem.physics.stations import GENERATED

_COORDINATES = ("r^x", "r^y", "theta")
_TURNED = np.array([0.0, 0.0, 0.1])  # arbitrary


def checked_connectors(model: Model) -> tuple[Connector, ...]:
    """Return the connectors of a model, evaluated once to check shapes and finite values."""
    amplitude, first, connectors = model.coordinates - sum(map(amplitudes_of, model.at_points)), model.coordinates, []
    value = first_value(model)
    behind = value + sum(len(prescribed_by(item)) for item in model.at_points)
    for given in model.at_points:
        for item, nodes in _with_nodes(given, model):
            dofs, positions = [], []
            for mesh, node, *slope in nodes:
                numbers, place = mesh.coordinates_of(node), slope[0] if slope else mesh.position[node].tolist()
                names = ("r_x^x", "r_x^y") if slope else _COORDINATES[: 3 if uses_rotations(item) else 2]
                dofs += [numbers[name] for name in names]
                positions.append([*place, 0.0])
            dofs += range(amplitude, amplitude + amplitudes_of(item))
            positions += [[0.0] * 3] * -(-amplitudes_of(item) // 3)
            amplitude += amplitudes_of(item)
            values = len(prescribed_by(item))
            own = np.concatenate([np.arange(first, first + item.unknowns), np.arange(value, value + values)])
            first, value = first + item.unknowns, value + values
            memory = np.arange(behind, behind + len(remembered(item)))
            behind += len(memory)
            place = np.array(dofs, dtype=np.int64), own, memory, np.array(positions)
            connectors.append(Connector(item, *place, given, model.name_of(given)))
    for connector in connectors:
        if connector.compiled is None:
            _require_finite(connector.alone)
        elif connector.compiled not in GENERATED:
            _require_usable(connector.alone)
    return tuple(connectors)


def first_value(model: Model) -> int:
    """Return the number of the first coordinate that is a prescribed value of a condition; they follow multipliers."""
    return model.coordinates + sum(item.unknowns for item in model.at_points)


_Nodes = list[tuple[Any, ...]]  # a mesh and a node, and the reference slope if r_x is meant


def _with_nodes(given: Contribution, model: Model) -> list[tuple[Contribution, _Nodes]]:
    """Return a part with its nodes; of one along a beam, what acts at its nodes and quadrature points."""
    if not isinstance(given, PartAlongBeam):
        places = [(model.mesh_of(point), point.fraction) for point in given.points]
        return [(given, [(mesh, mesh.node_at(fraction)) for mesh, fraction in places])]
    mesh = model.mesh_of(given.beam.start)
    element = mesh.beam.element
    if given.rotations and any("theta" not in mesh.coordinates_of(node) for node in range(mesh.nodes)):
        raise InputError(
            f"{type(given).__name__} acts on rotations along a beam, and the nodes of {element.name} have none; take "
            "an element with rotations, such as CRBF"
        )
    xi, weights = rule_of(element.field)
    lengths, arcs = np.zeros(len(mesh.position)), np.zeros(len(mesh.position))
    np.add.at(lengths, mesh.node, mesh.lengths[:, None] * weights)
    elements = np.repeat(np.arange(mesh.elements), len(xi))
    arcs[mesh.node.ravel()] = mesh.arc_length(elements, np.tile(xi, mesh.elements))
    points = [given.beam.at(min(arc / given.beam.curve.length, 1.0)) for arc in arcs.tolist()]
    if type(given).on_axis is not PartAlongBeam.on_axis:
        return [_on_axis(given, mesh, points, model)]
    at_nodes = [(item, [(mesh, node)]) for node, item in enumerate(given.at_nodes(points, lengths))]
    return [*at_nodes, *_at_stations(given, mesh, points)]


def _on_axis(given: PartAlongBeam, mesh: BeamMesh, points: list[Point], model: Model) -> tuple[Contribution, _Nodes]:
    """Return what acts on the axis of a beam and on a point, with its rows: the first node, the point, the others."""
    element, field, point = mesh.beam.element, mesh.beam.element.field, given.points[1]
    wanted = [name for name in field.vectors if name in ("r", "r_x")]
    without = [node for node in range(mesh.nodes) if any(f"{name}^x" not in mesh.labels(node) for name in wanted)]
    if without:
        x, y = mesh.position[without[0]].tolist()
        raise InputError(
            f"{type(given).__name__} needs r_x as a coordinate, which the node of {element.name} at ({x:g}, {y:g}) "
            "does not have, by its element or as its rotation is fixed; take another element, such as CRBF(3)"
        )
    vectors = reference_vectors(mesh, np.arange(mesh.elements)).reshape(*mesh.node.shape, -1, 2)
    slope = np.zeros((mesh.nodes, 2))
    slope[mesh.node] = vectors[:, :, len(wanted) - 1]
    other = model.mesh_of(point)
    rows: _Nodes = [(mesh, node) for node in range(mesh.nodes)]
    rows.insert(1, (other, other.node_at(point.fraction)))
    rows += [(mesh, node, slope[node].tolist()) for node in range(mesh.nodes) if "r_x" in wanted]
    places = np.stack([mesh.node + (mesh.node > 0), mesh.node + mesh.nodes + 1][: len(wanted)], axis=2)
    scale = scales(element, mesh.lengths)[:, r_slots(field)]
    axis = AxisRows(field, places.reshape(mesh.elements, -1), scale, (points[0], point, *points[1:]))
    return given.on_axis(axis), rows


def _at_stations(given: PartAlongBeam, mesh: BeamMesh, points: Sequence[Point]) -> list[tuple[Contribution, _Nodes]]:
    """Return what acts at the quadrature points of a part along a beam, with the nodes of the element."""
    if type(given).at_stations is PartAlongBeam.at_stations:
        return []
    field = mesh.beam.element.field
    if "r_x" in field.vectors:
        raise InputError(
            f"{type(given).__name__} acts at stations along a beam, which the {field.name} field with r_x does "
            "not have; take elements of an order, such as CRBF(3)"
        )
    element, xi, weight = length_points(mesh)
    slopes = field.centreline(xi, 1) / jacobians(mesh, element, xi)[0][:, None]
    nodes = mesh.node[element]
    rows = zip(nodes.tolist(), field.centreline(xi), slopes, weight.tolist(), strict=True)
    stations = [Station(tuple(points[node] for node in own), *row) for own, *row in rows]
    found = given.at_stations(stations)
    if len(found) != len(stations):
        raise InputError(
            f"at_stations of {type(given).__name__} must return a part for each of {len(stations)}, got {len(found)}"
        )
    return [(item, [(mesh, node) for node in own]) for own, item in zip(nodes.tolist(), found, strict=True)]


def _require_finite(item: Connector) -> None:
    """Raise InputError if the force of a connector is not finite near the reference, or a shape is wrong.

    Points are turned even without rotations, so that moments which rotations would cause are refused too.
    """
    at = item.at(somewhere_near(item), TIMES[0], gravity_of(item))
    if item.per_point == 2:
        at = replace(at, q=at.q + _TURNED, v=at.v + _TURNED, a=at.a + _TURNED)
    if not (np.isfinite(item.force(at)).all() and np.isfinite(item.energy(at)).all()):
        raise InputError(f"force or energy of {item.name} is not finite near the reference")


def _require_usable(item: Connector) -> None:
    """Raise InputError if a part in formulas or C has numbers that are not finite at the start, or lacks a potential.

    Motions judge their steps by the energy, in which the work of a force without its potential would be missing.
    """
    p, v, a = somewhere_near(item)
    gravity, still, definition = gravity_of(item), np.zeros_like(p), item.compiled
    if definition is not None and item.item.conservative and type(item.item).energy is PartAtPoints.energy:
        none = definition.potential is definition.kinetic is None and not definition.multipliers
        if none and item.force_in((p, still, still), TIMES[0], gravity).any():
            raise InputError(
                f"{item.name} is conservative, but {definition.name} has a force at rest without its potential; give "
                f"the potential as well, or {item.name} conservative = False"
            )
    p[item.dofs] = item.undeformed
    try:
        item.tangent((p, v, a), TIMES[0], gravity, (1.0, 0.0, 0.0))
    except LinAlgError:
        raise InputError(f"force of {item.name} or its derivative is not finite in the reference") from None
    with np.errstate(all="ignore"):
        item.remember(item.at((p, v, a), TIMES[0], gravity))
