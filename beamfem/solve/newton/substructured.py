"""Newton's corrections of a long chain, by substructures on two threads."""

from concurrent.futures import Executor

import numpy as np

from beamfem.assembly.equations import STATICS, linearise
from beamfem.assembly.system import System
from beamfem.solve.newton.convergence import Balance, Correction, balance_with
from beamfem.solve.newton.cut_chain import substructures_of
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.newton.linear_step import count_after
from beamfem.solve.newton.prescribed_step import PrescribedStep
from beamfem.solve.newton.substructures import correct, joined, negative_pivots


class SubstructuredProblem:
    """The equilibrium at a load factor, from the state `start` (n,); pool: provides a second thread."""

    counts_digits = True

    def __init__(
        self,
        system: System,
        start: np.ndarray,
        load_factor: float,
        newton: Newton,
        step: PrescribedStep,
        pool: Executor,
    ) -> None:
        self.system, self.start, self.load_factor, self.newton = system, start, load_factor, newton
        self.step, self.pool, self.substructures = step, pool, substructures_of(system, start, load_factor)
        self.number, self.size, self.first, self.second = 0, np.inf, np.nan, 0

    def correct(self) -> Correction:
        """Take the next correction. Raises LinAlgError if pivoting is needed."""
        change = (self.step.step, self.step.force) if self.number == 0 else None
        before = self.size
        self.size, shared = correct(self.substructures, self.pool, self.newton.independent_stresses, change)
        negative = negative_pivots(self.substructures, shared)
        self.number += 1
        if self.number == 1:
            self.first = self.size
        elif self.number == 2:
            self.second = negative
        return Correction(self.number, self.size, before, negative)

    @property
    def state(self) -> np.ndarray:
        """The state (n,) reached."""
        result = np.zeros(len(self.start))
        for half in self.substructures:
            result[half.place] = half.p
        return result

    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""
        p, unbalanced, jacobian = joined(self.substructures, self.pool)
        return balance_with(self.system, p, self.load_factor, unbalanced, jacobian)

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        return self.first, self.second

    def count_after_linear(self) -> int:
        """Return the negative pivots at the start with the stresses of a linear step, repeated here; -1 if singular."""
        zeros = np.zeros(len(self.start))
        unbalanced, tangent = linearise(self.system, self.start, zeros, zeros, self.load_factor, STATICS)
        step, free = self.step.step.copy(), self.system.free_dofs
        step[free] = tangent.solve(-(unbalanced + self.step.force)[free], self.system.rotated)
        return count_after(self.system, self.start, step, self.load_factor)
