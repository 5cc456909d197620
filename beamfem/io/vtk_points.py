"""Points of bodies and centrelines in the cells of ParaView files, and the fields there."""

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.material import Material
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import reference_axis
from beamfem.model.model import Model
from beamfem.results import postprocess
from beamfem.results.axis_fields import AxisPoints, rotation, section_forces
from beamfem.results.batched_beams import LikeBeams, equal_beams
from beamfem.results.self_stress import self_stress
from beamfem.results.solution import Solution
from beamfem.results.stresses import in_the_plane, second_piola_kirchhoff, von_mises
from beamfem.section import Layered

_LINES_PER_ELEMENT = 12
_ACROSS = 2  # intervals of a layer, whose stress is a parabola at most
_FORCES = {"normal": "normal_force", "shear": "shear_force", "moment": "bending_moment"}


class Samples:
    """Points (xi, y) of elements of like beams, in the order that VTK wants them in a cell.

    layer: the layer of the body from whose lower face to the upper one there are `across` intervals, or None for the
    axis; order: places in the table (degree + 1, heights), flattened. element: elements that have this layer (ne,).
    """

    def __init__(self, group: LikeBeams, layer: int | None, order: np.ndarray, across: int = 0) -> None:
        self.group, points = group, group.points
        self.points, self.layer, self.order, self.mesh = points, layer, order, points.mesh
        self.across = across
        self.distributions = points.distributions
        if layer is None:
            self.y = np.zeros((len(self.points.xi), 1))
            self.element = np.arange(self.mesh.elements)
        else:
            low, high = np.moveaxis(self.distributions.layers[:, layer], -1, 0)
            self.y = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, across + 1)
            self.y[:, -1] = high
            has_layer = (self.distributions.number > layer).reshape(self.mesh.elements, -1)
            self.element = np.flatnonzero(has_layer.any(axis=1))
        self.axis = reference_axis(self.mesh, self.points.element, self.points.xi)
        self.reference = self._at_heights(self.points.reference, self.axis.d)

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.element) * len(self.order)

    @property
    def at_rest(self) -> np.ndarray:
        """The reference positions of all points (1, points, 3) [m]."""
        return self._by_cell(self.reference[None])

    @property
    def material(self) -> Material | None:
        """The material of the beam, or of its layer; None if the section brings its stiffness."""
        beam = self.mesh.beam
        if self.layer is not None and isinstance(beam.section, Layered):
            return beam.section.layers[self.layer].material
        return beam.material

    def arrays(self, solution: Solution, rows: slice = slice(None)) -> dict[str, np.ndarray]:
        """Return numbers (steps, points), vectors (..., 3) and tensors (..., 6) of some rows of a solution."""
        element, xi, p, v = self.points.element, self.points.xi, solution.p[rows], solution.v[rows]
        now = postprocess.axis(self.mesh, postprocess.nodal_vectors(self.mesh, p), element, xi)
        position = self._at_heights(now.r, now.d)
        result = {
            "points": position,
            "displacement": position - self.reference,
            "rotation": np.repeat(rotation(self.points, solution, rows)[..., None], self.y.shape[-1], axis=-1),
        }
        if not solution.static:
            rate = postprocess.axis(self.mesh, postprocess.nodal_velocities(self.mesh, p, v), element, xi)
            result["velocity"] = self._at_heights(rate.r, rate.d)
        strain = postprocess.green_strain(now, self.axis, self.y)
        for component in ("xx", "yy", "xy"):
            result[f"green_strain_{component}"] = getattr(strain, component)
        forces = section_forces(self.points, solution, rows)
        eigenstress = self_stress(solution, self.mesh, element, xi, self.layer, self.y, rows)
        result |= self._stress(forces, eigenstress)
        result["cauchy_stress"] = in_the_plane(
            result["stress_xx"], result["stress_xy"], postprocess.direction(self.mesh, now)
        )
        result["second_piola_kirchhoff_stress"] = second_piola_kirchhoff(
            result["cauchy_stress"], now, self.axis, self.y
        )
        for name, values in forces.items():
            result[_FORCES[name]] = np.repeat(values[..., None], self.y.shape[-1], axis=-1)
        return {name: self._by_cell(values) for name, values in result.items()}

    @cached_property
    def beam(self) -> np.ndarray:
        """Number of the beam of each of the elements (ne,)."""
        return np.repeat(self.group.numbers, [points.mesh.elements for points in self.group.single])[self.element]

    @cached_property
    def known(self) -> dict[str, bool]:
        """Whether there is a place along the beams where a component of stress is known at all heights of a cell."""
        finite = {name: bool(values.any()) for name, values in self._finite.items()}
        return finite | dict.fromkeys(("cauchy_stress", "second_piola_kirchhoff_stress"), finite["von_mises_stress"])

    @property
    def unknown(self) -> list[int]:
        """Numbers of the beams with no place where the normal stress is known at all heights of a cell."""
        parts = self.group.parted(self._finite["stress_xx"], 0)
        return [number for number, known in zip(self.group.numbers, parts, strict=True) if not known.any()]

    @cached_property
    def _finite(self) -> dict[str, np.ndarray]:
        """Whether a component of stress is known at all heights, at each point of the axis (points,)."""
        ones = np.ones((1, len(self.points.xi)))
        unit = self._stress({"normal": ones, "shear": ones, "moment": ones})
        return {name: np.isfinite(values).all(axis=-1)[0] for name, values in unit.items()}

    def _stress(self, forces: dict[str, np.ndarray], self_stress: np.ndarray | float = 0.0) -> dict[str, np.ndarray]:
        """Return the stress (steps, points of the axis, heights) [Pa] of section forces (steps, points of the axis).

        self_stress: what layers do against each other, of the same shape.
        """
        distributions = self.distributions
        along = distributions.normal_stress(self.layer, self.y, forces["normal"], forces["moment"]) + self_stress
        sheared = distributions.shear_stress(self.layer, self.y, forces["shear"])
        return {"stress_xx": along, "stress_xy": sheared, "von_mises_stress": von_mises(along, sheared)}

    def _at_heights(self, r: np.ndarray, d: np.ndarray) -> np.ndarray:
        return np.asarray(r[..., None, :] + self.y[..., None] * d[..., None, :])

    def _by_cell(self, values: np.ndarray) -> np.ndarray:
        """Order values (steps, points of the axis, heights, ...) by cells; vectors of the plane get z = 0."""
        steps, tail = len(values), values.shape[3:]
        by_element = values.reshape(steps, self.mesh.elements, -1, *tail)[:, self.element]
        cells = by_element[:, :, self.order].reshape(steps, -1, *tail)
        return np.pad(cells, ((0, 0), (0, 0), (0, 1))) if tail == (2,) else cells


