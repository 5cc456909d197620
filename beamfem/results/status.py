"""How a solve ended."""

from dataclasses import dataclass
from enum import Enum

from numpy import nan


class Status(Enum):
    """How a solve ended; the values are sentences."""

    COMPLETED = "the solve came to its end"
    ROUND_OFF = "the solve came to its end, where the residual is at the round-off floor of the model"
    UNSTABLE = "the solve came to its end, but an equilibrium that it found, or started from, is unstable"
    STOPPED = "the solve stopped before its end"


@dataclass(frozen=True)
class Statistics:
    """Newton iterations in all, completed steps, steps that were cut, and how the solve ended, in a sentence.

    digits: of the forces of the last equilibrium that the balance of loads and reactions makes sure, nan if not known.
    status: the same as a member of an enum; warnings: sentences on what a user should know before using the numbers.
    """

    iterations: int
    steps: int
    cuts: int
    ended: str
    status: Status = Status.COMPLETED
    warnings: tuple[str, ...] = ()
    digits: float = nan
