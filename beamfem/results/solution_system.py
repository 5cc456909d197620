"""The equations that the rows of a solution satisfy, their loads and imposed strains; corrections of static rows.

In a stiff part of a model the last digit of a position may amount to a force larger than the applied loads. The state
is still the equilibrium; the correction is found from the residual (`precision.roundoff.remainder`) and stored apart.
"""

from collections.abc import Callable

import numpy as np

from beamfem.equations.differences import changed, widths
from beamfem.equations.system import System, system_of
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.precision.roundoff import digits_of, remainder
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


_ENOUGH = 7.0  # digits of the forces at which a state needs no correction


def remainders(solution: Solution) -> np.ndarray:
    """Return the corrections of the coordinates of each row (steps, n); zero if they are exact enough."""
    result = np.zeros(solution.p.shape)
    if not solution.static:
        return result
    system = system_of(solution.model, True)
    for row, at in enumerate(solution.at):
        if digits_of(system, solution.p[row], float(at)) < _ENOUGH:
            result[row] = remainder(system, solution.p[row], float(at)).step
    return result


def _corrected(solution: Solution) -> np.ndarray:
    """Return whether each row has remainders (steps,)."""
    return np.asarray(solution.remainders.any(axis=1))


def _widths(solution: Solution) -> np.ndarray:
    """Return the widths of the differences (steps,), those of the whole model: values of a beam do not depend on which
    others are evaluated with it.
    """
    return widths(system_of(solution.model, solution.static), solution.remainders)


def exactly(
    solution: Solution,
    values: Callable[[np.ndarray], np.ndarray],
    rows: slice | np.ndarray = slice(None),
    some: slice | np.ndarray = slice(None),
) -> np.ndarray:
    """Return a function (steps, ...) of some coordinates (steps, k) of rows; remainders are included to first order."""
    p = solution.p[rows][:, some]
    result = values(p)
    if not solution.computed(_corrected)[rows].any():
        return result
    return result + changed(values, p, solution.remainders[rows][:, some], solution.computed(_widths)[rows])
