"""Initial velocities of a motion, and its start on its supports."""

from collections.abc import Callable

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.element.fields import cross, dot
from beamfem.equations.model_coordinates import coordinate_of
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.kernels.block import SHEAR_RIGID, STRETCH
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import reference_position
from beamfem.model.beam import beam_in_words
from beamfem.model.contribution import prescribed_by
from beamfem.model.supports import PointSupport, Value
from beamfem.model.time_functions import Integral
from beamfem.results.postprocess import nodal_rotations, nodal_vectors
from beamfem.results.solution import State
from beamfem.solve.start.start_state import matched, transferred
from beamfem.validation import called, vector

_NEAR = 0.01  # of an element, between the points of a difference
_FORWARD = (-25.0, 48.0, -36.0, 16.0, -3.0)  # twelfths


def start_velocity(
    system: System,
    p: np.ndarray,
    velocity: RigidVelocity | Callable[[np.ndarray], np.ndarray] | None,
    start: State | None,
) -> np.ndarray:
    """Return p' (n,) of a velocity field at the state p.

    A function takes the reference position (2,) [m] and returns (vx, vy) [m/s]. Sections then do not rotate, unless
    their element ties them to the axis.
    """
    result = np.zeros(system.model.size)
    if start is not None and velocity is None:
        result = transferred(start, system, "start")[1]
    if velocity is None:
        return result
    if not isinstance(velocity, RigidVelocity) and not callable(velocity):
        raise InputError(f"velocity must be a RigidVelocity or a function of the position, got {velocity!r}")
    if isinstance(velocity, RigidVelocity):
        return rigid_rates(system, velocity, p)
    return _of_field(system, velocity, p)


def _of_field(system: System, velocity: Callable[[np.ndarray], np.ndarray], p: np.ndarray) -> np.ndarray:
    """Return the rates (n,) of a velocity field at the state p; a shared coordinate takes the mean of its beams."""
    total, times = np.zeros(len(p)), np.zeros(len(p))
    for mesh in system.model.meshes:
        values = np.array([vector("velocity", called("velocity", velocity, x)) for x in mesh.position])
        slopes = _along(mesh, velocity) if "r_x" in mesh.vectors else values
        e = nodal_vectors(mesh, p[None])[0]
        for code, nodes in mesh.node_kinds:
            names = labels(code, mesh.vectors)
            rates = {"r": values[nodes], "r_x": slopes[nodes]}
            if code in (STRETCH, SHEAR_RIGID):
                # r_x = s t: its rate along t is that of s, across it s times that of the angle
                r_x = e[nodes, mesh.vectors.index("r_x")]
                length = np.linalg.norm(r_x, axis=1)
                turning, stretching = cross(r_x, slopes[nodes]) / length**2, dot(r_x, slopes[nodes]) / length
                rates |= {"theta": turning, "s": stretching}
            for column, label in enumerate(names):
                name, _, axis = label.partition("^")
                if name in rates:
                    dofs = mesh.kinematics.dof[nodes, column]
                    total[dofs] += rates[name][:, "xy".index(axis)] if axis else rates[name]
                    times[dofs] += 1.0
    return total / np.maximum(times, 1.0)


