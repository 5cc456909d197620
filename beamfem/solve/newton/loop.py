"""Newton's iteration, the same for every problem: linearise, correct, check."""

from typing import NamedTuple, Protocol

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
