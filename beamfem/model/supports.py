"""The supports of the package."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.support_base import LineSupport, PointSupport, Value
from beamfem.validation import convert, finite, function_of_one, squared, vector


@dataclass(frozen=True)
class Clamp(PointSupport):
    """Constrain position and rotation of the section.

    r_x may still stretch and, except for the elastic line, shear.

    Parameters
    ----------
    point : Point
        The clamped point.

    Examples
    --------
    >>> clamped = bf.Model([beam], supports=[bf.Clamp(beam.start), bf.Clamp(beam.end)])
    >>> len(clamped.supports)
    2
    """

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"ux": 0.0, "uy": 0.0, "rotation": 0.0}


@dataclass(frozen=True)
class Pin(PointSupport):
    """Constrain the position; the rotation is free.

    Parameters
    ----------
    point : Point
        The pinned point.

    Examples
    --------
    >>> simply_supported = bf.Model([beam], supports=[bf.Pin(beam.start), bf.Roller(beam.end)])
    >>> len(simply_supported.supports)
    2
    """

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"ux": 0.0, "uy": 0.0}


@dataclass(frozen=True)
class Roller(PointSupport):
    """Constrain the displacement along a normal only.

    Parameters
    ----------
    point : Point
        The supported point.
    normal : (float, float), [-], default (0, 1)
        Direction of the constraint; its length does not matter.

    Raises
    ------
    InputError
        For a zero normal.

    Examples
    --------
    >>> inclined = bf.Roller(beam.end, normal=(-1.0, 1.0))
    >>> inclined.direction.round(3)
    array([-0.707,  0.707])
    """

    point: Point
    normal: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "normal")
        if not any(self.normal):
            raise InputError("the normal of a Roller must not be zero")

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        return {"normal": 0.0}

    @property
    def direction(self) -> np.ndarray:
        """Unit normal (2,) [-]."""
        return np.array(self.normal) / np.hypot(*self.normal)


@dataclass(frozen=True)
class Prescribed(PointSupport):
    """Prescribe displacement and rotation at a point, from the reference.

    A number is multiplied by the load factor in statics and constant in dynamics; a function depends on time [s], or on
    the load factor in statics. None leaves a direction free.

    Parameters
    ----------
    point : Point
        The moved point.
    ux, uy : float or callable, [m], optional
        Displacement.
    rotation : float or callable, [rad], optional
        Rotation of the section.

    Raises
    ------
    InputError
        If nothing is prescribed, or a value is invalid.

    Examples
    --------
    >>> pushed = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=-0.1)])
    >>> round(float(bf.solve_static(pushed).reaction(beam.end)[-1, 1]), -2)
    -32800.0
    """

    point: Point
    ux: Value | None = field(default=None, metadata={"unit": "m"})
    uy: Value | None = field(default=None, metadata={"unit": "m"})
    rotation: Value | None = field(default=None, metadata={"unit": "rad"})

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.prescribed():
            raise InputError("Prescribed needs at least one of ux, uy and rotation")
        for name, value in self.prescribed().items():
            if callable(value):
                function_of_one(f"{name} of Prescribed", value, "time")
            else:
                convert(self, squared(finite), name)

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        values = {"ux": self.ux, "uy": self.uy, "rotation": self.rotation}
        return {name: value for name, value in values.items() if value is not None}


@dataclass(frozen=True)
class Spring(PointSupport):
    """Spring to the ground, unstressed in the reference.

    Parameters
    ----------
    point : Point
        The supported point.
    stiffness : (float, float), [N/m], default (0, 0)
        Stiffness (kx, ky) against displacement.
    rotational : float, [N m/rad], default 0
        Stiffness against rotation.

    Raises
    ------
    InputError
        For a negative stiffness, or if all are zero.

    Examples
    --------
    >>> spring = bf.Spring(beam.end, stiffness=(0.0, 1e5), rotational=200.0)
    """

    point: Point
    stiffness: tuple[float, float] = field(default=(0.0, 0.0), metadata={"unit": "N/m"})
    rotational: float = field(default=0.0, metadata={"unit": "N m/rad"})

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        convert(self, squared(finite), "rotational")
        values = (*self.stiffness, self.rotational)
        if min(values) < 0.0 or max(values) == 0.0:
            raise InputError(f"the stiffness of a Spring must not be negative, and somewhere positive, got {values}")

    def springs(self) -> dict[str, float]:
        """Return the stiffness by direction, [N/m] and [N m/rad], without zeros."""
        pairs = zip(("ux", "uy", "rotation"), (*self.stiffness, self.rotational), strict=True)
        return {name: value for name, value in pairs if value > 0.0}


@dataclass(frozen=True)
class Foundation(LineSupport):
    """Winkler foundation along a beam, unstressed in the reference.

    Parameters
    ----------
    beam : Beam
        The supported beam.
    stiffness : (float, float), [N/m^2]
        Stiffness (kx, ky) per reference length.

    Raises
    ------
    InputError
        For a negative stiffness, or if both are zero.

    Examples
    --------
    >>> soil = bf.Foundation(beam, stiffness=(0.0, 1e6))
    """

    beam: Beam
    stiffness: tuple[float, float] = field(metadata={"unit": "N/m^2"})

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        if min(self.stiffness) < 0.0 or max(self.stiffness) == 0.0:
            raise InputError(f"the stiffness of a Foundation must not be negative, and somewhere positive: {self}")
