"""One state of a motion or a path, with results without the axis of steps."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.model.beam import Point
from beamfem.results.solution import Solution, State


@dataclass(frozen=True, eq=False)
class StateWithResults(State):
    """A state with the results of a solution, without its axis of steps."""

    static: ClassVar[bool]

    @cached_property
    def alone(self) -> Solution:
        """The state as a solution of one row."""
        return self.as_row(self.static)

    def position(self, point: Point) -> np.ndarray:
        """Return the position of a point (2,) [m]."""
        return np.asarray(self.alone.position(point)[0])

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point from the reference configuration (2,) [m]."""
        return np.asarray(self.alone.displacement(point)[0])

    def rotation(self, point: Point) -> float:
        """Return the rotation of the section at a point [rad], counter-clockwise positive, full turns included."""
        return float(self.alone.rotation(point)[0])


@dataclass(frozen=True, eq=False)
class MotionState(StateWithResults):
    """One state of a motion, passed to the function of an `Event`: results as those of a Solution in one row.

    Parameters
    ----------
    p, v, a : array, (n,)
        Coordinates and their rates, see `State`.
    at : float, [s]
        Time.
    model : Model
        The model.
    turned : array, [rad], (m,), optional
        See `State`.

    Examples
    --------
    >>> event = bf.Event("tip is below", lambda state: state.position(beam.end)[1] + 0.01)
    >>> bf.simulate(model, duration=0.02, step=0.001, events=[event]).events[0].row
    7
    """

    static: ClassVar[bool] = False

    def __repr__(self) -> str:
        return f"{type(self).__name__}(time {self.at:.6g} {self.model.unit('s')}, of {self.model!r})"

    @property
    def time(self) -> float:
        """Time [s] of the state."""
        return self.at

    def velocity(self, point: Point) -> np.ndarray:
        """Return the velocity of a point (2,) [m/s]."""
        return np.asarray(self.alone.velocity(point)[0])

    def acceleration(self, point: Point) -> np.ndarray:
        """Return the acceleration of a point (2,) [m/s^2]."""
        return np.asarray(self.alone.acceleration(point)[0])


@dataclass(frozen=True)
class Occurrence:
    """An event that has occurred in a motion.

    Parameters
    ----------
    name : str
        Name of the event.
    time : float, [s]
        When.
    row : int
        The first row of the motion at or after that time, the last one if there is none.
    """

    name: str
    time: float
    row: int
