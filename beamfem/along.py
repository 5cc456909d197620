"""Fields along the axes of beams at points fit for drawing and export: between the stations of section forces too."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamfem import postprocess
from beamfem.element.coordinates import Gradients
from beamfem.errors import InputError
from beamfem.model.distributions import Distributions, distributions, layers
from beamfem.model.mesh import BeamMesh
from beamfem.model.reference import reference_axis, stations


@dataclass(frozen=True, eq=False)
class AxisPoints:
    """Points of a beam's axis: `pieces` equal intervals an element, so that neighbours both have their common end.

    element, xi (points,).
    """

    mesh: BeamMesh
    pieces: int

    @cached_property
    def element(self) -> np.ndarray:
        return np.repeat(np.arange(self.mesh.elements), self.pieces + 1)

    @cached_property
    def xi(self) -> np.ndarray:
        return np.tile(np.arange(self.pieces + 1) / self.pieces, self.mesh.elements)

    @cached_property
    def arc_length(self) -> np.ndarray:
        """Arc length in the reference (points,) [m]."""
        return self.mesh.arc_length(self.element, self.xi)

    @cached_property
    def distributions(self) -> Distributions:
        """The layers of the section at each point, and how they distribute forces over their height."""
        return distributions(self.mesh, self.element, self.xi)

    @cached_property
    def layers(self) -> np.ndarray:
        """Lower and upper y of each layer of the body (points, layers, 2) [m], from the bottom up."""
        return layers(self.mesh, self.element, self.xi)

    @cached_property
    def faces(self) -> np.ndarray:
        """Lower and upper y of the body (points, 2) [m]."""
        return self.layers[:, [0, -1], [0, 1]]

    @cached_property
    def reference(self) -> np.ndarray:
        """Position in the reference (points, 2) [m]."""
        return self.mesh.position[self.mesh.node[self.element, 0]] + self._reference_axis.r

    @cached_property
    def _reference_axis(self) -> postprocess.Axis:
        return reference_axis(self.mesh, self.element, self.xi)

    def positions(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return r and d (steps, points, 2) of the states p (steps, n)."""
        now = postprocess.axis(self.mesh, postprocess.nodal_vectors(self.mesh, p), self.element, self.xi)
        return now.r, now.d

    def velocities(self, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the velocity of the axis (steps, points, 2) [m/s]."""
        rates = postprocess.nodal_velocities(self.mesh, p, v)
        return postprocess.axis(self.mesh, rates, self.element, self.xi).r


def section_forces(points: AxisPoints, p: np.ndarray) -> dict[str, np.ndarray]:
    """Return normal and shear force [N] and moment [N m] (steps, points) of the states p (steps, n).

    In each element the polynomial that comes nearest to the values at its Gauss points in the mean square, of one
    degree less than the field: these values are what an element knows, and full integration adds waves to them.
    """
    mesh = points.mesh
    found = postprocess.section_forces(mesh, p)
    xi, weight = mesh.beam.element.quadrature()
    gauss = mesh.arc_length(*stations(mesh))
    at = np.abs(found.arc_length[:, None] - gauss).argmin(axis=0)
    degree = min(len(xi), mesh.beam.element.field.degree) - 1
    legendre = np.polynomial.legendre.legvander
    norm = 2 * np.arange(degree + 1) + 1
    project = (legendre(2.0 * xi - 1.0, degree) * weight[:, None] * norm).T
    own = np.arange(points.pieces + 1) / points.pieces
    table = legendre(2.0 * own - 1.0, degree) @ project
    shape = (len(p), mesh.elements, len(xi))
    return {
        name: np.einsum("iq,seq->sei", table, getattr(found, name)[:, at].reshape(shape)).reshape(len(p), -1)
        for name in ("normal", "shear", "moment")
    }


def rotation(points: AxisPoints, p: np.ndarray) -> np.ndarray:
    """Return the rotation of the section from the reference (steps, points) [rad]; steps must follow each other."""
    now = postprocess.axis(points.mesh, postprocess.nodal_vectors(points.mesh, p), points.element, points.xi)
    return postprocess.turning(points.mesh, p, now, points.element, points.xi)


@dataclass(frozen=True)
class Quantity:
    """A field along the axis: its name for people, its unit, and values(points, p, v, rows) -> (rows, points)."""

    label: str
    unit: str
    values: Callable[[AxisPoints, np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def _section_force(name: str) -> Callable[..., np.ndarray]:
    def values(points: AxisPoints, p: np.ndarray, v: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return section_forces(points, p[rows])[name]

    return values


def _field(pick: Callable[[postprocess.Fields], np.ndarray]) -> Callable[..., np.ndarray]:
    def values(points: AxisPoints, p: np.ndarray, v: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return pick(postprocess.fields(points.mesh, p[rows], points.element, points.xi))

    return values


def _rotation(points: AxisPoints, p: np.ndarray, v: np.ndarray, rows: np.ndarray) -> np.ndarray:
    # gradients count full turns from row to row and must see them all
    if isinstance(points.mesh.beam.element.coordinates, Gradients):
        return rotation(points, p)[rows]
    return rotation(points, p[rows])


def _displacement(points: AxisPoints, p: np.ndarray, v: np.ndarray, rows: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(points.positions(p[rows])[0] - points.reference, axis=-1))


def _speed(points: AxisPoints, p: np.ndarray, v: np.ndarray, rows: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(points.velocities(p[rows], v[rows]), axis=-1))


QUANTITIES = {
    "moment": Quantity("bending moment", "N m", _section_force("moment")),
    "normal": Quantity("normal force", "N", _section_force("normal")),
    "shear": Quantity("shear force", "N", _section_force("shear")),
    "rotation": Quantity("rotation", "rad", _rotation),
    "displacement": Quantity("displacement", "m", _displacement),
    "speed": Quantity("speed", "m/s", _speed),
    "axial_strain": Quantity("axial strain", "-", _field(lambda fields: fields.green_strain.xx)),
    "shear_angle": Quantity("shear angle", "rad", _field(lambda fields: fields.shear_angle)),
}


def quantity(name: str) -> Quantity:
    """Return a quantity by its name. Raises InputError."""
    if name not in QUANTITIES:
        raise InputError(f"there is no quantity {name!r} along a beam; those that are: {', '.join(QUANTITIES)}")
    return QUANTITIES[name]
