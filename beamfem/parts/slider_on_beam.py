"""A slider on the axis of a beam."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.fields import cross
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point, require_beam, require_point_of
from beamfem.model.contribution import At
from beamfem.model.load_shapes import Bar, ConnectorShape
from beamfem.parts.at_points import AxisRows, PartAlongBeam

_STEPS = 30  # of Newton's method for the closest place, at most


@dataclass(frozen=True, slots=True)
class SliderOnBeam(PartAlongBeam):
    """A point that slides without friction along the axis of a beam, from element to element.

    Its condition is that the distance from the axis, (r_b - r(s)) . n(s) at the closest place s, is that of the
    reference; beyond the ends of the beam, from the tangents there. Its multiplier is the force across the axis [N].
    The point turns freely. A mass rides on the beam as a `PointMass` at the point.

    Parameters
    ----------
    beam : Beam
        The beam, with elements of which r, or r and r_x, are coordinates: all but `ShearRigid`.
    point : Point
        Point of another beam.

    Raises
    ------
    InputError
        For an invalid value.

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
        """Return what acts on the nodes of the beam and on the point."""
        return OnAxis(axis)

    def shapes(self) -> tuple[ConnectorShape, ...]:
        """Return the shape to draw: a dot."""
        return (Bar(self.point, self.point),)


@dataclass(frozen=True, eq=False)
class OnAxis:
    """The condition of a slider on the vectors of a beam; see `AxisRows`. Row 1 of q is the position of the point."""

    axis: AxisRows

    unknowns: ClassVar[int] = 1
    conservative: ClassVar[bool] = True
    rotations: ClassVar[bool] = False

    @property
    def points(self) -> tuple[Point, ...]:
        """The first node of the beam, the point that slides, and the other nodes."""
        return self.axis.points

    def on_points(self, forces: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Return forces (..., rows, 3) on its points alone, those on slopes as moments."""
        count = len(self.points)
        result, slopes = forces[..., :count, :].copy(), forces[..., count:, :]
        at_nodes = np.delete(np.arange(count), 1)
        result[..., at_nodes, 2] += cross(q[count:, :2], slopes[..., :2])
        return np.asarray(result)

    def force(self, at: At) -> np.ndarray:
        """Return the forces on all rows, and the distance less that in the reference."""
        place, start = self._closest(np.real(at.q)), self._closest(at.reference)
        result = np.zeros((len(at.q), 3))
        result[place.rows, :2] = np.real(at.own[0]) * np.outer(place.shape, place.normal)
        return np.append(result, place.distance - start.distance)

    def energy(self, at: At) -> tuple[float, float]:
        """Return no energies."""
        return 0.0, 0.0

    def exact_tangent(self, at: At) -> np.ndarray:
        """Return the derivative (2 m + 1, 2 m + 1) of forces and condition by q and the multiplier.

        With r_b - r = sum w_i x_i at the place s, where (r_b - r) . r' = 0, the gradient of the distance is w_i n, and
        dn = - t (n . dr') / |r'|.
        """
        place, size = self._closest(at.q), len(at.q)
        normal, length = place.normal, float(np.hypot(*place.tangent))
        moved, turned = (np.kron(table, np.eye(2)) for table in (place.shape, place.slope))
        rate = place.tangent @ moved + place.distance * (normal @ turned)
        rate /= length**2 - place.distance * (normal @ place.bend)
        across = (normal @ turned + (normal @ place.bend) * rate) / length
        stiffness = np.outer(normal @ turned, rate) + np.outer(place.tangent @ moved, across) / length
        numbers = (2 * place.rows[:, None] + np.arange(2)).ravel()
        result = np.zeros((2 * size + 1, 2 * size + 1))
        result[np.ix_(numbers, numbers)] = -at.own[0] * stiffness
        result[numbers, -1] = result[-1, numbers] = normal @ moved
        return result

    def _closest(self, q: np.ndarray) -> "_Place":
        """Return the closest place on the axis, among the elements of the nearest node."""
        apart = ((q[: len(self.points), :2] - q[1, :2]) ** 2).sum(axis=1)
        apart[1] = np.inf
        found = np.flatnonzero((self.axis.rows == np.argmin(apart)).any(axis=1)).tolist()
        return min((self._on_element(element, q) for element in found), key=lambda place: place.gap)

    def _on_element(self, element: int, q: np.ndarray) -> "_Place":
        axis, field, point = self.axis, self.axis.field, q[1, :2]
        rows, scale = axis.rows[element], axis.scale[element]
        vectors = q[rows, :2] * scale[:, None]
        low, high = -np.inf if element == 0 else 0.0, np.inf if element == len(axis.rows) - 1 else 1.0
        xi = 0.5
        for _ in range(_STEPS):
            inside = np.array([min(max(xi, 0.0), 1.0)])
            beyond = xi - inside[0]
            slope, bend = (field.centreline(inside, order)[0] for order in (1, 2))
            shape, bend = field.centreline(inside)[0] + beyond * slope, bend * (beyond == 0.0)
            apart, tangent, second = point - shape @ vectors, slope @ vectors, bend @ vectors
            size = tangent @ tangent
            change = (apart @ tangent) / (curved if (curved := size - apart @ second) > 0.1 * size else size)
            new = min(max(xi + change, low), high)
            if abs(new - xi) <= 1e-14:
                break
            xi = new
        normal = np.array([-tangent[1], tangent[0]]) / np.sqrt(size)
        every = np.concatenate([[1.0], -shape * scale]), np.concatenate([[0.0], slope * scale])
        gap = float(apart @ apart)
        return _Place(np.append(1, rows), *every, tangent, second, normal, float(apart @ normal), gap)


@dataclass(frozen=True, eq=False)
class _Place:
    """A place on the axis: rows (k,) of q of the point and of vectors, with r_b - r = sum shape_i q_i, and so on."""

    rows: np.ndarray
    shape: np.ndarray
    slope: np.ndarray
    tangent: np.ndarray
    bend: np.ndarray
    normal: np.ndarray
    distance: float
    gap: float
