"""Checks of a solution, whose findings are its warnings, and Python warnings where they are large.

A solve decides by the nodes of the elements whether a closer look is worth it; `solution.warnings` takes that look
anyway. To add a check, write a function that returns findings and list it in `findings`; if it is cheap, or a bound
decides whether it is needed, in `_needed` too.
"""

from collections.abc import Callable, Iterable
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import EnergyWarning, warn
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
    warn_of(chain.from_iterable(check(solution) for check in _needed(solution)))
    return solution


def warn_of(found: Iterable[Finding]) -> None:
    """Issue a Python warning for every finding with a category."""
    for finding in found:
        if finding.kind is not None:
            warn(finding.sentence, finding.kind)


class _Limits(NamedTuple):
    """Weights of stretches and angles between neighbouring nodes, whose sum exceeds 1 where a closer look is needed.

    locked, curved (m,): of an angle, and a constant, for locking; stretched, bent (m,): for large strains; most: the
    largest of the weights; constant: the largest of `curved`; hindered: see `large_strains.hindered`.
    """

    locked: np.ndarray
    curved: np.ndarray
    stretched: np.ndarray
    bent: np.ndarray
    most: float
    constant: float
    hindered: bool


def _limits(system: System) -> _Limits:
    (locked, curved), (stretched, bent) = locking.weights(system), large_strains.weights(system)
    most = max(float(np.hypot(stretched, bent).max()), float(locked.max()))
    return _Limits(locked, curved, stretched, bent, most, float(curved.max()), large_strains.hindered(system))


def may_lock(system: System, p: np.ndarray, times: float = 1.0) -> bool:
    """Return whether locking may change results by 1 % in states p (rows, n); times: of what they deform."""
    chord, sections = shared(system, pairs).change(p)
    return _may_lock(shared(system, _limits), times * np.abs((chord * sections.conj()).imag))


def _may_lock(limits: _Limits, angles: np.ndarray) -> bool:
    return bool((angles * limits.locked + limits.curved).max() > 1.0)


def _needed(solution: "Solution") -> list[_Check]:
    """Return the checks that may find what is worth a Python warning, in the rows that are looked at."""
    system = loading(solution)[0]
    limits = shared(system, _limits)
    chord, sections = shared(system, pairs).change(solution.p[rows_looked_at(solution)])
    close = np.abs(chord - sections).max() * limits.most + limits.constant <= 1.0
    if close and not limits.hindered:
        return []
    deformed = chord * sections.conj()
    stretches, angles = np.abs(deformed.real - 1.0), np.abs(deformed.imag)
    strained = limits.hindered or (stretches * limits.stretched + angles * limits.bent).max() > 1.0
    checks = ((_may_lock(limits, angles), locking.locking), (strained, large_strains.large_strains))
    return [check for needed, check in checks if needed]
