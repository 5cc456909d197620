"""Whether the steps of a motion are those of the generalized-alpha method, each converged."""

from collections.abc import Iterator, Mapping

import numpy as np

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.motion.equations_of_motion import EquationsOfMotion

_ROWS = 8
_LEFT = 1e-8  # of the model, or [rad]: ten times the tolerance of a step
_ROUND_OFF = 1e-9  # of what a step adds up: the mean of one step has the errors of all before
_PREDICTING = 4  # accelerations before, which predict that of a step: it has the round-off of what they add up to


def faults_of_steps(motion: bf.Solution, options: Mapping[str, object]) -> Iterator[str]:
    """Say which steps a correction with a tangent of its own still moves, and which do not follow from the one before.

    Chung and Hulbert 1993, in the form of Arnold and Bruels 2007: p' and p follow from p'' and its mean over a step.
    """
    if motion.statistics.cuts:
        return  # rows of steps that were cut do not follow from each other in one step
    system, h, rho = system_of(motion.model, False), options["step"], options["integrator"].rho_inf
    of_mean, of_force = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 + of_force - of_mean
    beta = 0.25 * (gamma + 0.5) ** 2
    share = (1.0 - of_force) / (1.0 - of_mean)
    weights = (h * h * beta * share, h * gamma * share, 1.0)
    equations, time = EquationsOfMotion(system, np.zeros(1)), motion.at
    free, scale = equations.free, equations.scale
    whole = np.isclose(np.diff(time, prepend=time[0] - h) / h, options["save_every"], rtol=1e-6)
    for row in np.unique(np.linspace(1, len(time) - 1, _ROWS).astype(int)):
        state = motion.p[row], motion.v[row], motion.a[row], float(time[row])
        tangent = equations.tangent(*state, weights)
        try:
            change = weights[0] * equations.solve([[tangent]], -equations.residual(*state)[None])[0]
        except bf.ConvergenceError:
            continue
        reach = max(1.0, float(np.max(np.abs(motion.p[row] - motion.p[0]) / system.scale)))
        if whole[row] and np.max(np.abs(change) / scale, initial=0.0) > _LEFT * reach:
            yield f"step to {time[row]:g} s: a correction of {np.max(np.abs(change) / scale):.1e} is left"
    kinks = any(isinstance(getattr(load, "amplitude", None), bf.Interpolated) for load in motion.model.loads)
    if options["save_every"] != 1 or kinks:
        return
    p, v, a = (each[:, free] / scale for each in (motion.p, motion.v, motion.a))
    # under sudden loads the first step begins with a mean of p'', which its p' shows; p must follow from it too
    of_start, of_end = (of_force - of_mean) / (1.0 - of_mean), (1.0 - of_force) / (1.0 - of_mean)
    begun = ((v[1] - v[0]) / h - gamma * of_end * a[1]) / (1.0 - gamma + gamma * of_start)
    if np.abs(begun - a[0]).max() > 0.01 * np.abs(a[0]).max():
        a = np.concatenate([begun[None], a[1:]])
    mean = a[0]
    for row in range(1, len(time)):
        new = (of_force * a[row - 1] + (1.0 - of_force) * a[row] - of_mean * mean) / (1.0 - of_mean)
        moved = p[row - 1] + h * v[row - 1] + h * h * ((0.5 - beta) * mean + beta * new)
        faster = v[row - 1] + h * ((1.0 - gamma) * mean + gamma * new)
        predicted = h * h * a[max(row - _PREDICTING, 0) : row + 1]
        sizes = max(np.abs([p[row], h * v[row], h * h * new]).max(), np.abs(predicted).max())
        left = max(float(np.abs(moved - p[row]).max()), h * float(np.abs(faster - v[row]).max()))
        if left > _ROUND_OFF * sizes:
            yield f"step to {time[row]:g} s does not follow from the one before: {left:.1e} of {sizes:.1e}"
        mean = new
