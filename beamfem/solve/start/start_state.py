"""The state that a solve starts from."""

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.results.check_arrays import require_finite
from beamfem.results.solution import Solution, State
from beamfem.solve.start.equilibrium_check import left_over
from beamfem.solve.start.transfer import transferred, warn_of_lost_history

_SAME = 1e-9  # of the size of the model, or rad: tolerance of prescribed coordinates


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
    Raises InputError for a state that moves, or is none of its load factor.
    """
    if isinstance(about, Solution) and not about.static:
        raise InputError(
            "about must be a static equilibrium, this solution is a motion", remedy="give one of solve_static"
        )
    about = last_state(about, "about")
    p = start_state(system, about, "about")
    if about is None:
        return p, 0.0
    if np.any(about.v) or np.any(about.a):
        raise InputError("about must be a state at rest, this one moves", remedy="take it from solve_static")
    _require_of_load_factor(system, about, p)
    return p, about.at


def _require_of_load_factor(system: System, about: State, p: np.ndarray) -> None:
    """Raise InputError if supports that move, or those of the state's own model, prescribe other coordinates (n,)."""
    own, load_factor = about.model is system.model, about.at
    values = system.prescribed_values(load_factor)
    for item, value in zip(system.prescribed, values.tolist(), strict=True):
        moves = callable(item.value) or item.value != 0.0
        if (own or moves) and abs(p[item.dof] - value) > _SAME * system.scale[item.dof]:
            raise InputError(
                f"about is no state of load factor {load_factor:g}, its at: a support prescribes {value:.6g} of a "
                f"coordinate that is {p[item.dof]:.6g}. Give a state of solve_static as it is, such as solution[-1]"
            )
    if own and (force := left_over(system, p, load_factor)) > 0.0:
        raise InputError(
            f"about is no state of load factor {load_factor:g}, its at: it is not in equilibrium, a force of "
            f"{force:.3g} is unbalanced. Give a state of solve_static as it is, such as solution[-1]"
        )
