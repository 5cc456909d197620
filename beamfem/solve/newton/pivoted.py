"""Newton's corrections of any model: sparse matrix, stress resultants as unknowns, or band with pivoting."""

import numpy as np

from beamfem.assembly.equations import STATICS, linearise, predicted_stresses
from beamfem.assembly.system import System
from beamfem.linalg.tangent import Factorised, Stresses
from beamfem.solve.newton.convergence import Balance, balance_of
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.newton.iteration_loop import SingleCorrections
from beamfem.solve.newton.linear_step import count_after
from beamfem.solve.newton.prescribed_step import PrescribedStep


class PivotedProblem(SingleCorrections):
    """The equilibrium at a load factor, from the state `start` (n,)."""

    counts_digits = False

    def __init__(
        self, system: System, start: np.ndarray, load_factor: float, newton: Newton, step: PrescribedStep
    ) -> None:
        super().__init__()
        self.system, self.start, self.load_factor, self.newton, self.step = system, start, load_factor, newton, step
        self.state = self.linear = start
        self.stresses: Stresses | None = None

    def take(self) -> tuple[float, int]:
        """Take the next correction, see `SingleCorrections`. Raises LinAlgError if the tangent is singular."""
        system, p, zeros, free = self.system, self.state, np.zeros(len(self.state)), self.system.free_dofs
        unbalanced, tangent = linearise(system, p, zeros, zeros, self.load_factor, STATICS, self.stresses)
        factors: Factorised = tangent.factorised(system.rotated)
        step = self.step.step.copy() if self.taken == 0 else np.zeros(len(p))
        step[free], after = factors.correction(unbalanced[free])
        if self.taken == 0 and self.step.moves:
            step[free] -= factors.solve(self.step.force[free])
            after = None
        if self.newton.independent_stresses:
            self.stresses = after or predicted_stresses(system, p, step, self.load_factor)
        self.state = p + step
        if self.taken == 0:
            self.linear = self.state
        return float(np.max(np.abs(step) / system.scale, initial=0.0)), factors.negative_pivots

    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""
        return balance_of(self.system, self.state, self.load_factor)

    def count_after_linear(self) -> int:
        """Return the negative pivots at the start with the stresses of a linear step, -1 if singular."""
        return count_after(self.system, self.start, self.linear - self.start, self.load_factor)
