"""The cells of ParaView files: bodies or centrelines of all beams, and the fields that are written of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.io.parts_in_words import material_in_words, section_in_words
from beamfem.material import Material
from beamfem.mesh.reference import reference_axis
from beamfem.model.beam import Beam, names
from beamfem.model.model import Model
from beamfem.results import postprocess
from beamfem.results.axis_fields import QUANTITIES
from beamfem.results.axis_points import AxisPoints, axis_at
from beamfem.results.batched_beams import LikeBeams, equal_beams
from beamfem.results.beam_stress import (
    in_the_plane,
    second_piola_kirchhoff,
    stress_in_layer,
    von_mises,
    warn_of_unknown_stress,
)
from beamfem.results.full_turns import rotation
from beamfem.results.section_forces import at_points
from beamfem.results.solution import Solution
from beamfem.section import Layered
from beamfem.validation import flag, one_of, require_known, shown
from beamfem.value_keys import by_value

_LINES_PER_ELEMENT = 12
_ACROSS = 2  # intervals of a layer, whose stress is a parabola at most
_ERROR = "error_share"
_FORCES = ("normal_force", "shear_force", "bending_moment")


class Samples:
    """Points (xi, y) of elements of like beams, in the order that VTK wants them in a cell.

    layer: the layer of the body from whose lower face to the upper one there are `across` intervals, or None for the
    axis; order: places in the table (degree + 1, heights), flattened. element: elements that have this layer (ne,).
    """

    def __init__(self, group: LikeBeams, layer: int | None, order: np.ndarray, across: int = 0) -> None:
        self.group, points = group, group.points
        self.points, self.layer, self.order, self.mesh = points, layer, order, points.mesh
        self.across = across
        if layer is None:
            self.y = np.zeros((len(self.points.xi), 1))
            self.element = np.arange(self.mesh.elements)
        else:
            low, high = np.moveaxis(points.distributions.layers[:, layer], -1, 0)
            self.y = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, across + 1)
            self.y[:, -1] = high
            has_layer = (points.distributions.number > layer).reshape(self.mesh.elements, -1)
            self.element = np.flatnonzero(has_layer.any(axis=1))
        self.axis = reference_axis(self.mesh, self.points.element, self.points.xi)
        self.reference = self._at_heights(self.points.reference, self.axis.d)

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.element) * len(self.order)

    @property
    def material(self) -> Material | None:
        """The material of the beam, or of its layer; None if the section brings its stiffness."""
        beam = self.mesh.beam
        if self.layer is not None and isinstance(beam.section, Layered):
            return beam.section.layers[self.layer].material
        return beam.material

    def arrays(self, solution: Solution, rows: slice = slice(None), with_errors: bool = False) -> dict[str, np.ndarray]:
        """Return numbers (steps, points), vectors (..., 3) and tensors (..., 6) of some rows of a solution.

        with_errors: whether the shares of elements in the error, which take a solve each, are among them.
        """
        now = self.points.now(p := solution.p[rows])
        position = self._at_heights(now.r, now.d)
        result = {
            "points": position,
            "displacement": position - self.reference,
            "rotation": self._at_all_heights(rotation(self.points, solution, rows)),
        }
        if not solution.static:
            rate = axis_at(self.mesh, p, self.points.element, self.points.xi, solution.v[rows])
            result["velocity"] = self._at_heights(rate.r, rate.d)
        strain = postprocess.green_strain(now, self.axis, self.y)
        for component in ("xx", "yy", "xy"):
            result[f"green_strain_{component}"] = getattr(strain, component)
        forces = at_points(solution, self.points, rows)
        along, sheared = stress_in_layer(solution, self.points, self.layer, self.y, forces, rows)
        cauchy = in_the_plane(along, sheared, postprocess.direction(self.mesh, now))
        result |= {"stress_xx": along, "stress_xy": sheared, "von_mises_stress": von_mises(along, sheared)}
        result["cauchy_stress"] = cauchy
        result["second_piola_kirchhoff_stress"] = second_piola_kirchhoff(cauchy, now, self.axis, self.y)
        for number, name in enumerate(_FORCES):
            result[name] = self._at_all_heights(forces[:, number])
        if with_errors:
            result[_ERROR] = self._at_all_heights(QUANTITIES[_ERROR].values(self.points, solution, rows))
        return {name: self.by_cell(values) for name, values in result.items()}

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
        ones, distributions = np.ones((1, len(self.points.xi))), self.points.distributions
        along = np.isfinite(distributions.normal_stress(self.layer, self.y, ones, ones)).all(axis=-1)[0]
        sheared = np.isfinite(distributions.shear_stress(self.layer, self.y, ones)).all(axis=-1)[0]
        return {"stress_xx": along, "stress_xy": sheared, "von_mises_stress": along & sheared}

    def _at_all_heights(self, values: np.ndarray) -> np.ndarray:
        return np.repeat(values[..., None], self.y.shape[-1], axis=-1)

    def _at_heights(self, r: np.ndarray, d: np.ndarray) -> np.ndarray:
        return np.asarray(r[..., None, :] + self.y[..., None] * d[..., None, :])

    def by_cell(self, values: np.ndarray) -> np.ndarray:
        """Order values (steps, points of the axis, heights, ...) by cells; vectors of the plane get z = 0."""
        steps, tail = len(values), values.shape[3:]
        by_element = values.reshape(steps, self.mesh.elements, -1, *tail)[:, self.element]
        cells = by_element[:, :, self.order].reshape(steps, -1, *tail)
        return np.pad(cells, ((0, 0), (0, 0), (0, 1))) if tail == (2,) else cells


def bodies(model: Model, alike: bool = False) -> list[Samples]:
    """Return the points of each layer as Lagrange quadrilaterals of degree (n, 2), or (n, n) where `alike`.

    They are exact for the field r0(x) + y d(x), and for the parabola of the shear stress in a rectangle.
    """
    fields = [mesh.beam.element.field for mesh in model.meshes]
    degrees = [max(3, field.degree, field.director_degree) for field in fields]
    groups = equal_beams(model, list(map(AxisPoints.spaced, model.meshes, degrees)), 1)
    return [sample for group in groups for sample in _body(group, alike)]


def centrelines(model: Model) -> list[Samples]:
    """Return the points of straight pieces, because ParaView 5.11 crashes on Lagrange curves."""
    groups = equal_beams(model, [AxisPoints.spaced(mesh, _LINES_PER_ELEMENT) for mesh in model.meshes], 1)
    return [Samples(group, None, np.arange(_LINES_PER_ELEMENT + 1)) for group in groups]


def _body(group: LikeBeams, alike: bool) -> list[Samples]:
    n = group.points.pieces
    m = n if alike else _ACROSS
    number = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
    # VTK: corners counter-clockwise, then inner points of the edges: bottom, right, top, left; then those of the cell
    corners = number[[0, n, n, 0], [0, 0, m, m]]
    edges = [number[1:n, 0], number[n, 1:m], number[1:n, m], number[0, 1:m]]
    order = np.concatenate([corners, *edges, number[1:n, 1:m].T.ravel()])
    return [Samples(group, layer, order, m) for layer in range(group.points.distributions.layers.shape[1])]


UNITS = {
    "points": "m",
    "displacement": "m",
    "velocity": "m/s",
    "rotation": "rad",
    "stress_xx": "Pa",
    "stress_xy": "Pa",
    "von_mises_stress": "Pa",
    "cauchy_stress": "Pa",
    "second_piola_kirchhoff_stress": "Pa",
    "normal_force": "N",
    "shear_force": "N",
    "bending_moment": "N m",
    "force": "N",
    "moment": "N m",
    "line_force": "N/m",
    "acceleration": "m/s^2",
    "stiffness": "N/m, N/m, N m/rad",
}  # what is not here is a number without a unit


Geometry = Literal["deformed", "reference"]
# numbers of cell types, from vtkCellType.h
VERTEX, LINE, LAGRANGE_QUADRILATERAL = 1, 3, 70
# of bodies, only where they are asked for: VTK tessellates curved cells with at most 18 numbers at a point
_TENSORS = ("cauchy_stress", "second_piola_kirchhoff_stress")


@dataclass(frozen=True)
class Content:
    """Content of files: points of the deformed or the reference geometry, fields, numbers of 4 or 8 bytes."""

    geometry: Geometry = "deformed"
    fields: tuple[str, ...] | None = None
    single: bool = False

    def __post_init__(self) -> None:
        one_of("geometry", self.geometry, ("deformed", "reference"))
        flag("single", self.single)

    def chosen(self, names: Sequence[str]) -> list[str]:
        """Return the points and those of the names that are wanted."""
        return [name for name in names if self.fields is None or name in ("points", *self.fields)]

    def require_known(self, known: Sequence[str]) -> None:
        """Raise InputError for a field that there is not."""
        for name in self.fields or ():
            require_known(f"fields has {shown(name)}, which is not there", name, known)

    def finished(self, arrays: dict[str, np.ndarray], at_rest: np.ndarray) -> dict[str, np.ndarray]:
        """Return arrays with points where they are wanted, and numbers of four bytes if these are; at_rest (1, ...)."""
        if self.geometry == "reference":
            arrays["points"] = np.repeat(at_rest, len(arrays["points"]), axis=0)
        return {name: values.astype(np.float32) for name, values in arrays.items()} if self.single else arrays


WHOLE = Content()


class Cells:
    """The cells of all beams: bodies, one cell an element and layer, or lines; elements share no points with others.

    alike: of one degree in both directions; readers of VTKHDF files before VTK 9.7 take no others. cell_type: in VTK;
    points: their number; connectivity: points of all cells, one cell after the other; offsets of each cell in it, and
    its length; degrees (cells, 3) of Lagrange cells, None for lines; numbers: cell data (cells,) by name, beam,
    material and section, and the layer of bodies from the bottom up; legend: names of these numbers.
    """

    def __init__(self, model: Model, whole: bool, alike: bool = False, content: Content = WHOLE) -> None:
        self.whole, self.content = whole, content
        self.beams, self.unit = model.beams, model.unit
        self.samples: Sequence[Samples] = bodies(model, alike) if whole else centrelines(model)
        # elements by beams and their layers, of all samples
        beam = np.concatenate([part.beam for part in self.samples])
        sample = np.repeat(np.arange(len(self.samples)), [len(part.element) for part in self.samples])
        layer = np.array([part.layer or 0 for part in self.samples])
        order = np.lexsort((layer[sample], beam))
        pieces = np.array([1 if whole else part.points.pieces for part in self.samples])
        cells = np.repeat(sample[order], pieces[sample[order]])  # the sample of each cell
        materials, material = _numbered([part.material for part in self.samples], _materials(model))
        sections, section = _numbered(
            [part.mesh.beam.section for part in self.samples], [beam.section for beam in model.beams]
        )
        self.numbers = {
            "beam": np.repeat(beam[order], pieces[sample[order]]),
            "material": material[cells],
            "section": section[cells],
            **({"layer": layer[cells]} if whole else {}),
        }
        self.legend = {
            **legend_of_beams(self.beams),
            "materials": [material_in_words(item, self.unit) for item in materials],
            "sections": [section_in_words(item, self.unit) for item in sections],
        }
        degree = np.array([(part.points.pieces, part.across, 1.0) for part in self.samples])[cells]
        self.degrees = degree if whole else None
        self.cell_type = LAGRANGE_QUADRILATERAL if whole else LINE
        self.points = sum(part.size for part in self.samples)
        corners = np.array([len(part.order) for part in self.samples])[sample]
        self._order = _ordered(corners, order)
        if whole:
            self.connectivity, self.offsets = np.arange(self.points), np.append(0, np.cumsum(corners[order]))
        else:
            # the last point of an element begins no line
            last = np.cumsum(corners[order]) - 1
            first = np.setdiff1d(np.arange(self.points), last, assume_unique=True)
            self.connectivity, self.offsets = np.column_stack([first, first + 1]).ravel(), 2 * np.arange(len(first) + 1)

    def warn_of_unknown_stress(self) -> None:
        """Warn of beams whose stress is left out, or nan beside that of others."""
        unknown = sorted({number for part in self.samples for number in part.unknown})
        warn_of_unknown_stress(self.beams, unknown, "left out" if len(unknown) == len(self.beams) else "nan")

    def names(self, solution: Solution) -> list[str]:
        """Return the fields that there are."""
        parts = [part.arrays(solution, slice(1)) for part in self.samples]
        return [*(name for name in self._known(parts) if name != "points"), *([_ERROR] if solution.static else [])]

    def arrays(self, solution: Solution, rows: slice) -> dict[str, np.ndarray]:
        """Return the fields at all points, (steps, points) and (steps, points, 3 or 6), of some rows of a solution.

        A stress that is known nowhere is left out, and so are what `content` does not name and, unless it names them,
        the stress tensors of bodies.
        """
        asked = _ERROR in (self.content.fields or ())
        parts = [part.arrays(solution, rows, asked) for part in self.samples]
        chosen = self.content.chosen(self._known(parts))
        if self.whole and self.content.fields is None:
            chosen = [name for name in chosen if name not in _TENSORS]
        result = {name: self._joined([part[name] for part in parts]) for name in chosen}
        at_rest = self._joined([part.by_cell(part.reference[None]) for part in self.samples])
        return self.content.finished(result, at_rest)

    def _known(self, parts: Sequence[dict[str, np.ndarray]]) -> list[str]:
        """Return the names of the arrays of samples but for a stress that is known nowhere."""
        known = {name for part in self.samples for name, told in part.known.items() if told}
        return [name for name in parts[0] if "stress" not in name or name in known]

    def _joined(self, parts: Sequence[np.ndarray]) -> np.ndarray:
        """Return values (steps, points, ...) of all samples in the order of the cells."""
        values = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)
        return values if self._order is None else values[:, self._order]


def _ordered(counts: np.ndarray, order: np.ndarray) -> np.ndarray | None:
    """Return the points of elements with so many points each, put in another order; None if it is the same."""
    if np.array_equal(order, np.arange(len(order))):
        return None
    first, own = np.cumsum(counts) - counts, counts[order]
    return np.repeat(first[order] - np.cumsum(own) + own, own) + np.arange(int(own.sum()))


def _materials(model: Model) -> list[Material | None]:
    """Return the materials of beams and layers; last, so that lines count as bodies do, None for what has its own."""
    materials: list[Material | None] = []
    for beam in model.beams:
        layers = beam.section.layers if isinstance(beam.section, Layered) else ()
        materials += [layer.material for layer in layers] or [beam.material]
    lines = [None for beam in model.beams if beam.material is None or isinstance(beam.section, Layered)]
    return [*(material for material in materials if material is not None), *lines]


def _numbered(items: Sequence[Any], among: Sequence[Any]) -> tuple[list[Any], np.ndarray]:
    """Return different ones of some items in the order of their first, and the place of each item among them."""
    first: dict[Any, Any] = {}
    for item in among:
        first.setdefault(by_value(item), item)
    places = {key: number for number, key in enumerate(first)}
    return list(first.values()), np.array([places[by_value(item)] for item in items])


def legend_of_beams(beams: Sequence[Beam]) -> dict[str, list[str]]:
    """Return the names of beams as the legend of their numbers, nothing where none has a name."""
    return {"beams": names(beams)} if any(beam.name is not None for beam in beams) else {}


def times(at: np.ndarray) -> np.ndarray:
    """Return what ParaView takes for time: `at` where it rises, else the numbers of the rows."""
    return at if np.all(np.diff(at) > 0.0) else np.arange(len(at), dtype=float)
