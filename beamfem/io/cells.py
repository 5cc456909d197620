"""The cells of ParaView files: bodies or centrelines of all beams, and what is written of them."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from beamfem.errors import UnknownStressWarning
from beamfem.io.samples import Samples, body, centreline
from beamfem.model.classes import by_value
from beamfem.model.model import Model
from beamfem.validation import flag, one_of, require_known, shown

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

Geometry = Literal["deformed", "reference"]
# numbers of cell types, from vtkCellType.h
VERTEX, POLY_LINE, LAGRANGE_QUADRILATERAL = 1, 4, 70
_NAMED = 10  # beams that a warning names


@dataclass(frozen=True)
class Content:
    """What files hold: points of the deformed or the reference geometry, which fields, numbers of 4 or 8 bytes."""

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


WHOLE = Content()


class Grid(Protocol):
    """What is written: cells of one type that share no points, the fields at the points, and numbers of the cells."""

    @property
    def cell_type(self) -> int:
        """Number of the type of the cells in VTK."""
        ...

    @property
    def points(self) -> int:
        """Number of points."""
        ...

    @property
    def offsets(self) -> np.ndarray:
        """First point of each cell, and the number of points."""
        ...

    @property
    def degrees(self) -> np.ndarray | None:
        """Degrees of the Lagrange cells (cells, 3), None for other cells."""
        ...

    @property
    def numbers(self) -> dict[str, np.ndarray]:
        """Cell data (cells,) by name."""
        ...

    @property
    def legend(self) -> dict[str, list[str]]:
        """What numbers of cells stand for, by name."""
        ...

    def arrays(self, solution: "Solution", rows: slice) -> dict[str, np.ndarray]:
        """Return points and fields (steps, points) and (steps, points, 3 or 6) of some rows of a solution."""
        ...


class Cells:
    """The cells of all beams of one kind, one an element and layer, which shares no points with others.

    alike: of one degree in both directions; readers of VTKHDF files before VTK 9.7 take no others.
    """

    def __init__(self, model: Model, whole: bool, alike: bool = False, content: Content = WHOLE) -> None:
        self.whole, self.meshes, self.content = whole, model.meshes, content
        by_beam = [body(mesh, alike) if whole else centreline(mesh) for mesh in model.meshes]
        self.samples: Sequence[Samples] = [part for parts in by_beam for part in parts]
        numbers = [number for number, parts in enumerate(by_beam) for _ in parts]
        cells = [len(part.element) for part in self.samples]
        self.beam = np.repeat(numbers, cells)
        self.materials, material = _distinct([part.material for part in self.samples])
        self.sections, section = _distinct([part.mesh.beam.section for part in self.samples])
        self.material, self.section = np.repeat(material, cells), np.repeat(section, cells)
        self.layer = np.repeat([part.layer or 0 for part in self.samples], cells)
        self.degree = np.repeat([(part.points.pieces, part.across) for part in self.samples], cells, axis=0)
        self.cell_type = LAGRANGE_QUADRILATERAL if whole else POLY_LINE
        self.offsets = np.append(0, np.cumsum(np.repeat([len(part.order) for part in self.samples], cells)))

    @property
    def points(self) -> int:
        """Number of points."""
        return int(self.offsets[-1])

    @property
    def degrees(self) -> np.ndarray | None:
        """Degrees of the Lagrange cells (cells, 3), None for lines."""
        if not self.whole:
            return None
        return np.column_stack([self.degree, np.ones(len(self.degree))]).astype(float)

    @property
    def numbers(self) -> dict[str, np.ndarray]:
        """Cell data (cells,) by name: beam, material and section, and the layer of bodies from the bottom up."""
        numbers = {"beam": self.beam, "material": self.material, "section": self.section}
        return numbers | {"layer": self.layer} if self.whole else numbers

    @property
    def legend(self) -> dict[str, list[str]]:
        """What the numbers of materials and sections stand for, by name."""
        return {"materials": list(map(_written, self.materials)), "sections": list(map(_written, self.sections))}

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

    def names(self, solution: "Solution") -> list[str]:
        """Return the fields that there are."""
        return [name for name in self.arrays(solution, slice(1)) if name != "points"]

    def arrays(self, solution: "Solution", rows: slice) -> dict[str, np.ndarray]:
        """Return the fields at all points, (steps, points) and (steps, points, 3 or 6), of some rows of a solution.

        A stress that is known nowhere is left out, and so is what `content` does not name.
        """
        parts = [part.arrays(solution, rows) for part in self.samples]
        known = {name for part in self.samples for name, told in part.known.items() if told}
        names = [name for name in parts[0] if "stress" not in name or name in known]
        chosen = self.content.chosen(names)
        found = {name: np.concatenate([part[name] for part in parts], axis=1) for name in chosen}
        if self.content.geometry == "reference":
            still = np.concatenate([part.at_rest for part in self.samples], axis=1)
            found["points"] = np.repeat(still, len(found["points"]), axis=0)
        return by_precision(found, self.content)


def by_precision(arrays: dict[str, np.ndarray], content: Content) -> dict[str, np.ndarray]:
    """Return arrays with numbers of four bytes where `content` asks for them."""
    return {name: values.astype(np.float32) for name, values in arrays.items()} if content.single else arrays


def _distinct(items: Sequence[Any]) -> tuple[list[Any], list[int]]:
    """Return different items in the order of their first, and the number of each."""
    first: dict[Any, Any] = {}
    for item in items:
        first.setdefault(by_value(item), item)
    places = {key: number for number, key in enumerate(first)}
    return list(first.values()), [places[by_value(item)] for item in items]


def _written(part: Any) -> str:
    if part is None:
        return "of the section"
    return "varies along the beam" if callable(part) else str(part)


def times(at: np.ndarray) -> np.ndarray:
    """Return what ParaView takes for time: `at` where it rises, else the numbers of the rows."""
    return at if np.all(np.diff(at) > 0.0) else np.arange(len(at), dtype=float)
