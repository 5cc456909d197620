"""A slider on the axis of a beam."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from beamfem.element.fields import cross
from beamfem.errors import InputError
from beamfem.kernels.connection_passes import LEAST, SAME, STEPS
from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.contribution import At
from beamfem.model.load_shapes import Bar, ConnectorShape
from beamfem.parts.at_points import AxisRows, OnElements, PartAlongBeam
from beamfem.physics.compiled_connections import passes_of
from beamfem.physics.connections import Connection
from beamfem.physics.sliding import sliding


@dataclass(frozen=True, slots=True)
class SliderOnBeam(PartAlongBeam):
    """A point that slides without friction along the axis of a beam, from element to element.

    Its condition is that the distance from the axis, (r_b - r(s)) . n(s) at the closest place s, is that of the
    reference; beyond the ends of the beam, from the tangents there. Its multiplier is the force across the axis [N].
    The point turns freely. A mass rides on the beam as a `PointMass` at the point. Raises InputError for an invalid
    value.

    Parameters
    ----------
    beam : Beam
        The beam, with elements of which r, or r and r_x, are coordinates: all but `ShearRigid`.
    point : Point
        Point of another beam.

    Examples
    --------
    >>> rod = bf.Beam(bf.Line((0.5, 1), (0.5, 0)), 2, bf.CRBF(order=3), bf.Rectangle(0.02, 0.02), steel)
    >>> foot = bf.SliderOnBeam(beam, rod.end)
    >>> resting = bf.Model([beam, rod], [bf.Clamp(beam.start), bf.Clamp(rod.start)], connectors=[foot])
    """

    beam: Beam
    point: Point

    unknowns: ClassVar[int] = 1

    def __post_init__(self) -> None:
        require_beam("SliderOnBeam", self.beam)
        require_point_of(self, "point")
        if self.point.beam is self.beam:
            raise InputError("the point of a SliderOnBeam must be on another beam than that on which it slides")

    @property
    def points(self) -> tuple[Point, ...]:
        """The start of the beam and the point."""
        return self.beam.start, self.point

    def on_axis(self, axis: AxisRows) -> "OnAxis":
        """Return the part that acts on the nodes of the beam and on the point."""
        return OnAxis(axis)

    def shapes(self) -> tuple[ConnectorShape, ...]:
        """Return the shape to draw: a dot."""
        return (Bar(self.point, self.point),)


@dataclass(frozen=True, eq=False)
class OnAxis(OnElements):
    """The condition of a slider on the vectors of a beam; see `AxisRows`. Row 1 of q is the position of the point."""

    axis: AxisRows

    unknowns: ClassVar[int] = 1
    conservative: ClassVar[bool] = True
    rotations: ClassVar[bool] = False

    @property
    def points(self) -> tuple[Point, ...]:
        """The first node of the beam, the point that slides, and the other nodes."""
        return self.axis.points

    @property
    def connection(self) -> Connection:
        """A point that slides on an element."""
        return sliding(self.axis.rows.shape[1])

    def data_of(self, reference: np.ndarray) -> list[np.ndarray]:
        """Return the coefficients of the shape functions of each element, and the distance in the reference."""
        count = self.axis.rows.shape[1]
        places = 0.5 * (1.0 - np.cos(np.pi * (np.arange(count) + 0.5) / count))
        powers = np.linalg.solve(np.vander(places - 0.5, increasing=True), self.axis.field.centreline(places))
        data = [np.concatenate([[count], (powers * scale).T.ravel(), [0.0]]) for scale in self.axis.scale]
        distance = self._evaluate("force", self._closest(reference, data), reference, np.zeros(1))[-1]
        for each in data:
            each[-1] = distance
        return data

    def on_points(self, forces: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Return forces (..., rows, 3) on its points alone, those on slopes as moments."""
        count = len(self.points)
        result, slopes = forces[..., :count, :].copy(), forces[..., count:, :]
        at_nodes = np.delete(np.arange(count), 1)
        result[..., at_nodes, 2] += cross(q[count:, :2], slopes[..., :2])
        return np.asarray(result)

    def force(self, at: At) -> np.ndarray:
        """Return the forces on all rows, and the distance less that in the reference."""
        q, own = np.real(at.q), np.real(at.own)
        place = self._closest(q, self.data_of(at.reference))
        forces, result = self._evaluate("force", place, q, own), np.zeros((len(q), 3))
        result[np.append(1, self.axis.rows[place.element]), :2] = forces[:-1].reshape(-1, 2)
        return np.append(result, forces[-1])

    def energy(self, at: At) -> tuple[float, float]:
        """Return no energies."""
        return 0.0, 0.0

    def exact_tangent(self, at: At) -> np.ndarray:
        """Return the derivative (2 m + 1, 2 m + 1) of forces and condition by q and the multiplier."""
        place = self._closest(at.q, self.data_of(at.reference))
        result, own = np.zeros((2 * len(at.q) + 1,) * 2), self.coordinates[place.element]
        result[np.ix_(own, own)] = self._evaluate("tangent", place, at.q, at.own, 1.0, 0.0, 0.0)
        return result

    def _evaluate(self, what: str, place: "_Place", q: np.ndarray, own: np.ndarray, *weights: float) -> np.ndarray:
        """Return the force (k + 1,) or the tangent (k + 1, k + 1) on the point and the vectors of an element."""
        vectors = self._vectors(place.element, q)
        still, size, xi = np.zeros(len(vectors)), len(vectors) + 1, np.array([place.xi])
        result = np.empty(size if what == "force" else (size, size))
        passes = getattr(passes_of(self.connection), what)
        passes(vectors, still, still, np.array(own), xi, place.data, np.zeros(2), *weights, result)
        return result

    def _vectors(self, element: int, q: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray(q[np.append(1, self.axis.rows[element]), :2]).ravel()

    def _closest(self, q: np.ndarray, data: Sequence[np.ndarray]) -> "_Place":
        """Return the closest place on the axis, on the elements at the nearest node."""
        nodes = self.axis.rows[:, :: self.position_step]
        apart = ((q[nodes, :2] - q[1, :2]) ** 2).sum(axis=2).min(axis=1)
        near = np.flatnonzero(apart <= apart.min()).tolist()
        return min((self._on_element(element, q, data[element]) for element in near), key=lambda place: place.gap)

    def _on_element(self, element: int, q: np.ndarray, data: np.ndarray) -> "_Place":
        low, high = -np.inf if element == 0 else 0.0, np.inf if element == len(self.axis.rows) - 1 else 1.0
        vectors, out, root, xi = self._vectors(element, q), np.empty(4), passes_of(self.connection).root, 0.5
        assert root is not None
        for _ in range(STEPS):
            root(vectors, data, xi, out)
            last, xi = xi, min(max(xi + out[0] / (out[1] if out[1] > LEAST * out[3] else out[3]), low), high)
            if abs(xi - last) <= SAME:
                break
        return _Place(element, data, xi, float(out[2]))


class _Place(NamedTuple):
    """A place xi on an element, its data, and the square of the distance from the point."""

    element: int
    data: np.ndarray
    xi: float
    gap: float
