"""A distributed force along a beam."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.load_base import Amplitude, LineLoad
from beamfem.validation import called, convert, flag, squared, vector

Varying = Callable[[float], Sequence[float]]


@dataclass(frozen=True)
class DistributedLoad(LineLoad):
    """Distributed force on a beam, per reference length.

    Raises InputError for an invalid value.

    Parameters
    ----------
    beam : Beam
        The loaded beam.
    vector : (float, float) or callable, [N/m]
        Force per length (qx, qy) in the global axes x and y; or a function of the arc length [m] from the start that
        returns it. Elements end at the `kinks` of a function (declared, or jumps that are found).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the load grows with the load factor in statics, if it has no amplitude.
    follower : bool, default False
        Whether the force at each point rotates with its section; on a curved beam that is not normal to the axis, see
        `Pressure`.

    Examples
    --------
    >>> weight = bf.DistributedLoad(beam, (0.0, -385.0))
    >>> triangle = bf.DistributedLoad(beam, lambda s: (0.0, -500.0 * s))
    """

    along: ClassVar[tuple[str, ...]] = ("vector",)

    beam: Beam
    vector: tuple[float, float] | Varying = field(metadata={"unit": "N/m"})
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        if not callable(self.vector):
            convert(self, squared(vector), "vector")
        super().__post_init__()
        flag("follower of DistributedLoad", self.follower)

    @property
    def axes(self) -> Literal["plane", "section"]:
        """Axes of the forces: "section" for a follower load, otherwise "plane"."""
        return "section" if self.follower else "plane"

    @property
    def uniform(self) -> bool:  # type: ignore[override]
        """Whether the load is the same at every arc length."""
        return not callable(self.vector)

    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces (qx, qy) per length (n, 2) [N/m] at arc lengths (n,) [m], see `LineLoad.forces`.

        Raises InputError if a function does not return two finite numbers.
        """
        return self.values(arc_length)

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces (qx, qy) per length (n, 2) [N/m] at arc lengths (n,) [m], see `LineLoad.values_of`."""
        return self.values(arc_length)

    def values(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces per length at given arc lengths.

        Raises InputError if a function does not return two finite numbers.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, [N/m], (n, 2)
            Forces (qx, qy) per reference length, without the factor of the load.

        Examples
        --------
        >>> bf.DistributedLoad(beam, lambda s: (0.0, -500.0 * s)).values(np.array([1.0, 2.0]))
        array([[    0.,  -500.],
               [    0., -1000.]])
        """
        if not callable(self.vector):
            return np.tile(self.vector, (len(arc_length), 1))
        function, name = self.vector, "vector of DistributedLoad"
        forces = [vector(f"{name} at arc length {s:g}", called(name, function, s)) for s in arc_length.tolist()]
        return np.array(forces).reshape(-1, 2)
