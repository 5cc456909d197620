"""Extremes of quantities that are known at stations of elements, and exactly at any point between them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np

from beamfem.model.beam import Beam
from beamfem.units import Units

Force = Literal["normal", "shear", "moment"]
Part = Literal["lower", "upper", "tension", "compression", "shear", "von_mises", "utilisation"]


@dataclass(frozen=True)
class Peak:
    """The extreme of a section force or a stress, which unpacks into its value, arc length [m] and row.

    part: which stress [Pa], utilisation [-] or section force [N], [N m] it is, whose SI unit is `unit`; at: load factor
    of the row, or time [s] unless `static`; units: those of the model, and `called`: the beam in words, for the text.

    Examples
    --------
    >>> value, arc_length, row = solution.stresses(beam).peak("tension")
    """

    value: float
    arc_length: float
    row: int
    at: float
    beam: Beam
    part: Part | Force = "von_mises"
    static: bool = True
    units: Units = field(default=Units(), repr=False)
    unit: str = field(default="Pa", repr=False)
    called: str = field(default="", repr=False)

    def __iter__(self) -> Iterator[float]:
        return iter((self.value, self.arc_length, self.row))

    def __repr__(self) -> str:
        return f"Peak({self.part} {self.in_words if np.isfinite(self.value) else 'is not known'}, of {self.called})"

    @property
    def in_words(self) -> str:
        """Value and place with their units."""
        factor, name = self.units.readable(self.value, self.unit)
        unit = "" if name == "-" else f" {name}"
        when = f"load factor {self.at:.4g}" if self.static else f"t = {self.at:.4g} {self.units.of('s')}"
        return (
            f"{factor * self.value:.4g}{unit} at {self.arc_length:.4g} {self.units.of('m')} in row {self.row}, {when}"
        )


At = Callable[[int, np.ndarray, np.ndarray], np.ndarray]  # row, element and xi (points,): values (points,)
Measure = Callable[[Any], Any]  # what is largest at the extreme, such as the magnitude

_SAME = 1e-8  # fraction of the extreme: smaller differences are not searched
_MOST = 24  # searches, each of which evaluates one element in one row a few times
_POINTS, _PASSES = 33, 4  # of a search; a pass narrows the interval to a 16th


class Extreme(NamedTuple):
    """A value and where it is: row, element and xi; nan and row -1 if none is known."""

    value: float
    row: int
    element: int
    xi: float


_Found = TypeVar("_Found", Extreme, Peak)


def at_stations(values: np.ndarray, xi: np.ndarray, measure: Measure) -> Extreme:
    """Return the extreme of values (rows, elements, stations) at stations xi (stations,) of each element."""
    if not np.isfinite(values).any():
        return Extreme(np.nan, -1, -1, np.nan)
    row, element, station = np.unravel_index(int(np.nanargmax(measure(values))), values.shape)
    return Extreme(float(values[row, element, station]), int(row), int(element), float(xi[station]))


def estimate(values: np.ndarray, xi: np.ndarray, measure: Measure) -> float:
    """Return about how large the measure becomes at and between stations, see `extreme`; nan if no value is known."""
    measured = measure(values)
    known = at_stations(measured, xi, np.asarray)
    return known.value if known.row < 0 else max(known.value, float(_vertices(measured, xi).max(initial=-np.inf)))


def extreme(values: np.ndarray, xi: np.ndarray, measure: Measure, at: At) -> Extreme:
    """Return the value of largest measure at and between the stations of all elements and rows.

    values (rows, elements, stations): at stations xi (stations,) of each element, nan where unknown; at: values at
    points of elements in a row. With `at`, the largest value is searched beside the extreme of the stations, and
    between three stations wherever a parabola through them has a vertex above what has been found so far, the highest
    first.
    """
    found, vertices = at_stations(values, xi, measure), _vertices(measure(values), xi)
    if found.row < 0:
        return found
    size, station = float(measure(found.value)), int(np.searchsorted(xi, found.xi))
    around = xi[max(station - 1, 0)], xi[min(station + 1, len(xi) - 1)]
    beside = _searched(at, measure, found.row, found.element, (float(around[0]), float(around[1])))
    if _exceeds(reached := float(measure(beside.value)), size):
        found, size = beside, reached
    for _ in range(_MOST if vertices.size else 0):
        row, element, first = (int(i) for i in np.unravel_index(int(vertices.argmax()), vertices.shape))
        if not _exceeds(float(vertices[row, element, first]), size):
            break
        vertices[row, element, first] = -np.inf
        other = _searched(at, measure, row, element, (float(xi[first]), float(xi[first + 2])))
        if (reached := float(measure(other.value))) > size:
            found, size = other, reached
    return found


def extreme_of_beams(estimates: np.ndarray, measure: Measure, of_beam: Callable[[int], _Found]) -> tuple[int, _Found]:
    """Return the number of the beam whose extreme has the largest measure of all, and that extreme.

    estimates (beams,): see `estimate`; of_beam: the extreme of a beam, asked for as long as an estimate is larger.
    """
    order = np.argsort(-estimates, kind="stable").tolist()  # nan is last
    number, found = order[0], of_beam(order[0])
    for other in order[1:]:
        if not _exceeds(float(estimates[other]), float(measure(found.value))):
            break
        if measure((candidate := of_beam(other)).value) > measure(found.value):
            number, found = other, candidate
    return number, found


def _exceeds(estimated: float, size: float) -> bool:
    """Return whether an estimate is above what has been found by more than what is not searched."""
    return estimated > size + _SAME * abs(size)


def _vertices(measured: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Return the largest values (rows, elements, stations - 2) of parabolas through three stations.

    -inf for those without a largest value between the three.
    """
    first, middle, last = measured[..., :-2], measured[..., 1:-1], measured[..., 2:]
    width, whole = np.diff(xi)[:-1], xi[2:] - xi[:-2]
    slope = (middle - first) / width
    bend = ((last - middle) / np.diff(xi)[1:] - slope) / whole
    with np.errstate(divide="ignore", invalid="ignore"):
        along = 0.5 * (width - slope / bend)
        value = first + slope * along + bend * along * (along - width)
    return np.where((bend < 0.0) & (along > 0.0) & (along < whole), value, -np.inf)


def _searched(at: At, measure: Measure, row: int, element: int, between: tuple[float, float]) -> Extreme:
    low, high = between
    for _ in range(_PASSES):
        xi = np.linspace(low, high, _POINTS)
        values = at(row, np.full(_POINTS, element), xi)
        best = int(np.nanargmax(measure(values)))
        low, high = xi[max(best - 1, 0)], xi[min(best + 1, _POINTS - 1)]
    return Extreme(float(values[best]), row, element, float(xi[best]))
