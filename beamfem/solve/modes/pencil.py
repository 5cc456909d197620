"""Small vibration about a state: stiffness and mass of the unknown coordinates, counts of eigenvalues."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import csr_array

from beamfem.assembly.equations import INERTIA, STATICS, linearise, residual, with_stresses
from beamfem.assembly.system import Proven, System
from beamfem.cached_properties import cached_property
from beamfem.linalg.tangent import UNROTATED, Factorised, Stresses, Tangent
from beamfem.precision.roundoff import LAST_DIGITS, lost_digits

_RANGE = 80.0  # logarithm of the largest ratio of eigenvalues
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
        zeros = np.zeros(len(self.p))
        return residual(self.system, self.p, zeros, zeros, self.load_factor)[self.system.free_dofs]

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
        conditions = len(self.system.connectors.multipliers)
        return self.mass.shape[0] - len(self.system.rotated[0]) - 2 * conditions

    def below(self, value: float) -> int:
        """Return how many eigenvalues of a symmetric pencil are below a value (Sylvester's law of inertia)."""
        return self.shifted(value).factorised(self.system.rotated).negative_pivots

    def below_exactly(self, value: float) -> int:
        """Return how many eigenvalues of a symmetric pencil are below a value, however close some are to it.

        With contributions, only the plain tangent is available, as in `lost`.
        """
        if self.system.connectors.items:
            return self.below(value)
        return self.exact(value).factorised(self.system.rotated).negative_pivots

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
        low = high - _RANGE
        while high - low > np.log(4.0):
            middle = 0.5 * (low + high)
            size = np.exp(middle)
            near = self.below(size) - (self.below(-size) if self.symmetric else 0)
            low, high = (low, middle) if near > rigid else (middle, high)
        shift = -float(np.exp(high))
        while self.symmetric and not self.clear_of(shift):
            shift *= 4.0
        return shift

    def clear_of(self, shift: float) -> bool:
        """Return whether a negative shift is below all eigenvalues of a symmetric pencil, and away from them.

        Near an eigenvalue round-off decides whether a shift is below it, and its factors lose the other eigenvalues.
        This happens because the stiffness is odd in the load about a critical point, so that eigenvalues on one side of
        it coincide with a shift for the other side.
        """
        return self.below(_AWAY * shift) == 0
