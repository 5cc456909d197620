"""When an iteration has come to its end: small corrections, a small residual, or nothing but round-off left of it."""

import math
from dataclasses import dataclass

import numpy as np

from beamfem.assembly.equations import residual
from beamfem.assembly.round_off import MOST_DIGITS, load_size, row_floors
from beamfem.assembly.system import System
from beamfem.solve.newton.iteration import Newton, Termination

STAGNANT = 1e-6  # corrections below this that no longer shrink are round-off, if the residual says so too
_SURE = 1e-9  # of the movement: a correction this small changes nothing that is asked for
LARGEST = 1e3  # of the model; larger corrections lead nowhere


@dataclass(frozen=True)
class Correction:
    """A correction: its number, its size and that of the one before, and the negative pivots of its tangent.

    Sizes are relative: of the model for positions, else absolute.
    """

    number: int
    size: float
    before: float
    negative_pivots: int

    @property
    def diverges(self) -> bool:
        return not self.size <= LARGEST

    @property
    def stagnates(self) -> bool:
        return self.number > 2 and self.size > 0.25 * self.before and self.size < STAGNANT

    def is_small(self, newton: Newton) -> bool:
        return self.size <= newton.tolerance or self.stagnates


@dataclass(frozen=True, eq=False)
class Balance:
    """What is left of the balance in a state p (n,): residual (n,), its largest of the unknown, and the largest force.

    Forces are multiplied by what their coordinate is measured by, so that they compare with moments [N m]. inverted:
    whether the beam is turned inside out somewhere, which elastic forces that are polynomials do not prevent.
    """

    p: np.ndarray
    residual: np.ndarray
    largest: float
    force: float
    inverted: bool

    @property
    def digits(self) -> float:
        """How many digits of the largest force every row leaves."""
        return min(math.log10(self.force / self.largest), MOST_DIGITS) if self.largest > 0.0 else MOST_DIGITS


def balance_of(system: System, p: np.ndarray, load_factor: float) -> Balance:
    """Return the balance of a state (n,) at a load factor."""
    zeros = np.zeros(len(p))
    unbalanced = residual(system, p, zeros, zeros, load_factor)
    return balance_with(system, p, load_factor, unbalanced, system.assembler().smallest_jacobian(p))


def balance_with(system: System, p: np.ndarray, load_factor: float, unbalanced: np.ndarray, jacobian: float) -> Balance:
    """Return the balance of a state whose residual (n,) and smallest r0' x d are known."""
    # the largest load counts where nothing reacts
    load = load_size(system, system.loads_at(load_factor))
    largest = float(np.max(np.abs(system.along_free(unbalanced)) * system.scale[system.free_dofs], initial=0.0))
    force = float(np.max(np.abs(unbalanced) * system.scale, initial=0.0))
    return Balance(p, unbalanced, largest, max(force, load), jacobian <= 0.0)


def check_convergence(system: System, balance: Balance, newton: Newton, correction: Correction) -> Termination | None:
    """Say how an iteration ended whose corrections are small or no longer shrink; None if it shall go on.

    Where the residual is above the tolerance, each row must have come to its own floor, and what the next correction
    would be must be lost in the digits of the movement.
    """
    if correction.size <= newton.tolerance and balance.largest <= newton.residual_tolerance * balance.force:
        ended = Termination.CONVERGED
    elif _settled(system, balance.p, correction) and np.all(
        np.abs(system.along_free(balance.residual)) <= row_floors(system, balance.p)[system.free_dofs]
    ):
        ended = Termination.ROUND_OFF
    else:
        return None
    return Termination.INVERTED if balance.inverted else ended


def _settled(system: System, p: np.ndarray, correction: Correction) -> bool:
    """Return whether a further correction, if they shrink as before, is small against the movement or below a digit."""
    if correction.stagnates:
        return True
    size, before = correction.size, correction.before
    following = size * min(size / before, 1.0) if correction.number > 1 else size
    moved = float(np.max(np.abs(p - system.reference) / system.scale, initial=0.0))
    last_digit = np.finfo(float).eps * float(np.max(np.abs(p) / system.scale, initial=1.0))
    return following <= max(_SURE * moved, last_digit)
