"""Forces that joints transmit, from the equilibrium of what is on one side of them."""

from collections import defaultdict
from functools import partial

import numpy as np

from beamfem.element.fields import cross
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Point
from beamfem.model.contribution import Contribution
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load, PointLoad, factor
from beamfem.model.model import Model
from beamfem.model.supports import PointSupport
from beamfem.parts.motor import Motor
from beamfem.results.element_loads import Rows
from beamfem.results.free_bodies import Parted, cut_free
from beamfem.results.reactions import connector_force, forces_at, reaction_of
from beamfem.results.section_forces import of_elements
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.validation import shown

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
        if part is joint and len(part.points) == 2:
            return connector_force(solution, part)[:, 1]
    raise InputError(
        f"{shown(joint)} is neither a joint, a motor nor a connector of two points of this model; use one of "
        "model.joints"
    )


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
        return _of_load(solution, last)
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
            result -= _of_load(solution, load)
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


def _of_load(solution: Solution, load: PointLoad) -> np.ndarray:
    """Return the force and the moment (steps, 3) of a load at a point."""
    system, times = loading(solution)
    factors = np.array([factor(load, float(time), system.static) for time in times])
    force = factors[:, None] * np.array(load.value)
    if load.follower:
        c, s = np.cos(turn := solution.rotation(load.point)), np.sin(turn)
        force[:, :2] = np.column_stack([c * force[:, 0] - s * force[:, 1], s * force[:, 0] + c * force[:, 1]])
    return force
