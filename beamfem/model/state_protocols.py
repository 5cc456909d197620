"""Data of a state that loads and supports need: directions of the axis, and displacements from the reference."""

from typing import Literal, Protocol

import numpy as np

from beamfem.element.coordinates import across
from beamfem.model.beam import Beam, Point

Axes = Literal["plane", "section", "axis"]


class Stations(Protocol):
    """Points (n,) of a beam in states of a model."""

    @property
    def rotation(self) -> np.ndarray:
        """Rotations of the sections from the reference (steps, n) [rad]."""

    @property
    def slope(self) -> np.ndarray:
        """Derivatives r0' (steps, n, 2) [-]."""


class Placed(Protocol):
    """A state of a model, with the members that shapes need."""

    @property
    def time(self) -> float:
        """Time [s] or load factor of the loads."""
        ...

    def at(self, point: Point) -> Stations:
        """Return the state at a point."""

    def along(self, beam: Beam, arc_length: np.ndarray) -> Stations:
        """Return the state at arc lengths (n,) [m] of a beam."""

    def stations(self, beam: Beam) -> np.ndarray:
        """Return the arc lengths (n,) [m] at which loads along a beam are integrated."""


def in_plane(vectors: np.ndarray, axes: Axes, at: Stations) -> np.ndarray:
    """Return vectors (steps, n, 2) along the axes of a load in x and y.

    axes: "plane": x and y; "section": rotated with the section from the reference; "axis": along r0' and normal to it.
    """
    if axes == "section":
        angle = at.rotation[..., None]
        return np.asarray(np.cos(angle) * vectors + np.sin(angle) * across(vectors))
    if axes == "axis":
        slope = at.slope
        return np.asarray(vectors[..., :1] * slope + vectors[..., 1:] * across(slope))
    return vectors
