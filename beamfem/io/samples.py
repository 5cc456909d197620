"""What ParaView files hold: points of bodies and centrelines by cells, and the fields there."""

import warnings
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from beamfem.errors import UnknownStressWarning
from beamfem.model.mesh import BeamMesh
from beamfem.model.model import Model
from beamfem.model.reference import reference_axis
from beamfem.results import postprocess
from beamfem.results.along import AxisPoints, rotation, section_forces
from beamfem.results.self_stress import self_stress
from beamfem.results.stresses import in_the_plane, von_mises

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_LINES_PER_ELEMENT = 12
_ACROSS = 2  # intervals of a layer, whose stress is a parabola at most
_NAMED = 10  # beams that a warning names


class Samples:
    """Points (xi, y) of elements of a beam, in the order that VTK wants them in a cell.

    layer: the layer of the body from whose lower face to the upper one there are `across` intervals, or None for the
    axis; order: places in the table (degree + 1, heights), flattened. element: elements that have this layer (ne,).
    """

    def __init__(self, points: AxisPoints, layer: int | None, order: np.ndarray, across: int = 0) -> None:
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
            there = (self.distributions.number > layer).reshape(self.mesh.elements, -1)
            self.element = np.flatnonzero(there.any(axis=1))
        self.axis = reference_axis(self.mesh, self.points.element, self.points.xi)
        self.reference = self._at_heights(self.points.reference, self.axis.d)

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.element) * len(self.order)

    def arrays(self, solution: "Solution", rows: slice = slice(None)) -> dict[str, np.ndarray]:
        """Return numbers (steps, points), vectors (..., 3) and tensors (..., 6) of some rows of a solution."""
        element, xi, p, v = self.points.element, self.points.xi, solution.p[rows], solution.v[rows]
        now = postprocess.axis(self.mesh, postprocess.nodal_vectors(self.mesh, p), element, xi)
        rate = postprocess.axis(self.mesh, postprocess.nodal_velocities(self.mesh, p, v), element, xi)
        position = self._at_heights(now.r, now.d)
        result = {
            "points": position,
            "displacement": position - self.reference,
            "velocity": self._at_heights(rate.r, rate.d),
            "rotation": np.repeat(rotation(self.points, solution, rows)[..., None], self.y.shape[-1], axis=-1),
        }
        strain = postprocess.green_strain(now, self.axis, self.y)
        for component in ("xx", "yy", "xy"):
            result[f"green_strain_{component}"] = getattr(strain, component)
        forces = section_forces(self.points, solution, rows)
        own = self_stress(solution, self.mesh, element, xi, self.layer, self.y, rows)
        result |= self._stress(forces, own)
        result["cauchy_stress"] = in_the_plane(
            result["stress_xx"], result["stress_xy"], postprocess.direction(self.mesh, now)
        )
        if self.layer is None:
            names = {"normal": "normal_force", "shear": "shear_force", "moment": "bending_moment"}
            for name, values in forces.items():
                result[names[name]] = values[..., None]
        return {name: self._by_cell(values) for name, values in result.items()}

    @cached_property
    def known(self) -> dict[str, bool]:
        """Whether there is a place along the beam where a component of stress is known at all heights of a cell."""
        one = np.ones((1, len(self.points.xi)))
        unit = self._stress({"normal": one, "shear": one, "moment": one})
        told = {name: bool(np.isfinite(values).all(axis=-1).any()) for name, values in unit.items()}
        return told | {"cauchy_stress": told["von_mises_stress"]}

    def _stress(self, forces: dict[str, np.ndarray], self_stress: np.ndarray | float = 0.0) -> dict[str, np.ndarray]:
        """Return the stress (steps, points of the axis, heights) [Pa] of section forces (steps, points of the axis).

        self_stress: what layers do against each other, of the same shape.
        """
        own = self.distributions
        along = own.normal_stress(self.layer, self.y, forces["normal"], forces["moment"]) + self_stress
        sheared = own.shear_stress(self.layer, self.y, forces["shear"])
        # beam theory: fibres do not press on each other
        found = {"stress_xx": along, "stress_yy": 0.0 * along, "stress_xy": sheared}
        return found | {"von_mises_stress": von_mises(along, sheared)}

    def _at_heights(self, r: np.ndarray, d: np.ndarray) -> np.ndarray:
        return np.asarray(r[..., None, :] + self.y[..., None] * d[..., None, :])

    def _by_cell(self, values: np.ndarray) -> np.ndarray:
        """Order values (steps, points of the axis, heights, ...) by cells; vectors of the plane get z = 0."""
        steps, tail = len(values), values.shape[3:]
        by_element = values.reshape(steps, self.mesh.elements, -1, *tail)[:, self.element]
        cells = by_element[:, :, self.order].reshape(steps, -1, *tail)
        return np.pad(cells, ((0, 0), (0, 0), (0, 1))) if tail == (2,) else cells


