"""The base classes of supports, at a point or along a beam."""

from abc import ABC, abstractmethod
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.load_shapes import Constraint, Springs, SpringsAlong, SupportShape
from beamfem.validation import called, finite, function_of_one, positive, require_known, shown, squared, vector

DIRECTIONS = ("ux", "uy", "rotation")
Value = float | Callable[[float], float]
_UNIT = 1e-9  # largest deviation of the length of a unit vector from 1


class Support(ABC):
    """A connection of beams to the ground: frozen dataclasses that derive from `PointSupport` or `LineSupport`."""

    @property
    @abstractmethod
    def place(self) -> Beam | Point:
        """The supported beam or point."""

    @abstractmethod
    def shapes(self) -> tuple[SupportShape, ...]:
        """Return the shapes to draw."""

    @abstractmethod
    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined support."""


class PointSupport(Support):
    """A support at a point: its prescribed directions and its springs.

    Directions are "ux" and "uy" [m] and "rotation" [rad], from the reference.
    """

    point: Point

    def __post_init__(self) -> None:
        require_point_of(self)

    def prescribed(self) -> Mapping[str, Value]:
        """Return the prescribed "ux", "uy" [m] and "rotation" [rad] by name; none unless overridden.

        Values are numbers, which grow with the load factor in statics, or functions of time [s]. "normal": 0.0
        constrains the displacement along `direction`; no other value is possible.
        """
        return {}

    def springs(self) -> Mapping[str, float]:
        """Return the stiffness of springs to the ground by name; none unless overridden.

        They are "ux", "uy" [N/m] and "rotation" [N m/rad], none of them zero.
        """
        return {}

    @property
    def direction(self) -> np.ndarray | None:
        """Unit vector (2,) [-] along which "normal" is prescribed, None if it is not."""
        return None

    @property
    def place(self) -> Point:
        return self.point

    def shapes(self) -> tuple[SupportShape, ...]:
        prescribed, springs = self.prescribed(), self.springs()
        shapes: tuple[SupportShape, ...] = ()
        if prescribed:
            shapes = (Constraint(self.point, prescribed, self.direction),)
        if springs:
            kx, ky, rotational = (springs.get(name, 0.0) for name in DIRECTIONS)
            shapes = (*shapes, Springs(self.point, (kx, ky), rotational))
        return shapes

    def require_valid(self) -> None:
        kind = type(self).__name__
        require_point_of(self)
        prescribed = _by_direction(f"prescribed of {kind}", self.prescribed, (*DIRECTIONS, "normal"))
        springs = _by_direction(f"springs of {kind}", self.springs, DIRECTIONS)
        if not prescribed and not springs:
            raise InputError(f"{kind} does nothing: let prescribed() or springs() of it return something by direction")
        for direction, value in prescribed.items():
            what = f"{direction} prescribed by {kind}"
            if direction == "normal" and (callable(value) or finite(what, value) != 0.0):
                raise InputError(f"{what} must be 0.0, got {shown(value)}: only ux, uy and rotation can be moved")
            if callable(value):
                function_of_one(what, value, "time")
            else:
                squared(finite)(what, value)
        for direction, stiffness in springs.items():
            squared(positive)(f"stiffness of {kind} in {direction}", stiffness)
        _require_direction(self, "normal" in prescribed)


class LineSupport(Support):
    """Springs along a beam to the ground, of a stiffness (kx, ky) [N/m^2] per reference length."""

    beam: Beam
    stiffness: tuple[float, float]

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))

    @property
    def place(self) -> Beam:
        return self.beam

    def shapes(self) -> tuple[SupportShape, ...]:
        return (SpringsAlong(self.beam, self.stiffness),)

    def require_valid(self) -> None:
        LineSupport.__post_init__(self)
        kind = type(self).__name__
        stiffness = squared(vector)(f"stiffness of {kind}", getattr(self, "stiffness", None))
        if min(stiffness) < 0.0 or max(stiffness) == 0.0:
            raise InputError(f"the stiffness of a {kind} must not be negative, and somewhere positive, got {stiffness}")


def _require_direction(support: PointSupport, needed: bool) -> None:
    what = f"direction of {type(support).__name__}"
    direction = called(what, lambda: support.direction)
    if direction is None and needed:
        raise InputError(f'{what} must be a unit vector, since "normal" is prescribed along it, got None')
    if direction is not None:
        if not needed:
            raise InputError(f'{what} is given, but prescribed() returns no "normal" along it')
        size = np.hypot(*vector(what, direction))
        if abs(size - 1.0) > _UNIT:
            raise InputError(f"{what} must be a unit vector, got {shown(direction)} of length {size:g}")


def _by_direction(what: str, function: Callable[[], Any], known: tuple[str, ...]) -> Mapping[str, Any]:
    values = called(what, function)
    if not isinstance(values, Mapping):
        raise InputError(f'{what} must return a dict by direction, such as {{"ux": 0.0}}, got {shown(values)}')
    for direction in values:
        require_known(f"{what} has the unknown direction {shown(direction)}", direction, known)
    return values


class SupportsAlong:
    """The supports at points of a model, sorted along each beam."""

    def __init__(self, supports: Iterable[PointSupport]) -> None:
        found: defaultdict[int, list[PointSupport]] = defaultdict(list)
        for support in sorted(supports, key=lambda support: support.point.fraction):
            found[id(support.point.beam)].append(support)
        self._beams = {beam: ([support.point.fraction for support in own], own) for beam, own in found.items()}

    def near(self, point: Point, distance: float) -> list[PointSupport]:
        """Return the supports on a point's beam whose fractions differ from the point's by less than a distance [-]."""
        fractions, supports = self._beams.get(id(point.beam), ([], []))
        begin = bisect_left(fractions, point.fraction - distance)
        end = bisect_right(fractions, point.fraction + distance)
        return [support for support in supports[begin:end] if abs(support.point.fraction - point.fraction) < distance]
