"""A part of a loading path about a critical point, interpolated from points on both sides of it."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from beamfem.cached_properties import cached_property
from beamfem.linalg.lapack import eigh, svd
from beamfem.solve.continuation.continuation import PathPoint
from beamfem.solve.modes.pencil import Pencil
from beamfem.solve.stability.loading_path import LoadingPath, Softest

_NODES = np.array([-1.0, -0.75, -0.45, 0.45, 0.75, 1.0])  # in units of the radius
_REFERENCE = 2  # the node to whose modes those of the others are rotated
_SPARE = 2  # modes found beyond those that are unstable
_APART = 0.5  # of the change of stiffness in a window: closer modes are taken as one subspace
_ALIKE = 0.7  # smallest cosine between the subspaces of soft modes at two nodes


@dataclass(frozen=True)
class Zero:
    """A distance at which the stiffness of a mode of a window vanishes, and the number of that mode by stiffness."""

    at: float
    number: int


@dataclass(frozen=True, eq=False)
class Window:
    """Points of a path at distances `at` along a direction.

    softest: modes of each point; slopes: of the load factor (points,); mass (unknown, unknown) at one point; free: the
    unknown coordinates.
    """

    centre: float
    radius: float
    at: np.ndarray
    points: list[PathPoint]
    softest: list[Softest]
    slopes: np.ndarray
    mass: csr_array
    free: np.ndarray

    @classmethod
    def about(
        cls, path: LoadingPath, normal: np.ndarray, ends: tuple[PathPoint, PathPoint], centre: float, radius: float
    ) -> "Window":
        """Return the window about a distance from the first of two ends along a normal (n + 1,).

        Raises PathLostError, ConvergenceError.
        """
        at = centre + radius * _NODES
        points = [on_path(path, normal, ends, x) for x in at]
        count = max(point.negative_pivots for point in points) + _SPARE
        softest = [path.softest(point, count) for point in points]
        slopes = np.array([point.tangent[-1] / path.line.dot(normal, point.tangent) for point in points])
        mass = Pencil(path.system, points[_REFERENCE].y[:-1], points[_REFERENCE].load_factor).mass
        return cls(centre, radius, at, points, softest, slopes, mass, path.system.free_dofs)

    @cached_property
    def rows(self) -> np.ndarray:
        """Coordinates and load factor (points, n + 1)."""
        return np.array([point.y for point in self.points])

    def weights(self, x: float) -> np.ndarray:
        """Return the weights (points,) of the polynomial through all points, at a distance x."""
        differences = self.at[:, None] - self.at
        np.fill_diagonal(differences, 1.0)
        parts = np.tile(x - self.at, (len(self.at), 1)) / differences
        np.fill_diagonal(parts, 1.0)
        return np.asarray(parts.prod(axis=1))

    @cached_property
    def _soft(self) -> slice:
        """The modes whose stiffness changes its sign, and those that come close to them in stiffness."""
        count = min(len(soft.values) for soft in self.softest)
        values = np.array([soft.values[:count] for soft in self.softest])
        low, high = values.min(axis=0), values.max(axis=0)
        changing = np.flatnonzero((low < 0.0) & (high >= 0.0))
        if not len(changing):
            return slice(0, 0)
        first, last = int(changing[0]), int(changing[-1]) + 1
        gap = _APART * float((high - low)[changing].max())
        while last < count and low[last] < high[last - 1] + gap:
            last += 1
        while first > 0 and high[first - 1] > low[first] - gap:
            first -= 1
        return slice(first, last)

    @cached_property
    def _turned(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Soft modes of each point (points, unknown, m), rotated to those of one of them, their stiffness
        (points, m, m) and the smallest cosine between their subspaces.
        """
        reference = self.mass @ self.softest[_REFERENCE].vectors[:, self._soft]
        vectors, stiffness, least = [], [], 1.0
        for soft in self.softest:
            modes = soft.vectors[:, self._soft]
            left, cosines, right = svd(modes.T @ reference)
            turn = left @ right
            vectors.append(modes @ turn)
            stiffness.append(turn.T @ (soft.values[self._soft, None] * turn))
            least = min(least, float(cosines.min()))
        return np.array(vectors), np.array(stiffness), least

    @property
    def alike(self) -> bool:
        """Whether the soft modes of all points span nearly the same subspace."""
        return self._soft.stop == 0 or self._turned[2] > _ALIKE

    def zeros(self, reach: float) -> list[Zero]:
        """Return the zeros of the stiffness of soft modes, at most `reach` from the centre."""
        from scipy.optimize import brentq  # slow to import

        if self._soft.stop == 0:
            return []

        def stiffness(x: float, number: int) -> float:
            return float(self._modes(x)[0][number])

        ends = self.centre - reach, self.centre + reach
        values = [self._modes(x)[0] for x in ends]
        changing = np.flatnonzero(values[0] * values[1] < 0.0)
        zeros = [Zero(brentq(stiffness, *ends, args=(int(i),), xtol=1e-15, rtol=1e-14), int(i)) for i in changing]
        return sorted(zeros, key=lambda zero: zero.at)

    def mode(self, zero: Zero) -> np.ndarray:
        """Return the mode (n,) whose stiffness vanishes at a zero."""
        turned = np.tensordot(self.weights(zero.at), self._turned[0], axes=1)
        result = np.zeros(self.rows.shape[1] - 1)
        result[self.free] = turned @ self._modes(zero.at)[1][:, zero.number]
        return result

    def _modes(self, x: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness (m,), ascending, and combinations (m, m) of the soft modes at a distance."""
        return eigh(np.tensordot(self.weights(x), self._turned[1], axes=1))

    def turn(self) -> float | None:
        """Return the distance at which the load has an extremum between the inner points, None if it has none."""
        from scipy.optimize import brentq  # slow to import

        inner = self.at[_REFERENCE], self.at[_REFERENCE + 1]
        if self.slopes[_REFERENCE] * self.slopes[_REFERENCE + 1] >= 0.0:
            return None
        return float(brentq(lambda x: self.weights(x) @ self.slopes, *inner, xtol=1e-15, rtol=1e-14))

    def aside(self, mode: np.ndarray) -> np.ndarray:
        """Return the component of each point (points,) along a mode (n,)."""
        return np.asarray(self.rows[:, self.free] @ (self.mass @ mode[self.free]))


def on_path(path: LoadingPath, normal: np.ndarray, ends: tuple[PathPoint, PathPoint], x: float) -> PathPoint:
    """Return the point of a path at a distance along a normal from the first of two others. Raises PathLostError."""
    before, after = (end.y for end in ends)
    nearest = before if 2.0 * x < path.line.dot(normal, after - before) else after
    return path.corrected(smooth(path, normal, ends, x), nearest, normal, after - before)


def smooth(path: LoadingPath, normal: np.ndarray, ends: tuple[PathPoint, PathPoint], x: float) -> np.ndarray:
    """Return coordinates and load factor (n + 1,) on the cubic through two points, continued by its tangents."""
    before, after = (end.y for end in ends)
    slopes = [end.tangent / path.line.dot(normal, end.tangent) for end in ends]
    reach = path.line.dot(normal, after - before)
    if x <= 0.0:
        return np.asarray(before + x * slopes[0])
    if x >= reach:
        return np.asarray(after + (x - reach) * slopes[1])
    t = x / reach
    interpolated = (1.0 - t) ** 2 * (1.0 + 2.0 * t) * before + t**2 * (3.0 - 2.0 * t) * after
    return np.asarray(interpolated + reach * t * (1.0 - t) * ((1.0 - t) * slopes[0] - t * slopes[1]))
