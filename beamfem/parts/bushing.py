"""A bushing: springs and dampers between two sections in both axes and the angle."""

from dataclasses import dataclass, field

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.load_shapes import Spiral
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import BUSHING
from beamfem.validation import items, not_negative, shown, squared


@dataclass(frozen=True, slots=True)
class Bushing(BetweenPlaces):
    """Springs and dampers between two sections, in axes that turn with the first, free of force in the reference.

    Potential (kx u^2 + ky v^2 + kt (tb - ta)^2) / 2, with the displacement (u, v) of b relative to a in axes that are x
    and y in the reference and turn with the section of a. The dampers act on the rates of the same three. Raises
    InputError for an invalid value.

    Parameters
    ----------
    a, b : Point
        Points of beams.
    stiffness : (float, float, float), [N/m, N/m, N m/rad]
        Stiffness (kx, ky, kt).
    damping : (float, float, float), [N s/m, N s/m, N m s/rad], default (0, 0, 0)
        Damping.

    Examples
    --------
    >>> wall = bf.Beam(bf.Line((2, 0), (3, 0)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
    >>> rubber = bf.Bushing(beam.end, wall.start, (1e6, 1e6, 500.0), damping=(1e3, 1e3, 1.0))
    >>> mounted = bf.Model([beam, wall], [bf.Clamp(wall.end)], [bf.Gravity((0, -9.81))], connectors=[rubber])
    """

    connection = BUSHING

    a: Point
    b: Point
    stiffness: tuple[float, float, float] = field(metadata={UNIT: "N/m, N/m, N m/rad"})
    damping: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), metadata={UNIT: "N s/m, N s/m, N m s/rad"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        for name in ("stiffness", "damping"):
            what, given = f"{name} of Bushing", getattr(self, name)
            numbers = tuple(squared(not_negative)(what, value) for value in items(what, given))
            if len(numbers) != 3:
                raise InputError(f"{what} must be three numbers, along x, y and against rotation, got {shown(given)}")
            object.__setattr__(self, name, numbers)

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness, damping and the distance in the reference."""
        return (*self.stiffness, *self.damping, *(reference[1, :2] - reference[0, :2]).tolist())

    def shapes(self) -> tuple[Spiral, ...]:
        """Return the shape to draw."""
        return (Spiral(self.a),)
