"""Energy and momentum conserving steps: forces between two states with mean stresses."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import block_diag, coo_array, csr_array, dia_array, kron

from beamfem.equations.equations import linearise
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.kernels.block import ELASTIC_LINE, GRADIENTS, ROTATED_GRADIENTS, ROTATION, STRUCTURAL, Block
from beamfem.physics.connections import MASS
from beamfem.physics.kinematics import MEASURES, evaluate
from beamfem.results.solution import State
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion
from beamfem.solve.motion.time_marching import initial_acceleration

_COMPLEX_STEP = 1e-30
_TOLERANCE = 1e-13  # of the model: a correction that ends an iteration
_NOISE = 1e-10  # of the model: smaller corrections that no longer decrease are round-off
_ITERATIONS = 30
_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class EnergyMomentum:
    """Energy-momentum method: conserves energy and both momenta at any step size; second order.

    The midpoint rule in nodal vectors e with a constant mass, M (e1' - e0') / h + f = 0, e1 - e0 = h (e0' + e1') / 2.
    f has the mean of the stresses of both states, and algebraic differences of the strains, which are functions of
    products of r', d and d', so that f . (e1 - e0) is the change of the strain energy (Simo and Tarnow 1992; Gonzalez
    2000). Where directors rotate, moments act across the mean director (Betsch and Leyendecker 2006). Kinetic energies
    of results use angular velocities, which differ from e' by a part of second order that does not accumulate; it is
    small where steps resolve the vibrations.

    It is for elastic beams with gradients or rotations that shear. Forces that have a potential which is not quadratic
    in positions, such as those of a `SpringDamper`, are those of the mean state, and conserve energy to second order.

    Raises
    ------
    InputError
        As the motion begins, if the model has other elements, section laws, damping of beams, imposed strains, moved
        supports, conditions, or masses other than a `PointMass` without inertia.

    Examples
    --------
    >>> free = bf.Model([beam])
    >>> motion = bf.simulate(
    ...     free, 0.1, 0.005, integrator=bf.EnergyMomentum(), velocity=bf.RigidVelocity(angular=20.0, about=(0.5, 0.0))
    ... )
    >>> bool(np.ptp(motion.energy().total) < 1e-8 * motion.energy().total[0])
    True
    """

    def run(self) -> "EnergyMomentumRun":
        """Return the integrator of one motion, which keeps the rates of nodal vectors."""
        return EnergyMomentumRun()


class _Points(NamedTuple):
    """The quadrature points of a block: r', d and d' (points, 6) from all nodal vectors, weights [m] and section."""

    measures: int
    gather: csr_array  # (6 points, size)
    weight: np.ndarray  # (points,) [m]
    stiffness: np.ndarray  # (points, ns, ns)
    reference: np.ndarray  # (points, ns)


class _Vectors(NamedTuple):
    """All nodal vectors e (size,) as functions of p: `linear` p (size, n), and directors that rotate.

    rows (k, 2): of the directors; angles (k,): numbers of their angles; start (k,) [rad]: angles in the reference.
    """

    linear: csr_array
    rows: np.ndarray
    angles: np.ndarray
    start: np.ndarray
    mass: csr_array
    points: tuple[_Points, ...]

    def at(self, p: np.ndarray) -> np.ndarray:
        """Return e in p."""
        e, angle = self.linear @ p, p[self.angles] + self.start
        e[self.rows] = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
        return np.asarray(e)

    def along(self, directors: np.ndarray) -> csr_array:
        """Return the derivative (size, n) of e as directors (k, 2) rotate by their angles."""
        across = directors @ _TURN.T
        columns = np.repeat(self.angles, 2)
        rotating = coo_array((across.ravel(), (self.rows.ravel(), columns)), shape=self.linear.shape)
        return csr_array(self.linear + rotating)


class EnergyMomentumRun:
    """The steps of `EnergyMomentum` in one motion."""

    def __init__(self) -> None:
        self._vectors: _Vectors | None = None
        self._masses: csr_array | None = None
        self._rates: tuple[float, np.ndarray] | None = None

    def memory(self) -> dict[str, np.ndarray]:
        """Return the rates of nodal vectors, and their time."""
        return {} if self._rates is None else {"time": np.array(self._rates[0]), "rates": self._rates[1]}

    def recall(self, memory: Mapping[str, np.ndarray]) -> None:
        """Go on with the rates that were kept."""
        self._rates = (float(memory["time"]), memory["rates"]) if memory else None

    def step(self, motion: EquationsOfMotion, begin: State, end: float) -> State:
        """Return the state after a step. Raises ConvergenceError."""
        system, h = motion.system, end - begin.at
        if self._vectors is None:
            _require_conservable(system)
            self._vectors = _vectors_of(system)
            self._masses = _masses_at_points(system)
        vectors = self._vectors
        e0 = vectors.at(begin.p)
        if self._rates is None or abs(self._rates[0] - begin.at) > 1e-9 * h:
            self._rates = begin.at, vectors.along(e0[vectors.rows]) @ begin.v
        rates = self._rates[1]
        for start in (begin.p + h * begin.v, begin.p):  # rates of vibrations that the step does not resolve mislead
            p = self._solved(motion, begin, start.copy(), (e0, rates), end)
            if p is not None:
                e1 = vectors.at(p)
                self._rates = end, 2.0 / h * (e1 - e0) - rates
                return self._reached(begin, p, e1, h, end)
        raise ConvergenceError(f"{_ITERATIONS} iterations did not suffice")

    def _solved(
        self,
        motion: EquationsOfMotion,
        begin: State,
        p: np.ndarray,
        start: tuple[np.ndarray, np.ndarray],
        end: float,
    ) -> np.ndarray | None:
        """Return p (n,) at the end of a step by Newton's method, None if it does not converge."""
        free, before = motion.free, np.inf
        for _ in range(_ITERATIONS):
            left, tangent = self._balance(motion.system, begin, p, start, end)
            change = motion.solver(csr_array(tangent[free][:, free]))(-left[free])
            motion.counted[0] += 1
            p[free] += change
            size = float(np.max(np.abs(change) / motion.scale))
            if not np.isfinite(size):
                return None
            if size <= _TOLERANCE or (size <= _NOISE and size > 0.5 * before):
                return p
            before = size
        return None

    def _reached(self, begin: State, p: np.ndarray, e1: np.ndarray, h: float, end: float) -> State:
        vectors, rates = self._vectors, self._rates
        assert vectors is not None
        assert rates is not None
        v = 2.0 / h * (p - begin.p) - begin.v
        across = e1[vectors.rows] @ _TURN.T
        v[vectors.angles] = np.einsum("ij,ij->i", across, rates[1][vectors.rows])
        state = np.array([p, v, np.zeros_like(p)])
        found = initial_acceleration(system_of(begin.model, static=False), state, end)
        return replace(begin, p=state[0], v=state[1], a=found, at=end)

    def _balance(
        self, system: System, begin: State, p: np.ndarray, start: tuple[np.ndarray, np.ndarray], end: float
    ) -> tuple[np.ndarray, csr_array]:
        """Return the left-hand side (n,) of a step, and its derivative by p."""
        vectors, masses, (e0, rates), h = self._vectors, self._masses, start, end - begin.at
        assert vectors is not None
        assert masses is not None
        e1 = vectors.at(p)
        middle = 0.5 * (e0 + e1)[vectors.rows]
        whole, stiffness = vectors.mass @ (2.0 / h**2 * (e1 - e0) - 2.0 / h * rates), 2.0 / h**2 * vectors.mass
        for points in vectors.points:
            force, slope = _force_between(points, points.gather @ e0, points.gather @ e1)
            whole += points.gather.T @ force
            stiffness = stiffness + points.gather.T @ slope @ points.gather
        across, derivative = vectors.along(middle), vectors.along(e1[vectors.rows])
        weights, mean, rate = (0.5, 1.0 / h, 0.0), 0.5 * (begin.p + p), (p - begin.p) / h
        time = 0.5 * (begin.at + end)
        other, own = linearise(system, mean, rate, np.zeros_like(p), time, weights, equations=system.without_stiffness)
        left = across.T @ whole + other + masses @ (2.0 / h * (rate - begin.v))
        tangent = across.T @ stiffness @ derivative + 2.0 / h**2 * masses
        turning = np.zeros(len(p))
        np.add.at(turning, vectors.angles, -0.5 * (e1[vectors.rows] * whole[vectors.rows]).sum(axis=1))
        free = system.free_dofs
        selected = coo_array((np.ones(len(free)), (free, np.arange(len(free)))), shape=(len(p), len(free))).tocsr()
        others = selected @ own.sparse((np.empty(0, dtype=np.int64), np.empty((0, 2)))) @ selected.T
        return left, csr_array(tangent + others + dia_array((turning[None], [0]), shape=tangent.shape))