def _along(mesh: BeamMesh, velocity: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Return the derivative (nodes, 2) [1/s] of a velocity field along the beam, at the ends of its elements.

    It is a difference of fourth order inside each element, so that the field is evaluated on the beam only; at a node
    of two elements it is the mean of both, but at a corner each side has its own.
    """
    total, elements = np.zeros((mesh.nodes, 2)), np.zeros((mesh.nodes, 1))
    number = np.arange(mesh.elements)
    for end, inward in ((0, 1.0), (-1, -1.0)):
        slope = np.zeros((mesh.elements, 2))
        for k, weight in enumerate(_FORWARD):
            xi = np.full(mesh.elements, -min(inward, 0.0) + inward * k * _NEAR)
            places = reference_position(mesh, number, xi)
            slope += weight * np.array([vector("velocity", called("velocity", velocity, x)) for x in places])
        nodes = mesh.node[:, end]
        np.add.at(total, nodes, inward * slope / (12.0 * _NEAR * mesh.lengths[:, None]))
        np.add.at(elements, nodes, 1.0)
    return total / np.maximum(elements, 1.0)


# of the largest displacement of the start, or of the size of the model if that is smaller: a jump along a slender beam
# strains it by far more than a deflection of the same size
_OFF = 1e-6
_SAME = 1e-9  # of the size of the model, and rad: the transfer of a state takes it for the same place
_ZERO = 1e-12  # of the size of the model, and rad: round-off in messages
_NAMES = {"r^x": "ux", "r^y": "uy", "theta": "rotation"}


def require_on_supports(system: System, p: np.ndarray, prescribed: np.ndarray, given: bool) -> None:
    """Raise InputError if a support would move its point from the start at once.

    p (n,): coordinates of the start; prescribed (nh,): values of the prescribed coordinates at time 0; given: whether
    the start is a state, not the reference.
    """
    near = _near(system, p)
    gaps = prescribed - p[system.prescribed_dofs]
    gaps -= _unfelt_turns(system, gaps)
    jumps = _large(system.prescribed_dofs, gaps, near * system.scale[system.prescribed_dofs])
    offsets = np.array([normal @ (p - system.reference)[dof : dof + 2] for dof, normal in system.inclined])
    slides = _large(np.array([dof for dof, _ in system.inclined]), offsets, near * system.extent)
    if not jumps and not slides:
        return
    for support in system.model.point_supports:
        mesh = system.model.mesh_of(support.point)
        numbers = mesh.coordinates_of(mesh.node_at(support.point.fraction))
        names = {direction: coordinate_of(support, direction) for direction in support.prescribed()}
        if any(name is not None and numbers[name] in jumps for name in names.values()):
            dofs = {direction: (_NAMES[name], numbers[name]) for direction, name in names.items() if name is not None}
            raise InputError(_jumping(system, support, p, dofs, jumps, given))
        if None in names.values() and numbers["r^x"] in slides:
            raise InputError(_sliding(system, support, slides[numbers["r^x"]]))
    for item in system.connectors.items:
        for dof in (each for each in item.values.tolist() if each in jumps):
            raise InputError(
                f"{item.name} at {item.item.points[-1]} prescribes {_number(system, dof, p[dof] + jumps[dof])} when "
                f"the motion begins, but {'start' if given else 'the reference'} has {_number(system, dof, p[dof])}, "
                f"so that it would jump by {abs(jumps[dof]):.4g}; {_going_on(prescribed_by(item.item)[0], 'angle')}"
            )


def require_joined(system: System, start: State, moving: bool) -> None:
    """Raise InputError if joints of beams would change positions, rotations or their rates of a start at once.

    In its transfer, nodes that are joined have the coordinates and rates of one of the beams. moving: whether the
    motion begins with its rates.
    """
    model = system.model
    if start.model is model:
        return
    p, v = transferred(start, system, "start")
    near = _near(system, p)
    shared = np.bincount(np.concatenate([mesh.kinematics.dof[:, 0] for mesh in model.meshes])) > 1
    fastest = max(float(np.abs(start.v).max()), np.finfo(float).tiny)
    for old, new in matched(start.model, model, "start"):
        before, after = _of_sections(old, start.p, start.v), _of_sections(new, p, v)
        change = after - before
        change[1] -= 2.0 * np.pi * np.round(change[1].real / (2.0 * np.pi))
        joined = shared[new.kinematics.dof[:, 0]]
        sizes = system.extent, 1.0, *((fastest, fastest / system.extent) if moving else (np.inf, np.inf))
        relative = np.abs(change).T / sizes * joined[:, None]
        if (relative > near).any():
            node = int(relative.max(axis=1).argmax())
            (x, y), unit = new.position[node].tolist(), model.unit
            units = unit("m"), "rad", f"{unit('m')}/{unit('s')}", f"rad/{unit('s')}"
            changes = zip(np.abs(change[:, node]).tolist(), units, (relative[node] > near).tolist(), strict=True)
            by = " and ".join(f"{size:.3g} {name}" for size, name, large in changes if large)
            raise InputError(
                f"start does not satisfy a joint of this model: the one at ({x:g}, {y:g}), undeformed, would change "
                f"{beam_in_words(model.beams, model.number_of(new.beam))} by {by} at once; join what meets in the state"
            )


def _of_sections(mesh: BeamMesh, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return position [m] as a complex number, rotation [rad] and their rates (4, nodes) of the nodes of a beam."""
    e, rate = nodal_vectors(mesh, p[None])[0], nodal_vectors(mesh, p[None], v=v[None])[0]
    way = mesh.vectors.index("r_x") if mesh.beam.element.forces.turns_with == "r_x" else -1
    turning = cross(e[:, way], rate[:, way]) / dot(e[:, way], e[:, way])
    position, velocity = (values[:, 0, 0] + 1j * values[:, 0, 1] for values in (e, rate))
    return np.array([position, nodal_rotations(mesh, p[None])[0], velocity, turning])


def _near(system: System, p: np.ndarray) -> float:
    """Return how far, in sizes of the model or rad, a state p (n,) may be off what holds it: the error of solvers."""
    moved = float(np.abs(p - system.reference)[system.positions].max()) / system.extent
    return max(_OFF * min(moved, 1.0), _SAME)


def put_onto_supports(system: System, state: np.ndarray, prescribed: np.ndarray) -> np.ndarray:
    """Give prescribed coordinates of a state p, p', p'' (4, n) their values (3, nh), and remove what rollers stop.

    Return the change of p' (n,).
    """
    before = state[1].copy()
    state[:3, system.prescribed_dofs] = prescribed
    for dof, normal in system.inclined:
        pair = slice(dof, dof + 2)
        state[0, pair] -= normal * (normal @ (state[0, pair] - system.reference[pair]))
        state[1, pair] -= normal * (normal @ state[1, pair])
    return np.asarray(state[1] - before)


def _unfelt_turns(system: System, gaps: np.ndarray) -> np.ndarray:
    """Return the full turns (nh,) [rad] in gaps of rotations that no spring or connector feels.

    The section stays where it is: a crank may go on with a function that begins at 0 again.
    """
    felt = np.concatenate([system.springs.numbers[:, 0], *(item.all for item in system.connectors.items)])
    rotations = np.array([item.rotation for item in system.prescribed], dtype=bool)
    unfelt = ~np.isin(system.prescribed_dofs, felt)
    return np.where(rotations & unfelt, 2.0 * np.pi * np.round(gaps / (2.0 * np.pi)), 0.0)


def _large(dofs: np.ndarray, gaps: np.ndarray, near: np.ndarray | float) -> dict[int, float]:
    """Return the gaps (n,) that are larger than a tolerance, by the number of their coordinate."""
    large = np.abs(gaps) > near
    return dict(zip(dofs[large].tolist(), gaps[large].tolist(), strict=True)) if large.any() else {}


def _jumping(
    system: System,
    support: PointSupport,
    p: np.ndarray,
    dofs: dict[str, tuple[str, int]],
    jumps: dict[int, float],
    given: bool,
) -> str:
    """Return the message that a support prescribes coordinates other than those of a start p (n,).

    dofs: name and number of the coordinate of each direction; jumps: change [m], [rad] of those that would jump; given:
    see `require_on_supports`.
    """
    metre, prescribed = system.model.unit("m"), support.prescribed()
    imposed, there, hold, driven, advice = [], [], [], False, ""
    sizes = {metre: 0.0, "rad": 0.0}
    for direction, (name, dof) in dofs.items():
        unit = "rad" if direction == "rotation" else metre
        value = p[dof] - system.reference[dof]
        hold.append(f"{name} = {_number(system, dof, value, 12)}")
        if dof in jumps:
            imposed.append(f"{name} = {_number(system, dof, value + jumps[dof])} {unit}")
            there.append(f"{name} = {_number(system, dof, value)} {unit}")
            sizes[unit] = float(np.hypot(sizes[unit], jumps[dof]))
            driven = driven or callable(prescribed[direction])
            advice = advice or _going_on(prescribed[direction], name)
    jump = " and ".join(f"{size:.4g} {unit}" for unit, size in sizes.items() if size > 0.0)
    name = system.model.name_of(support)
    message = (
        f"{name} at {support.point}, prescribes {', '.join(imposed)} when the motion begins, but "
        f"{'start' if given else 'the reference'} has {', '.join(there)} there: it would jump by {jump}. "
    )
    if not given:
        if driven:
            start = "Subtract from its functions their values at time 0, or start from a static state with these values"
        else:
            start = "Use a function of time that begins at 0, or start from what solve_static finds with this support"
        return message + start
    message += f"To hold it where it is, use a Prescribed support with {', '.join(hold)}"
    if driven:
        return f"{message}; to continue a motion, {advice}"
    return f"{message}; or start from what solve_static finds with this support"


def _going_on(value: Value, name: str) -> str:
    """Return what continues the motion that a value prescribes."""
    if isinstance(value, Integral):
        return f"prescribe {name} in place of its rate: where start has it, and the integral of the rate from then on"
    return "shift the time of its functions, which begins at 0 again"


def _sliding(system: System, support: PointSupport, beside: float) -> str:
    """Return the message that an inclined roller holds its point on a line that is a distance [m] away."""
    assert support.direction is not None
    x, y = support.direction.tolist()
    name = system.model.name_of(support)
    return (
        f"{name} at {support.point}, holds the displacement along ({x:.4g}, {y:.4g}) at 0, but start "
        f"has {beside:.4g} {system.model.unit('m')} there, by which it would jump; start from what solve_static finds "
        "with this support"
    )


def _number(system: System, dof: int, value: float, digits: int = 6) -> str:
    return f"{0.0 if abs(value) < _ZERO * system.scale[dof] else value:.{digits}g}"
