"""Participation factors of modes in rigid motions."""

import numpy as np

from beamfem.equations.equations import residual
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import system_of
from beamfem.errors import InputError
from beamfem.results.solution import State
from beamfem.validation import vector

_LARGE = 2.0**30  # acceleration beside whose inertia forces all others are round-off


def participation(state: State, modes: np.ndarray, direction: tuple[float, float] | RigidVelocity) -> np.ndarray:
    """Return phi^T M r (count,) of modes (count, n) for a rigid motion r of all coordinates, prescribed ones included.

    Raises InputError for a direction of no length, and for complex modes.
    """
    if np.iscomplexobj(modes):
        raise InputError("participation factors are those of undamped modes, which are real; these are complex")
    system, motion = system_of(state.model, static=True), direction
    if not isinstance(motion, RigidVelocity):
        x, y = vector("direction", motion)
        size = float(np.hypot(x, y))
        if size == 0.0:
            raise InputError("direction must not be (0, 0)")
        motion = RigidVelocity((x / size, y / size))
    p, zeros = state.p, np.zeros_like(state.p)
    rates = _LARGE * rigid_rates(system, motion, p)
    ends = [residual(system, p, zeros, side * rates, state.at) for side in (1.0, -1.0)]
    return np.asarray(modes @ (ends[0] - ends[1]) / (2.0 * _LARGE))
