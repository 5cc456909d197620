"""What end stops have in common: limits of a measure between two sections, and how bodies bounce off them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.errors import InputError
from beamfem.parts.at_points import BetweenPlaces
from beamfem.validation import convert, finite, not_negative, optional, positive, squared

_NEVER = 1e300  # [rad] or [m], far away in all units


def require_rebound(part: Any) -> None:
    """Raise InputError for an invalid stiffness, damping or coefficient of restitution, or for both of the last two."""
    convert(part, squared(positive), "stiffness")
    convert(part, squared(not_negative), "damping")
    convert(part, optional(squared(positive)), "restitution")
    kind = type(part).__name__
    if part.restitution is not None and part.restitution > 1.0:
        raise InputError(f"restitution of {kind} is at most 1, got {part.restitution:g}")
    if part.restitution is not None and part.damping:
        raise InputError(f"{kind} takes a damping or a coefficient of restitution, got both")


def rebound_of(part: Any) -> float:
    """Return the share of the energy that is given back, the square of the coefficient of restitution."""
    return 1.0 if part.restitution is None else float(part.restitution) ** 2


class EndStop(BetweenPlaces):
    """Stiff one-sided springs that keep a measure of two sections between two limits."""

    __slots__ = ()

    if TYPE_CHECKING:  # fields of derived dataclasses
        low: float | None
        high: float | None
        stiffness: float
        damping: float
        restitution: float | None

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        convert(self, optional(finite), "low", "high")
        require_rebound(self)
        if self.low is None and self.high is None:
            raise InputError(f"{type(self).__name__} needs one of its limits low and high")
        low, high = self.limits
        if low > high:
            raise InputError(f"low of {type(self).__name__} must not be above high, got {low:g} and {high:g}")

    @property
    def conservative(self) -> bool:  # type: ignore[override]
        """Whether it gives back all of its energy at rest."""
        return self.restitution is None

    @property
    def limits(self) -> tuple[float, float]:
        """Both limits; one that is missing is far away."""
        return (-_NEVER if self.low is None else self.low), (_NEVER if self.high is None else self.high)

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness, damping, rebound and both limits."""
        return self.stiffness, self.damping, rebound_of(self), *self.limits
