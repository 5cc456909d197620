"""Materials, sections and functions of a model file."""

from collections.abc import Callable
from inspect import signature
from typing import Any

from beamfem.cli.modelfile.functions import FUNCTIONS
from beamfem.cli.modelfile.named import Named, value_by
from beamfem.cli.modelfile.own_parts import build_own_or_kind, own_code
from beamfem.cli.modelfile.table import Kinds, Reader, Table, build
from beamfem.cli.modelfile.varying import VaryingList, varying
from beamfem.material import Material
from beamfem.section import Circle, Layer, Layered, Rectangle, Section, Tube

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


def materials(root: Table) -> Named:
    """Return the materials of a file."""
    return Named("material", root.named("materials"), {}, lambda table: build(table, Material))


def sections(root: Table, material: Named, function: Named) -> Named:
    """Return the sections of a file; layers use its materials, numbers may be functions of the arc length."""
    value = value_by(function)

    def layers(table: Table, key: str) -> Any:
        make_layer = varying(Layer)
        result = [build(layer, make_layer, {"material": material, "thickness": value}) for layer in table.tables(key)]
        return VaryingList(tuple(result)) if any(map(callable, result)) else result

    readers: dict[str, Reader] = {"layers": layers} | dict.fromkeys(_NUMBERS, value)
    kinds = {kind: varying(make) for kind, make in SECTIONS.items()}
    types: dict[Any, Reader] = {Material: material, Callable: value}

    def make(table: Table) -> Any:
        return build_own_or_kind(table, kinds, readers, types)

    return Named("section", root.named("sections"), {}, make, kinds)


def functions(root: Table) -> Named:
    """Return the functions of a file."""

    def make(table: Table) -> Any:
        types: dict[Any, Reader] = {Callable: value_by(result)}
        return build_own_or_kind(table, FUNCTIONS, {"function": own_code}, types)

    result = Named("function", root.named("functions"), {}, make, FUNCTIONS)
    return result
