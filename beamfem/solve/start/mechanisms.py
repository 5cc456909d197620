"""Reject models with too few conditions, mechanisms if every beam is taken as rigid, or with redundant ones."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackError, eigsh

from beamfem.equations.bound_connector import Connector
from beamfem.equations.connector_traits import lets_go
from beamfem.equations.redundant_conditions import dependent_on_others, gradients_of
from beamfem.equations.redundant_conditions import in_words as in_words_of
from beamfem.equations.rigid_velocity import RigidVelocity, set_rigid_rates
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, FreeMotionError, InputError
from beamfem.model.beam import Point, beam_in_words
from beamfem.model.missing_joints import Pair, in_words, unjoined_ends
from beamfem.model.model import Model

NEGLIGIBLE = 1e-9  # of the size of the model
_DENSE_BODIES = 300
_FIRST_FEW = 3


def bodies_of(model: Model) -> np.ndarray:
    """Return the number of the body (beams,) that each beam is part of; rigid joints make one body of two beams."""
    pairs = [
        (model.number_of(joint.a.beam), model.number_of(joint.b.beam))
        for joint in model.shared_joints
        if joint.keeps_angle
    ]
    count = len(model.beams)
    if not pairs:
        return np.arange(count)
    a, b = np.array(pairs).T
    return connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(count, count)), directed=False)[1]


class Conditions:
    """Conditions on the motions (a, b, turn) of all bodies from a state p (n,).

    Lengths are relative to the size of the model, rotations are about its centre. body (beams,): the body of each beam.
    """

    def __init__(self, system: System, body: np.ndarray, p: np.ndarray) -> None:
        model = system.model
        self.model, self.body, self.extent = model, body, system.extent
        self.nodes = [p[mesh.kinematics.dof[:, :2]] for mesh in model.meshes]
        self.centre = np.mean([positions.mean(axis=0) for positions in self.nodes], axis=0)
        self.bodies = int(body.max() + 1)
        self.entries: list[tuple[int, int, float]] = []
        self.count = 0
        for support in model.point_supports:
            displacement = self.displacement(support.point)
            body_number = int(body[model.number_of(support.point.beam)])
            rows = {"ux": displacement[0], "uy": displacement[1], "rotation": np.array([0.0, 0.0, 1.0])}
            if support.direction is not None:
                rows["normal"] = support.direction @ displacement
            for direction in (*support.prescribed(), *support.springs()):
                self._add({body_number: rows[direction]})
        for foundation in model.line_supports:
            number = model.number_of(foundation.beam)
            for position in self.nodes[number]:
                for row, k in zip(self.moved(position), foundation.stiffness, strict=True):
                    if k > 0.0:
                        self._add({int(body[number]): row})
        for joint in model.shared_joints:
            one, other = (int(body[model.number_of(point.beam)]) for point in (joint.a, joint.b))
            if one != other:
                for left, right in zip(self.displacement(joint.a), self.displacement(joint.b), strict=True):
                    self._add({one: left, other: -right})
        for connector, stopped in system.connectors.stopped():
            self._resist(connector.item.points, stopped)

    def _resist(self, points: Sequence[Point], stopped: np.ndarray) -> None:
        """Add conditions on motions (r, 3 m) of points."""
        moved = [np.vstack([self.extent * self.displacement(point), [0.0, 0.0, 1.0]]) for point in points]
        bodies = [int(self.body[self.model.number_of(point.beam)]) for point in points]
        for row in stopped:
            parts, every = {number: np.zeros(3) for number in bodies}, 0.0
            for number, coefficients, motion in zip(bodies, row.reshape(-1, 3), moved, strict=True):
                parts[number] += coefficients @ motion
                every = max(every, float((np.abs(coefficients) @ np.abs(motion)).max()))
            size = max(float(np.abs(part).max()) for part in parts.values())
            if size > NEGLIGIBLE * every:  # what is left of terms that cancel out within a body is round-off
                self._add({number: part / size for number, part in parts.items()})

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement (2, 3) of a point per unit of a, b and turn of its body."""
        node = self.model.mesh_of(point).node_at(point.fraction)
        return self.moved(self.nodes[self.model.number_of(point.beam)][node])

    def moved(self, position: np.ndarray) -> np.ndarray:
        """Return the displacement (2, 3) of a position (2,) [m] per unit of a, b and turn of the body there."""
        x, y = (position - self.centre) / self.extent
        return np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])

    def _add(self, parts: dict[int, np.ndarray]) -> None:
        for number, row in parts.items():
            self.entries += [(self.count, 3 * number + i, float(value)) for i, value in enumerate(row)]
        self.count += 1

    def matrix(self) -> csr_array:
        """Return the conditions (m, 3 bodies); their product with an unconstrained motion is zero."""
        row, column, value = np.array(self.entries or [(0, 0, 0.0)]).T
        shape = (max(self.count, 1), 3 * self.bodies)
        return csr_array(coo_array((value, (row.astype(int), column.astype(int))), shape=shape))

    def rates(self, p: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Return the change (n,) of the coordinates from the state p with a motion (3 bodies,)."""
        result = np.zeros(len(p))
        for number, mesh in enumerate(self.model.meshes):
            a, b, turn = motion.reshape(-1, 3)[self.body[number]].tolist()
            velocity = RigidVelocity((a * self.extent, b * self.extent), turn, tuple(self.centre))
            set_rigid_rates(mesh, velocity, p, result)
        return result


def mechanisms(conditions: Conditions) -> np.ndarray:
    """Return an orthonormal basis (m, 3 bodies) of the motions that satisfy all conditions."""
    size, rows = 3 * conditions.bodies, conditions.matrix()
    if conditions.bodies <= _DENSE_BODIES:
        return _null_space(rows.toarray())
    wanted = _FIRST_FEW
    while 2 * wanted < size:
        start = np.random.default_rng(1).standard_normal(size)
        try:
            values, vectors = eigsh(rows.T @ rows, k=wanted, sigma=-1e-6, v0=start)
        except ArpackError as error:
            raise ConvergenceError(
                f"whether {conditions.bodies} bodies can move freely could not be determined: {error}"
            ) from error
        if values.max() >= NEGLIGIBLE:
            return np.asarray(vectors.T[values < NEGLIGIBLE])
        wanted *= 4
    return _null_space(rows.toarray())


def _null_space(rows: np.ndarray) -> np.ndarray:
    if len(rows) > rows.shape[1]:
        # the same singular values and basis, without a square matrix of all nodes on a foundation
        rows = np.asarray(np.linalg.qr(rows, mode="r"))
    _, singular, basis = np.linalg.svd(rows)
    return np.asarray(basis[int((singular > NEGLIGIBLE).sum()) :])


_PROVEN = "supported"


class FreeMotion(NamedTuple):
    """Conditions that leave motions of bodies free in the reference, and the error that names these."""

    conditions: Conditions
    error: FreeMotionError


def require_support(system: System) -> None:
    """Raise FreeMotionError with a beam, a point and the motion if a rigid-body motion or a mechanism is possible."""
    found = free_motion(system)
    if found is not None:
        raise found.error


def free_when_open(system: System) -> str:
    """Return "; where ... are open, ..." if parts that hold one way only alone hold a model, nothing otherwise."""
    opening = [item for item in system.connectors.items if lets_go(item)]
    given = {id(item.given) for item in opening}
    others = [connector for connector in system.model.connectors if id(connector) not in given]
    found = free_motion(system_of(system.model.with_(connectors=others), static=True)) if opening else None
    if found is None:
        return ""
    return (
        f"; where parts that hold one way only are open ({in_words_of(opening)}), {found.error.reason}: add a support, "
        "or let the loads that close them act from the start, with scale=False"
    )


def no_equilibrium_at_start(system: System, why: str) -> str:
    """Return the message that there is no equilibrium at load factor 0."""
    acting = "under the loads that do not scale" if system.loads.at(0.0).any else "at load factor 0"
    return lost_at(system, 0.0, f"no equilibrium {acting}: {why}")


def lost_at(system: System, load_factor: float, message: str) -> str:
    """Return the message that there is no state or path beyond a load factor, and where parts that are open cause it.

    Without a load, pretension of parts that hold one way only moves what it does not clamp, until they are open.
    """
    opened = free_when_open(system)
    if opened and abs(load_factor) <= NEGLIGIBLE and not system.loads.at(0.0).any:
        return f"no unique equilibrium at load factor 0{opened}"
    return message + opened


def free_motion(system: System) -> FreeMotion | None:
    """Return the rigid-body motions and mechanisms that are possible in the reference, None if there are none."""
    if _PROVEN in system.tables:
        return None
    model = system.model
    body = bodies_of(model)
    held = (support.prescribed().keys() for support in model.point_supports)
    if len(body) == 1 and any({"ux", "uy", "rotation"} <= directions for directions in held):
        system.tables[_PROVEN] = True
        return None
    rows = Conditions(system, body, system.reference)
    free = mechanisms(rows)
    if not len(free):
        system.tables[_PROVEN] = True
        return None
    sizes = np.abs(free[0].reshape(-1, 3)).max(axis=1)[body]
    # the first of those that move equally, whatever the round-off
    number = int(np.flatnonzero(sizes > (1.0 - 1e-6) * sizes.max())[0])
    motions = [motion.reshape(-1, 3)[body[number]] for motion in free]
    described = dict.fromkeys(
        "it " + describe(motion[:2] * system.extent, motion[2], rows.centre, system.extent)
        for motion in motions
        if np.abs(motion).max() > NEGLIGIBLE
    )
    start, end = model.beams[number].start, model.beams[number].end
    moved = [float(np.abs(rows.displacement(point) @ motions[0]).max()) for point in (start, end)]
    farthest = (start, end)[int(moved[1] > (1.0 + 1e-6) * moved[0])]
    x, y = farthest.reference
    unjoined = next((pair for pair in unjoined_ends(model) if _parts(rows, free, pair)), None)
    missing = f"{in_words(model, unjoined)}: add a Rigid or a Hinge. Otherwise a" if unjoined else "A"
    opening = [item for item in system.connectors.items if lets_go(item)]
    closing = f", or loads with scale=False that close {in_words_of(opening)} from the start" if opening else ""
    error = FreeMotionError(
        f"{beam_in_words(model.beams, number)} can move freely: {', '.join(described)}; its point ({x:g}, {y:g}) moves",
        remedy=f"{missing} static solve needs supports that hold it (a Clamp, or a Pin and a Roller) or joints that "
        f"stiffen it (Rigid instead of Hinge){closing}; without them, use simulate",
    )
    return FreeMotion(rows, error)


def _parts(rows: Conditions, motions: np.ndarray, pair: Pair) -> bool:
    """Return whether motions (m, 3 bodies) part two points at one place, or turn them differently."""
    one, other = (int(rows.body[rows.model.number_of(point.beam)]) for point in pair)
    own = motions.reshape(len(motions), -1, 3)
    between = own[:, one] - own[:, other]
    apart = between @ np.vstack([rows.moved(pair[0].reference), [0.0, 0.0, 1.0]]).T
    return bool(np.abs(apart).max() > NEGLIGIBLE)


def describe(translation: np.ndarray, turn: float, origin: np.ndarray, reach: float) -> str:
    """Return a rigid motion in words: the velocity (2,) of the point `origin` and the rotation; reach: body size."""
    if abs(turn) * reach < 1e-6 * np.hypot(*translation):
        x, y = translation / np.hypot(*translation)
        if max(abs(x), abs(y)) > 1.0 - 1e-9:
            return f"translates along {'x' if abs(x) > abs(y) else 'y'}"
        return f"translates along ({abs(x):.3g}, {np.copysign(y, x * y):.3g})"
    centre = origin + np.array([-translation[1], translation[0]]) / turn
    x, y = np.where(np.abs(centre) < 1e-6 * reach, 0.0, centre)
    return f"turns about ({x:.6g}, {y:.6g})"


_INDEPENDENT = "independent"


def require_independent(system: System, p: np.ndarray) -> None:
    """Raise InputError if conditions of connectors, supports and joints are redundant in a state p (n,)."""
    reference = p is system.reference
    if not len(system.connectors.multipliers) or (reference and _INDEPENDENT in system.tables):
        return
    if len(_redundant(system, p)[0]) > len(system.connectors.left_out):
        raise InputError(dependent(system, p))
    if reference:
        system.tables[_INDEPENDENT] = True


def _redundant(system: System, p: np.ndarray) -> tuple[np.ndarray, list[Connector]]:
    """Return the multipliers of redundant conditions in a state p (n,), and the connectors involved."""
    return dependent_on_others(gradients_of(system.connectors, p, system.held))


def dependent(system: System, p: np.ndarray) -> str:
    """Return the message that conditions of connectors are linearly dependent in a state p (n,)."""
    found = _redundant(system, p)[1] or [item for item in system.connectors.items if len(item.multipliers)]
    return (
        f"conditions of connectors ({in_words_of(found)}) are redundant, among themselves or with supports and joints: "
        "their multipliers are not unique; leave out those that are not needed, or ask for those of least norm, "
        'redundant_conditions="least_norm" of the model'
    )
