"""Strains that loads impose on a beam, in the rows of a solution."""

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.results.solution import Solution
from beamfem.results.solution_system import imposing, loading


def imposed_measures(solution: Solution, mesh: BeamMesh, rows: slice | np.ndarray = slice(None)) -> np.ndarray | float:
    """Return the imposed strains (steps, points, ns) at the strain energy points of a beam; 0 if there are none."""
    system, _ = loading(solution)
    imposed = system.blocks[mesh.block].imposed
    if imposed is None:
        return 0.0
    strains = imposed.of(slice(mesh.first_element, mesh.first_element + mesh.elements))
    values = [strains.at(factors) for factors in solution.computed(imposing)[rows]]
    return np.array(values).reshape(len(values), -1, strains.first.shape[-1])