def _force_between(points: _Points, q0: np.ndarray, q1: np.ndarray) -> tuple[np.ndarray, csr_array]:
    """Return the forces (6 points,) on r', d and d' between two states (6 points,), and their derivative by the end."""
    start, finish = q0.reshape(-1, 6), q1.reshape(-1, 6)
    between = _structural if points.measures == STRUCTURAL else _green_lagrange
    force: Callable[[np.ndarray], np.ndarray] = lambda end: points.weight[:, None] * between(points, start, end)  # noqa: E731
    slope = np.empty((len(start), 6, 6))
    for column in range(6):
        moved = finish.astype(complex)
        moved[:, column] += 1j * _COMPLEX_STEP
        slope[:, :, column] = force(moved).imag / _COMPLEX_STEP
    count = len(start)
    rows = np.arange(6 * count).reshape(count, 6)
    entries = coo_array(
        (slope.ravel(), (np.repeat(rows, 6, axis=1).ravel(), np.tile(rows, (1, 6)).ravel())), shape=(6 * count,) * 2
    )
    return force(finish).ravel(), csr_array(entries)


def _resultants(points: _Points, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the mean of the stress resultants (points, ns) of two states (points, 6)."""
    measure = MEASURES[points.measures]
    strains = (evaluate(measure, q[:, :2], q[:, 2:4], q[:, 4:]) for q in (start, end))
    mean = 0.5 * sum(strains) - points.reference
    return np.einsum("pij,pj->pi", points.stiffness, mean)


def _green_lagrange(points: _Points, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the forces (points, 6): strains are quadratic, so their change is that of the mean state."""
    s, m = _resultants(points, start, end), 0.5 * (start + end)
    r, d, e = m[:, :2], m[:, 2:4], m[:, 4:]
    a, b, c, yy, shear, shear_slope = s.T[:, :, None]
    return np.concatenate(
        [a * r + b * e + shear * d, yy * d + shear * r + shear_slope * e, b * r + c * e + shear_slope * d], axis=1
    )


def _structural(points: _Points, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the forces (points, 6): algebraic differences of functions of r' x d, r' . d, d x d' and d . d."""
    (x0, y0, z0, w0), (x1, y1, z1, w1) = (_products(q) for q in (start, end))
    s0, s1 = np.sqrt(w0), np.sqrt(w1)
    normal, shear, moment, thickness = _resultants(points, start, end).T
    inverse, fall = 0.5 * (1.0 / s0 + 1.0 / s1), -0.5 / (s0 * s1 * (s0 + s1))
    square, fall_of_square = 0.5 * (1.0 / w0 + 1.0 / w1), -0.5 / (w0 * w1)
    by_x, by_y, by_z = normal * inverse, shear * inverse, moment * square
    by_w = fall * (normal * (x0 + x1) + shear * (y0 + y1)) + fall_of_square * moment * (z0 + z1) + thickness / (s0 + s1)
    m = 0.5 * (start + end)
    rx, ry, dx, dy, ex, ey = m.T
    return np.stack(
        [
            by_x * dy + by_y * dx,
            -by_x * dx + by_y * dy,
            -by_x * ry + by_y * rx + by_z * ey + 2.0 * by_w * dx,
            by_x * rx + by_y * ry - by_z * ex + 2.0 * by_w * dy,
            -by_z * dy,
            by_z * dx,
        ],
        axis=1,
    )


def _products(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return r' x d, r' . d, d x d' and d . d of states (points, 6)."""
    rx, ry, dx, dy, ex, ey = q.T
    return rx * dy - ry * dx, rx * dx + ry * dy, dx * ey - dy * ex, dx * dx + dy * dy


def _vectors_of(system: System) -> _Vectors:
    """Return the nodal vectors of all blocks one after the other."""
    rows, columns, values, directors, angles, start, masses, points = [], [], [], [], [], [], [], []
    sizes = [2 * len(block.dof) * _per_node(block) for block in system.blocks]
    first = np.append(0, np.cumsum(sizes))
    for block, offset in zip(system.blocks, first.tolist(), strict=False):
        count, vectors = len(block.dof), _per_node(block)
        numbers = offset + np.arange(count * 2 * vectors).reshape(count, 2 * vectors)
        linear = np.ones((count, 2 * vectors), dtype=bool)
        turned = block.node_kind == ROTATION
        linear[turned, -2:] = False
        rows.append(numbers[linear])
        columns.append(
            block.dof[:, : 2 * vectors][linear] if block.dof.shape[1] >= 2 * vectors else _padded(block)[linear]
        )
        values.append(np.ones(int(linear.sum())))
        directors.append(numbers[turned, -2:])
        angles.append(block.dof[turned, 2 * vectors - 2])
        start.append(np.arctan2(block.frame[turned, 1], block.frame[turned, 0]))
        masses.append(_mass(block, count * vectors))
        points.append(_points(block, offset, int(first[-1])))
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    linear_part = coo_array(entries, shape=(int(first[-1]), system.model.size))
    return _Vectors(
        csr_array(linear_part),
        np.concatenate(directors),
        np.concatenate(angles),
        np.concatenate(start),
        csr_array(block_diag(masses)),
        tuple(points),
    )


def _per_node(block: Block) -> int:
    """Return the number of nodal vectors of a node."""
    return block.scale.shape[1] // block.node.shape[1]


def _padded(block: Block) -> np.ndarray:
    """Return the numbers of coordinates (N, 2 vectors), of which a node with an angle does not use the last."""
    width = max(2 * _per_node(block), block.dof.shape[1])
    return np.pad(block.dof, ((0, 0), (0, width - block.dof.shape[1])), constant_values=-1)[:, : 2 * _per_node(block)]


def _vector_numbers(block: Block) -> np.ndarray:
    """Return the numbers (ne, nv) of the nodal vectors of each element."""
    vectors = _per_node(block)
    return (block.node[:, :, None] * vectors + np.arange(vectors)).reshape(len(block.node), -1)


def _mass(block: Block, size: int) -> csr_array:
    """Return the mass matrix of the components of all nodal vectors of a block."""
    numbers, mass = _vector_numbers(block), block.mass[block.kind]
    width = numbers.shape[1]
    rows, columns = np.repeat(numbers, width, axis=1), np.tile(numbers, (1, width))
    whole = coo_array((mass.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
    return csr_array(kron(csr_array(whole), np.eye(2)))


def _points(block: Block, offset: int, size: int) -> _Points:
    """Return the quadrature points of a block whose nodal vectors begin at an offset."""
    vectors, numbers = _per_node(block), _vector_numbers(block)
    slope, director = block.slope[block.kind], block.director
    elements, count, width = slope.shape
    last = np.arange(width) % vectors == vectors - 1
    weights = np.zeros((elements, count, 3, width))
    weights[:, :, 0, ~last], weights[:, :, 2, last] = slope[:, :, ~last], slope[:, :, last]
    weights[:, :, 1, last] = director
    rows = np.broadcast_to(np.arange(elements * count * 3).reshape(elements, count, 3, 1), weights.shape)
    columns = np.broadcast_to(numbers[:, None, None, :], weights.shape)
    known = weights != 0.0
    entries = weights[known], (rows[known], columns[known] + offset // 2)
    gather = coo_array(entries, shape=(3 * elements * count, size // 2))
    kinds = block.kind
    return _Points(
        block.measures,
        csr_array(kron(csr_array(gather), np.eye(2))),
        block.weight[kinds].ravel(),
        block.stiffness[kinds].reshape(elements * count, *block.stiffness.shape[2:]),
        block.reference[kinds].reshape(elements * count, -1),
    )


def _masses_at_points(system: System) -> csr_array:
    """Return the mass matrix (n, n) of the point masses."""
    result = csr_array((system.model.size, system.model.size))
    zeros = np.zeros(system.model.size)
    for item in system.connectors.items:
        if item.compiled == MASS:
            own = item.tangent((system.reference, zeros, zeros), 0.0, np.zeros(2), (0.0, 0.0, 1.0))
            rows, columns = np.repeat(item.all, len(item.all)), np.tile(item.all, len(item.all))
            result = result + coo_array((own.ravel(), (rows, columns)), shape=result.shape)
    return csr_array(result)


def _require_conservable(system: System) -> None:
    """Raise InputError for what `EnergyMomentum` cannot conserve."""
    why = None
    measures = {block.measures for block in system.blocks}
    kinds = {int(kind) for block in system.blocks for kind in block.node_kind}
    zeros = np.zeros(system.model.size)
    moving = [
        item.name
        for item in system.connectors.items
        if item.compiled != MASS
        and item.tangent((system.reference, zeros, zeros), 0.0, np.zeros(2), (0.0, 0.0, 1.0)).any()
    ]
    if ELASTIC_LINE in measures:
        why = "ElasticLine forces; use Structural or ContinuumMechanics"
    elif not kinds <= {GRADIENTS, ROTATED_GRADIENTS, ROTATION}:
        why = "nodes that do not shear"
    elif any(block.law is not None or block.imposed is not None for block in system.blocks):
        why = "a section law or imposed strains"
    elif any(block.damping.any() or block.mass_damping for block in system.blocks):
        why = "damping of beams"
    elif system.driven:
        why = "supports that move"
    elif len(system.connectors.multipliers):
        why = "conditions with multipliers"
    elif moving:
        why = f"the inertia of {moving[0]}"
    if why is not None:
        raise InputError(f"EnergyMomentum is not for {why}; use GeneralizedAlpha or Radau")
