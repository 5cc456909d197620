"""Checks of a solution, whose findings are its warnings, and Python warnings where they are large.

A solve decides by the nodes of the elements whether a closer look is worth it; `solution.warnings` takes that look
anyway. To add a check, write a function that returns findings and list it in `findings`; if it is cheap, or a bound
decides whether it is needed, in `warned` too.
"""

from collections.abc import Callable, Iterable
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import EnergyWarning, warn
from beamfem.kernels.neighbouring_nodes import exceeds
from beamfem.kernels.pointers import address_of
from beamfem.results import large_strains, locking
from beamfem.results.element_shapes import pairs, rows_looked_at, shared
from beamfem.results.energy_balance import energy_warnings
from beamfem.results.finding import Finding
from beamfem.results.loading import loading
from beamfem.results.unjoined import unjoined_warnings

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_Solution = TypeVar("_Solution", bound="Solution")
_Check = Callable[["Solution"], Iterable[Finding]]
_LOCKED, _STRAINED = 1, 2  # results of `exceeds`


def findings(solution: "Solution") -> tuple[Finding, ...]:
    """Return all that is found wrong with a solution, besides what its solver has found."""
    checks: tuple[_Check, ...] = (
        locking.locking,
        large_strains.large_strains,
        lambda solution: (Finding(sentence, EnergyWarning) for sentence in energy_warnings(solution)),
        lambda solution: map(Finding, unjoined_warnings(solution)),
    )
    return tuple(chain.from_iterable(check(solution) for check in checks))


def warned(solution: _Solution) -> _Solution:
    """Return a solution that has just been found, after Python warnings of what is wrong with it by 1 % and more."""
    bounds = shared(loading(solution)[0], _bounds)
    p = solution.p[rows_looked_at(solution)].copy()  # writable, whose address is found in half the time
    found = exceeds.compiled(*p.shape, bounds.pairs, 1.0, address_of(p), *bounds.addresses)
    if found & _LOCKED:
        warn_of(locking.locking(solution))
    if found & _STRAINED or bounds.hindered:
        warn_of(large_strains.large_strains(solution))
    return solution


def warn_of(found: Iterable[Finding]) -> None:
    """Issue a Python warning for every finding with a category."""
    for finding in found:
        if finding.kind is not None:
            warn(finding.sentence, finding.kind)


class _Bounds(NamedTuple):
    """Arguments of `exceeds` for the elements of a model; hindered: see `large_strains.hindered`."""

    pairs: int
    numbers: np.ndarray
    factors: np.ndarray
    addresses: tuple[int, int]
    hindered: bool


def _bounds(system: System) -> _Bounds:
    """Return bounds below which no strains are large, and no result changes by 1 % without locking."""
    neighbours = shared(system, pairs)
    weights = np.vstack([locking.weights(system), large_strains.weights(system)])
    factors = np.hstack([neighbours.at_rest.view(float), weights.T])
    addresses = address_of(neighbours.numbers), address_of(factors)
    return _Bounds(len(factors), neighbours.numbers, factors, addresses, large_strains.hindered(system))


def may_lock(system: System, p: np.ndarray) -> bool:
    """Return whether locking may change frequencies about a state p (n,) by 1 %, which are sensitive twice as much."""
    bounds = shared(system, _bounds)
    return bool(exceeds(1, len(p), bounds.pairs, 2.0, p, *bounds.addresses) & _LOCKED)
