"""Checks at the start of a solve: what an analysis supports, equilibrium, memory."""

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.connector_traits import damps_at_rest
from beamfem.equations.equations import linearise_at_rest, residual_at_rest
from beamfem.equations.system import System
from beamfem.errors import InputError
from beamfem.installed_memory import USABLE_FRACTION, in_gib, installed_memory
from beamfem.precision.roundoff import digits_of, load_size, remainder, row_floors


def refuse_memory(system: System, analysis: str) -> None:
    """Raise InputError if a connector or a section law has history, so that states do not depend on the load alone."""
    for kind, name in system.history.holders:
        raise InputError(
            f"{analysis} does not support {kind} with history, such as {name}; solve_static and simulate do"
        )


def refuse_frame(system: System, analysis: str) -> None:
    """Raise InputError if the model is described in a rotating frame."""
    if system.model.frame is not None:
        raise InputError(
            f"{analysis} does not support models in a RotatingFrame; equilibria and their vibrations are supported"
        )


def refuse_dampers(system: System) -> None:
    """Raise InputError if the force of a connector depends on velocities about rest, which free vibrations neglect."""
    for item in system.connectors.items:
        if damps_at_rest(item):
            raise InputError(
                f"solve_modes finds undamped vibrations, but the force of {item.name} depends on velocities; leave it "
                "out, or find damped ones by linearise(model, about).modes(count)"
            )


_TOLERANCE = 1e-6  # of the largest force: largest residual of an equilibrium
_SAME = 1e-9  # of the movement of a state: a smaller correction does not change the results
_LAST_DIGIT = 8.0 * np.finfo(float).eps  # of the size of the model
_CANCELLED = 1e4 * np.finfo(float).eps  # round-off of strains due to positions, up to this for fields of high order


def left_over(system: System, p: np.ndarray, load_factor: float) -> float:
    """Return the largest unbalanced force [N, N m] in the state p (n,); 0 if it is small enough."""
    unbalanced, tangent = linearise_at_rest(system, p, load_factor)
    remaining = np.abs(system.along_free(unbalanced))
    acting = [float(np.abs(values).max(initial=0.0)) for values in system.loads.at(load_factor).points]
    if system.loads.imposing(load_factor).any():
        acting.append(load_size(system, load_factor) / system.extent)
    force = max([float(np.abs(unbalanced).max()), *acting])
    reach = max([float(np.abs(p).max()), *(beam.curve.length for beam in system.model.beams)])
    round_off = _CANCELLED * reach * np.asarray(abs(tangent.sparse(system.rotated)).sum(axis=1))
    if np.all(remaining <= _TOLERANCE * force):
        return 0.0
    # small loads may be below the round-off of stiff rows, but still bend a slender beam
    small = np.all(remaining <= np.maximum(_TOLERANCE * force, round_off)) or np.array_equal(p, system.reference)
    if small and _sure(system, p, load_factor):
        return 0.0
    return float(remaining.max())


def require_equilibrium(system: System, p: np.ndarray, load_factor: float, use: str) -> None:
    """Raise InputError if a state p (n,) is not in equilibrium; use: what it is given for, such as "vibrate"."""
    force = left_over(system, p, load_factor)
    if force > 0.0:
        raise InputError(
            f"the state to {use} about is not in equilibrium: at load factor {load_factor:g} a force of {force:.3g} "
            "is unbalanced",
            remedy="Give a state of solve_static with the same loads as about",
        )


def _sure(system: System, p: np.ndarray, load_factor: float) -> bool:
    """Return whether a state (n,) balances the loads except for its last digits; without loads, all rows count."""
    if not system.loads.at(load_factor).any:
        unbalanced = np.abs(system.along_free(residual_at_rest(system, p, load_factor)))
        if np.all(unbalanced <= row_floors(system, p)[system.free_dofs]):
            return True
    if digits_of(system, p, load_factor) >= 1.0 or remainder(system, p, load_factor).digits >= 1.0:
        return True
    # where a structure was unloaded, no force is left to compare with, but the movement that is missing may be nothing
    moved = float(np.max(np.abs(p - system.reference) / system.scale, initial=0.0))
    free = system.free_dofs
    unbalanced, tangent = linearise_at_rest(system, p, load_factor)
    try:
        step = tangent.factorised(system.rotated).solve(-unbalanced[free])
    except LinAlgError:
        return False
    return float(np.max(np.abs(step) / system.scale[free], initial=0.0)) <= max(_SAME * moved, _LAST_DIGIT)


_STATE = 3 * 8  # bytes of a coordinate: p, p', p''
_STEP = 8 * 8  # bytes of a step, stored or not: its time, prescribed values and loads


def require_memory(coordinates: int, duration: float, step: float, save_every: int) -> None:
    """Raise InputError if the states of a motion need more memory [bytes] than this computer has."""
    steps = duration / step
    memory = installed_memory()
    needed = steps * (_STATE * coordinates / save_every + _STEP)
    if memory is None or needed <= USABLE_FRACTION * memory:
        return
    room = USABLE_FRACTION * memory - steps * _STEP
    every = "one" if save_every == 1 else f"{save_every}th"
    kept = (
        f" of {coordinates} coordinates, of which every {every} is kept," if coordinates else ", whose times are kept,"
    )
    message = f"{steps:.3g} steps{kept} need {in_gib(needed)}, and this computer has {in_gib(memory)}"
    if room > 0.0:
        enough = int(-(-(steps * _STATE * coordinates) // room))
        raise InputError(f"{message}; save_every={enough} would fit")
    raise InputError(f"{message}; take a larger step, or a shorter duration and continue from the last state")
