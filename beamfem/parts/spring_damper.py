"""A spring with a damper, straight between two points or from a point to the ground."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.contribution import At
from beamfem.model.load_shapes import Coil
from beamfem.model.part_units import UNIT
from beamfem.model.time_functions import Interpolated
from beamfem.parts.at_points import BetweenPlaces
from beamfem.physics.connections import GROUNDED_SPRING, SPRING, Connection, Functions, spring_with_law
from beamfem.quadrature import gauss
from beamfem.validation import convert, not_negative, optional, squared, takes

_PARTS, _POINTS = 256, 3  # of the quadrature of a law, which may have kinks
_OF_ARRAYS = Functions(np.sqrt, np.cos, np.sin, lambda x: np.maximum(x, 0.0))


@dataclass(frozen=True)
class _MeasuredForce:
    """The law of a table, as a sum of kinks: constant outside of its points (elongation [m], force [N])."""

    points: tuple[tuple[float, float], ...]

    def __call__(self, elongation: Any, f: Any) -> Any:
        places, forces = zip(*self.points, strict=True)
        slopes = [0.0, *(np.diff(forces) / np.diff(places)).tolist(), 0.0]
        kinks = zip(places, np.diff(slopes).tolist(), strict=True)
        return forces[0] + sum(change * f.positive(elongation - place) for place, change in kinks)


@dataclass(frozen=True, slots=True)
class SpringDamper(BetweenPlaces):
    """A straight spring and damper between two points: its force is k (l - l0) + c dl/dt along the line between them.

    With a law F(e, f) of the elongation e = l - l0 in place of a stiffness, the force is F + c dl/dt. The law is
    written with +, -, *, /, whole powers, f.sqrt and f.positive, which is max(x, 0); see `Connection`. An
    `Interpolated` table of forces is a law too. Raises InputError for an invalid value, and if the points coincide in
    the reference.

    Parameters
    ----------
    a : Point
        Point of a beam.
    b : Point or (float, float), [m]
        Point of a beam, or a place on the ground.
    stiffness : float or callable, [N/m]
        Stiffness k >= 0, or a law F(e, f) [N], or `Interpolated` from elongations [m] to forces [N].
    damping : float, [N s/m], default 0
        Damping c >= 0.
    length : float, [m], optional
        Length l0 free of force, by default the distance in the reference.

    Examples
    --------
    >>> stay = bf.SpringDamper(beam.end, (2.0, 1.0), stiffness=1e5, damping=10.0)
    >>> stayed = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e4))], connectors=[stay])
    >>> rope = bf.SpringDamper(beam.end, (2.0, 1.0), lambda e, f: 10.0 + 1e5 * f.positive(e) ** 2)
    """

    apart: ClassVar[bool] = True
    may_end_on_ground: ClassVar[bool] = True

    a: Point
    b: Point | tuple[float, float]
    stiffness: float | Callable[[Any, Any], Any] = field(metadata={UNIT: "N/m"})
    damping: float = field(default=0.0, metadata={UNIT: "N s/m"})
    length: float | None = field(default=None, metadata={UNIT: "m"})

    def __post_init__(self) -> None:
        BetweenPlaces.__post_init__(self)
        if not callable(self.stiffness):
            convert(self, squared(not_negative), "stiffness")
        elif not isinstance(self.stiffness, Interpolated) and not takes(self.stiffness, 2):
            raise InputError("a law of a SpringDamper is a function of the elongation and f: lambda e, f: 1e3 * e**3")
        convert(self, squared(not_negative), "damping")
        convert(self, optional(squared(not_negative)), "length")

    @property
    def _law(self) -> Callable[[Any, Any], Any] | None:
        """Its law as a function of the elongation and f, None for a linear spring."""
        if isinstance(self.stiffness, Interpolated):
            return _MeasuredForce(tuple((float(place), float(force)) for place, force in self.stiffness.points))
        return self.stiffness if callable(self.stiffness) else None

    @property
    def connection(self) -> Connection:
        """A spring between points, or to the ground."""
        if (law := self._law) is not None:
            return spring_with_law(law, not isinstance(self.b, Point))
        return SPRING if isinstance(self.b, Point) else GROUNDED_SPRING

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return stiffness, damping and free length, and the place on the ground if it ends there."""
        length = self.distance if self.length is None else self.length
        own = 0.0 if callable(self.stiffness) else self.stiffness, self.damping, length
        return (*own, *self.ground)

    def energy(self, at: At) -> tuple[float, float]:
        """Return no kinetic energy, and the potential energy [J], of a law by quadrature of its force."""
        if (law := self._law) is None:
            return BetweenPlaces.energy(self, at)
        (ax, ay), (bx, by) = [np.real(row[:2]) for row in at.q] + ([self.ground] if self.ground else [])
        elongation = np.hypot(bx - ax, by - ay) - self.data(at.reference)[2]
        places, weights = gauss(_POINTS)
        every = (np.arange(_PARTS)[:, None] + places) / _PARTS
        strained = elongation[..., None, None] * every
        forces = np.broadcast_to(law(strained, _OF_ARRAYS), strained.shape)
        return 0.0, elongation * (forces @ weights).mean(axis=-1)

    def shapes(self) -> tuple[Coil, ...]:
        """Return the shape to draw."""
        return (Coil(self.a, self.b),)
