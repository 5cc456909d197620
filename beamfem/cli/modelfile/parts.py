"""Materials, sections, elements, curves and functions of a model file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from inspect import signature
from pathlib import Path
from typing import Any

from beamfem.cli.modelfile.drawing import from_drawing
from beamfem.cli.modelfile.functions import FUNCTIONS
from beamfem.cli.modelfile.table import Reader, Table, build, build_kind, shown
from beamfem.cli.modelfile.varying import varying
from beamfem.curves import Arc, BSpline, Chain, Line, Polyline, elliptic_arc
from beamfem.element.element import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, ShearRigid
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Forces, SplitContinuum, Structural
from beamfem.material import Material
from beamfem.section import Circle, Layer, Layered, Rectangle, Section, Tube
from beamfem.validation import nearest

Kinds = Mapping[str, Callable[..., Any]]


def _continuum(plane_stress: bool = False) -> Forces:
    return ContinuumMechanics(plane_stress)


def _split() -> Forces:
    return SplitContinuum()


def _elastic_line() -> Forces:
    return ElasticLine()


def _structural() -> Forces:
    return Structural()


FORCES: Kinds = {
    "continuum": _continuum,
    "split-continuum": _split,
    "elastic-line": _elastic_line,
    "structural": _structural,
}
ELEMENTS: Kinds = {kind.__name__: kind for kind in (ANCF, ANCFCRBF, BilinearANCF, BilinearCRBF, CRBF, ShearRigid)}
CURVES: Kinds = {
    "line": Line,
    "arc": Arc,
    "elliptic-arc": elliptic_arc,
    "polyline": Polyline,
    "bspline": BSpline,
    "chain": Chain,
    "dxf": from_drawing,
}
SECTIONS: Kinds = {
    "rectangle": Rectangle,
    "circle": Circle,
    "tube": Tube,
    "moments": Section,
    "stiffness": Section.from_stiffness,
    "layered": Layered,
}
# numbers of sections, which may be functions of the arc length
_NUMBERS = {key for kind in SECTIONS.values() for key in signature(kind).parameters} - {"layers"}


@dataclass(frozen=True)
class Named:
    """Parts that a file gives a name, to be used by it; each is made once."""

    kind: str
    tables: Mapping[str, Table]
    made: dict[str, Any]
    make: Callable[[Table], Any]
    short: tuple[str, ...] = ()  # kinds that need no further keys, so that their name alone will do

    def __call__(self, table: Table, key: str) -> Any:
        """Return the part at a key: a name, a table of its own, or a kind alone. Raises ModelFileError."""
        value = table.values[key]
        if isinstance(value, dict):
            return self.make(table.table(key))
        if not isinstance(value, str):
            raise table.error(f"must be a name or a table, got {shown(value)}", key)
        if value in self.tables:
            return self.part(value)
        if value in self.short:
            return self.make(Table(table.source, (*table.path, key), {"kind": value}))
        raise table.error(f"there is no {self.kind} {value!r}; {nearest(value, [*self.tables, *self.short])}", key)

    def part(self, name: str) -> Any:
        if name not in self.made:
            self.made[name] = self.make(self.tables[name])
        return self.made[name]

    def check_all(self) -> None:
        """Make every part, so that a mistake in one that is not used is found too."""
        for name in self.tables:
            self.part(name)


def materials(root: Table) -> Named:
    """Return the materials of a file."""
    return Named("material", root.named("materials"), {}, lambda table: build(table, Material))


def elements(root: Table) -> Named:
    """Return the elements of a file; presets go without a name as well."""
    forces = Named("kind of forces", {}, {}, lambda table: build_kind(table, FORCES, {}), tuple(FORCES))
    readers = {"forces": forces}
    short = tuple(name for name in ELEMENTS if name != "CRBF")

    def make(table: Table) -> Any:
        return build_kind(table, ELEMENTS, readers)

    return Named("element", root.named("elements"), {}, make, short)


def sections(root: Table, material: Named, function: Named) -> Named:
    """Return the sections of a file; layers use its materials, numbers may be functions of the arc length."""

    def layers(table: Table, key: str) -> list[Layer]:
        return [build(layer, Layer, {"material": material}) for layer in table.tables(key)]

    readers: dict[str, Reader] = {"layers": layers} | dict.fromkeys(_NUMBERS, value_by(function))
    kinds = {kind: varying(make) for kind, make in SECTIONS.items()}
    return Named("section", root.named("sections"), {}, lambda table: build_kind(table, kinds, readers))


def functions(root: Table) -> Named:
    """Return the functions of a file."""
    return Named("function", root.named("functions"), {}, lambda table: build_kind(table, FUNCTIONS, {}))


def value_by(function: Named) -> Reader:
    """Return what reads a number, or a function by name or as a table."""

    def value(table: Table, key: str) -> Any:
        given = table.values[key]
        if isinstance(given, bool) or not isinstance(given, int | float | str | dict):
            raise table.error(f"must be a number, or a function by name or as a table, got {shown(given)}", key)
        if isinstance(given, str) and given not in function.tables:
            known = nearest(given, function.tables) if function.tables else "the file has none"
            raise table.error(f"must be a number or the name of a function, got {shown(given)}; {known}", key)
        return given if isinstance(given, int | float) else function(table, key)

    return value


def curve(table: Table, key: str) -> Any:
    """Return the curve at a key. Raises ModelFileError."""

    def parts(chain: Table, name: str) -> list[Any]:
        return [build_kind(part, CURVES, readers) for part in chain.tables(name)]

    def file(drawing: Table, name: str) -> Path:
        return drawing.source.file.parent / drawing.text(name)

    readers: dict[str, Reader] = {"curves": parts, "file": file}
    return build_kind(table.table(key), CURVES, readers)
