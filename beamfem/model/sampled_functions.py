"""Functions that were saved as samples."""

from bisect import bisect_left
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.reprs import brief
from beamfem.section.protocol import CrossSection

_SAME = 1e-9  # fraction of the length within which an arc length counts as a saved one


@dataclass(frozen=True)
class Sampled:
    """A function saved as values (n,) at increasing times [s] or load factors at (n,), linear between them."""

    at: tuple[float, ...]
    values: tuple[float, ...]

    __repr__ = brief

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times [s] or load factors (n,) where the slope jumps."""
        return self.at

    def __call__(self, at: float) -> float:
        """Return the value at a time [s] or load factor. Raises InputError outside of the saved range."""
        if not self.at[0] <= at <= self.at[-1]:
            raise InputError(
                f"this function was saved as its values from {self.at[0]:g} to {self.at[-1]:g} and cannot be "
                f"evaluated at {at:g}; to run the model there, give it the function itself again"
            )
        after = bisect_left(self.at, at)
        if self.at[after] == at:
            return self.values[after]
        fraction = (at - self.at[after - 1]) / (self.at[after] - self.at[after - 1])
        return (1.0 - fraction) * self.values[after - 1] + fraction * self.values[after]


@dataclass(frozen=True)
class SampledAlong:
    """A load along a beam, saved as values (n,) or (n, 2) at increasing arc lengths at (n,) [m], linear between them.

    kinks (nj,): arc lengths [m] of kinks, at which elements end.
    """

    at: tuple[float, ...]
    values: tuple[Any, ...]
    kinks: tuple[float, ...] = ()

    __repr__ = brief

    def __call__(self, arc_length: float) -> Any:
        """Return the value at an arc length [m]; beyond the saved range, that of the nearer end."""
        columns = np.array(self.values).reshape(len(self.at), -1).T
        values = tuple(float(np.interp(arc_length, self.at, column)) for column in columns)
        return values if len(values) > 1 else values[0]


@dataclass(frozen=True)
class SampledSection:
    """A section that varies, saved as its values (n,) at increasing arc lengths at (n,) [m], linear between them.

    kinks (nj,): arc lengths [m] of its jumps and kinks.
    """

    at: tuple[float, ...]
    values: tuple[CrossSection, ...]
    kinks: tuple[float, ...] = ()

    __repr__ = brief

    def __call__(self, arc_length: float) -> CrossSection:
        """Return the section at an arc length [m]. Raises InputError between two of different kinds."""
        after = min(max(bisect_left(self.at, arc_length), 1), len(self.at) - 1)
        low, high = self.at[after - 1], self.at[after]
        near = _SAME * (self.at[-1] - self.at[0])
        if arc_length - low <= near:
            return self.values[after - 1]
        if high - arc_length <= near:
            return self.values[after]
        try:
            section = _between(self.values[after - 1], self.values[after], (arc_length - low) / (high - low))
        except ValueError:
            raise InputError(
                f"the section was saved as its values, which are of different kinds at the arc lengths {low:g} and "
                f"{high:g}; to evaluate it at {arc_length:g}, give the function itself again"
            ) from None
        assert isinstance(section, CrossSection)
        return section


def _between(low: Any, high: Any, fraction: float) -> Any:
    """Return the same object with interpolated numbers; ValueError if the two objects differ otherwise."""
    if is_dataclass(low) and not isinstance(low, type) and type(low) is type(high):
        names = [field.name for field in fields(low)]
        return replace(low, **{name: _between(getattr(low, name), getattr(high, name), fraction) for name in names})
    if isinstance(low, tuple) and isinstance(high, tuple):
        return tuple(_between(one, other, fraction) for one, other in zip(low, high, strict=True))
    if isinstance(low, int | float) and isinstance(high, int | float):
        return (1.0 - fraction) * low + fraction * high
    if low == high:
        return low
    raise ValueError
