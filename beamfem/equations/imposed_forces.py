"""Magnitude of imposed strains, measured by the forces that would suppress them."""

import numpy as np

from beamfem.equations.applied_loads import LoadsAt
from beamfem.equations.equations import STATICS
from beamfem.equations.system import System


def imposed_forces(system: System, loads: LoadsAt) -> np.ndarray:
    """Return the forces (n,) that would hold the beams in their reference against the strains imposed on them."""
    result, p, zeros = np.empty(system.model.size), system.reference, np.zeros(system.model.size)
    assembler = system.assembler()
    assembler.load(np.zeros_like(loads.body), [np.zeros_like(values) for values in loads.points], loads.imposing)
    assembler.weigh(STATICS)
    assembler.balance(p, zeros, zeros, result, np.empty(0), False)
    return result
