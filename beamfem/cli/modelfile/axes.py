"""Axes of beams of a model file, and the elements along them."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from beamfem.cli.modelfile.drawing import from_drawing
from beamfem.cli.modelfile.own_parts import build_own_or_kind, own_code
from beamfem.cli.modelfile.table import Kinds, Reader, Table, build_kind, in_braces
from beamfem.curves import Arc, BSpline, Chain, Line, Parametric, Polyline, elliptic_arc, spline_through_hermite
from beamfem.model.grading import graded

CURVES: Kinds = {
    "line": Line,
    "arc": Arc,
    "elliptic-arc": elliptic_arc,
    "polyline": Polyline,
    "bspline": BSpline,
    "hermite": spline_through_hermite,
    "chain": Chain,
    "parametric": Parametric,
    "dxf": from_drawing,
}
MESHES: Kinds = {"graded": graded}


def curve(table: Table, key: str) -> Any:
    """Return the curve at a key. Raises ModelFileError."""

    def make(one: Table) -> Any:
        return build_own_or_kind(one, CURVES, readers, {})

    def parts(chain: Table, name: str) -> list[Any]:
        return [make(part) for part in chain.tables(name)]

    def file(drawing: Table, name: str) -> Path:
        return drawing.source.file.parent / drawing.text(name)

    readers: dict[str, Reader] = {"curves": parts, "file": file, "function": own_code, "derivative": own_code}
    kind = table.values[key]
    if isinstance(kind, str) and kind in CURVES:
        raise table.error(f"must be a table: {in_braces(kind, CURVES[kind])}", key)
    return make(table.table(key))


def elements_along(table: Table, key: str) -> int | Sequence[float] | str:
    """Return `elements` of a beam: a number, fractions, "knots" or a graded mesh. Raises ModelFileError."""
    value = table.values[key]
    if isinstance(value, dict):
        value = build_kind(table.table(key), MESHES, {})
    elif isinstance(value, bool):
        raise table.error("must be a number, an array or a text, got " + str(value).lower(), key)
    return value
