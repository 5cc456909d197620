"""A motor at a point or in a hinge."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.contribution import At
from beamfem.model.load_base import Amplitude, CompositeLoad
from beamfem.model.load_shapes import Moment
from beamfem.model.part_units import UNIT
from beamfem.model.state_protocols import Placed
from beamfem.model.supports import Value
from beamfem.model.time_functions import Integral, kinks_of
from beamfem.parts.at_points import BetweenPlaces
from beamfem.parts.hinge import Hinge
from beamfem.parts.point_moment import PointMoment
from beamfem.parts.prescribed import Prescribed
from beamfem.parts.state_force import differentiated
from beamfem.physics.connections import MOTOR
from beamfem.validation import called, convert, finite, function_of_one, shown, squared, takes


@dataclass(frozen=True, eq=False)
class Drive(BetweenPlaces):
    """The condition of a motor in a hinge, t_b - t_a = u(t); its multiplier is the moment on a [N m]."""

    connection = MOTOR

    a: Point
    b: Point
    angle: Value

    @property
    def prescribed(self) -> tuple[Value, ...]:
        """The angle."""
        return (self.angle,)


@dataclass(frozen=True, eq=False)
class Controller:
    """The torque of a motor as a function of its state, on the last of its points and against the first of two."""

    points: tuple[Point, ...]
    torque: Callable[[float, float, float], float]

    unknowns: ClassVar[int] = 0
    conservative: ClassVar[bool] = False

    @property
    def kinks(self) -> tuple[float, ...]:
        """The times [s] that the function declares, at which it may jump."""
        return kinks_of(self.torque)

    def force(self, at: At) -> np.ndarray:
        """Return the moments that resist."""
        signs = np.array([-1.0, 1.0])[-len(self.points) :]
        forces = np.zeros_like(at.q)
        state = np.array([signs @ at.q[:, 2], signs @ at.v[:, 2]])
        torque = differentiated(lambda state: self._torque(at.time, *state.tolist()), state, np.ones(2))
        forces[:, 2] = -signs * torque
        return forces.ravel()

    def energy(self, at: At) -> tuple[float, float]:
        """Return no energies."""
        return 0.0, 0.0

    def _torque(self, *at: float) -> float:
        return finite("torque of Motor", called("torque of Motor", self.torque, *at))


@dataclass(frozen=True)
class Motor(CompositeLoad):
    """A motor that turns the section at a point against the ground, or both sides of a hinge against each other.

    Its angle, the rotation of the section at the point, or t_b - t_a in a hinge, is prescribed, or its speed, or its
    torque. A number is constant in dynamics and multiplied by the load factor in statics; a function depends on time
    [s], or on the load factor in statics, where the angle is the integral of the speed over it. In a hinge, the torque
    acts on the section of b, and its opposite on that of a.

    `solution.joint_force(motor)` has the torque. A motor does not hold the position: a `Pin` does. Raises InputError
    for an invalid value, or if not exactly one of angle, speed and torque is given.

    Parameters
    ----------
    at : Point or Hinge
        The point, or one of the hinges of the model.
    angle : float or callable, [rad], optional
        Angle from the reference.
    speed : float or callable, [rad/s], optional
        Angular velocity; the angle is 0 at the beginning.
    torque : float or callable, [N m], optional
        Torque, counter-clockwise; also a function of time, angle and speed, such as that of a controller.

    Examples
    --------
    >>> crank = bf.Beam(bf.Line((0, 0), (0.2, 0)), 2, bf.CRBF(order=3), bf.Rectangle(0.02, 0.02), steel)
    >>> motor = bf.Motor(crank.start, speed=3.0)
    >>> turning = bf.simulate(bf.Model([crank], [bf.Pin(crank.start)], [motor]), duration=0.1, step=1e-3)
    >>> round(float(turning.rotation(crank.start)[-1]), 6)
    0.3
    """

    at: Point | Hinge
    angle: Value | None = field(default=None, metadata={UNIT: "rad"})
    speed: Value | None = field(default=None, metadata={UNIT: "rad/s"})
    torque: Value | Callable[[float, float, float], float] | None = field(default=None, metadata={UNIT: "N m"})

    def __post_init__(self) -> None:
        if callable(self.torque) and not self.controlled:
            function_of_one("torque of Motor", self.torque, "time, or of time, angle and speed")
        super().__post_init__()
        if not isinstance(self.at, Point | Hinge):
            raise InputError(f"Motor acts at a point, such as beam.start, or in a Hinge, got {shown(self.at)}")
        given = [name for name in ("angle", "speed", "torque") if getattr(self, name) is not None]
        if len(given) != 1:
            raise InputError(f"Motor needs one of angle, speed and torque, got {' and '.join(given) or 'none'}")
        if callable(value := getattr(self, given[0])):
            if given[0] != "torque":
                function_of_one(f"{given[0]} of Motor", value, "time")
        else:
            convert(self, squared(finite), given[0])

    @property
    def controlled(self) -> bool:
        """Whether its torque is a function of its state."""
        return callable(self.torque) and takes(self.torque, 3)

    @property
    def joint(self) -> Hinge | None:
        """The hinge that it is in."""
        return self.at if isinstance(self.at, Hinge) else None

    @property
    def points(self) -> tuple[Point, ...]:
        """Its point, or both of its hinge."""
        return (self.at,) if isinstance(self.at, Point) else (self.at.a, self.at.b)

    @property
    def place(self) -> Point:
        """The last of its points, to which its angle and torque belong."""
        return self.points[-1]

    @property
    def amplitude(self) -> Amplitude:  # type: ignore[override]
        """A torque that is a function of time."""
        return self.torque if callable(self.torque) and not self.controlled else None  # type: ignore[return-value]

    @property
    def conservative(self) -> bool:
        """Whether its torque is constant; one that changes does work, the torque times the change of the angle.

        The work of one that is a function of the state is that of its `Controller`.
        """
        return self.amplitude is None

    @cached_property
    def parts(self) -> tuple[Any, ...]:
        """What prescribes its angle, or the moments of its torque."""
        if self.torque is None:
            if isinstance(self.at, Hinge):
                return (Drive(self.at.a, self.at.b, self._turned),)
            return (Prescribed(self.at, rotation=self._turned),)
        if self.controlled:
            return (Controller(self.points, self.torque),)  # type: ignore[arg-type]
        size = 1.0 if callable(self.torque) else self.torque
        pairs = zip(self.points, (-size, size)[-len(self.points) :], strict=True)
        return tuple(PointMoment(point, moment, self.amplitude) for point, moment in pairs)

    @property
    def layout(self) -> Any:
        """Points of a torque, of whose size no table depends; see `Load.layout`."""
        return self if self.torque is None or self.controlled else tuple(part.layout for part in self.parts)

    @property
    def _turned(self) -> Value:
        """The angle."""
        return Integral(self.speed) if self.angle is None else self.angle  # type: ignore[arg-type]

    def changed(self, change: Callable[[Value], Value]) -> "Motor":
        """Return the motor with its angle or torque replaced by `change` of it."""
        if self.controlled:
            return self
        if self.torque is None:
            return replace(self, angle=change(self._turned), speed=None)
        return replace(self, torque=change(self.torque))  # type: ignore[arg-type]

    def shapes(self, weight: float, placed: Placed) -> tuple[Moment, ...]:
        """Return the torque to draw, or the sense of the angle, see `Load.shapes`."""
        values = (self.angle, self.speed, self.torque)
        size = next((value for value in values if value is not None and not callable(value)), 1.0)
        return (Moment(self.place, weight * size),)
