"""Find the motions that supports and joints leave free when every beam is taken as rigid."""

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import eigsh

from beamfem.errors import FreeMotionError
from beamfem.model.beam import Point
from beamfem.model.joints import Rigid
from beamfem.model.model import Model
from beamfem.model.supports import Roller, Spring
from beamfem.model.system import System

_DENSE_BODIES = 300
_ZERO = 1e-9
_PROVEN = "supported"


def require_support(system: System) -> None:
    """Raise FreeMotionError naming a beam, a point and the motion where a rigid motion or a mechanism is left free."""
    if _PROVEN in system.proven:
        return
    model = system.model
    body = _bodies(model)
    rows = _Rows(model, body, system.extent)
    free = _null_space(rows.matrix(), 3 * int(body.max() + 1))
    if not len(free):
        system.proven.add(_PROVEN)
        return
    sizes = np.abs(free[0].reshape(-1, 3)).max(axis=1)[body]
    # the first of those that move alike, whatever the round-off
    number = int(np.flatnonzero(sizes > (1.0 - 1e-6) * sizes.max())[0])
    motions = [motion.reshape(-1, 3)[body[number]] for motion in free]
    described = [
        "it " + describe(motion[:2] * system.extent, motion[2], rows.centre, system.extent)
        for motion in motions
        if np.abs(motion).max() > _ZERO
    ]
    start, end = model.beams[number].start, model.beams[number].end
    moved = [float(np.abs(rows.displacement(point) @ motions[0]).max()) for point in (start, end)]
    farthest = (start, end)[int(moved[1] > (1.0 + 1e-6) * moved[0])]
    x, y = farthest.reference
    raise FreeMotionError(
        f"beam {number} can move freely: {', '.join(described)}; its point ({x:g}, {y:g}) moves. A static solve needs "
        "supports that hold it (a Clamp, or a Pin and a Roller) or joints that stiffen it (Rigid instead of Hinge); "
        "without them, use simulate"
    )


def _bodies(model: Model) -> np.ndarray:
    """Number of the body (beams,) that each beam is part of; rigid joints make one body of two beams."""
    pairs = [
        (model.number_of(joint.a.beam), model.number_of(joint.b.beam))
        for joint in model.joints
        if isinstance(joint, Rigid)
    ]
    count = len(model.beams)
    if not pairs:
        return np.arange(count)
    a, b = np.array(pairs).T
    return connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(count, count)), directed=False)[1]


class _Rows:
    """Conditions on the motions (a, b, turn) of all bodies; lengths by the model's size, turns about its centre."""

    def __init__(self, model: Model, body: np.ndarray, extent: float) -> None:
        self.model, self.body, self.extent = model, body, extent
        self.centre = np.mean([mesh.position.mean(axis=0) for mesh in model.meshes], axis=0)
        self.entries: list[tuple[int, int, float]] = []
        self.count = 0
        for support in model.point_supports:
            here = self.displacement(support.point)
            turn = np.array([0.0, 0.0, 1.0])
            own = int(body[model.number_of(support.point.beam)])
            if isinstance(support, Spring):
                held = [row for row, k in zip(here, support.stiffness, strict=True) if k > 0.0]
                held += [turn] if support.rotational > 0.0 else []
            elif isinstance(support, Roller):
                held = [support.direction @ here]
            else:
                given = {"ux": here[0], "uy": here[1], "rotation": turn}
                held = [given[name] for name in support.held()]
            for row in held:
                self._add({own: row})
        for foundation in model.foundations:
            own = int(body[model.number_of(foundation.beam)])
            for point in (foundation.beam.start, foundation.beam.at(0.5), foundation.beam.end):
                for row, k in zip(self.displacement(point), foundation.stiffness, strict=True):
                    if k > 0.0:
                        self._add({own: row})
        for joint in model.joints:
            a, b = (int(body[model.number_of(point.beam)]) for point in (joint.a, joint.b))
            if a != b:
                for left, right in zip(self.displacement(joint.a), self.displacement(joint.b), strict=True):
                    self._add({a: left, b: -right})

    def displacement(self, point: Point) -> np.ndarray:
        """Displacement (2, 3) of a point with a, b and turn of its body."""
        x, y = (point.reference - self.centre) / self.extent
        return np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])

    def _add(self, parts: dict[int, np.ndarray]) -> None:
        for own, row in parts.items():
            self.entries += [(self.count, 3 * own + i, float(value)) for i, value in enumerate(row)]
        self.count += 1

    def matrix(self) -> csr_array:
        row, column, value = np.array(self.entries or [(0, 0, 0.0)]).T
        size = 3 * int(self.body.max() + 1)
        shape = (max(self.count, 1), size)
        return csr_array(coo_array((value, (row.astype(int), column.astype(int))), shape=shape))


def _null_space(rows: csr_array, size: int) -> np.ndarray:
    """Motions (m, size) that satisfy all conditions; of a large model the first few."""
    if size <= 3 * _DENSE_BODIES:
        _, singular, basis = np.linalg.svd(rows.toarray())
        return basis[int((singular > _ZERO).sum()) :]
    start = np.random.default_rng(1).standard_normal(size)
    values, vectors = eigsh(rows.T @ rows, k=3, sigma=-1e-6, v0=start)
    return np.asarray(vectors.T[values < _ZERO])


def describe(translation: np.ndarray, turn: float, origin: np.ndarray, reach: float) -> str:
    """Say a rigid motion in words: the velocity (2,) of the point `origin` and the turn; reach: size of the body."""
    if abs(turn) * reach < 1e-6 * np.hypot(*translation):
        x, y = translation / np.hypot(*translation)
        if max(abs(x), abs(y)) > 1.0 - 1e-9:
            return f"translates along {'x' if abs(x) > abs(y) else 'y'}"
        return f"translates along ({abs(x):.3g}, {np.copysign(y, x * y):.3g})"
    centre = origin + np.array([-translation[1], translation[0]]) / turn
    x, y = np.where(np.abs(centre) < 1e-6 * reach, 0.0, centre)
    return f"turns about ({x:.6g}, {y:.6g})"
