"""Newton's corrections of a model with a band tangent, in compiled code until one is small."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.band_workspace import band_workspace
from beamfem.assembly.system import System
from beamfem.kernels import newton_record as r
from beamfem.kernels.newton_loop import count_after_step, iterate
from beamfem.linalg.tangent import SMALLEST_PIVOT
from beamfem.precision.roundoff import load_size
from beamfem.solve.newton.convergence import LARGEST, STAGNANT, Balance, Correction
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.newton.prescribed_step import PrescribedStep


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

    def give_back(self) -> None:
        """Release the workspace for the next solve."""
        self.space.give_back(self.system)
