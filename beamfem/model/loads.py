"""The loads of the package: gravity, loads along beams, and loads at points."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from beamfem.model.beam import Beam, Point
from beamfem.model.load_base import Amplitude, BodyLoad, LineLoad, PointLoad
from beamfem.validation import called, convert, finite, flag, squared, vector

Varying = Callable[[float], Sequence[float]]


@dataclass(frozen=True)
class Gravity(BodyLoad):
    """Gravity, an acceleration of the mass of every beam.

    Parameters
    ----------
    vector : (float, float), [m/s^2]
        Acceleration (gx, gy).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether gravity grows with the load factor in statics, if it has no amplitude.

    Examples
    --------
    >>> heavy = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -9.81))]))
    >>> heavy.reaction(beam.start)[-1, 1:].round(1)  # fy, m
    array([770.1, 770.1])
    """

    vector: tuple[float, float] = field(metadata={"unit": "m/s^2"})
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        convert(self, squared(vector), "vector")
        super().__post_init__()


@dataclass(frozen=True)
class DistributedLoad(LineLoad):
    """Distributed force on a beam, per reference length.

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

    Raises
    ------
    InputError
        For an invalid value.

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

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, [N/m], (n, 2)
            Forces (qx, qy) per reference length, without the factor of the load.

        Raises
        ------
        InputError
            If a function does not return two finite numbers.

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


@dataclass(frozen=True)
class Pressure(LineLoad):
    """Pressure times width, normal to the deformed axis of a beam, per deformed length: a force p (-y', x') ds.

    It acts on the axis and does work on the area swept by the axis: a constant pressure is conservative if both ends of
    the beam are constrained in at least one direction, or close a ring.

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

    Raises
    ------
    InputError
        For an invalid value.

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

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, [N/m], (n,)
            Pressure times width, without the factor of the load.

        Raises
        ------
        InputError
            If a function does not return a finite number.

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


@dataclass(frozen=True)
class PointForce(PointLoad):
    """Force on the axis at a point.

    Parameters
    ----------
    point : Point
        Point of application.
    vector : (float, float), [N]
        Force (fx, fy).
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the force grows with the load factor in statics, if it has no amplitude.
    follower : bool, default False
        Whether the force rotates with the section.

    Examples
    --------
    >>> push = bf.PointForce(beam.end, (0.0, -1e4))
    >>> periodic = bf.PointForce(beam.end, (0.0, -1e4), amplitude=lambda time: np.sin(20.0 * time))
    """

    point: Point
    vector: tuple[float, float] = field(metadata={"unit": "N"})
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "vector")

    @property
    def value(self) -> tuple[float, float, float]:
        """Force fx, fy [N] and moment [N m]."""
        return (*self.vector, 0.0)


@dataclass(frozen=True)
class PointMoment(PointLoad):
    """Moment, counter-clockwise, conjugate to the rotation of the section: virtual work M dtheta.

    Parameters
    ----------
    point : Point
        Point of application.
    moment : float, [N m]
        Moment.
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the moment grows with the load factor in statics, if it has no amplitude.
    follower : bool, default False
        Accepted for uniformity; in the plane a moment that rotates with the section is the same moment.

    Examples
    --------
    >>> bent = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 1e4)]))
    >>> round(float(bent.rotation(beam.end)[-1]), 5)  # M L / E I
    0.02286
    """

    point: Point
    moment: float = field(metadata={"unit": "N m"})
    amplitude: Amplitude = None
    scale: bool = True
    follower: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(finite), "moment")

    @property
    def value(self) -> tuple[float, float, float]:
        """Force fx, fy [N] and moment [N m]."""
        return (0.0, 0.0, self.moment)
