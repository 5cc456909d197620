"""Newton's corrections: of a band in compiled code, or of any model with pivoting."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.band_workspace import band_workspace
from beamfem.assembly.differences import differentiated
from beamfem.assembly.equations import STATICS, linearise, linearise_after, predicted_stresses, residual
from beamfem.assembly.system import System
from beamfem.cached_properties import cached_property
from beamfem.kernels import newton_record as r
from beamfem.kernels.newton_loop import count_after_step, iterate
from beamfem.linalg.tangent import SMALLEST_PIVOT, Factorised, Stresses
from beamfem.precision.roundoff import load_size
from beamfem.solve.newton.iteration import LARGEST, STAGNANT, Balance, Correction, Newton, SingleCorrections, balance_of


class PrescribedStep:
    """The step (n,) from a state (n,) that brings the prescribed coordinates to their values at a load factor."""

    def __init__(self, system: System, start: np.ndarray, load_factor: float) -> None:
        self.system, self.start, self.load_factor = system, start, load_factor
        self.step = np.zeros(len(start))
        dofs = system.prescribed_dofs
        change = system.prescribed_values(load_factor) - start[dofs]
        self.moves = np.count_nonzero(change) > 0
        if self.moves:
            self.step[dofs] = change

    @cached_property
    def force(self) -> np.ndarray:
        """Change of the residual (n,) with the step."""
        if not self.moves:
            return np.zeros(len(self.start))
        zeros = np.zeros(len(self.start))
        return differentiated(
            self.system, lambda p: residual(self.system, p, zeros, zeros, self.load_factor), self.start, self.step
        )


def count_after(system: System, start: np.ndarray, step: np.ndarray, load_factor: float) -> int:
    """Return the negative pivots of the tangent in `start` (n,) with the stress resultants of a linear step (n,).

    The shape after the step may be far off, so that the count of its tangent says nothing. -1 if it is singular.
    """
    try:
        return linearise_after(system, start, step, load_factor).factorised(system.rotated).negative_pivots
    except LinAlgError:
        return -1


class BandProblem:
    """The equilibrium at a load factor, from the state `start` (n,); keep: see `find_equilibrium`."""

    counts_digits = True

    def __init__(
        self,
        system: System,
        start: np.ndarray,
        load_factor: float,
        newton: Newton,
        step: PrescribedStep,
        keep: int | None,
    ) -> None:
        self.system, self.start, self.space = system, start, band_workspace(system)
        loads, space = system.loads_at(load_factor), self.space
        self.load = load_size(system, loads)
        space.begin(loads, load_factor)
        space.p[:], space.step[:], space.found[:] = start, 0.0, 0.0
        space.found[r.CORRECTION] = space.found[r.CORRECTION_BEFORE] = np.inf
        space.prescribed_step[:], space.prescribed_force[:] = step.step, step.force
        limits = space.limits
        limits[r.TOLERANCE], limits[r.STAGNANT], limits[r.DIVERGENT] = newton.tolerance, STAGNANT, LARGEST
        limits[r.PIVOT_RATIO], limits[r.MOST_ITERATIONS] = SMALLEST_PIVOT, newton.iterations
        limits[r.PREDICTED_RESULTANTS] = newton.independent_stresses
        limits[r.REQUIRED_NEGATIVE_PIVOTS] = -1 if keep is None else keep

    def correct(self) -> Correction:
        """Take corrections until one is small or stagnant. Raises LinAlgError if pivoting is needed."""
        space, found = self.space, self.space.found
        factorised = space.call(iterate.compiled)
        if not factorised:
            raise LinAlgError("a pivot is tiny")
        space.prescribed_step[:] = space.prescribed_force[:] = 0.0
        negative = int(found[r.NEGATIVE_PIVOTS])
        return Correction(int(found[r.ITERATIONS]), found[r.CORRECTION], found[r.CORRECTION_BEFORE], negative)

    @property
    def state(self) -> np.ndarray:
        """The state (n,) reached."""
        return self.space.p.copy()

    def balance(self) -> Balance:
        """Return the balance of forces in the state reached."""
        space, found = self.space, self.space.found
        force = max(found[r.FORCE], self.load)
        return Balance(space.p, space.residual, found[r.UNBALANCED], force, found[r.JACOBIAN] <= 0.0)

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        found = self.space.found
        return float(found[r.FIRST_CORRECTION]), int(found[r.NEGATIVE_PIVOTS_AFTER_FIRST])

    def count_after_linear(self) -> int:
        """Return the negative pivots at the start with the stresses of a linear step; overwrites the state reached."""
        space = self.space
        space.step[:] = space.linear - self.start
        space.p[:] = self.start
        return int(space.call(count_after_step.compiled))

    def return_scratch(self) -> None:
        """Release the workspace for the next solve."""
        self.space.return_scratch(self.system)


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
