"""How much of its stiffness a loaded structure has lost: (K0 - K) phi = mu K0 phi, K is singular where a mu is 1.

K0 is the tangent in a stable state. On a linear path mu grows in proportion to the load, mu_j = load / critical load j,
so that each mu is nearly straight over the load factor and the order of critical loads is that of the mu.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from beamfem.analysis.eigenpairs import Pairs, largest_pairs
from beamfem.analysis.equations import STATICS, linearise
from beamfem.analysis.mode_stiffness import mode_stiffness
from beamfem.analysis.pencil import UNTURNED, is_symmetric
from beamfem.analysis.primary_path import Equilibrium
from beamfem.analysis.tangent import Factorised, Tangent
from beamfem.errors import ConvergenceError, InputError
from beamfem.model.system import System

_CHANGE = 1e-3  # of the coordinates, over which the tangent's derivative is taken
_NONE = 1e-10  # of the largest |mu|: values this small are round-off


@dataclass(frozen=True, eq=False)
class Start:
    """The stable state that stiffness is lost from."""

    system: System
    state: Equilibrium
    stiffness: csr_array
    factors: Factorised

    @classmethod
    def at(cls, system: System, state: Equilibrium) -> "Start":
        """Return what is needed of a state. Raises InputError where it is not stable or loads are not conservative."""
        tangent = _tangent(system, state.p, state.load_factor)
        start = cls(system, state, tangent.sparse(UNTURNED), tangent.factorised(system.turned))
        if start.factors.negative_pivots > 0:
            raise InputError(
                f"the state at load factor {state.load_factor:g} that buckling starts from is unstable already, "
                f"in {start.factors.negative_pivots} direction(s)"
            )
        return start

    def lost(self, p: np.ndarray, load_factor: float, count: int) -> np.ndarray:
        """Return the `count` largest shares mu (m,), descending, and all others above 1. Raises ConvergenceError.

        There are as many above 1 as the tangent has negative eigenvalues, but for round-off: none is missed.
        """
        tangent = _tangent(self.system, p, load_factor)
        negative = tangent.factorised(self.system.turned).negative_pivots
        change = csr_array(self.stiffness - tangent.sparse(UNTURNED))
        known: Pairs | None = None
        missing = max(count, negative)
        for _ in range(5):
            known = largest_pairs(change, self.stiffness, self.factors, missing, known)
            missing = negative - int((known[0] > 1.0 - self._round_off(known[1])).sum())
            if missing <= 0:
                return known[0]
        raise ConvergenceError(f"{missing} unstable mode(s) at load factor {load_factor:.6g} were not found")

    def _round_off(self, shapes: np.ndarray) -> np.ndarray:
        """Return how near to 1 the shares of shapes (n, m) may lie while the sign of a pivot is chance.

        It is the round-off of phi K phi, which is large where parts cancel that stretch a slender beam.
        """
        stretched = self.stiffness.diagonal() @ shapes**2
        return np.asarray(4.0 * np.finfo(float).eps * stretched)

    def lost_by_mode(self, p: np.ndarray, load_factor: float, number: int) -> float:
        """Return the share mu counted from 0 by `number`, without the round-off of assembled tangents."""
        return 1.0 - mode_stiffness(self.system, p, load_factor, self.critical_shape(p, load_factor, number))

    def critical_shape(self, p: np.ndarray, load_factor: float, number: int) -> np.ndarray:
        """Return the shape (n,) of the share counted from 0 by `number`, phi K0 phi = 1, close to where it is 1."""
        change = csr_array(self.stiffness - _tangent(self.system, p, load_factor).sparse(UNTURNED))
        result = np.zeros_like(p)
        result[self.system.free_dofs] = largest_pairs(change, self.stiffness, self.factors, number + 1)[1][:, number]
        return result

    def rates(self, count: int) -> np.ndarray:
        """Return the `count` largest rates dmu/d(load factor) (m,) at the start, only positive ones.

        The derivative of the tangent along the path is a difference of fourth order.
        """
        moved = float(np.max(np.abs(self.state.slope) / self.system.scale))
        width = _CHANGE / moved
        rate = csr_array(self.stiffness.shape)
        for steps, weight in ((1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)):
            at = steps * width
            tangent = _tangent(self.system, self.state.p + at * self.state.slope, self.state.load_factor + at)
            rate = rate + weight / (12.0 * width) * tangent.sparse(UNTURNED)
        if not is_symmetric(csr_array(self.stiffness + width * rate)):
            raise InputError(
                "some load turns with the beam and its work depends on the way: such loads can make a structure "
                "flutter before its tangent is singular. Look at the growth of solve_modes(model, about=state) instead"
            )
        found = largest_pairs(csr_array(-rate), self.stiffness, self.factors, count)[0]
        return np.asarray(found[found > _NONE * moved])


def _tangent(system: System, p: np.ndarray, load_factor: float) -> Tangent:
    rest = np.zeros_like(p)
    return linearise(system, p, rest, rest, load_factor, STATICS)[1]
