"""Checks of a solution, whose findings are its warnings, and Python warnings where they are large.

A solve decides by the nodes of the elements whether a closer look is worth it; `solution.warnings` takes that look
anyway. To add a check, write a function that returns findings and list it in `findings`; if it is cheap, or a bound
decides whether it is needed, in `warned` too.
"""

from collections.abc import Callable, Iterable
from itertools import chain
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import EnergyWarning, warn
from beamfem.kernels.neighbouring_nodes import LOCKED, STRAINED, exceeds
from beamfem.kernels.pointers import address_of
from beamfem.results import large_strains, locking
from beamfem.results.element_shapes import ROWS, pairs, rows_looked_at
from beamfem.results.energy_balance import energy_warnings
from beamfem.results.finding import Finding
from beamfem.results.joint_warnings import unjoined_warnings
from beamfem.results.solution_system import loading

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_Solution = TypeVar("_Solution", bound="Solution")
_Check = Callable[["Solution"], Iterable[Finding]]


def findings(solution: "Solution") -> tuple[Finding, ...]:
    """Return all that is found wrong with a solution, besides what its solver has found."""
    checks: tuple[_Check, ...] = (
        lambda solution: solution.computed(locking.locking),
        lambda solution: solution.computed(large_strains.large_strains),
        lambda solution: (Finding(sentence, EnergyWarning) for sentence in solution.computed(energy_warnings)),
        lambda solution: map(Finding, unjoined_warnings(solution)),
    )
    return tuple(chain.from_iterable(check(solution) for check in checks))


def warned(solution: _Solution) -> _Solution:
    """Return a solution that has just been found, after Python warnings of what is wrong with it by 1 % and more."""
    found = _found(loading(solution)[0], solution.p[rows_looked_at(solution)])
    if found & LOCKED:
        warn_of(solution.computed(locking.locking))
    if found & STRAINED:
        warn_of(solution.computed(large_strains.large_strains))
    return solution


def warn_of(found: Iterable[Finding]) -> None:
    """Issue a Python warning for every finding with a category."""
    for finding in found:
        if finding.kind is not None:
            warn(finding.sentence, finding.kind)


class _Bounds:
    """Bounds below which no strains are large, and no result changes by 1 % without locking; states: to be compared."""

    def __init__(self, system: System) -> None:
        neighbours, size = system.table(pairs), system.model.size
        weights = np.vstack([locking.weights(system), large_strains.weights(system)])
        factors = np.hstack([neighbours.at_rest.view(float), weights.T])
        self.states = np.empty((ROWS, size))
        self._arrays = self.states, neighbours.numbers, factors
        known = STRAINED if large_strains.hindered(system) else 0
        self._table = np.array([size, len(factors), known, *map(address_of, self._arrays)], dtype=np.int64)
        self.table = address_of(self._table)


def _unused(system: System) -> list[_Bounds]:
    """Return a list of bounds, which no other thread uses while they are not in it."""
    return [_Bounds(system)]


def _found(system: System, p: np.ndarray, times: int = 1) -> int:
    """Return what may be wrong with states p (rows, n), see `exceeds`; times: factor of angles for locking."""
    unused = system.table(_unused)
    try:
        bounds = unused.pop()
    except IndexError:
        bounds = _Bounds(system)
    bounds.states[: len(p)] = p
    found: int = exceeds.compiled(bounds.table, len(p), times)
    unused.append(bounds)
    return found


def may_lock(system: System, p: np.ndarray) -> bool:
    """Return whether locking may change frequencies about a state p (n,) by 1 %, which are sensitive twice as much."""
    return bool(_found(system, p[None], 2) & LOCKED)
