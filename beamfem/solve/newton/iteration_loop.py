"""Newton's iteration, the same for every problem: linearise, correct, check."""

from abc import ABC, abstractmethod
from typing import NamedTuple, Protocol

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.solve.newton.convergence import Correction
from beamfem.solve.newton.iteration import Termination


class Problem(Protocol):
    """Equations in a state: an equilibrium, a point of a path, the end of a time step."""

    def correct(self) -> Correction:
        """Linearise and take the next correction, or several until one is small. Raises LinAlgError."""
        ...

    def check(self, correction: Correction) -> Termination | None:
        """Return why the iteration ends after a correction, None if it goes on."""
        ...


class SingleCorrections(ABC):
    """Base class of problems that take one correction at a time: it counts them and remembers the first two."""

    def __init__(self) -> None:
        self.taken, self._size = 0, np.inf
        self._first, self._second = np.nan, 0

    @abstractmethod
    def take(self) -> tuple[float, int]:
        """Take the next correction; return its size and the negative pivots of its tangent. Raises LinAlgError."""

    def correct(self) -> Correction:
        """Take the next correction. Raises LinAlgError."""
        before = self._size
        self._size, negative = self.take()
        self.taken += 1
        if self.taken == 1:
            self._first = self._size
        elif self.taken == 2:
            self._second = negative
        return Correction(self.taken, self._size, before, negative)

    def after_first(self) -> tuple[float, int]:
        """Return the size of the first correction and the negative pivots of the second tangent."""
        return self._first, self._second


class Iterated(NamedTuple):
    """Why an iteration ended, after how many corrections, and the negative pivots of the last tangent."""

    ended: Termination
    iterations: int
    negative_pivots: int


def iterate(problem: Problem, most: int) -> Iterated:
    """Correct the state of a problem until it says why to end, or `most` times."""
    number = negative = 0
    while number < most:
        try:
            correction = problem.correct()
        except LinAlgError:
            return Iterated(Termination.SINGULAR, number + 1, negative)
        number, negative = correction.number, correction.negative_pivots
        ended = problem.check(correction)
        if ended is not None:
            return Iterated(ended, number, negative)
    return Iterated(Termination.EXHAUSTED, number, negative)
