"""Convergence of an iteration: small corrections, and a residual that is small or at the round-off floor."""

import math
from typing import NamedTuple

import numpy as np

from beamfem.assembly.equations import STATICS, residual
from beamfem.assembly.system import System
from beamfem.precision.roundoff import MOST_DIGITS, load_size, row_floors
from beamfem.solve.newton.iteration import Newton, Termination

STAGNANT = 1e-6  # corrections below this that no longer decrease are round-off, if the residual agrees
_SURE = 1e-9  # of the movement: smaller corrections do not change the results
_EPS = float(np.finfo(float).eps)
LARGEST = 1e3  # of the model; larger corrections mean divergence


class Correction(NamedTuple):
    """A correction: its number, its size and that of the previous one, and the negative pivots of its tangent.

    Sizes are relative to the model for positions, and absolute otherwise.
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


class Balance(NamedTuple):
    """Balance of forces in a state p (n,): residual (n,), its largest unconstrained component, and the largest force.

    Forces are multiplied by the scale of their coordinate, so that they can be compared with moments [N m]. inverted:
    whether an element is inverted somewhere, which polynomial elastic forces do not prevent; gap: the largest movement,
    relative to the scale of the coordinates, that a condition of a connector is away from being met.
    """

    p: np.ndarray
    residual: np.ndarray
    largest: float
    force: float
    inverted: bool
    gap: float = 0.0

    @property
    def digits(self) -> float:
        """Number of digits of the largest force above the round-off of every row."""
        return min(math.log10(self.force / self.largest), MOST_DIGITS) if self.largest > 0.0 else MOST_DIGITS


def balance_of(system: System, p: np.ndarray, load_factor: float) -> Balance:
    """Return the balance of a state (n,) at a load factor."""
    zeros = np.zeros(len(p))
    unbalanced = residual(system, p, zeros, zeros, load_factor)
    return balance_with(system, p, load_factor, unbalanced, system.assembler().smallest_jacobian(p))


def balance_with(system: System, p: np.ndarray, load_factor: float, unbalanced: np.ndarray, jacobian: float) -> Balance:
    """Return the balance of a state whose residual (n,) and smallest r0' x d are known."""
    # without reactions the largest load counts
    load = load_size(system, system.loads_at(load_factor))
    forces = np.abs(unbalanced) * system.scale
    free = np.abs(system.along_free(unbalanced)) * system.scale[system.free_dofs]
    multipliers = system.connectors.multipliers
    if len(multipliers):
        forces[multipliers] = free[system.unknowns.free[multipliers]] = 0.0
    largest, force = float(np.max(free, initial=0.0)), float(np.max(forces, initial=0.0))
    gap = _largest_gap(system, p, load_factor, unbalanced) if len(multipliers) else 0.0
    return Balance(p, unbalanced, largest, max(force, load), jacobian <= 0.0, gap)


def _largest_gap(system: System, p: np.ndarray, load_factor: float, unbalanced: np.ndarray) -> float:
    """Return the largest gap of a condition, see `Balance`; its gradient makes it a movement, whatever its unit is."""
    zeros, connectors = np.zeros(len(p)), system.connectors
    largest = 0.0
    tangents = connectors.tangents((p, zeros, zeros), load_factor, STATICS)
    for item, tangent in zip(connectors.items, tangents, strict=True):
        gradients = np.abs(tangent[len(item.dofs) :, : len(item.dofs)])
        gaps = np.abs(unbalanced[item.own]) / (gradients @ system.scale[item.dofs])
        largest = max(largest, float(np.max(gaps, initial=0.0)))
    return largest


def check_convergence(system: System, balance: Balance, newton: Newton, correction: Correction) -> Termination | None:
    """Return how an iteration ended whose corrections are small or no longer decrease; None if it is to continue.

    If the residual is above the tolerance, each row must have reached its round-off floor, and the next correction must
    be below the round-off of the movement.
    """
    met = balance.gap <= newton.tolerance and balance.largest <= newton.residual_tolerance * balance.force
    if correction.size <= newton.tolerance and met:
        ended = Termination.CONVERGED
    elif _settled(system, balance.p, correction) and bool(
        (np.abs(system.along_free(balance.residual)) <= row_floors(system, balance.p)[system.unknowns.chosen]).all()
    ):
        ended = Termination.ROUND_OFF
    else:
        return None
    return Termination.INVERTED if balance.inverted else ended


def _settled(system: System, p: np.ndarray, correction: Correction) -> bool:
    """Return whether the next correction, at the present rate, is small relative to the movement or below round-off."""
    if correction.stagnates:
        return True
    size, before = correction.size, correction.before
    following = size * min(size / before, 1.0) if correction.number > 1 else size
    moved = float((np.abs(p - system.reference) / system.scale).max(initial=0.0))
    if following <= _SURE * moved:
        return True
    return following <= _EPS * float((np.abs(p) / system.scale).max(initial=1.0))
