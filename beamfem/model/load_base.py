"""What all loads have in common: a factor, and what drawings, files and energies ask of them."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.load_shapes import LoadShape
from beamfem.model.state_protocols import Axes, Displaced, Placed
from beamfem.validation import flag, function_of_one, function_value

Amplitude = Callable[[float], float] | None


class Load(ABC):
    """A load with a factor: amplitude(time), or else, in statics, the load factor if `scale` is True, or else 1.

    Loads are frozen dataclasses that derive from `PointLoad`, `LineLoad`, `BodyLoad` or `ImposedStrain`.
    """

    along: ClassVar[tuple[str, ...]] = ()

    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        kind = type(self).__name__
        if self.amplitude is not None:
            function_of_one(f"amplitude of {kind}", self.amplitude, "time")
        flag(f"scale of {kind}", self.scale)

    @property
    @abstractmethod
    def place(self) -> Beam | Point | None:
        """The beam or point that the load acts on, None for all beams."""

    @property
    def axes(self) -> Axes:
        """Axes of what the load returns as `acting`: "plane", "section" or "axis", see `LineLoad`."""
        return "plane"

    @property
    def layout(self) -> Any:
        """All of the load but its size; the load itself if tables of solvers depend on its size."""
        return self

    @property
    @abstractmethod
    def conservative(self) -> bool:
        """Whether the load has a potential while its factor is constant, whatever the supports."""

    @abstractmethod
    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the shapes to draw for the load in a state of the model.

        Parameters
        ----------
        weight : float, [-]
            Factor by which the size of the load is multiplied.
        placed : Placed
            The state, with the rotations and directions of the axis there.

        Returns
        -------
        tuple of Force, Moment, ForcesAlong, Acceleration or Strains
            The shapes, see `beamfem.model.load_shapes`.
        """

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        """Return what acts on beams from outside, along `axes` and without the factor of the load.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start of a beam.

        Returns
        -------
        mapping
            "force" [N], "line_force" [N/m] or "acceleration" [m/s^2], (n, 2), and "moment" [N m], (n, 1); nothing for
            imposed strains.
        """
        return {}

    def work(self, displaced: Displaced) -> np.ndarray:
        """Return the work from the reference to states of the model; that of imposed strains is in the strain energy.

        Parameters
        ----------
        displaced : Displaced
            The states, with the displacements of the beams.

        Returns
        -------
        array, [J], (steps,)
            Work of a conservative load, without its factor.
        """
        return np.zeros(len(displaced))

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined load."""
        if isinstance(getattr(type(self), "amplitude", None), property):
            kind = type(self).__name__
            raise InputError(f"amplitude of {kind} must be a field or a method of the time, not a property")
        Load.__post_init__(self)


def factor(load: Load, time: float, static: bool) -> float:
    """Return the factor of a load at a time, in statics at a load factor.

    It is amplitude(time) if there is one, or else, in statics, the load factor for loads with `scale`, or else 1.
    """
    if load.amplitude is not None:
        return function_value(f"amplitude of {type(load).__name__}", load.amplitude, time)
    return time if static and load.scale else 1.0
