"""Pressure on the side of a beam."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.load_base import Amplitude, LineLoad
from beamfem.validation import called, convert, finite, squared


@dataclass(frozen=True)
class Pressure(LineLoad):
    """Pressure times width, normal to the deformed axis of a beam, per deformed length: a force p (-y', x') ds.

    It acts on the axis and does work on the area swept by the axis: a constant pressure is conservative if both ends of
    the beam are constrained in at least one direction, or close a ring. Raises InputError for an invalid value.

    Parameters
    ----------
    beam : Beam
        The loaded beam.
    value : float or callable, [N/m]
        Pressure times width, positive towards the left of the direction from start to end, the +y side of its sections;
        or a function of the reference arc length [m] that returns it. Elements end at the `kinks` of a function
        (declared, or jumps that are found).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the pressure grows with the load factor in statics, if it has no amplitude.

    Examples
    --------
    >>> uniform = bf.Pressure(beam, -500.0)
    >>> hydrostatic = bf.Pressure(beam, lambda s: -9810.0 * 0.05 * s)
    """

    along: ClassVar[tuple[str, ...]] = ("value",)
    axes: ClassVar[Literal["axis"]] = "axis"

    beam: Beam
    value: float | Callable[[float], float] = field(metadata={"unit": "N/m"})
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        if not callable(self.value):
            convert(self, squared(finite), "value")
        super().__post_init__()

    @property
    def uniform(self) -> bool:  # type: ignore[override]
        """Whether the load is the same at every arc length."""
        return not callable(self.value)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the pressure times width (n,) [N/m] at arc lengths (n,) [m], see `LineLoad.values_of`."""
        return self.values(arc_length)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the pressure times width at given arc lengths.

        Raises InputError if a function does not return a finite number.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, [N/m], (n,)
            Pressure times width, without the factor of the load.

        Examples
        --------
        >>> bf.Pressure(beam, lambda s: -500.0 * s).values(np.array([1.0, 2.0]))
        array([ -500., -1000.])
        """
        if not callable(self.value):
            return np.full(len(arc_length), self.value)
        function, name = self.value, "value of Pressure"
        return np.array([finite(f"{name} at arc length {s:g}", called(name, function, s)) for s in arc_length.tolist()])

    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces (0, p) [N/m] along and across the deformed axis (n, 2), see `LineLoad.forces`."""
        return np.column_stack([np.zeros(len(arc_length)), self.values(arc_length)])
