"""The state that a solve starts from."""

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.results.fitting import require_finite
from beamfem.results.solution import Solution, State
from beamfem.solve.start.transfer import transferred, warn_of_lost_history


def last_state(given: State | Solution | None, name: str = "start") -> State | None:
    """Return a state as it is, and of a solution its last one. Raises InputError for anything else but None."""
    if isinstance(given, Solution):
        if not len(given):
            raise InputError(f"{name} must be a state, but this solution has no rows")
        return given[-1]
    if given is not None and not isinstance(given, State):
        raise InputError(f"{name} must be a state, such as solution[-1], or a solution, got a {type(given).__name__}")
    return given


def start_state(system: System, start: State | None, name: str = "start") -> np.ndarray:
    """Return the coordinates (n,) to start from: the reference, or those of a state of a compatible model."""
    if start is None:
        return system.reference.copy()
    require_finite(name, start)
    warn_of_lost_history(start, system, name)
    return transferred(start, system, name)[0]


def resting_state(system: System, about: State | Solution | None) -> tuple[np.ndarray, float]:
    """Return the coordinates (n,) of a static equilibrium and its load factor: the reference and 0 for None.

    about: a state, or a static solution for its last one; it may come from a model with other supports.
    Raises InputError for a state that moves.
    """
    if isinstance(about, Solution) and not about.static:
        raise InputError("about must be a static equilibrium, this solution is a motion; give one of solve_static")
    about = last_state(about, "about")
    p = start_state(system, about, "about")
    if about is None:
        return p, 0.0
    if np.any(about.v) or np.any(about.a):
        raise InputError("about must be a state at rest, this one moves; take it from solve_static")
    return p, about.at
