"""What parts at points have in common: force and energy from the definition of their connection."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from beamfem.element.fields import Field
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, require_point_of
from beamfem.model.contribution import At, Contribution
from beamfem.model.load_shapes import ConnectorShape
from beamfem.model.supports import Value
from beamfem.physics.compiled_connections import in_python
from beamfem.physics.connections import Connection, Functions
from beamfem.validation import convert, squared, vector

# of numbers and arrays, complex ones too
ANALYTIC = Functions(np.sqrt, np.cos, np.sin, lambda x: np.where(np.real(x) > 0.0, x, 0.0 * x))


class PartAtPoints:
    """A `Contribution` whose forces are derived from energies and conditions, and compiled; see `Connection`.

    Attributes
    ----------
    points : tuple of Point, (m,)
        Its points.
    prescribed : tuple of float or callable
        Values of the conditions that have one, see `Connection.prescribed`: numbers, which grow with the load factor in
        statics, or functions of time [s], in statics of the load factor.
    connection : Connection
        Its definition.
    """

    __slots__ = ()
    conservative: ClassVar[bool] = True  # a damper exerts no force at rest

    if TYPE_CHECKING:  # fields or properties of derived dataclasses, for which those here would be defaults

        @property
        def points(self) -> tuple[Point, ...]:
            """Points (m,) on which it acts."""
            ...

        @property
        def connection(self) -> Connection:
            """The definition of its energies and conditions."""
            ...

    @property
    def prescribed(self) -> tuple[Value, ...]:
        """Values of its conditions, none unless overridden."""
        return ()

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return its numbers, by default its attributes by the names of `Connection.data`.

        reference (m, 3): q of its points in the reference.
        """
        return tuple(getattr(self, name) for name in self.connection.data)

    @property
    def rotations(self) -> bool:
        """Whether it depends on the rotations of its points."""
        return self.connection.coordinates == 3

    @property
    def one_sided(self) -> bool:
        """Whether its conditions come and go."""
        return self.connection.one_sided

    @property
    def unknowns(self) -> int:
        """Number of its multipliers."""
        return self.connection.multipliers

    @property
    def memory(self) -> tuple[float, ...]:
        """Initial history variables, zero."""
        return (0.0,) * len(self.connection.memory)

    def remember(self, at: At) -> tuple[float, ...]:
        """Return the history variables after an accepted step."""
        connection = self.connection
        if connection.remember is None:
            return ()
        q, v = (connection.split(self._coordinates(x)) for x in (at.q, at.v))
        return connection.remember(q, v, (*self._data(at), *at.own), ANALYTIC)

    def shapes(self) -> tuple[ConnectorShape, ...]:
        """Return the shapes to draw; without any, a dashed line connects its points."""
        return ()

    def on_points(self, forces: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Return forces (..., rows, 3) on its points, without those on amplitudes."""
        return forces[..., : len(self.points), :]

    def _data(self, at: At) -> tuple[float, ...]:
        return (*self.data(at.reference), *at.memory)

    def _coordinates(self, rows: np.ndarray) -> np.ndarray:
        """Return the coordinates (k, ...) of rows like `At.q`."""
        own = np.asarray(rows)[:, : self.connection.coordinates]
        return own.reshape(-1, *own.shape[2:])[: self.connection.size]

    def force(self, at: At) -> np.ndarray:
        """Return the resisting forces fx, fy, moment at each point, then the conditions (3 m + k,)."""
        size, columns = self.connection.size, self.connection.coordinates
        q, v, a = (self._coordinates(x) for x in (at.q, at.v, at.a))
        turned = np.array([(np.cos(angle), np.sin(angle)) for angle in at.q[:, 2]]).ravel()
        result = np.zeros(size + len(at.own), dtype=np.result_type(q, v, a, at.own, float))
        in_python(self.connection)(q, v, a, at.own, turned, self._data(at), at.gravity, result)
        forces = np.zeros(at.q.shape, dtype=result.dtype)
        forces.flat[np.flatnonzero(np.arange(forces.size) % 3 < columns)[:size]] = result[:size]
        return np.concatenate([forces.ravel(), result[size:]])

    def energy(self, at: At) -> tuple[float, float]:
        """Return the kinetic and the potential energy [J], of many states if they are a last axis of `at`."""
        connection, data = self.connection, self._data(at)
        q, v = (connection.split(self._coordinates(x)) for x in (at.q, at.v))
        kinetic = connection.kinetic(q, v, data, ANALYTIC) if connection.kinetic else 0.0
        potential = connection.potential(q, data, at.gravity, ANALYTIC) if connection.potential else 0.0
        return kinetic, potential + (connection.stored(q, data, ANALYTIC) if connection.stored else 0.0)


class AtPoint(PartAtPoints):
    """A part at a point of a beam."""

    __slots__ = ()

    if TYPE_CHECKING:

        @property
        def point(self) -> Point:
            """Its point."""
            ...

    def __post_init__(self) -> None:
        require_point_of(self, "point")

    @property
    def points(self) -> tuple[Point, ...]:
        """The point."""
        return (self.point,)


class BetweenPlaces(PartAtPoints):
    """A part between the points a and b of beams, which may have to be apart; b may be a place on the ground."""

    __slots__ = ()
    apart: ClassVar[bool] = False
    may_end_on_ground: ClassVar[bool] = False

    if TYPE_CHECKING:

        @property
        def a(self) -> Point:
            """Its first point."""
            ...

        @property
        def b(self) -> Point | tuple[float, float]:
            """Its second point, or the place on the ground [m]."""
            ...

    def __post_init__(self) -> None:
        require_point_of(self, "a")
        if isinstance(self.b, Point) or not self.may_end_on_ground:
            require_point_of(self, "b")
        else:
            convert(self, squared(vector), "b")
        if self.apart and self.distance == 0.0:
            raise InputError(
                f"{type(self).__name__} needs two places that are apart, but a and b are both at {self.a}; "
                "a Hinge or a Rigid joins them"
            )

    @property
    def points(self) -> tuple[Point, ...]:
        """Its points on beams."""
        return (self.a, self.b) if isinstance(self.b, Point) else (self.a,)

    @property
    def ground(self) -> tuple[float, ...]:
        """The place on the ground (2,) [m] where it ends, or nothing (0,)."""
        return () if isinstance(self.b, Point) else (float(self.b[0]), float(self.b[1]))

    @property
    def distance(self) -> float:
        """Distance of a and b in the reference [m]."""
        x, y = self.a.reference - (self.b.reference if isinstance(self.b, Point) else self.b)
        return math.hypot(x, y)


class Station(NamedTuple):
    """A quadrature point along a beam, with the shape functions of its field.

    points (m,): nodes of the element; shape (m,): r = sum shape_i r_i, and d = sum shape_i d_i with d_i = (-sin t_i,
    cos t_i) at nodes with rotations; slope (m,) [1/m]: r' = sum slope_i r_i, likewise d'; length [m]: weight.
    """

    points: tuple[Point, ...]
    shape: np.ndarray
    slope: np.ndarray
    length: float


class AxisRows(NamedTuple):
    """Where the vectors of the axis of a beam are among the rows of q: those of its points, then slopes at its nodes.

    rows (ne, k), scale (ne, k): of each element, r = sum N_i(xi) scale_i q_i with the shape functions of the field;
    points: the first node, the point of another beam, the other nodes.
    """

    field: Field
    rows: np.ndarray
    scale: np.ndarray
    points: tuple[Point, ...]


class OnElements:
    """A `Contribution` on a point and on one of the elements of a beam at a time; see `Connection.compiled`."""

    __slots__ = ()

    if TYPE_CHECKING:

        @property
        def axis(self) -> AxisRows:
            """The axis on which it acts."""
            ...

        @property
        def connection(self) -> Connection:
            """Its definition on an element; its points are row 1 of q and the vectors of the element."""
            ...

    @property
    def position_step(self) -> int:
        """Number of vectors of a node."""
        return 1 + ("r_x" in self.axis.field.vectors)

    @property
    def coordinates(self) -> list[np.ndarray]:
        """Numbers (k,) of the coordinates of each element among those of q (2 m,) and the multipliers."""
        size = 2 * (1 + int(self.axis.rows.max()))
        own = size + np.arange(self.connection.multipliers)
        rows = [np.append(1, rows) for rows in self.axis.rows]
        return [np.concatenate([(2 * each[:, None] + np.arange(2)).ravel(), own]) for each in rows]

    def data_of(self, reference: np.ndarray) -> list[np.ndarray]:
        """Return the numbers of each element; reference (m, 3): q in the reference."""
        raise NotImplementedError


class PartAlongBeam:
    """A part along a beam that acts at all of its nodes, or at the quadrature points of its elements.

    Attributes
    ----------
    beam : Beam
        The beam.
    """

    __slots__ = ()
    unknowns: ClassVar[int] = 0
    conservative: ClassVar[bool] = True
    rotations: ClassVar[bool] = False

    beam: Beam

    @property
    def points(self) -> tuple[Point, ...]:
        """The ends of the beam."""
        return self.beam.start, self.beam.end

    def at_nodes(self, points: Sequence[Point], lengths: np.ndarray) -> tuple[PartAtPoints, ...]:
        """Return the parts at the nodes of the beam, by default none; lengths (n,): tributary lengths [m]."""
        return ()

    def at_stations(self, stations: Sequence[Station]) -> tuple[PartAtPoints, ...]:
        """Return the parts at the quadrature points of the beam, by default none, each on the points of its station.

        Fields of order k have stations, the cubic one with r_x has none.
        """
        return ()

    def on_axis(self, axis: AxisRows) -> Contribution:
        """Return the part on all nodal vectors of the axis and on its second point, which is on another beam."""
        raise NotImplementedError

    def shapes(self) -> tuple[ConnectorShape, ...]:
        """Return the shapes to draw, by default none."""
        return ()

    def force(self, at: At) -> np.ndarray:
        """Return the forces at the ends: none, as those at the nodes are separate parts."""
        return np.zeros(3 * len(at.q))

    def energy(self, at: At) -> tuple[float, float]:
        """Return the kinetic and the potential energy [J]: none."""
        return 0.0, 0.0
