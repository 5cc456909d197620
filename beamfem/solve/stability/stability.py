"""Whether states are stable, and the stable equilibrium that a search for buckling starts from."""

import numpy as np

from beamfem.equations.connector_traits import damps_at_rest
from beamfem.equations.equations import STATICS, linearise_at_rest, load_change, with_stresses
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.precision.mixed_tangent import MixedTangent
from beamfem.precision.roundoff import counts_with_stresses
from beamfem.results.solution import Solution, State
from beamfem.solve.linear.linearise import linearise
from beamfem.solve.modes.modes import solve_modes
from beamfem.solve.newton.newton import Newton, solve_equilibrium
from beamfem.solve.start.mechanisms import no_equilibrium_at_start
from beamfem.solve.start.start_checks import left_over
from beamfem.solve.start.start_state import resting_state
from beamfem.solve.statics.statics import first_equilibrium

_MODES = 12  # lowest modes that are checked for flutter under follower loads


def stable_rows(solution: Solution) -> np.ndarray:
    """Return whether each row of a static solution is stable (steps,); see `Solution.stable`."""
    system = system_of(solution.model, static=True)
    if system.symmetric:
        mixed = len(solution) > 0 and counts_with_stresses(system, solution.p[-1], float(solution.at[-1]))
        counts = (unstable_directions(system, p, at, mixed) for p, at in zip(solution.p, solution.at, strict=True))
        return np.array([count == 0 for count in counts])
    count = min(_MODES, len(system.free_dofs))
    damped = any(damps_at_rest(item) for item in system.connectors.items)
    return np.array([not np.any(_growth(solution[row], count, damped) > 0.0) for row in range(len(solution))])


def _growth(state: State, count: int, damped: bool) -> np.ndarray:
    """Return the growth (m,) [1/s] of the slowest modes of vibration about a state."""
    if damped:
        linear = linearise(state.model, state)
        return linear.modes(min(count, len(linear))).growth
    return solve_modes(state.model, count, about=state).growth


def unstable_directions(system: System, p: np.ndarray, load_factor: float, mixed: bool) -> int:
    """Return how many eigenvalues of the tangent are negative in the state p (n,); mixed: with stress resultants."""
    zeros = np.zeros(len(p))
    tangent = linearise_at_rest(system, p, load_factor)[1]
    if mixed and not isinstance(tangent, MixedTangent):
        tangent = with_stresses(system, (p, zeros, zeros), load_factor, STATICS, None, tangent)
    return tangent.factorised(system.rotated).negative_pivots


_WIDTHS = (1e-6, *np.linspace(0.1, 1.0, 10).tolist(), 3.0, 10.0)  # of the load factor: amplitudes may be flat at first
_ROUND_OFF = 8.0 * np.finfo(float).eps  # of the largest force: what is left of one along the normal of a roller


def stable_start(system: System, about: State | Solution | None) -> tuple[np.ndarray, float]:
    """Return the state p (n,) and load factor to start from. Raises InputError, ConvergenceError."""
    p, load_factor = resting_state(system, about)
    if left_over(system, p, load_factor) > 0.0:
        if about is None:
            equilibrium = first_equilibrium(system, Newton())
        else:
            equilibrium = solve_equilibrium(system, p, load_factor, Newton())
        if not equilibrium.ended.good:
            why = equilibrium.ended.value
            if about is None:
                raise ConvergenceError(no_equilibrium_at_start(system, why))
            raise ConvergenceError(f"no equilibrium at load factor {load_factor:g} to start from: {why}")
        p = equilibrium.state
    # imposed strains, as of heat, may load a beam between its supports without moving it
    imposed = any(block.imposed is not None for block in system.blocks)
    changes = (load_change(system, p, load_factor, load_factor + width) for width in _WIDTHS)
    parts = ((system.along_free(each) * system.scale[system.free_dofs], each * system.scale) for each in changes)
    grows = (np.any(np.abs(acting) > _ROUND_OFF * np.abs(whole).max()) for acting, whole in parts)
    if not imposed and not any(grows):
        raise InputError(
            "no load grows with the load factor, or supports take it up, so none can buckle the model",
            remedy="add one with scale=True",
        )
    unstable = unstable_directions(system, p, load_factor, mixed=False)
    if unstable > 0 and counts_with_stresses(system, p, load_factor):
        unstable = unstable_directions(system, p, load_factor, mixed=True)
    if unstable > 0:
        raise InputError(
            f"the state at load factor {load_factor:g} that buckling starts from is unstable already, "
            f"in {unstable} direction(s)"
        )
    return p, load_factor
