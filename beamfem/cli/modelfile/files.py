"""Files to write for a model file: results, pictures, pages and films, each with its options."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Protocol

import numpy as np

from beamfem.assembly.system import System
from beamfem.cli.modelfile.analyses import Modes
from beamfem.cli.modelfile.found import Analysis, Found
from beamfem.cli.modelfile.places import Places
from beamfem.cli.modelfile.table import Kinds, Reader, Table, build_kind
from beamfem.cli.targets import below, require_target
from beamfem.errors import InputError
from beamfem.io.boundary import Boundary
from beamfem.io.cells import Cells, Content
from beamfem.io.description import describe
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.along import QUANTITIES
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics
from beamfem.validation import count, flag, items, one_of, positive, require_known, text

_TARGETS = {"results": "out", "vtk": "vtk", "film": "film", "page": "page", "body": "body"}
_HISTORY = ("displacement", "ux", "uy", "position", "velocity", "rotation", "force", "reaction_moment", "energy")


class OutputFile(Protocol):
    """Interface of files to write; require: raises InputError if a model or an analysis cannot provide the data."""

    @property
    def file(self) -> Path: ...
    def require(self, model: Model, analysis: Analysis) -> None: ...
    def write(self, found: Found) -> None: ...


class _OfAny:
    """A file of any model and analysis."""

    def require(self, model: Model, analysis: Analysis) -> None:
        """Accept every model and analysis."""


@dataclass(frozen=True)
class Results(_OfAny):
    """Model and states (.h5)."""

    file: Path

    def require(self, model: Model, analysis: Analysis) -> None:
        """Reject parts that cannot be saved."""
        require_saved(model)

    def write(self, found: Found) -> None:
        found.solution.save(self.file)


@dataclass(frozen=True)
class Vtk(_OfAny):
    """Bodies, centrelines, supports and loads for ParaView (.pvd, .vtkhdf); every: every n-th state."""

    file: Path
    geometry: Literal["deformed", "reference"] = "deformed"
    fields: Sequence[str] | None = None
    single: bool = False
    every: int = 1

    def __post_init__(self) -> None:
        Content(self.geometry, None, self.single)
        count("every", self.every)
        if self.fields is not None:
            items("fields", self.fields)

    def require(self, model: Model, analysis: Analysis) -> None:
        """Reject unknown fields."""
        if self.fields is not None:
            moving = analysis.moving or isinstance(analysis, Modes)
            content = Content(fields=tuple(self.fields))
            known = Cells(model, True).names(_at_rest(model, not moving))
            content.require_known([*known, *Boundary(model, content).names])

    def write(self, found: Found) -> None:
        selected = found.solution if self.every == 1 else found.solution[:: self.every]
        selected.to_vtk(self.file, geometry=self.geometry, fields=self.fields, single=self.single)


@dataclass(frozen=True)
class Plot(_OfAny):
    """Deformed shapes (.png, .svg, .pdf)."""

    file: Path
    colour: str | None = None
    shapes: int | None = None
    undeformed: bool = True
    supports: bool = True
    loads: bool = True

    def __post_init__(self) -> None:
        _check_colour(self.colour)
        if self.shapes is not None:
            count("shapes", self.shapes)
        _check_flags(self)

    def write(self, found: Found) -> None:
        options: dict[str, Any] = {name: value for name, value in vars(self).items() if name != "file"}
        found.solution.plot(self.file, **options)


@dataclass(frozen=True)
class Film(_OfAny):
    """The moving body (.gif, .mp4)."""

    file: Path
    fps: float = 15.0
    seconds: float = 4.0
    colour: str | None = None
    undeformed: bool = True
    supports: bool = True
    loads: bool = True
    dpi: int = 100

    def __post_init__(self) -> None:
        positive("fps", self.fps)
        positive("seconds", self.seconds)
        _check_colour(self.colour)
        count("dpi", self.dpi)
        _check_flags(self)

    def write(self, found: Found) -> None:
        options: dict[str, Any] = {name: value for name, value in vars(self).items() if name != "file"}
        found.solution.animate(self.file, **options)


@dataclass(frozen=True)
class Page(_OfAny):
    """A page with a slider over the states (.html)."""

    file: Path
    title: str | None = None
    frames: int = 60

    def __post_init__(self) -> None:
        count("frames", self.frames)
        if self.title is not None:
            text("title", self.title)

    def write(self, found: Found) -> None:
        found.solution.to_html(self.file, title=self.title, frames=self.frames)


@dataclass(frozen=True)
class Body(_OfAny):
    """The solid body in a state (.png); row: which, from 1, by default the last; size: pixels."""

    file: Path
    row: int | None = None
    colour: str | None = None
    size: Sequence[int] = (1400, 900)

    def __post_init__(self) -> None:
        _check_colour(self.colour)
        if self.row is not None:
            count("row", self.row)
        if not isinstance(self.size, list | tuple) or len(self.size) != 2:
            raise InputError(f"size must be two numbers of pixels, such as [1400, 900], got {self.size}")
        for pixels in self.size:
            count("size", pixels)

    def write(self, found: Found) -> None:
        number = len(found.solution) if self.row is None else self.row
        if number > len(found.solution):
            raise InputError(f"{self.file}: row is {number}, but there are {len(found.solution)} states")
        width, height = self.size
        found.solution.picture(self.file, row=number - 1, colour=self.colour, size=(width, height))


@dataclass(frozen=True)
class History:
    """A quantity of points over the states, or "energy" (.png, .svg, .pdf); see `Solution.plot_history`."""

    file: Path
    points: Sequence[Point] = ()
    quantity: str = "displacement"

    def __post_init__(self) -> None:
        require_known(f"there is no quantity {self.quantity!r} to draw over the states", self.quantity, _HISTORY)
        if bool(self.points) == (self.quantity == "energy"):
            raise InputError('points are needed, or quantity = "energy", which is of the whole model')

    def require(self, model: Model, analysis: Analysis) -> None:
        """Reject analyses without states to draw."""
        _require_states(analysis)

    def write(self, found: Found) -> None:
        found.solution.plot_history(list(self.points) or None, self.quantity, self.file)


@dataclass(frozen=True)
class LoadDisplacement:
    """The load factor over a displacement, with limit points and bifurcations (.png, .svg, .pdf)."""

    file: Path
    point: Point
    quantity: str = "uy"

    def __post_init__(self) -> None:
        one_of("quantity", self.quantity, ("ux", "uy", "rotation"))

    def require(self, model: Model, analysis: Analysis) -> None:
        """Reject analyses without load factors."""
        _require_states(analysis)
        if analysis.moving:
            raise InputError("a motion has no load factor to draw; these go with static and path")

    def write(self, found: Found) -> None:
        found.solution.plot_load_displacement(self.point, self.quantity, self.file)


@dataclass(frozen=True)
class Shapes:
    """The first `most` modes of buckling or vibration (.png, .svg, .pdf)."""

    file: Path
    most: int = 6

    def __post_init__(self) -> None:
        count("most", self.most)

    def require(self, model: Model, analysis: Analysis) -> None:
        """Reject analyses without modes."""
        if analysis.states:
            raise InputError("this analysis finds no modes; these go with buckling and modes")

    def write(self, found: Found) -> None:
        if found.modes is not None:
            found.modes.plot(self.file, most=self.most)


@dataclass(frozen=True)
class Undeformed(_OfAny):
    """The model before any solve, with its supports and loads (.png, .svg, .pdf)."""

    file: Path

    def write(self, found: Found) -> None:
        found.solution.model.plot(self.file)


FILES: Kinds = {
    "results": Results,
    "vtk": Vtk,
    "plot": Plot,
    "film": Film,
    "page": Page,
    "body": Body,
    "history": History,
    "load-displacement": LoadDisplacement,
    "mode-shapes": Shapes,
    "model": Undeformed,
}


def files(root: Table, places: Places, model: Model, analysis: Analysis) -> tuple[OutputFile, ...]:
    """Return the files that a model file requests. Raises ModelFileError."""

    def file(table: Table, key: str) -> Path:
        try:
            target = below(table.source.file.parent, table.text(key))
            require_target(_TARGETS.get(table.values["kind"], "curve"), target)
        except InputError as error:
            raise table.error(str(error), key) from None
        return target

    readers: dict[str, Reader] = {
        "file": file,
        "point": places.point,
        "points": places.points,
    }
    result: list[OutputFile] = []
    for table in root.tables("files"):
        result.append(build_kind(table, FILES, readers))
        try:
            result[-1].require(model, analysis)
        except InputError as error:
            raise table.refused(error) from None
        if [other.file for other in result].count(result[-1].file) > 1:
            raise table.error(f"{result[-1].file} is written twice", "file")
    return tuple(result)


def require_saved(model: Model) -> None:
    """Raise InputError if a model has parts that cannot be saved in a results file."""
    describe(model, np.zeros(1))


def _at_rest(model: Model, static: bool) -> Solution:
    """Return the stress-free model as a solution of one row, which has the names of all fields."""
    p = System(model, static).reference[None]
    return Solution(model, static, np.zeros(1), p, np.zeros_like(p), np.zeros_like(p), Statistics(0, 0, 0, ""))


def _check_colour(colour: str | None) -> None:
    if colour is not None:
        require_known(f"colour has no {colour!r}", colour, QUANTITIES)


def _check_flags(shown: Plot | Film) -> None:
    for name in ("undeformed", "supports", "loads"):
        flag(name, getattr(shown, name))


def _require_states(analysis: Analysis) -> None:
    if not analysis.states:
        raise InputError("this analysis has no states to draw; these go with static, path and dynamics")
