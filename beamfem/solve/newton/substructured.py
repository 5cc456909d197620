"""Newton's corrections of a long chain, by substructures on two threads."""

from concurrent.futures import Executor

import numpy as np

from beamfem.assembly.equations import STATICS, linearise
from beamfem.assembly.system import System
from beamfem.solve.newton.convergence import Balance, balance_with
from beamfem.solve.newton.cut_chain import substructures_of
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.newton.linear_step import count_after
from beamfem.solve.newton.loop import SingleCorrections
from beamfem.solve.newton.prescribed_step import PrescribedStep
from beamfem.solve.newton.substructures import correct, joined, negative_pivots


class SubstructuredProblem(SingleCorrections):
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
        super().__init__()
        self.system, self.start, self.load_factor, self.newton = system, start, load_factor, newton
        self.step, self.pool, self.substructures = step, pool, substructures_of(system, start, load_factor)

    def take(self) -> tuple[float, int]:
        """Take the next correction, see `SingleCorrections`. Raises LinAlgError if pivoting is needed."""
        change = (self.step.step, self.step.force) if self.taken == 0 else None
        size, shared = correct(self.substructures, self.pool, self.newton.independent_stresses, change)
        return size, negative_pivots(self.substructures, shared)

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

    def count_after_linear(self) -> int:
        """Return the negative pivots at the start with the stresses of a linear step, repeated here; -1 if singular."""
        zeros = np.zeros(len(self.start))
        unbalanced, tangent = linearise(self.system, self.start, zeros, zeros, self.load_factor, STATICS)
        step, free = self.step.step.copy(), self.system.free_dofs
        step[free] = tangent.solve(-(unbalanced + self.step.force)[free], self.system.rotated)
        return count_after(self.system, self.start, step, self.load_factor)
