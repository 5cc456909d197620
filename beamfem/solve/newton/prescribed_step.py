"""The step of prescribed coordinates at the beginning of an iteration."""

import numpy as np

from beamfem.assembly.differences import differentiated
from beamfem.assembly.equations import residual
from beamfem.assembly.system import System
from beamfem.cached_properties import cached_property


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