def bodies(model: Model, alike: bool = False) -> list[Samples]:
    """Return the points of each layer as Lagrange quadrilaterals of degree (n, 2), or (n, n) where `alike`.

    They are exact for the field r0(x) + y d(x), and for the parabola of the shear stress in a rectangle.
    """
    groups = equal_beams(model, [AxisPoints(mesh, _degree(mesh)) for mesh in model.meshes], 1)
    return [sample for group in groups for sample in _body(group, alike)]


def centrelines(model: Model) -> list[Samples]:
    """Return the points of straight pieces, because ParaView 5.11 crashes on Lagrange curves."""
    groups = equal_beams(model, [AxisPoints(mesh, _LINES_PER_ELEMENT) for mesh in model.meshes], 1)
    return [Samples(group, None, np.arange(_LINES_PER_ELEMENT + 1)) for group in groups]


def _degree(mesh: BeamMesh) -> int:
    return max(3, mesh.beam.element.field.degree, mesh.beam.element.field.director_degree)


def _body(group: LikeBeams, alike: bool) -> list[Samples]:
    n = group.points.pieces
    m = n if alike else _ACROSS
    number = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
    # VTK: corners counter-clockwise, then inner points of the edges: bottom, right, top, left; then those of the cell
    corners = number[[0, n, n, 0], [0, 0, m, m]]
    edges = [number[1:n, 0], number[n, 1:m], number[1:n, m], number[0, 1:m]]
    order = np.concatenate([corners, *edges, number[1:n, 1:m].T.ravel()])
    return [Samples(group, layer, order, m) for layer in range(group.points.distributions.layers.shape[1])]
