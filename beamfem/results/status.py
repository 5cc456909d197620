"""How a solve ended."""

from dataclasses import dataclass
from enum import Enum

from numpy import nan


class Status(Enum):
    """Termination status of a solve; the values are sentences."""

    COMPLETED = "the solve completed"
    ROUND_OFF = "the solve completed, with the residual at the round-off floor of the model"
    UNSTABLE = "the solve completed, but an equilibrium that it found, or started from, is unstable"
    STOPPED = "the solve stopped before completion"


@dataclass(frozen=True)
class Statistics:
    """Total Newton iterations, completed steps, cut steps, and the termination reason in a sentence.

    status: the termination as a member of `Status`; warnings: sentences to heed before using the results; digits: exact
    digits of the forces of the last equilibrium, from the balance of loads and reactions, nan if not known.
    """

    iterations: int
    steps: int
    cuts: int
    ended: str
    status: Status = Status.COMPLETED
    warnings: tuple[str, ...] = ()
    digits: float = nan

    @property
    def outcome(self) -> str:
        """Whether the solve completed, with the reason for its end behind it."""
        return f"{'stopped' if self.status is Status.STOPPED else 'completed'}: {self.ended}"

    @property
    def effort(self) -> str:
        """Iterations and steps in words."""
        cut = f", {counted(self.cuts, 'step')} cut" if self.cuts else ""
        return f"{counted(self.iterations, 'Newton iteration')} in {counted(self.steps, 'step')}{cut}"


def counted(number: int, what: str) -> str:
    """Return a number of things in words, such as "1 step"."""
    return f"{number} {what}{'' if number == 1 else 's'}"