def body(mesh: BeamMesh, alike: bool = False) -> list[Samples]:
    """Return the points of each layer as Lagrange quadrilaterals of degree (n, 2), or (n, n) where `alike`.

    They are exact for the field r0(x) + y d(x), and for the parabola of the shear stress in a rectangle.
    """
    n = max(3, mesh.beam.element.field.degree, mesh.beam.element.field.director_degree)
    m = n if alike else _ACROSS
    number = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
    # VTK: corners counter-clockwise, then inner points of the edges: bottom, right, top, left; then those of the cell
    corners = number[[0, n, n, 0], [0, 0, m, m]]
    edges = [number[1:n, 0], number[n, 1:m], number[1:n, m], number[0, 1:m]]
    order = np.concatenate([corners, *edges, number[1:n, 1:m].T.ravel()])
    points = AxisPoints(mesh, n)
    return [Samples(points, layer, order, m) for layer in range(points.distributions.layers.shape[1])]


def centreline(mesh: BeamMesh) -> list[Samples]:
    """Return the points of straight pieces, because ParaView 5.11 crashes on Lagrange curves."""
    return [Samples(AxisPoints(mesh, _LINES_PER_ELEMENT), None, np.arange(_LINES_PER_ELEMENT + 1))]


class Cells:
    """The cells of all beams of one kind, one an element and layer, which shares no points with others.

    alike: of one degree in both directions; readers of VTKHDF files before VTK 9.7 take no others.
    """

    def __init__(self, model: Model, whole: bool, alike: bool = False) -> None:
        self.whole, self.meshes = whole, model.meshes
        by_beam = [body(mesh, alike) if whole else centreline(mesh) for mesh in model.meshes]
        self.samples: Sequence[Samples] = [part for parts in by_beam for part in parts]
        numbers = [number for number, parts in enumerate(by_beam) for _ in parts]
        cells = [len(part.element) for part in self.samples]
        self.beam = np.repeat(numbers, cells)
        self.layer = np.repeat([part.layer or 0 for part in self.samples], cells)
        self.degree = np.repeat([(part.points.pieces, part.across) for part in self.samples], cells, axis=0)
        self.offsets = np.append(0, np.cumsum(np.repeat([len(part.order) for part in self.samples], cells)))

    @property
    def points(self) -> int:
        return int(self.offsets[-1])

    @property
    def degrees(self) -> np.ndarray:
        """Degrees of the Lagrange cells (cells, 3)."""
        return np.column_stack([self.degree, np.ones(len(self.degree))]).astype(float)

    @property
    def numbers(self) -> dict[str, np.ndarray]:
        """Cell data (cells,) by name: the beam in the model, and the layer of bodies from the bottom up."""
        return {"beam": self.beam, "layer": self.layer} if self.whole else {"beam": self.beam}

    def warn_of_unknown_stress(self) -> None:
        """Warn of beams whose stress is left out, or nan beside that of others."""
        number = {id(mesh): i for i, mesh in enumerate(self.meshes)}
        unknown = sorted({number[id(part.mesh)] for part in self.samples if not part.known["stress_xx"]})
        if unknown:
            shown = ", ".join(map(str, unknown[:_NAMED])) + (", ..." if len(unknown) > _NAMED else "")
            what = "left out" if len(unknown) == len(self.meshes) else "nan"
            warnings.warn(
                f"the stress of {len(unknown)} of {len(self.meshes)} beams ({shown}) is not known and is {what}: their "
                "sections are given by a stiffness, a law of their own, or moments without a height; "
                "Section(..., height=) gives it",
                UnknownStressWarning,
                stacklevel=5,
            )

    def arrays(self, solution: "Solution", rows: slice) -> dict[str, np.ndarray]:
        """Return the fields at all points, (steps, points) and (steps, points, 3 or 6), of some rows of a solution.

        A stress that is known nowhere is left out.
        """
        parts = [part.arrays(solution, rows) for part in self.samples]
        known = {name for part in self.samples for name, told in part.known.items() if told}
        names = [name for name in parts[0] if "stress" not in name or name in known]
        return {name: np.concatenate([part[name] for part in parts], axis=1) for name in names}


def times(at: np.ndarray) -> np.ndarray:
    """Return what ParaView takes for time: `at` where it rises, else the numbers of the rows."""
    return at if np.all(np.diff(at) > 0.0) else np.arange(len(at), dtype=float)
