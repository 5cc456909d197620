"""Loads of a model at a time."""

from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.model.load_base import factor, forces_of
from beamfem.model.model import Model


@dataclass(frozen=True, eq=False)
class LoadsAt:
    """Loads of a model at a time, in statics at a load factor.

    body (beams, 4): acceleration [m/s^2] and load per length [N/m]; points (nl, 3) of each block: forces [N] and
    moments [N m] at points; imposing (k,): factors of the loads that impose strains.
    """

    body: np.ndarray
    points: tuple[np.ndarray, ...]
    imposing: np.ndarray

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """All arrays of loads."""
        return (self.body, *self.points, self.imposing)

    @cached_property
    def largest(self) -> tuple[float, float]:
        """Largest component of a force [N] and largest moment [N m] at points."""
        maxima = [(0.0, 0.0, 0.0)]
        maxima += [np.abs(forces.reshape(-1, 3)).max(axis=0).tolist() for forces in self.points if forces.size]
        x, y, moment = (max(values) for values in zip(*maxima, strict=True))
        return max(x, y), moment

    @property
    def any(self) -> bool:
        """Whether any load is not zero."""
        return any(bool(array.any()) for array in self.arrays)


def body_loads(model: Model, time: float, static: bool) -> np.ndarray:
    """Return acceleration [m/s^2] and load per length [N/m] of each beam (beams, 4) at a time."""
    result = np.zeros((len(model.beams), 4))
    for load in model.gravity:
        result[:, :2] += np.array(load.vector) * factor(load, time, static)
    for line in model.line_loads:
        if line.even:
            result[model.number_of(line.beam), 2:] += forces_of(line, np.zeros(1))[0] * factor(line, time, static)
    return result
