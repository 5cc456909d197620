"""Small vibration about a state: its stiffness and mass, and the lowest eigenpairs of K phi = lambda M phi.

They are complete by Sturm counts, and accurate for slender beams.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from beamfem.cached_properties import cached_property
from beamfem.equations.equations import INERTIA, STATICS, linearise, residual_at_rest, with_stresses
from beamfem.equations.system import Proven, System
from beamfem.errors import ConvergenceError
from beamfem.linalg.eigenpairs import Pairs, largest_pairs, nothing_known, orthonormal
from beamfem.linalg.lapack import LinAlgError, eigh
from beamfem.linalg.tangent import UNROTATED, Factorised, Stresses, Tangent
from beamfem.precision.roundoff import LAST_DIGITS, LOSES, lost_digits
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes

_LOG_RANGE = 80.0  # logarithm of the largest ratio of eigenvalues
_AWAY = 0.75  # of a shift: least distance of an eigenvalue from it
_ASYMMETRY = 1e-12
_FELT = 1e-4  # of the work of random forces: fraction of the round-off of the stiffness above which it is examined


def is_symmetric(system: System, matrix: csr_array) -> bool:
    """Return whether a tangent (unknown, unknown) is symmetric up to round-off relative to its diagonal.

    Moments and forces are compared by their work on motions of the size of the model.
    """
    length = system.scale[system.free_dofs]
    size = np.sqrt(np.abs(matrix.diagonal())) * length
    difference = (matrix - matrix.T).tocoo()
    row, column = difference.row, difference.col
    apart = np.abs(difference.data) * length[row] * length[column]
    return bool(np.all(apart <= _ASYMMETRY * np.maximum(size[row] * size[column], 1e-3 * size.max() ** 2)))


@dataclass(frozen=True, eq=False)
class Pencil:
    """K phi = lambda M phi about the state p (n,) at a load factor."""

    system: System
    p: np.ndarray
    load_factor: float

    @cached_property
    def unbalanced(self) -> np.ndarray:
        """Residual (unknown,) of the state."""
        return residual_at_rest(self.system, self.p, self.load_factor)[self.system.free_dofs]

    def shifted(self, shift: float) -> Tangent:
        """Return K - shift M."""
        return self._tangent((1.0, 0.0, -shift))

    def _tangent(self, coefficients: tuple[float, float, float]) -> Tangent:
        mixed = Proven.LOSES_DIGITS in self.system.proven and coefficients != INERTIA
        stresses = self.balanced_stresses if mixed else None
        return linearise(self.system, *self._at_rest, self.load_factor, coefficients, stresses)[1]

    @property
    def _at_rest(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.p, np.zeros(len(self.p)), np.zeros(len(self.p))

    @cached_property
    def balanced_stresses(self) -> Stresses | None:
        """The stress resultants (ne, nq, ns) of each block that balance the loads, which rounded strains may not do.

        None in the reference, where all residuals are round-off, and in unstable states, which no correction balances.
        """
        if np.array_equal(self.p, self.system.reference):
            return None
        plain = linearise(self.system, *self._at_rest, self.load_factor, STATICS)[1]
        mixed = with_stresses(self.system, self._at_rest, self.load_factor, STATICS, None, plain)
        try:
            moved, stresses = mixed.factorised(self.system.rotated).correction(self.unbalanced)
        except LinAlgError:
            return None
        scale = self.system.scale[self.system.free_dofs]
        return stresses if np.max(np.abs(moved) / scale, initial=0.0) <= LAST_DIGITS else None

    @cached_property
    def mass(self) -> csr_array:
        return self._tangent(INERTIA).sparse(UNROTATED)

    @cached_property
    def stiffness(self) -> csr_array:
        return self._tangent(STATICS).sparse(UNROTATED)

    @cached_property
    def symmetric(self) -> bool:
        return is_symmetric(self.system, self.stiffness)

    @cached_property
    def size(self) -> int:
        """Number of modes; each inclined roller and each multiplier constrains one coordinate, and has none itself."""
        corner = self.stiffness.diagonal()[self.mass.shape[0] - len(self.system.connectors.multipliers) :]
        active = np.count_nonzero(corner == 0.0)  # of the conditions that come and go, too
        return self.mass.shape[0] - len(self.system.rotated[0]) - len(corner) - active

    def below(self, value: float) -> int:
        """Return how many eigenvalues of a symmetric pencil are below a value (Sylvester's law of inertia)."""
        return self.shifted(value).factorised(self.system.rotated).negative_pivots

    def begin(self, rigid: int) -> tuple[float, Factorised, float]:
        """Return a shift below all eigenvalues, see `shift`, the factors of K - shift M there, and what is `lost`."""
        shift = self.shift(rigid)
        factors = self.shifted(shift).factorised(self.system.rotated)
        lost = self.lost(shift, factors)
        if lost > LOSES:
            self.system.proven.add(Proven.LOSES_DIGITS)
            shift = self.shift(rigid)
            factors = self.shifted(shift).factorised(self.system.rotated)
        return shift, factors, lost

    def lost(self, shift: float, factors: Factorised) -> float:
        """Return the relative error of a solution with the plain K - shift M, 0 if it is negligible.

        factors: of K - shift M. If random inertia forces move parts so soft that the last digits of the stiffness
        count, the error is found by comparison with the tangent that has stress resultants as unknowns.
        """
        if Proven.LOSES_DIGITS in self.system.proven or self.system.connectors.items:
            return 0.0
        force = self.mass @ np.random.default_rng(0).standard_normal(self.mass.shape[0])
        moved = factors.solve(force)
        parts = float(np.abs(moved) @ (abs(self.stiffness) @ np.abs(moved)))
        if np.finfo(float).eps * parts <= _FELT * abs(float(moved @ force)):
            return 0.0
        return lost_digits(self.system, self.p, self.load_factor, (1.0, 0.0, -shift))

    def exact(self, shift: float) -> Tangent:
        """Return K - shift M with stress resultants as unknowns, which keeps the accuracy of soft parts."""
        if Proven.LOSES_DIGITS in self.system.proven:
            return self.shifted(shift)
        plain, coefficients = self.shifted(shift), (1.0, 0.0, -shift)
        return with_stresses(self.system, self._at_rest, self.load_factor, coefficients, self.balanced_stresses, plain)

    def shift(self, rigid: int) -> float:
        """Return a shift [1/s^2] below all eigenvalues, of the magnitude of the elastic one nearest to zero.

        rigid: number of zero eigenvalues; without any, zero itself is such a shift for a stable state.
        """
        if rigid == 0 and self.symmetric and self.below(0.0) == 0:
            return 0.0
        stiffness, mass = np.abs(self.stiffness.diagonal()), self.mass.diagonal()
        high = np.log(4.0 * float(np.max(stiffness[mass > 0.0] / mass[mass > 0.0])))  # multipliers have none
        low = high - _LOG_RANGE
        while high - low > np.log(4.0):
            middle = 0.5 * (low + high)
            size = np.exp(middle)
            near = self.below(size) - (self.below(-size) if self.symmetric else 0)
            low, high = (low, middle) if near > rigid else (middle, high)
        shift = -float(np.exp(high))
        # Near an eigenvalue round-off decides whether a shift is below it, and its factors lose the other eigenvalues.
        # This happens because the stiffness is odd in the load about a critical point, so that eigenvalues on one side
        # of it coincide with a shift for the other side.
        while self.symmetric and self.below(_AWAY * shift) > 0:
            shift *= 4.0
        return shift


_CLUSTER = 1e-9  # eigenvalues with a smaller relative distance cannot be counted separately


def complete(pencil: Pencil, squares: np.ndarray, count: int, rigid: int) -> tuple[int, int, float]:
    """Return whether at least the first `count` of ascending eigenvalues (m,), m > count, are the lowest ones.

    The result (found, missing, cut) says that the first `found` are, if none is `missing` below the value of the cut.

    rigid: number of zero eigenvalues besides. The eigenvalues below the largest gap after the last one are counted, or
    below the first gap if some of those between were missed. If there is no gap, or some are missing, the last one may
    belong to a cluster with more members than were asked for: it then does not matter which of them are found, so those
    below the cluster are counted.
    """
    joined = np.diff(squares) <= _CLUSTER * np.abs(squares[1:])
    for above in (count + int(np.argmax(np.diff(squares[count - 1 :]))), count):
        if not joined[above - 1]:
            cut = 0.5 * (squares[above - 1] + squares[above])
            if _below(pencil, squares, cut, rigid) == above:
                return above, 0, cut
    gaps = np.flatnonzero(~joined) + 1
    first, end = gaps[gaps < count].max(initial=0), gaps[gaps >= count].min(initial=len(squares))
    cut = squares[first] - _CLUSTER * abs(squares[first])
    if first > 0:
        cut = max(cut, 0.5 * (squares[first - 1] + squares[first]))
    return int(end), _below(pencil, squares, cut, rigid) - int(first), cut


def _below(pencil: Pencil, squares: np.ndarray, cut: float, rigid: int) -> int:
    """Return how many eigenvalues there are below a cut, without the zero ones.

    The round-off of the plain tangent moves its eigenvalues, so that those near the cut would be counted at random.
    """
    near = np.abs(squares - cut).min() <= LOSES * abs(cut)
    # with connectors, only the plain tangent is available
    tangent = pencil.exact(cut) if near and not pencil.system.connectors.items else pencil.shifted(cut)
    return tangent.factorised(pencil.system.rotated).negative_pivots - (rigid if cut > 0.0 else 0)


_SPARE = 4  # eigenvalues found beyond those asked for, so that a gap can be seen
_RANGE = 1e6  # largest ratio of eigenvalues that are computed together from the stiffness
_SEARCHES = 8
WRONG = 1e-5  # of vectors: largest acceptable error by round-off of the tangent
_SOLVES = 2  # for vectors with noticeable round-off: each reduces their error to about a hundredth


def lowest_pairs(pencil: Pencil, count: int, rigid: np.ndarray) -> Pairs:
    """Return the lowest lambda (m,) [1/s^2], ascending, and vectors (unknown, m), of a symmetric pencil, m >= count.

    rigid (unknown, r): M-orthonormal vectors with lambda = 0, which the result does not contain. Raises
    ConvergenceError if some were missed.
    """
    n, available = pencil.mass.shape[0], pencil.size - rigid.shape[1]
    if count == 0:
        return nothing_known(n)
    start, factors, lost = pencil.begin(rigid.shape[1])
    wanted, known = min(count + _SPARE, available), rigid
    correction = np.zeros_like(pencil.p)
    correction[pencil.system.free_dofs] = -factors.solve(pencil.unbalanced)
    pairs, missing = nothing_known(n), wanted
    for _ in range(_SEARCHES):
        more = largest_pairs(pencil.mass, factors, min(missing, available - len(pairs[0])), known)
        pairs = _sorted(np.append(pairs[0], start + 1.0 / more[0]), np.column_stack([pairs[1], more[1]]))
        squares, vectors = _refined(pencil, *_sharpened(pencil, *pairs, start if lost > WRONG else None), correction)
        if len(squares) == available:
            return squares, vectors
        found, missing, cut = complete(pencil, squares, count, rigid.shape[1])
        if missing == 0:
            return squares[:found], vectors[:, :found]
        missing = max(missing, _SPARE)
        known = np.column_stack([known, more[1]])
    below_cut = f"{np.sqrt(max(cut, 0.0)) / (2.0 * np.pi):.6g} {pencil.system.model.unit('Hz')}"
    raise ConvergenceError(f"modes below {below_cut} were missed")


def _sharpened(pencil: Pencil, squares: np.ndarray, vectors: np.ndarray, start: float | None) -> Pairs:
    """Return the vectors (unknown, m) of eigenvalues far above the lowest after further solves, at a shift below them.

    The factors that found them carry the round-off of the lowest, which grows with the ratio of the eigenvalues.
    start: shift below all if the round-off of the tangent is noticeable, so that the lowest are solved for as well.
    """
    first, *others = _alike(squares)
    sharp = vectors[:, first]
    if start is not None:
        sharp = _solved(pencil, pencil.exact(start), np.empty((len(vectors), 0)), sharp)
    for part in others:
        shift = 0.5 * squares[part.start]
        tangent = pencil.shifted(shift) if start is None else pencil.exact(shift)
        sharp = np.column_stack([sharp, _solved(pencil, tangent, sharp, vectors[:, part])])
    return squares, sharp


def _solved(pencil: Pencil, tangent: Tangent, known: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return vectors (n, m) after inverse iterations, without their components along known ones (n, k).

    They are M-orthonormal: otherwise all of them would come near the one whose eigenvalue is nearest to the shift.
    """
    factors, result = tangent.factorised(pencil.system.rotated), _besides(pencil, known, vectors)
    for _ in range(_SOLVES):
        result = np.column_stack([factors.solve(column) for column in (pencil.mass @ result).T])
        result = orthonormal(_besides(pencil, known, result), pencil.mass)
    return result


def _besides(pencil: Pencil, known: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return vectors (n, m) without their components along known ones (n, k), and with x^T M x = 1."""
    vectors = vectors - known @ (known.T @ (pencil.mass @ vectors))
    return np.asarray(vectors / np.sqrt((vectors * (pencil.mass @ vectors)).sum(axis=0)))


def _refined(pencil: Pencil, squares: np.ndarray, vectors: np.ndarray, correction: np.ndarray) -> Pairs:
    """Return eigenpairs recomputed from the stiffness of their vectors, free of the round-off of assembled tangents.

    Vectors with eigenvalues of similar size are treated together (Rayleigh-Ritz), as they may be mixed if these are
    close.
    """
    modes = np.zeros((len(squares), len(pencil.p)))
    modes[:, pencil.system.free_dofs] = vectors.T
    stiffness = stiffness_of_modes(pencil.system, pencil.p, pencil.load_factor, modes, correction)
    mass = vectors.T @ (pencil.mass @ vectors)
    parts = []
    for part in _alike(squares):
        try:
            values, mixed = eigh(stiffness[part, part], mass[part, part])
        except LinAlgError:
            raise ConvergenceError(
                "the tangent of such a slender model has no reliable digits, so that modes cannot be distinguished"
            ) from None
        parts.append((values, vectors[:, part] @ mixed))
    return _sorted(np.concatenate([values for values, _ in parts]), np.column_stack([x for _, x in parts]))


def _alike(squares: np.ndarray) -> list[slice]:
    """Return parts of ascending eigenvalues, cut at gaps, whose ratio is bounded."""
    first, result = 0, []
    while first < len(squares):
        far = np.flatnonzero(squares[first:] > _RANGE * np.abs(squares[: first + 1]).max())
        last = len(squares)
        if len(far):
            inside = np.arange(first + 1, first + int(far[0]) + 1)
            fractions = np.abs(squares[inside - 1]) / squares[inside]
            last = int(inside[np.argmin(fractions)])
        result.append(slice(first, last))
        first = last
    return result


def _sorted(values: np.ndarray, vectors: np.ndarray) -> Pairs:
    order = np.argsort(values, kind="stable")
    return values[order], vectors[:, order]
