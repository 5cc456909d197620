"""Forces on points that depend on time and on the state of motion."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.contribution import At
from beamfem.model.load_shapes import Bar
from beamfem.model.time_functions import kinks_of
from beamfem.validation import called, takes


@dataclass(frozen=True)
class StateForce:
    """A force on points as a function of time, positions and velocities, such as that of a controller or a thruster.

    Derivatives of the function are central differences, so that it may be any function of real numbers. Raises
    InputError for a function of other arguments.

    Parameters
    ----------
    points : Point or tuple of Point
        The point, or m points of beams.
    function : callable, [N, N, N m]
        Function of time [s], in statics of the load factor, of x, y and the rotation from the reference, (3,) of one
        point or (m, 3) of several, [m, m, rad], and of their rates. It returns fx, fy and moment on each point.

    Examples
    --------
    >>> thruster = bf.StateForce(beam.end, lambda time, q, v: (-20.0 * np.sin(q[2]), 20.0 * np.cos(q[2]), 0.0))
    >>> skyhook = bf.StateForce(beam.end, lambda time, q, v: (0.0, -50.0 * v[1], 0.0))
    >>> held = bf.Model([beam], [bf.Clamp(beam.start)], connectors=[thruster, skyhook])
    """

    unknowns: ClassVar[int] = 0
    conservative: ClassVar[bool] = False

    points: tuple[Point, ...]
    function: Callable[[float, np.ndarray, np.ndarray], Any]

    def __post_init__(self) -> None:
        if isinstance(self.points, Point):
            object.__setattr__(self, "points", (self.points,))
        if not callable(self.function) or not takes(self.function, 3):
            raise InputError(
                "the function of a StateForce takes time, q and v: lambda time, q, v: (0.0, -50.0 * v[1], 0.0)"
            )

    @property
    def kinks(self) -> tuple[float, ...]:
        """The times [s] that the function declares, at which it may jump."""
        return kinks_of(self.function)

    def force(self, at: At) -> np.ndarray:
        """Return the forces and moments that resist."""
        shape = at.q.shape if len(at.q) > 1 else (3,)

        def acting(state: np.ndarray) -> np.ndarray:
            q, v = state.reshape(2, *shape)
            forces = np.asarray(called("function of StateForce", self.function, at.time, q, v), dtype=float)
            if forces.shape != shape:
                raise InputError(f"function of StateForce must return fx, fy and moment {shape}, got {forces.shape}")
            return forces

        size = max(point.beam.curve.length for point in self.points)
        return -differentiated(acting, np.stack([at.q, at.v]), np.tile([size, size, 1.0], 2 * len(at.q))).ravel()

    def energy(self, at: At) -> tuple[float, float]:
        """Return no energies."""
        return 0.0, 0.0

    def shapes(self) -> tuple[Bar, ...]:
        """Return the shapes to draw: dots."""
        return tuple(Bar(point, point) for point in self.points)


_WIDTH = 1e-6  # of the differences


def differentiated(function: Callable[[np.ndarray], Any], at: np.ndarray, units: np.ndarray) -> Any:
    """Return a function of real numbers (n,) at complex ones, with derivatives by differences in natural units (n,)."""
    real, moved = at.real.ravel(), at.imag.ravel()
    result = function(real)
    for number in np.flatnonzero(moved):
        step = np.zeros(len(real))
        step[number] = _WIDTH * max(units[number], abs(real[number]))
        result = result + 1j * moved[number] * (function(real + step) - function(real - step)) / (2.0 * step[number])
    return result
