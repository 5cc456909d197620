"""Points along the axis of a beam, in the reference and in states."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.fields import Axis
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import reference_position
from beamfem.mesh.section_stress import Distributions, distributions, layers
from beamfem.results.nodal import axis_at, rate_at


@dataclass(frozen=True, eq=False)
class AxisPoints:
    """Points of a beam's axis, given by element and xi (points,).

    pieces: number of equal intervals of every element between them; 0 for points at other places.
    """

    mesh: BeamMesh
    element: np.ndarray
    xi: np.ndarray
    pieces: int = 0

    @classmethod
    def on_each(cls, mesh: BeamMesh, xi: np.ndarray, pieces: int = 0) -> "AxisPoints":
        """Return points at the same xi (k,) of every element."""
        return cls(mesh, np.repeat(np.arange(mesh.elements), len(xi)), np.tile(xi, mesh.elements), pieces)

    @classmethod
    def spaced(cls, mesh: BeamMesh, pieces: int) -> "AxisPoints":
        """Return the ends of equal intervals of every element; adjacent elements both include their common end."""
        return cls.on_each(mesh, np.arange(pieces + 1) / pieces, pieces)

    @classmethod
    def at(cls, mesh: BeamMesh, fractions: Sequence[float]) -> "AxisPoints":
        """Return the points at fractions of the length of a beam."""
        element, xi = map(np.array, zip(*map(mesh.locate, fractions), strict=True))
        return cls(mesh, element, xi)

    def by_element(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values (rows, points) on each element as (rows, elements, k), and xi (k,), see `on_each`."""
        each = len(self.xi) // self.mesh.elements
        return values.reshape(len(values), self.mesh.elements, each), self.xi[:each]

    @cached_property
    def arc_length(self) -> np.ndarray:
        """Arc length in the reference configuration (points,) [m]."""
        return self.mesh.arc_length(self.element, self.xi)

    @cached_property
    def distributions(self) -> Distributions:
        """The layers of the section at each point, and the distribution of section forces over their height."""
        return distributions(self.mesh, self.element, self.xi)

    @cached_property
    def layers(self) -> np.ndarray:
        """Lower and upper y of each layer of the section (points, layers, 2) [m], from the bottom up."""
        return layers(self.mesh, self.element, self.xi)

    @cached_property
    def faces(self) -> np.ndarray:
        """Lower and upper y of the section (points, 2) [m]."""
        return self.layers[:, [0, -1], [0, 1]]

    @cached_property
    def reference(self) -> np.ndarray:
        """Position in the reference configuration (points, 2) [m]."""
        return reference_position(self.mesh, self.element, self.xi)

    def positions(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return r [m] and d [-] (steps, points, 2) in the states p (steps, n)."""
        now = self.now(p)
        return now.r, now.d

    def now(self, p: np.ndarray) -> Axis:
        """Return the deformed axis at the points in the states p (steps, n)."""
        return axis_at(self.mesh, p, self.element, self.xi)

    def velocities(self, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the velocity of the axis (steps, points, 2) [m/s]."""
        return rate_at(self.mesh, p, v, self.element, self.xi).r
