"""What holds a beam. Each support lists the directions and the turn it prescribes at a point."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, require_beam, require_point
from beamfem.model.shapes import Held, Springs, SpringsAlong, SupportShape
from beamfem.validation import convert, finite, function_of_one, squared, vector

Value = float | Callable[[float], float]


@dataclass(frozen=True)
class Clamp:
    """Hold the position and the section's direction; r_x stays free to stretch and, off the elastic line, to shear."""

    point: Point

    def __post_init__(self) -> None:
        require_point("Clamp", self.point)

    def held(self) -> dict[str, Value]:
        return {"ux": 0.0, "uy": 0.0, "rotation": 0.0}

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return what it looks like."""
        return (Held(self.point, self.held()),)


@dataclass(frozen=True)
class Pin:
    """Hold the position."""

    point: Point

    def __post_init__(self) -> None:
        require_point("Pin", self.point)

    def held(self) -> dict[str, Value]:
        return {"ux": 0.0, "uy": 0.0}

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return what it looks like."""
        return (Held(self.point, self.held()),)


@dataclass(frozen=True)
class Roller:
    """Hold the position along `normal` (2,) only. Raises InputError for a zero normal."""

    point: Point
    normal: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        require_point("Roller", self.point)
        convert(self, squared(vector), "normal")
        if not any(self.normal):
            raise InputError("the normal of a Roller must not be zero")

    def held(self) -> dict[str, Value]:
        return {"normal": 0.0}

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return what it looks like."""
        return (Held(self.point, self.held(), self.direction),)

    @property
    def direction(self) -> np.ndarray:
        """Unit normal (2,)."""
        return np.array(self.normal) / np.hypot(*self.normal)


@dataclass(frozen=True)
class Prescribed:
    """Prescribe displacement ux, uy [m] and rotation [rad] from the reference; None leaves free.

    A number grows with the load factor in statics and is a constant in dynamics; a function is one of time, in statics
    of the load factor. Raises InputError.
    """

    point: Point
    ux: Value | None = None
    uy: Value | None = None
    rotation: Value | None = None

    def __post_init__(self) -> None:
        require_point("Prescribed", self.point)
        if not self.held():
            raise InputError("Prescribed needs at least one of ux, uy and rotation")
        for name, value in self.held().items():
            if callable(value):
                function_of_one(f"{name} of Prescribed", value, "time")
            else:
                convert(self, squared(finite), name)

    def held(self) -> dict[str, Value]:
        given = {"ux": self.ux, "uy": self.uy, "rotation": self.rotation}
        return {name: value for name, value in given.items() if value is not None}

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return what it looks like."""
        return (Held(self.point, self.held()),)


@dataclass(frozen=True)
class Spring:
    """Spring to the ground against displacement (kx, ky) [N/m] and rotation [N m/rad], at rest in the reference.

    Raises InputError for a negative stiffness, or where there is none at all.
    """

    point: Point
    stiffness: tuple[float, float] = (0.0, 0.0)
    rotational: float = 0.0

    def __post_init__(self) -> None:
        require_point("Spring", self.point)
        convert(self, squared(vector), "stiffness")
        convert(self, squared(finite), "rotational")
        values = (*self.stiffness, self.rotational)
        if min(values) < 0.0 or max(values) == 0.0:
            raise InputError(f"the stiffness of a Spring must not be negative, and somewhere positive, got {values}")

    @property
    def by_coordinate(self) -> dict[str, float]:
        """Stiffness [N/m] or [N m/rad] against each coordinate of a node, by its name."""
        return {"r^x": self.stiffness[0], "r^y": self.stiffness[1], "theta": self.rotational}

    def held(self) -> dict[str, Value]:
        return {}

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return what it looks like."""
        return (Springs(self.point, self.stiffness, self.rotational),)


@dataclass(frozen=True)
class Foundation:
    """Winkler foundation along a beam, (kx, ky) [N/m^2] per reference length, at rest in the reference.

    Raises InputError for a negative stiffness, or where there is none at all.
    """

    beam: Beam
    stiffness: tuple[float, float]

    def __post_init__(self) -> None:
        require_beam("Foundation", self.beam)
        convert(self, squared(vector), "stiffness")
        if min(self.stiffness) < 0.0 or max(self.stiffness) == 0.0:
            raise InputError(f"the stiffness of a Foundation must not be negative, and somewhere positive: {self}")

    def shapes(self) -> tuple[SupportShape, ...]:
        """Return what it looks like."""
        return (SpringsAlong(self.beam, self.stiffness),)


PointSupport = Clamp | Pin | Roller | Prescribed | Spring
Support = PointSupport | Foundation
