"""The equilibria that continue a state as the load factor changes, without leaving for another path."""

from dataclasses import dataclass

import numpy as np

from beamfem.analysis.equations import STATICS, linearise, load_slope
from beamfem.analysis.newton import Newton, solve_equilibrium
from beamfem.errors import BeamfemError
from beamfem.model.model import Model
from beamfem.model.system import System
from beamfem.solution import Solution, Statistics

_WIDTH = 1e-6  # of the load factor, for the slope of held coordinates
_STRAYED = 0.3  # of a step: an equilibrium this far from the predicted one may be of another path
_CLOSE = 1e-6  # of the model: equilibria this near to the predicted one are of the same path
_SMALLEST_STEP = 1e-6  # of the way from the start


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A state p (n,) at a load factor, and its slope dp/d(load factor) (n,)."""

    load_factor: float
    p: np.ndarray
    slope: np.ndarray


class PathEndsError(BeamfemError):
    """The path cannot be followed beyond the last equilibrium found."""


class PrimaryPath:
    """The path through a state; `found` grows with every step, ordered by load factor."""

    def __init__(self, system: System, p: np.ndarray, load_factor: float) -> None:
        self.system = system
        self.scale = system.scale
        self.found = [self._equilibrium(p, load_factor)]

    def _equilibrium(self, p: np.ndarray, load_factor: float) -> Equilibrium:
        rest, free, held = np.zeros_like(p), self.system.free_dofs, self.system.held_dofs
        slope = np.zeros_like(p)
        change = self.system.held_values(load_factor + _WIDTH) - self.system.held_values(load_factor - _WIDTH)
        slope[held] = change / (2.0 * _WIDTH)
        tangent = linearise(self.system, p, rest, rest, load_factor, STATICS)[1]
        slope[free] = tangent.solve(-load_slope(self.system, p, load_factor)[free], self.system.turned)
        return Equilibrium(load_factor, p, slope)

    def reach(self, load_factor: float) -> Equilibrium:
        """Return the equilibrium at a load factor above the start. Raises PathEndsError."""
        start = min(self.found, key=lambda known: abs(known.load_factor - load_factor))
        smallest = _SMALLEST_STEP * abs(load_factor - self.found[0].load_factor)
        step = load_factor - start.load_factor
        while start.load_factor != load_factor:
            left = load_factor - start.load_factor
            target = load_factor if abs(step) >= abs(left) * (1.0 - 1e-9) else start.load_factor + step
            following = self._step(start, target)
            if following is None:
                step = 0.5 * (target - start.load_factor)
                if abs(step) < smallest:
                    raise PathEndsError
                continue
            start = following
            self.found = sorted([*self.found, start], key=lambda known: known.load_factor)
            step = 2.0 * step
        return start

    def _step(self, start: Equilibrium, target: float) -> Equilibrium | None:
        change = (target - start.load_factor) * start.slope
        result = solve_equilibrium(self.system, start.p + change, target, Newton())
        size = np.max(np.abs(change) / self.scale)
        strayed = np.max(np.abs(result.state - start.p - change) / self.scale)
        if not result.ended.good or strayed > max(_STRAYED * size, _CLOSE):
            return None
        return self._equilibrium(result.state, target)

    def between(self, load_factor: float) -> np.ndarray:
        """Return the state (n,) at a load factor by interpolation between the four equilibria nearest to it.

        Where the tangent is singular, this is exacter than an equilibrium that has been solved for.
        """
        near = sorted(self.found, key=lambda known: abs(known.load_factor - load_factor))[:4]
        result = np.zeros_like(near[0].p)
        for one in near:
            others = [(load_factor - o.load_factor) / (one.load_factor - o.load_factor) for o in near if o is not one]
            result += np.prod(others) * one.p
        return result

    def solution(self, model: Model) -> Solution:
        """Return the equilibria found, as a solution."""
        p = np.array([known.p for known in self.found])
        at = np.array([known.load_factor for known in self.found])
        statistics = Statistics(0, len(self.found) - 1, 0, "the equilibria that were found on the primary path")
        return Solution(model, True, at, p, np.zeros_like(p), np.zeros_like(p), statistics)
