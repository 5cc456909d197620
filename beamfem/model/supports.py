"""Supports."""

from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.support import LineSupport, PointSupport, Value
from beamfem.validation import convert, finite, function_of_one, squared, vector


@dataclass(frozen=True)
class Clamp(PointSupport):
    """Constrain position and rotation of the section; r_x may stretch and, except for the elastic line, shear."""

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return what is prescribed, by direction."""
        return {"ux": 0.0, "uy": 0.0, "rotation": 0.0}


@dataclass(frozen=True)
class Pin(PointSupport):
    """Constrain the position; the rotation is free."""

    point: Point

    def prescribed(self) -> dict[str, Value]:
        """Return what is prescribed, by direction."""
        return {"ux": 0.0, "uy": 0.0}


@dataclass(frozen=True)
class Roller(PointSupport):
    """Constrain the displacement along `normal` (2,) only. Raises InputError for a zero normal."""

    point: Point
    normal: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "normal")
        if not any(self.normal):
            raise InputError("the normal of a Roller must not be zero")

    def prescribed(self) -> dict[str, Value]:
        """Return what is prescribed, by direction."""
        return {"normal": 0.0}

    @property
    def direction(self) -> np.ndarray:
        """Unit normal (2,)."""
        return np.array(self.normal) / np.hypot(*self.normal)


@dataclass(frozen=True)
class Prescribed(PointSupport):
    """Prescribe displacement ux, uy [m] and rotation [rad] from the reference; None leaves a direction free.

    A number grows with the load factor in statics and is constant in dynamics; a function depends on time, in statics
    on the load factor. Raises InputError.
    """

    point: Point
    ux: Value | None = None
    uy: Value | None = None
    rotation: Value | None = None

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
        """Return what is prescribed, by direction."""
        given = {"ux": self.ux, "uy": self.uy, "rotation": self.rotation}
        return {name: value for name, value in given.items() if value is not None}


@dataclass(frozen=True)
class Spring(PointSupport):
    """Spring to the ground against displacement (kx, ky) [N/m] and rotation [N m/rad], unstressed in the reference.

    Raises InputError for a negative stiffness, or if there is none at all.
    """

    point: Point
    stiffness: tuple[float, float] = (0.0, 0.0)
    rotational: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        convert(self, squared(finite), "rotational")
        values = (*self.stiffness, self.rotational)
        if min(values) < 0.0 or max(values) == 0.0:
            raise InputError(f"the stiffness of a Spring must not be negative, and somewhere positive, got {values}")

    def springs(self) -> dict[str, float]:
        """Return the stiffness [N/m], [N m/rad] by direction."""
        given = zip(("ux", "uy", "rotation"), (*self.stiffness, self.rotational), strict=True)
        return {name: value for name, value in given if value > 0.0}


@dataclass(frozen=True)
class Foundation(LineSupport):
    """Winkler foundation along a beam, (kx, ky) [N/m^2] per reference length, unstressed in the reference.

    Raises InputError for a negative stiffness, or if there is none at all.
    """

    beam: Beam
    stiffness: tuple[float, float]

    def __post_init__(self) -> None:
        super().__post_init__()
        convert(self, squared(vector), "stiffness")
        if min(self.stiffness) < 0.0 or max(self.stiffness) == 0.0:
            raise InputError(f"the stiffness of a Foundation must not be negative, and somewhere positive: {self}")
