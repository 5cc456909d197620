"""How a solve ended."""

from enum import Enum


class Status(Enum):
    """How a solve ended; the values are sentences."""

    COMPLETED = "the solve came to its end"
    ROUND_OFF = "the solve came to its end, where the residual is at the round-off floor of the model"
    UNSTABLE = "the solve came to its end, but some of its rows are unstable equilibria"
    STOPPED = "the solve stopped before its end"
