"""A function that was saved as the values it had."""

from bisect import bisect_left
from dataclasses import dataclass

from beamfem.errors import InputError


@dataclass(frozen=True)
class Sampled:
    """A function saved as values (n,) at increasing times [s] or load factors at (n,), linear between them."""

    at: tuple[float, ...]
    values: tuple[float, ...]

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
        share = (at - self.at[after - 1]) / (self.at[after] - self.at[after - 1])
        return (1.0 - share) * self.values[after - 1] + share * self.values[after]
