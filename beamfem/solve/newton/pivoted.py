"""Newton's corrections of any model: sparse matrix, stress resultants as unknowns, or band with pivoting."""

import numpy as np

from beamfem.assembly.equations import STATICS, linearise, predicted_stresses
from beamfem.assembly.system import System
from beamfem.linalg.tangent import Factorised, Stresses
from beamfem.solve.newton.convergence import Balance, Correction, balance_of
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.newton.linear_step import count_after
from beamfem.solve.newton.prescribed_step import PrescribedStep


class PivotedProblem:
    """The equilibrium at a load factor, from the state `start` (n,)."""

    counts_digits = False

    def __init__(
        self, system: System, start: np.ndarray, load_factor: float, newton: Newton, step: PrescribedStep
    ) -> None:
        self.system, self.start, self.load_factor, self.newton, self.step = system, start, load_factor, newton, step
        self.state = self.linear = start
        self.stresses: Stresses | None = None
        self.number, self.size, self.first, self.second = 0, np.inf, np.nan, 0

    def correct(self) -> Correction:
        """Take the next correction. Raises LinAlgError if the tangent is singular."""
        system, p, zeros, free = self.system, self.state, np.zeros(len(self.state)), self.system.free_dofs
        unbalanced, tangent = linearise(system, p, zeros, zeros, self.load_factor, STATICS, self.stresses)
        factors: Factorised = tangent.factorised(system.rotated)
        step = self.step.step.copy() if self.number == 0 else np.zeros(len(p))
        step[free], after = factors.correction(unbalanced[free])
        if self.number == 0 and self.step.moves:
            step[free] -= factors.solve(self.step.force[free])
            after = None
        if self.newton.independent_stresses:
            self.stresses = after or predicted_stresses(system, p, step, self.load_factor)
        self.state, before = p + step, self.size
        self.number += 1
        self.size = float(np.max(np.abs(step) / system.scale, initial=0.0))
        if self.number == 1:
            self.first, self.linear = self.size, self.state
        elif self.number == 2:
            self.second = factors.negative_pivots
        return Correction(self.number, self.size, before, factors.negative_pivots)

    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""
        return balance_of(self.system, self.state, self.load_factor)

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        return self.first, self.second

    def count_after_linear(self) -> int:
        """Return the negative pivots at the start with the stresses of a linear step, -1 if singular."""
        return count_after(self.system, self.start, self.linear - self.start, self.load_factor)
