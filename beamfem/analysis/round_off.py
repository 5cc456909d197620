"""What rounded coordinates leave of a balance, and what is known of a state beyond its last digit."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.analysis.equations import STATICS, linearise, residual
from beamfem.analysis.initial import RigidVelocity, start_velocity
from beamfem.analysis.tangent import Factorised
from beamfem.model.system import System

_EPSILON = float(np.finfo(float).eps)
_ERRORS = 4.0  # of a coordinate's last digit: each term is rounded, and so is their sum
_CORRECTIONS = 12
_LARGEST = 1e-7  # of the model: a state that needs more to be balanced is not balanced but for its last digits
DIFFERENCE = 1e-6  # of the model: how far a difference reaches that tells what the last digits do
_MOST_DIGITS = 15.0


def row_floors(system: System, p: np.ndarray) -> np.ndarray:
    """Return the residual (n,) [N, N m] that rounded coordinates leave in each row, see `model.round_off`."""
    reach = max(float(np.max(np.abs(p[system.positions]), initial=0.0)), system.extent)
    turn = max(float(np.max(np.abs(p[~system.positions]), initial=0.0)), 1.0)
    positions, directions = system.residual_errors
    return np.asarray(_ERRORS * _EPSILON * (reach * positions + turn * directions))


def round_off_floor(system: System, p: np.ndarray) -> float:
    """Return the largest residual [N, N m] that is left by rounded coordinates, of all rows."""
    return float(row_floors(system, p).max(initial=0.0))


@dataclass(frozen=True)
class Remainder:
    """What a state lacks to be balanced beyond its last digit.

    step (n,): to be added to p; digits: of the forces, once it is. 0 where not even the first is sure.
    """

    step: np.ndarray
    digits: float


def change(system: System, p: np.ndarray, step: np.ndarray, load_factor: float) -> np.ndarray:
    """Return the change of the residual (n,) with a step (n,) that may be below the last digit of p."""
    size = float(np.max(np.abs(step) / system.scale, initial=0.0))
    if size == 0.0:
        return np.zeros(len(p))
    rest, width = np.zeros(len(p)), DIFFERENCE / size
    ahead = residual(system, p + width * step, rest, rest, load_factor)
    behind = residual(system, p - width * step, rest, rest, load_factor)
    return np.asarray((ahead - behind) / (2.0 * width))


def digits_of(system: System, p: np.ndarray, load_factor: float) -> float:
    """Return how many digits of the forces are sure in a state p (n,) as it stands; all where nothing acts."""
    rest = np.zeros(len(p))
    found = residual(system, p, rest, rest, load_factor)
    return _digits(system, p, found, _acting(system, p, found, load_factor))


def remainder(system: System, p: np.ndarray, load_factor: float, factors: Factorised | None = None) -> Remainder:
    """Return what balances a state p (n,) that is an equilibrium but for its last digits.

    Newton's method goes on with p in two parts: steps below its last digit are added up apart, and what they change is
    taken from wider differences. Elements balance themselves whatever their strains, so that the balance regains all
    digits as long as the tangent has some.
    """
    rest, free = np.zeros(len(p)), system.free_dofs
    found = residual(system, p, rest, rest, load_factor)
    acting = _acting(system, p, found, load_factor)
    best = Remainder(np.zeros(len(p)), _digits(system, p, found, acting))
    if factors is None:
        try:
            factors = linearise(system, p, rest, rest, load_factor, STATICS)[1].factorised(system.turned)
        except (LinAlgError, ValueError):
            return best
    step, unbalanced = np.zeros(len(p)), found
    for _ in range(_CORRECTIONS):
        try:
            step[free] += factors.solve(-unbalanced[free])
        except (LinAlgError, ValueError):
            break
        if not np.max(np.abs(step) / system.scale, initial=0.0) <= _LARGEST:
            break
        unbalanced = found + change(system, p, step, load_factor)
        digits = _digits(system, p, unbalanced, _acting(system, p, unbalanced, load_factor))
        if digits <= best.digits + 0.3:
            break
        best = Remainder(step.copy(), digits)
    return best


def load_size(system: System, load_factor: float) -> float:
    """Return the largest force at a point, times the size of the model, or moment [N m]."""
    largest = 0.0
    for values in system.point_values(load_factor):
        size = np.abs(values)
        largest = max(largest, system.extent * float(size[:, :2].max(initial=0.0)), float(size[:, 2:].max(initial=0.0)))
    return largest


def _acting(system: System, p: np.ndarray, unbalanced: np.ndarray, load_factor: float) -> float:
    """Return the largest force, times the size of the model, or moment [N m] of loads, supports and springs."""
    held, springs = system.held_dofs, system.springs
    reactions = float(np.max(np.abs(unbalanced[held] * system.scale[held]), initial=0.0))
    for dof, normal in system.inclined:
        reactions = max(reactions, system.extent * abs(float(normal @ unbalanced[dof : dof + 2])))
    sprung = np.abs(springs.stiffness * (p[springs.dof] - springs.rest)) * system.scale[springs.dof]
    return max(load_size(system, load_factor), reactions, float(sprung.max(initial=0.0)))


def _digits(system: System, p: np.ndarray, unbalanced: np.ndarray, acting: float) -> float:
    """Return how many digits of the largest force that acts are sure, by each row and by the balance of the whole."""
    free = system.free_dofs
    left = np.zeros(len(p))
    left[free] = system.along_free(unbalanced)
    worst = float(np.max(np.abs(left) * system.scale, initial=0.0))
    centre = _centre(system, p)
    for motion in (RigidVelocity((1.0, 0.0)), RigidVelocity((0.0, 1.0)), RigidVelocity((0.0, 0.0), 1.0, centre)):
        size = 1.0 if motion.angular else system.extent
        worst = max(worst, size * abs(float(start_velocity(system, p, motion, None) @ left)))
    if worst == 0.0:
        return _MOST_DIGITS
    return min(max(float(np.log10(acting / worst)), 0.0), _MOST_DIGITS) if acting > 0.0 else 0.0


def _centre(system: System, p: np.ndarray) -> tuple[float, float]:
    """Mean position of the nodes [m]."""
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    x, y = p[nodes].mean(axis=0)
    return float(x), float(y)
