"""What ParaView files hold: points of bodies and centrelines by cells, and the fields there."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from beamfem import postprocess
from beamfem.along import AxisPoints, section_forces
from beamfem.element.coordinates import Gradients
from beamfem.model.mesh import BeamMesh
from beamfem.model.model import Model
from beamfem.model.reference import reference_axis

if TYPE_CHECKING:
    from beamfem.solution import Solution

_LINES_PER_ELEMENT = 12


class Samples:
    """Points (xi, y) of every element of a beam, in the order that VTK wants them in a cell.

    degree: intervals along an element; whole: lower and upper face, or the axis; order: places in the
    table (degree + 1, heights), flattened.
    """

    def __init__(self, mesh: BeamMesh, degree: int, whole: bool, order: np.ndarray) -> None:
        self.mesh, self.degree, self.order, self.whole = mesh, degree, order, whole
        self.points = AxisPoints(mesh, degree)
        self.y = self.points.faces if whole else np.zeros((len(self.points.xi), 1))
        self.axis = reference_axis(mesh, self.points.element, self.points.xi)
        self.reference = self._at_heights(self.points.reference, self.axis.d)
        self.turned: np.ndarray | None = None

    @property
    def size(self) -> int:
        """Number of points."""
        return self.mesh.elements * len(self.order)

    def arrays(self, solution: "Solution", rows: slice = slice(None)) -> dict[str, np.ndarray]:
        """Return numbers (steps, points) and vectors (steps, points, 3) of some rows of a solution."""
        element, xi, p, v = self.points.element, self.points.xi, solution.p[rows], solution.v[rows]
        now = postprocess.axis(self.mesh, postprocess.nodal_vectors(self.mesh, p), element, xi)
        rate = postprocess.axis(self.mesh, postprocess.nodal_velocities(self.mesh, p, v), element, xi)
        position = self._at_heights(now.r, now.d)
        result = {
            "points": position,
            "displacement": position - self.reference,
            "velocity": self._at_heights(rate.r, rate.d),
            "rotation": np.repeat(self._rotation(p, now)[..., None], self.y.shape[-1], axis=-1),
        }
        strain = postprocess.green_strain(now, self.axis, self.y)
        stress = postprocess.stress(self.mesh, strain, self.y)
        for component in ("xx", "yy", "xy"):
            result[f"green_strain_{component}"] = getattr(strain, component)
            result[f"stress_{component}"] = getattr(stress, component)
        if not self.whole:
            names = {"normal": "normal_force", "shear": "shear_force", "moment": "bending_moment"}
            for name, values in section_forces(self.points, solution, rows).items():
                result[names[name]] = values[..., None]
        return {name: self._by_cell(values) for name, values in result.items()}

    @property
    def has_material(self) -> bool:
        """Whether the stress is known: a section that is known by its stiffness only has none."""
        beam = self.mesh.beam
        return bool(beam.section_at(0.0).materials_at(np.zeros(1), beam.material))

    def _rotation(self, p: np.ndarray, now: postprocess.Axis) -> np.ndarray:
        """Rotation (steps, points of the axis) [rad], continuous from one call to the next."""
        turned = postprocess.turning(self.mesh, p, now, self.points.element, self.points.xi)
        # Gradients know their angle up to full turns only, and `turning` counts those from its own first row.
        if self.turned is not None and isinstance(self.mesh.beam.element.coordinates, Gradients):
            turned = turned + 2.0 * np.pi * np.round((self.turned - turned[0]) / (2.0 * np.pi))
        self.turned = turned[-1]
        return turned

    def _at_heights(self, r: np.ndarray, d: np.ndarray) -> np.ndarray:
        return np.asarray(r[..., None, :] + self.y[..., None] * d[..., None, :])

    def _by_cell(self, values: np.ndarray) -> np.ndarray:
        """Order values (steps, points of the axis, heights, ...) by cells; vectors get z = 0."""
        steps, tail = len(values), values.shape[3:]
        cells = values.reshape(steps, self.mesh.elements, -1, *tail)[:, :, self.order].reshape(steps, -1, *tail)
        return np.pad(cells, ((0, 0), (0, 0), (0, 1))) if tail else cells


def body(mesh: BeamMesh) -> Samples:
    """Return the points of Lagrange quadrilaterals of degree (n, 1), exact for the field r0(x) + y d(x)."""
    n = max(3, mesh.beam.element.field.degree, mesh.beam.element.field.director_degree)
    bottom = 2 * np.arange(n + 1)
    # VTK: corners counter-clockwise, then the inner points of the bottom edge, then those of the top edge.
    order = np.concatenate([[0, 2 * n, 2 * n + 1, 1], bottom[1:-1], bottom[1:-1] + 1])
    return Samples(mesh, n, True, order)


def centreline(mesh: BeamMesh) -> Samples:
    """Return the points of straight pieces, because ParaView 5.11 crashes on Lagrange curves."""
    return Samples(mesh, _LINES_PER_ELEMENT, False, np.arange(_LINES_PER_ELEMENT + 1))


class Cells:
    """The cells of all beams of one kind, one an element, which shares no points with others."""

    def __init__(self, model: Model, whole: bool) -> None:
        self.whole = whole
        self.beams: Sequence[Samples] = [body(mesh) if whole else centreline(mesh) for mesh in model.meshes]
        elements = [beam.mesh.elements for beam in self.beams]
        self.beam = np.repeat(np.arange(len(self.beams)), elements)
        self.degree = np.repeat([beam.degree for beam in self.beams], elements)
        self.offsets = np.append(0, np.cumsum(np.repeat([len(beam.order) for beam in self.beams], elements)))

    @property
    def points(self) -> int:
        return int(self.offsets[-1])

    @property
    def degrees(self) -> np.ndarray:
        """Degrees of the Lagrange cells (cells, 3)."""
        return np.stack([self.degree, np.ones_like(self.degree), np.ones_like(self.degree)], axis=1).astype(float)

    def arrays(self, solution: "Solution", rows: slice) -> dict[str, np.ndarray]:
        """Return the fields at all points, (steps, points) and (steps, points, 3), of some rows of a solution."""
        parts = [beam.arrays(solution, rows) for beam in self.beams]
        # a section given by its stiffness or by layers knows no stress at y = 0 or at its faces
        known = [name for name in parts[0] if not name.startswith("stress") or self._stressed]
        return {name: np.concatenate([part[name] for part in parts], axis=1) for name in known}

    @property
    def _stressed(self) -> bool:
        return all(beam.has_material for beam in self.beams)


def times(at: np.ndarray) -> np.ndarray:
    """Return what ParaView takes for time: `at` where it rises, else the numbers of the rows."""
    return at if np.all(np.diff(at) > 0.0) else np.arange(len(at), dtype=float)
