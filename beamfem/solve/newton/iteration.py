"""Options of the Newton iteration for an equilibrium, and how an iteration ended."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from beamfem.errors import InputError
from beamfem.validation import convert, count, flag, positive, shown


class Termination(Enum):
    """Why an iteration ended; the values are the sentences that users read."""

    CONVERGED = "the correction and the residual are within the tolerance"
    ROUND_OFF = "the residual has reached the round-off floor of the model"
    DIVERGED = "the corrections grew beyond the size of the model"
    EXHAUSTED = "the iterations ran out before the corrections became small"
    SINGULAR = "the tangent is singular"
    NO_DIGITS = "round-off leaves no digit of the forces: stiffnesses and loads of this model are too far apart"
    LOST = "the count of negative pivots changed on the way, so the equilibrium may be one of another path"
    LIMIT = "as they grow from zero, they reach a limit point, beyond which there is no equilibrium nearby"
    INVERTED = "the beam was turned inside out: r_x and r_y no longer form a right-handed pair"

    @property
    def good(self) -> bool:
        return self is Termination.CONVERGED or self is Termination.ROUND_OFF


class NewtonResult(NamedTuple):
    """The last state (n,) of an iteration, the number of iterations and why it ended.

    negative_pivots: of the last tangent; for a symmetric one, the number of unstable directions; digits: least number
    of reliable digits of the forces; first: size of the first correction [-]; linear: if the count of the second
    tangent differed from the one asked for, the negative pivots of the tangent at the start with the stresses of a
    linear step, -1 if it is singular.
    """

    state: np.ndarray
    iterations: int
    ended: Termination
    negative_pivots: int = 0
    digits: float = np.nan
    first: float = np.nan
    linear: int | None = None


@dataclass(frozen=True)
class Newton:
    """Tolerances and options of the Newton iteration.

    Parameters
    ----------
    tolerance : float, [-], default 1e-10
        Largest correction relative to the model's length or one radian.
    residual_tolerance : float, [-], default 1e-9
        Largest residual relative to the reactions and loads.
    iterations : int, default 15
        Largest number of iterations.
    independent_stresses : bool, default True
        Whether the geometric tangent takes the section forces that the last correction predicted.

    Raises
    ------
    InputError
        For an invalid value.

    References
    ----------
    Magisano, Leonetti and Garcea 2017 (independent stresses).

    Examples
    --------
    >>> solution = bf.solve_static(model, newton=bf.Newton(tolerance=1e-8, iterations=30))
    >>> solution.status.name
    'COMPLETED'
    """

    tolerance: float = 1e-10
    residual_tolerance: float = 1e-9
    iterations: int = 15
    independent_stresses: bool = True

    def __post_init__(self) -> None:
        convert(self, positive, "tolerance", "residual_tolerance")
        convert(self, count, "iterations")
        convert(self, flag, "independent_stresses")
        if max(self.tolerance, self.residual_tolerance) >= 1.0:
            raise InputError(
                "tolerance and residual_tolerance of Newton are fractions of the model and of its loads, below 1, got "
                f"{self.tolerance:g} and {self.residual_tolerance:g}"
            )


def require_newton(newton: Newton | None, default: Newton) -> Newton:
    """Return the given Newton, or the default for None. Raises InputError for anything else."""
    if newton is None:
        return default
    if not isinstance(newton, Newton):
        raise InputError(f"newton must be a Newton(tolerance=..., iterations=...), got {shown(newton)}")
    return newton
