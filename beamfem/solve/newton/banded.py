"""Newton's corrections of a model whose tangent is a band, in compiled code up to one that is small."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.arena import Arena
from beamfem.assembly.equations import STATICS
from beamfem.assembly.round_off import load_size
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.newton import iterate
from beamfem.linalg.tangent import SMALLEST_PIVOT
from beamfem.solve.newton.convergence import LARGEST, STAGNANT, Balance, Correction
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.newton.prescribed_step import PrescribedStep


class BandProblem:
    """The equilibrium at a load factor, from the state `start` (n,); keep: see `loop.iterate`."""

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
        self.system, self.start = system, start
        n, unknown, half = len(start), len(system.free_dofs), system.layouts[0].half_width
        values = system.point_values(load_factor)
        self.load = load_size(system, values)
        self.assembler = system.assembler()
        self.assembler.load(system.body(load_factor), values)
        self.assembler.weigh(STATICS)
        self.assembler.require("tangent", "prediction")
        room = Arena(
            {
                "p": (n,),
                "residual": (n,),
                record.STEP: (n,),
                record.PRESCRIBED_STEP: (n,),
                record.PRESCRIBED_FORCE: (n,),
                record.RIGHT: (unknown,),
                record.ROWS: (unknown, 2 * half + 1),
                record.LIMITS: (7,),
                record.FOUND: (9,),
                record.LINEAR: (n,),
            }
        )
        self.p, self.residual, first, *self.prescribed, _, rows, limits, self.found, self.linear = room.arrays.values()
        place = room.addresses
        states = place.pop("p"), place[record.STEP], place[record.STEP]
        self.assembler.place_at(states, place.pop("residual"), place[record.ROWS], rows.size)
        self.table, self.routines = system.solver_table.filled(place), system.solver_table.routines(moving=False)
        self.p[:], first[:] = start, 0.0
        self.prescribed[0][:], self.prescribed[1][:] = step.step, step.force
        self.found[:] = 0.0
        self.found[1:3] = np.inf
        limits[:4] = newton.tolerance, STAGNANT, LARGEST, SMALLEST_PIVOT
        limits[4:] = newton.iterations, newton.independent_stresses, -1 if keep is None else keep
        self._room = room

    def correct(self) -> Correction:
        """Take corrections up to one that is small or stagnant. Raises LinAlgError where pivots are needed."""
        if not iterate(self.assembler.address, self.table, self.routines):
            raise LinAlgError("a pivot is tiny")
        self.prescribed[0][:] = self.prescribed[1][:] = 0.0
        return Correction(int(self.found[0]), self.found[1], self.found[2], int(self.found[6]))

    @property
    def state(self) -> np.ndarray:
        """The state (n,) reached."""
        return self.p.copy()

    def balance(self) -> Balance:
        """Return what is left of the balance in the state reached."""
        force = max(self.found[4], self.load)
        return Balance(self.p, self.residual, self.found[3], force, self.found[5] <= 0.0)

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        return float(self.found[7]), int(self.found[8])

    def linear_state(self) -> np.ndarray:
        """Return the state (n,) after the first correction."""
        return self.linear.copy()
