"""The base class of accelerations of all mass."""

from collections.abc import Mapping

import numpy as np

from beamfem.model.load_base import Load
from beamfem.model.load_shapes import Acceleration, LoadShape
from beamfem.model.state_protocols import Displaced, Placed
from beamfem.validation import squared, vector


class BodyLoad(Load):
    """An acceleration that acts on all mass.

    Attributes
    ----------
    vector : (float, float), [m/s^2]
        The acceleration.
    """

    vector: tuple[float, float]

    @property
    def place(self) -> None:
        """None: the load acts on all beams."""
        return

    @property
    def layout(self) -> None:
        """None, as no table depends on an acceleration; see `Load.layout`."""
        return

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as every acceleration of all mass has."""
        return True

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the acceleration to draw, see `Load.shapes`."""
        return (Acceleration(weight * np.array(self.vector)),)

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        """Return the acceleration, see `Load.acting`."""
        return {"acceleration": np.array([self.vector])}

    def work(self, displaced: Displaced) -> np.ndarray:
        """Return the work on all mass, see `Load.work`."""
        return np.asarray(sum(moved @ np.array(self.vector) for moved in displaced.first_moments))

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined load."""
        super().require_valid()
        squared(vector)(f"vector of {type(self).__name__}", getattr(self, "vector", None))
