"""Supports, loads and connectors in ParaView files: a vertex for each place, with what acts on the beam there."""

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.io.boundary_conditions import COMPONENTS, ROLES, vertices
from beamfem.io.vtk_cells import VERTEX, Content, by_precision, legend_of_beams
from beamfem.mesh.reference import reference_position
from beamfem.model.model import Model
from beamfem.results import postprocess
from beamfem.results.solution import Solution


class Boundary:
    """The vertices of a model, with the attributes of `Cells`."""

    cell_type, degrees = VERTEX, None

    def __init__(self, model: Model, content: Content) -> None:
        self.content, self.beams, self.unit = content, model.beams, model.unit
        self.groups = vertices(model)
        numbers = {id(mesh): number for number, mesh in enumerate(model.meshes)}
        kinds = list(dict.fromkeys(group.kind for group in self.groups))
        self._sizes = [len(group.xi) for group in self.groups]
        self.points = sum(self._sizes)
        self.connectivity, self.offsets = np.arange(self.points), np.arange(self.points + 1)
        beam = [numbers[id(group.mesh)] for group in self.groups]
        kind, role = [kinds.index(group.kind) for group in self.groups], [group.role for group in self.groups]
        # cell data (cells,) by name, and names of these numbers
        self.numbers = {
            name: np.repeat(np.array(values, dtype=np.int64), self._sizes)
            for name, values in (("beam", beam), ("kind", kind), ("role", role))
        }
        self.legend = {**legend_of_beams(self.beams), "kinds": kinds, "roles": list(ROLES)}
        self._element, self._xi = (
            np.concatenate([getattr(group, name) for group in self.groups]) if self.groups else np.empty(0)
            for name in ("element", "xi")
        )
        # the vertices of each beam that has some
        self._places = [
            (model.meshes[number], np.flatnonzero(self.numbers["beam"] == number)) for number in dict.fromkeys(beam)
        ]

    @property
    def names(self) -> list[str]:
        """The fields that there are."""
        present = {name for group in self.groups for name in group.fields}
        return ["displacement", *(name for name in COMPONENTS if name in present)]

    def arrays(self, solution: Solution, rows: slice) -> dict[str, np.ndarray]:
        """Return points and fields (steps, points) and (steps, points, 3) of some rows; what nothing has is left out.

        A displacement is that of the axis; what does not apply at a vertex is zero there.
        """
        part, chosen = solution[rows], self.content.chosen(self.names)
        position = self._positions(part.p)
        result = {"points": position, "displacement": position - self._reference}
        if self.content.geometry == "reference":
            result["points"] = np.repeat(self._reference[None], len(part), axis=0)
        names = [name for name in chosen if name in COMPONENTS]
        values = [group.values(part) for group in self.groups] if names else []
        for name in names:
            result[name] = self._table(name, values, len(part))
        return by_precision({name: result[name] for name in ("points", *chosen)}, self.content)

    def _table(self, name: str, values: list[dict[str, np.ndarray]], steps: int) -> np.ndarray:
        components = COMPONENTS[name]
        sizes = zip(values, self._sizes, strict=True)
        parts = [fields[name] if name in fields else np.zeros((steps, size, components)) for fields, size in sizes]
        table = np.concatenate(parts, axis=1)
        return table if components == 3 else table[..., 0]

    def _positions(self, p: np.ndarray) -> np.ndarray:
        """Return the positions (steps, points, 3) [m] of the vertices in states p (steps, n)."""
        result = np.zeros((len(p), self.points, 3))
        for mesh, indices in self._places:
            vectors = postprocess.nodal_vectors(mesh, p)
            result[:, indices, :2] = postprocess.axis(mesh, vectors, self._element[indices], self._xi[indices]).r
        return result

    @cached_property
    def _reference(self) -> np.ndarray:
        result = np.zeros((self.points, 3))
        for mesh, indices in self._places:
            result[indices, :2] = reference_position(mesh, self._element[indices], self._xi[indices])
        return result
