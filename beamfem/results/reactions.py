"""Forces that supports, connectors and joints exert on beams; energies of connectors."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from beamfem.element.fields import cross
from beamfem.equations.bound_connector import Connector
from beamfem.equations.equations import residual
from beamfem.equations.frame_inertia import seen_from_rest
from beamfem.equations.model_coordinates import COORDINATES, coordinate_of
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Point
from beamfem.model.contribution import Contribution
from beamfem.model.imposed_strains import ImposedStrain
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load, PointLoad, factor
from beamfem.model.model import Model
from beamfem.model.supports import PointSupport
from beamfem.parts.at_points import BetweenPlaces
from beamfem.parts.motor import Motor
from beamfem.results.free_bodies import Parted, Rows, cut_free
from beamfem.results.section_forces import of_elements
from beamfem.results.solution import Solution
from beamfem.results.solution_system import exactly, loading
from beamfem.validation import shown


def reaction(solution: Solution, point: Point) -> np.ndarray:
    """Return fx, fy [N] and m [N m] of the supports and springs at a point of a beam (steps, 3).

    Supports at joined points of other beams are not included. Raises InputError if the point has no support.
    """
    model = solution.model
    model.mesh_of(point)  # refuses what is no point of this model
    supports = model.supports_along.near(point, 1e-9)
    if not supports:
        raise InputError(f"there is no support at {point}, so there is no reaction")
    return reaction_of(solution, supports)


def reaction_of(solution: Solution, own: Sequence[PointSupport]) -> np.ndarray:
    """Return fx, fy [N] and m [N m] (steps, 3) of all supports at one point of a beam."""
    point = own[0].point
    mesh = solution.model.mesh_of(point)
    dofs = mesh.coordinates_of(mesh.node_at(point.fraction))
    prescribed = {coordinate_of(support, direction) for support in own for direction in support.prescribed()}
    if None in prescribed:  # an inclined roller
        prescribed |= {"r^x", "r^y"}
    result = np.zeros((len(solution), 3))
    for column, (direction, name) in enumerate(COORDINATES.items()):
        if name in dofs:
            stiffness = sum(support.springs().get(direction, 0.0) for support in own)
            result[:, column] = _of_some(solution, dofs[name], name in prescribed, stiffness)
    return result


def _of_some(solution: Solution, dof: int, prescribed: bool, stiffness: float) -> np.ndarray:
    """Return the force (steps,) of supports with this stiffness on a coordinate, prescribed by them or not."""
    system, _ = loading(solution)
    moved = solution.p[:, dof] - system.reference[dof] + solution.remainders[:, dof]
    if not prescribed:
        return np.asarray(-stiffness * moved)
    others = float(system.springs.data[system.springs.numbers[:, 0] == dof, 0].sum()) - stiffness
    return np.asarray(solution.support_forces[:, dof] + others * moved)


def support_forces(solution: Solution) -> np.ndarray:
    """Return the generalized forces (steps, n) that supports and springs exert on every coordinate."""
    system, times = loading(solution)
    prescribed = np.zeros(solution.model.size, dtype=bool)
    prescribed[[*system.prescribed_dofs, *(dof + axis for dof, _ in system.inclined for axis in (0, 1))]] = True

    def forces(p: np.ndarray) -> np.ndarray:
        result = np.zeros(p.shape)
        for row, at in enumerate(times):
            result[row] = np.where(prescribed, residual(system, p[row], solution.v[row], solution.a[row], at), 0.0)
            np.subtract.at(result[row], system.springs.numbers, system.springs.forces(p[row]))
        return result

    return exactly(solution, forces)


def connector_force(solution: Solution, connector: Contribution) -> np.ndarray:
    """Return the forces of a connector on its points (steps, m, 3): fx, fy [N], moment [N m]. Raises InputError.

    Of a part along a beam, the points are the nodes of the beam.
    """
    return forces_at(solution, _bound(solution, connector))


def forces_at(solution: Solution, items: Sequence[Connector]) -> np.ndarray:
    """Return the forces of connectors on their points (steps, m, 3): fx, fy [N], moment [N m]."""
    system, times = loading(solution)
    forces = []
    v, a = seen_from_rest(system, solution.p, solution.v, solution.a, times)
    for *state, at in zip(solution.p, v, a, times.tolist(), strict=True):
        motion, gravity = (state[0], state[1], state[2]), system.connectors.gravity(at)
        acting = ((item, -item.force_in(motion, at, gravity)[: len(item.dofs)]) for item in items)
        forces.append([item.on_points(force, item.by_point(state[0][item.dofs])) for item, force in acting])
    return np.array(forces).reshape(len(solution), -1, 3)


def multipliers(solution: Solution, connector: Contribution) -> np.ndarray:
    """Return the additional unknowns of a connector (steps, k), such as multipliers. Raises InputError."""
    numbers = np.concatenate([item.multipliers for item in _bound(solution, connector)])
    if not len(numbers):
        raise InputError(
            f"{type(connector).__name__} has no multipliers",
            remedy="solution.joint_force(part) is the force that a part between two places exerts on the second one, "
            "solution.connector_force(part) on each of its points",
        )
    return solution.p[:, numbers]


def history(solution: Solution, connector: Contribution) -> dict[str, np.ndarray]:
    """Return the history variables of a connector by name (steps,), see `Solution.history`. Raises InputError."""
    item, *others = _bound(solution, connector)
    if others or not len(item.memory):
        raise InputError(f"{type(connector).__name__} has no history")
    names = item.compiled.memory if item.compiled is not None else map(str, range(len(item.memory)))
    return dict(zip(names, solution.p[:, item.memory].T, strict=True))


def _bound(solution: Solution, connector: Any) -> list[Connector]:
    bound = [item for item in loading(solution)[0].connectors.items if item.given is connector]
    if bound:
        return bound
    raise InputError(f"{shown(connector)} is not a connector of this model; use one of model.connectors")


def energies_of_part(solution: Solution, part: Any) -> np.ndarray:
    """Return kinetic and potential energy [J], and power [W], of a connector, mass, motor or load (steps, 3)."""
    if isinstance(part, Motor) and any(part is load for load in solution.model.loads):
        signs = (-1.0, 1.0)[-len(part.points) :]
        speeds = [sign * solution.angular_velocity(point) for sign, point in zip(signs, part.points, strict=True)]
        return np.column_stack([np.zeros((len(solution), 2)), _of_motor(solution, part)[:, 2] * sum(speeds)])
    system, times = loading(solution)
    power = np.zeros(len(solution))
    if isinstance(part, Load) and not isinstance(part, ImposedStrain) and any(part is x for x in solution.model.loads):
        chosen = np.array([any(each is x for x in part.parts) for each in solution.model.acting])
        for row, (p, v, a, at) in enumerate(zip(solution.p, solution.v, solution.a, times.tolist(), strict=True)):
            factors = np.where(chosen, system.loads.factors(at), 0.0)
            loads = (system.loads.of(at, each) for each in (factors, 0.0 * factors))
            acting, none = (residual(system, p, v, a, at, loads=each) for each in loads)
            power[row] = (none - acting) @ v
        return np.column_stack([np.zeros((len(solution), 2)), power])
    items = _bound(solution, part)
    for row, (p, v, a, at) in enumerate(zip(solution.p, solution.v, solution.a, times.tolist(), strict=True)):
        gravity = system.connectors.gravity(at)
        for item in items:
            power[row] -= item.force_in((p, v, a), at, gravity)[: len(item.dofs)] @ v[item.dofs]
    own = replace(system.connectors, items=tuple(items))
    return np.column_stack([own.energies((solution.p, solution.v, solution.a), times), power])


Node = tuple[int, int]  # number of the beam, and of its node


def joint_force(solution: Solution, joint: Joint | Contribution | Load) -> np.ndarray:
    """Return fx, fy [N] and m [N m] (steps, 3) of a joint on its second party, see `Solution.joint_force`."""
    for item in solution.model.shared_joints:
        if item is joint:
            return _of_cut(solution, item)
    for load in solution.model.loads:
        if load is joint and isinstance(load, Motor):
            return _of_motor(solution, load)
    for part in solution.model.at_points:
        if part is joint and len(part.points) == 2 and len(_bound(solution, part)) == 1:
            return connector_force(solution, part)[:, 1]
        if part is joint and isinstance(part, BetweenPlaces):
            return 0.0 - connector_force(solution, part)[:, 0]
    raise InputError(
        f"{shown(joint)} is neither a joint, a motor nor a connector of two points of this model; use one of "
        "model.joints"
    )


def tension(solution: Solution, part: Contribution) -> np.ndarray:
    """Return the tension (steps,) [N] of a connector between two places, from its force on the second one.

    Raises InputError for other parts.
    """
    if not isinstance(part, BetweenPlaces) or part.distance == 0.0:
        raise InputError(f"{shown(part)} does not lie between two places, so that it has no tension")
    force, start = joint_force(solution, part)[:, :2], solution.position(part.a)
    way = start - (solution.position(part.b) if isinstance(part.b, Point) else np.array(part.b))
    return np.einsum("sc,sc->s", force, way) / np.linalg.norm(way, axis=1)


def is_determined(model: Model, joint: Joint) -> bool:
    """Return whether no other joints connect the points of a joint too, so that its force is determined."""
    try:
        return bool(_side(model, joint))
    except InputError:
        return False


def _of_motor(solution: Solution, motor: Motor) -> np.ndarray:
    """Return the torque of a motor (steps, 3)."""
    last = motor.parts[-1]
    if isinstance(last, PointLoad):
        return force_of_load(solution, last)
    if not isinstance(last, PointSupport):
        return connector_force(solution, last)[:, -1]
    return reaction_of(solution, [last]) * (0.0, 0.0, 1.0)


def _of_cut(solution: Solution, joint: Joint) -> np.ndarray:
    """Return the force that balances all else that acts on the nodes on the second side of a joint."""
    side = _side(solution.model, joint)
    result = np.zeros((len(solution), 3))
    for node, point in side.items():
        result -= _of_elements(solution, *node)
        if supports := solution.model.supports_along.near(point, 1e-9):
            result -= reaction_of(solution, supports)
    for load in solution.model.point_loads:
        if _node(solution.model, load.point) in side:
            result -= force_of_load(solution, load)
    for item in loading(solution)[0].connectors.items:
        for number, point in enumerate(item.item.points):
            if _node(solution.model, point) in side:
                result -= forces_at(solution, [item])[:, number]
    if not joint.keeps_angle:
        result[:, 2] = 0.0
    return result


def _node(model: Model, point: Point) -> Node:
    number = model.number_of(point.beam)
    return number, model.meshes[number].node_at(point.fraction)


def _side(model: Model, joint: Joint) -> dict[Node, Point]:
    """Return the nodes that a joint and those beyond it connect to its first party. Raises InputError for a loop."""
    beyond: defaultdict[Node, list[Point]] = defaultdict(list)
    for other in model.shared_joints:
        if other is not joint:
            beyond[_node(model, other.a)].append(other.b)
            beyond[_node(model, other.b)].append(other.a)
    found, left = {_node(model, joint.b): joint.b}, [joint.b]
    while left:
        for point in beyond[_node(model, left.pop())]:
            if (node := _node(model, point)) not in found:
                found[node] = point
                left.append(point)
    if _node(model, joint.a) in found:
        raise InputError(
            f"other joints connect the points of {type(joint).__name__} at {joint.a} too, so that its force is not "
            "determined",
            remedy="join n beams at one place by n - 1 joints",
        )
    return found


def _of_elements(solution: Solution, number: int, node: int) -> np.ndarray:
    """Return the force of the elements of a beam (steps, 3) on one of its nodes, inertia and loads along it included.

    Like that of a section, the moment is about the node itself.
    """
    mesh = solution.model.meshes[number]
    elements = np.flatnonzero((mesh.node[:, 0] == node) | (mesh.node[:, -1] == node))
    return of_elements(solution, mesh, elements, partial(_on_node, mesh, elements, node), (3,))


def _on_node(mesh: BeamMesh, elements: np.ndarray, node: int, rows: Rows, own: Parted, p: np.ndarray) -> np.ndarray:
    bodies = cut_free(rows, mesh, elements, own, p)
    result = np.zeros((len(p), 3))
    arm = bodies.vectors[:, :, -len(mesh.vectors)] - bodies.vectors[:, :, 0]
    for number, element in enumerate(elements.tolist()):
        (at_start, at_end), (turn, turn_at_end) = bodies.force[:, :, number], bodies.moment[:, :, number]
        if mesh.node[element, 0] == node:
            result += np.column_stack([at_start, turn])
        if mesh.node[element, -1] == node:
            result -= np.column_stack([at_end, turn_at_end - cross(arm[:, number], at_end)])
    return result


def force_of_load(solution: Solution, load: PointLoad) -> np.ndarray:
    """Return the force and the moment (steps, 3) of a load at a point."""
    system, times = loading(solution)
    factors = np.array([factor(load, float(time), system.static) for time in times])
    force = factors[:, None] * np.array(load.value)
    if load.follower:
        c, s = np.cos(turn := solution.rotation(load.point)), np.sin(turn)
        force[:, :2] = np.column_stack([c * force[:, 0] - s * force[:, 1], s * force[:, 0] + c * force[:, 1]])
    return force
