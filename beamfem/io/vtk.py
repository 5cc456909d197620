"""ParaView files: the deformed body as curved quadrilaterals and the centreline as lines, one .vtu a step."""

import os
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_LAGRANGE_QUADRILATERAL, VTK_POLY_LINE, vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from beamfem import postprocess
from beamfem.element.coordinates import Gradients
from beamfem.errors import InputError
from beamfem.model.mesh import BeamMesh
from beamfem.model.reference import faces, reference_axis

if TYPE_CHECKING:
    from beamfem.solution import Solution

_VALUES_IN_MEMORY = 100_000
_STEPS_BETWEEN_PUBLISHING = 50
_LINES_PER_ELEMENT = 12


def write_pvd(solution: "Solution", path: str | PathLike[str]) -> None:
    """Write the body into `path` (.pvd) and the centrelines into <stem>_centreline.pvd; raises InputError.

    Point data: displacement [m], velocity [m/s], rotation [rad], Green strain [-], second Piola-Kirchhoff stress [Pa].
    """
    path = Path(path)
    if path.suffix != ".pvd":
        right = path.with_suffix(".pvd") if path.name else path / "result.pvd"
        raise InputError(f'ParaView opens a .pvd file, got "{path}"; "{right}" would be right')
    meshes = solution.model.meshes
    files = (
        _Series(path, VTK_LAGRANGE_QUADRILATERAL, [_body(mesh) for mesh in meshes]),
        _Series(path.with_stem(path.stem + "_centreline"), VTK_POLY_LINE, [_centreline(mesh) for mesh in meshes]),
    )
    chunk = max(1, _VALUES_IN_MEMORY // sum(len(beam.xi) for file in files for beam in file.beams))
    try:
        for first in range(0, len(solution), chunk):
            rows = slice(first, first + chunk)
            for file in files:
                file.write(solution.at[rows], solution.p[rows], solution.v[rows])
    finally:
        for file in files:
            file.publish()


class _Samples:
    """Points (xi, y) of every element of a beam, in the order that VTK wants them in a cell.

    degree: intervals along an element; whole: lower and upper face, or the axis; order: places in the
    table (degree + 1, heights), flattened.
    """

    def __init__(self, mesh: BeamMesh, degree: int, whole: bool, order: np.ndarray) -> None:
        self.mesh, self.degree, self.order = mesh, degree, order
        self.element = np.repeat(np.arange(mesh.elements), degree + 1)
        self.xi = np.tile(np.arange(degree + 1) / degree, mesh.elements)
        self.y = faces(mesh, self.element, self.xi) if whole else np.zeros((len(self.xi), 1))
        self.axis = reference_axis(mesh, self.element, self.xi)
        first = mesh.position[mesh.node[self.element, 0]]
        self.reference = self._at_heights(first + self.axis.r, self.axis.d)
        self.turned: np.ndarray | None = None

    def arrays(self, p: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
        """Return numbers (steps, points) and vectors (steps, points, 3) of the states p, v (steps, n)."""
        now = postprocess.axis(self.mesh, postprocess.nodal_vectors(self.mesh, p), self.element, self.xi)
        rates = postprocess.nodal_velocities(self.mesh, p, v)
        rate = postprocess.axis(self.mesh, rates, self.element, self.xi)
        position = self._at_heights(now.r, now.d)
        result = {
            "points": position,
            "displacement": position - self.reference,
            "velocity": self._at_heights(rate.r, rate.d),
            "rotation": np.repeat(self._rotation(p, now)[..., None], self.y.shape[-1], axis=-1),
        }
        strain = postprocess.green_strain(now, self.axis, self.y)
        stress = postprocess.stress(self.mesh, strain)
        for component in ("xx", "yy", "xy"):
            result[f"green_strain_{component}"] = getattr(strain, component)
            result[f"stress_{component}"] = getattr(stress, component)
        return {name: self._by_cell(values) for name, values in result.items()}

    def _rotation(self, p: np.ndarray, now: postprocess.Axis) -> np.ndarray:
        """Rotation (steps, points of the axis) [rad], continuous from one call to the next."""
        turned = postprocess.turning(self.mesh, p, now, self.element, self.xi)
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


def _body(mesh: BeamMesh) -> _Samples:
    """Return the points of Lagrange quadrilaterals of degree (n, 1), exact for the field r0(x) + y d(x)."""
    n = max(3, mesh.beam.element.field.degree, mesh.beam.element.field.director_degree)
    bottom = 2 * np.arange(n + 1)
    # VTK: corners counter-clockwise, then the inner points of the bottom edge, then those of the top edge.
    order = np.concatenate([[0, 2 * n, 2 * n + 1, 1], bottom[1:-1], bottom[1:-1] + 1])
    return _Samples(mesh, n, True, order)


def _centreline(mesh: BeamMesh) -> _Samples:
    # Straight pieces, because ParaView 5.11 crashes on Lagrange curves.
    return _Samples(mesh, _LINES_PER_ELEMENT, False, np.arange(_LINES_PER_ELEMENT + 1))


class _Series:
    """A .pvd file and the folder of its steps; one cell an element, which shares no points with others."""

    def __init__(self, path: Path, kind: int, beams: Sequence[_Samples]) -> None:
        self.path, self.beams, self.folder = path, beams, path.with_suffix("")
        self.folder.mkdir(parents=True, exist_ok=True)
        self.lines: list[str] = []
        per_cell = [beam for beam in beams for _ in range(beam.mesh.elements)]
        offsets = np.cumsum([0] + [len(beam.order) for beam in per_cell])
        cells = vtkCellArray()
        cells.SetData(*(numpy_to_vtkIdTypeArray(ids, deep=True) for ids in (offsets, np.arange(offsets[-1]))))
        self.grid = vtkUnstructuredGrid()
        self.grid.SetPoints(vtkPoints())
        self.grid.SetCells(kind, cells)
        if kind == VTK_LAGRANGE_QUADRILATERAL:
            degrees = numpy_to_vtk(np.array([(beam.degree, 1.0, 1.0) for beam in per_cell]), deep=True)
            degrees.SetName("HigherOrderDegrees")
            self.grid.GetCellData().SetHigherOrderDegrees(degrees)
        self.writer = vtkXMLUnstructuredGridWriter()
        self.writer.SetInputData(self.grid)
        self.writer.EncodeAppendedDataOff()

    def write(self, at: np.ndarray, p: np.ndarray, v: np.ndarray) -> None:
        """Write a file a step, of the states p, v (steps, n) at (steps,)."""
        parts = [beam.arrays(p, v) for beam in self.beams]
        joined = {name: np.concatenate([part[name] for part in parts], axis=1) for name in parts[0]}
        for row, time in enumerate(at):
            now = {name: numpy_to_vtk(values[row]) for name, values in joined.items()}
            self.grid.GetPoints().SetData(now.pop("points"))
            for name, array in now.items():
                array.SetName(name)
                self.grid.GetPointData().AddArray(array)
            file = self.folder / f"{len(self.lines):04d}.vtu"
            self.writer.SetFileName(os.fspath(file))
            if not self.writer.Write():
                raise OSError(f"could not write {file}; is the disk full?")
            source = quoteattr(f"{self.folder.name}/{file.name}")
            self.lines.append(f'    <DataSet timestep="{float(time)!r}" part="0" file={source}/>\n')
            if len(self.lines) % _STEPS_BETWEEN_PUBLISHING == 1:
                self.publish()

    def publish(self) -> None:
        """Rewrite the .pvd with the steps so far; readers see the old file or the new one, never a part."""
        temporary = self.path.with_name(self.path.name + ".tmp")
        head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
        temporary.write_text(head + "".join(self.lines) + "  </Collection>\n</VTKFile>\n", encoding="utf-8")
        os.replace(temporary, self.path)
