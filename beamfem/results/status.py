"""How a solve ended, and what is found wrong with its results."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from numpy import nan


class Status(Enum):
    """Termination status of a solve; the values are sentences."""

    COMPLETED = "the solve completed"
    ROUND_OFF = "the solve completed, with the residual as small as round-off allows"
    UNSTABLE = "the solve completed, but an equilibrium that it found, or started from, is unstable"
    STOPPED = "the solve stopped before completion"


@dataclass(frozen=True)
class Statistics:
    """How a solve went: iterations, completed steps, cuts of steps (of a motion, of groups of them), and why it ended.

    digits: exact digits of the forces of the last equilibrium, from the balance of loads and reactions, or of the
    largest force of the path where they have few; nan if unknown. rule: of a motion by a scheme, its time step [s],
    alpha_m, alpha_f, gamma and beta [-], see `Scheme`; by collocation with s stages, its time step h [s], s, and c, of
    which a step removes the share c (w h)^(2 s) of the energy of a vibration w; else empty.
    """

    iterations: int
    steps: int
    cuts: int
    ended: str
    status: Status = Status.COMPLETED
    warnings: tuple[str, ...] = ()
    digits: float = nan
    rule: tuple[float, ...] = ()

    @property
    def rejected(self) -> int:
        """Number of times that steps were refused and redone with shorter ones; the same as `cuts`."""
        return self.cuts

    @property
    def outcome(self) -> str:
        """Whether the solve completed, and why it ended, as text."""
        return f"{'stopped' if self.status is Status.STOPPED else 'completed'}: {self.ended}"

    @property
    def effort(self) -> str:
        """Numbers of iterations and steps, as text."""
        cut = f", {counted(self.cuts, 'step')} cut" if self.cuts else ""
        return f"{counted(self.iterations, 'Newton iteration')} in {counted(self.steps, 'step')}{cut}"


def counted(number: int, what: str) -> str:
    """Return a number of things in words, such as "1 step"."""
    return f"{number} {what}{'' if number == 1 else 's'}"


class Finding(NamedTuple):
    """A sentence for `warnings` of a result; kind: category of its Python warning, None if it is too small for one."""

    sentence: str
    kind: type[Warning] | None = None
