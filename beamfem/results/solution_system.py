"""The equations that the rows of a solution satisfy, the load factors or times of their loads, and imposed strains."""

import numpy as np

from beamfem.equations.system import System, system_of
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.results.solution import Solution


def loading(solution: Solution) -> tuple[System, np.ndarray]:
    """Return the system of a solution and the load factor or time [s] (steps,) of its loads in each row."""
    if solution.loaded is not None:
        return system_of(solution.model, static=True), solution.loaded
    return system_of(solution.model, solution.static), solution.at


def imposing(solution: Solution) -> np.ndarray:
    """Return the factors (steps, k) of the loads that impose strains."""
    system, at = loading(solution)
    return system.loads.of_rows(at.tolist()).imposing


def imposed_measures(solution: Solution, mesh: BeamMesh, rows: slice | np.ndarray = slice(None)) -> np.ndarray | float:
    """Return the imposed strains (steps, points, ns) at the strain energy points of a beam; 0 if there are none."""
    system, _ = loading(solution)
    imposed = system.blocks[mesh.block].imposed
    if imposed is None:
        return 0.0
    strains = imposed._replace(chosen=slice(mesh.first_element, mesh.first_element + mesh.elements))
    values = [strains.at(factors) for factors in solution.computed(imposing)[rows]]
    return np.array(values).reshape(len(values), -1, imposed.shape[-1])
