"""Newton's method for an equilibrium at a fixed load factor."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.analysis.equations import STATICS, linearise, predicted_stresses, residual
from beamfem.model.reference import stations
from beamfem.model.system import System
from beamfem.postprocess import axis, nodal_vectors

_STAGNANT = 1e-6  # corrections below this that no longer shrink are round-off, if the residual says so too


class Ended(Enum):
    """Why an iteration ended; the values are the sentences that users read."""

    CONVERGED = "the correction and the residual are within the tolerance"
    ROUND_OFF = "the residual has reached the round-off floor of the model"
    DIVERGED = "the corrections grew beyond the size of the model"
    EXHAUSTED = "the iterations ran out before the corrections became small"
    SINGULAR = "the tangent is singular"
    INVERTED = "the beam was turned inside out: r_x and r_y no longer form a right-handed pair"

    @property
    def good(self) -> bool:
        return self in (Ended.CONVERGED, Ended.ROUND_OFF)


@dataclass(frozen=True)
class NewtonResult:
    """The last state (n,) of an iteration, how many iterations it took and why it ended.

    negative_pivots: how many of the last tangent; of a symmetric one, in how many ways the equilibrium is unstable.
    """

    state: np.ndarray
    iterations: int
    ended: Ended
    negative_pivots: int = 0


@dataclass(frozen=True)
class Newton:
    """How to iterate.

    tolerance: largest correction relative to the model's length or one radian [-]; residual_tolerance: largest residual
    relative to the reactions and loads [-]; iterations: how many at most; independent_stresses: take the stress
    resultants predicted by the last correction for the geometric tangent (Magisano, Leonetti and Garcea 2017).
    """

    tolerance: float = 1e-10
    residual_tolerance: float = 1e-9
    iterations: int = 15
    independent_stresses: bool = True


def solve_equilibrium(system: System, start: np.ndarray, load_factor: float, newton: Newton) -> NewtonResult:
    """Return the equilibrium at `load_factor` that is found from the state `start` (n,)."""
    p, rest = start.copy(), np.zeros(len(start))
    scale = system.scale
    free = system.free_dofs
    stresses = None
    held_step = np.zeros(len(p))
    held_step[system.held_dofs] = system.held_values(load_factor) - p[system.held_dofs]
    last = np.inf
    for iteration in range(1, newton.iterations + 1):
        unbalanced, tangent = linearise(system, p, rest, rest, load_factor, STATICS, stresses)
        step = held_step if iteration == 1 else np.zeros(len(p))
        right = -unbalanced[free]
        if iteration == 1 and np.any(held_step):
            right -= _held_force(system, p, held_step, load_factor)[free]
        try:
            factors = tangent.factorised(system.turned)
            step[free] = factors.solve(right)
        except (LinAlgError, ValueError):
            return NewtonResult(p, iteration, Ended.SINGULAR)
        if newton.independent_stresses:
            stresses = predicted_stresses(system, p, step)
        p = p + step
        size = float(np.max(np.abs(step) / scale, initial=0.0))
        ended = verdict(system, p, load_factor, newton, iteration, (size, last))
        if ended is not None:
            state = start if ended is Ended.DIVERGED else p
            return NewtonResult(state, iteration, ended, factors.negative_pivots)
        last = size
    return NewtonResult(p, newton.iterations, Ended.EXHAUSTED)


def verdict(
    system: System, p: np.ndarray, load_factor: float, newton: Newton, iteration: int, sizes: tuple[float, float]
) -> Ended | None:
    """Say how an iteration ended whose last two corrections have these sizes; None where it shall go on."""
    size, before = sizes
    if not np.isfinite(size) or size > 1e3:
        return Ended.DIVERGED
    stagnant = iteration > 2 and size > 0.25 * before and size < _STAGNANT
    if size <= newton.tolerance or stagnant:
        return _judge(system, p, load_factor, newton, size)
    return None


def _judge(system: System, p: np.ndarray, load_factor: float, newton: Newton, size: float) -> Ended | None:
    """Say how an iteration ended whose corrections are small or no longer shrink; None where it shall go on."""
    rest = np.zeros(len(p))
    unbalanced = residual(system, p, rest, rest, load_factor)
    largest = float(np.max(np.abs(system.along_free(unbalanced)), initial=0.0))
    force = max(float(np.max(np.abs(unbalanced), initial=0.0)), _load_size(system, load_factor))
    if size <= newton.tolerance and largest <= newton.residual_tolerance * force:
        ended = Ended.CONVERGED
    elif largest <= round_off_floor(system, p):
        ended = Ended.ROUND_OFF
    else:
        return None
    return Ended.INVERTED if inverted(system, p) else ended


def inverted(system: System, p: np.ndarray) -> bool:
    """Tell whether r0' x d is negative at some Gauss point; elastic forces that are polynomials do not prevent it."""
    for mesh in system.model.meshes:
        element, xi = stations(mesh)
        now = axis(mesh, nodal_vectors(mesh, p[None]), element, xi)
        if np.any(now.r_s[..., 0] * now.d[..., 1] <= now.r_s[..., 1] * now.d[..., 0]):
            return True
    return False


def round_off_floor(system: System, p: np.ndarray) -> float:
    """Return the residual [N] that is left by cancellation when strains are formed from positions.

    A position of size |r| carries an error eps |r|, a strain over an element of length l therefore eps |r| / l times
    the slopes of the shape functions; the section answers with its largest axial stiffness, again times slopes.
    """
    worst = 0.0
    for block in system.blocks:
        stiffest = float(block.stiffness[:, :, 0, 0].max())
        per_node = block.scale.shape[1] // block.node.shape[1]
        carries_r = np.arange(block.scale.shape[1]) % per_node < per_node - 1
        slopes = np.abs(block.slope[0] / block.scale[0] * block.jacobian[0][:, None])[:, carries_r]
        share = (block.weight[0] / block.weight[0].sum()) @ slopes
        slope = float(slopes.sum(axis=1).max() * share.max())
        worst = max(worst, slope * stiffest / float(block.jacobian.min()))
    reach = max(float(np.max(np.abs(p))), system.extent)
    return 4.0 * np.finfo(float).eps * worst * reach


def _load_size(system: System, load_factor: float) -> float:
    """Largest force or moment that acts; keeps the residual's scale above zero where nothing reacts."""
    values = [np.abs(forces).max(initial=0.0) for forces in system.point_values(load_factor)]
    return float(max(values, default=0.0))


def _held_force(system: System, p: np.ndarray, step: np.ndarray, load_factor: float) -> np.ndarray:
    """Change of the residual with a step (n,) of the held coordinates, by a central difference."""
    rest = np.zeros(len(p))
    size = 1e-6 / max(float(np.max(np.abs(step))), 1e-300)
    ahead = residual(system, p + size * step, rest, rest, load_factor)
    behind = residual(system, p - size * step, rest, rest, load_factor)
    return np.asarray((ahead - behind) / (2.0 * size))
