"""Curves to draw for a model file: one quantity of a point over another, over time or over the load factor."""

from dataclasses import dataclass
from pathlib import Path

from beamfem.cli.modelfile.found import Analysis
from beamfem.cli.modelfile.outputs import require_supported
from beamfem.cli.modelfile.places import Places
from beamfem.cli.modelfile.quantities import QUANTITIES
from beamfem.cli.modelfile.table import Table, build
from beamfem.cli.targets import below, require_target
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.validation import require_known
from beamfem.view.curve import ENERGIES, OF_SECTION

Quantity = str | tuple[str, Point]


@dataclass(frozen=True)
class OutputCurve:
    """A picture of y over x: each a name and a point, or "load_factor", "time", or an energy of the model."""

    file: Path
    x: Quantity
    y: Quantity

    def __post_init__(self) -> None:
        require_target("curve", self.file)

    def draw(self, solution: Solution) -> None:
        """Write the picture."""
        solution.plot_curve(self.x, self.y, self.file)


def curves(root: Table, places: Places, model: Model, analysis: Analysis) -> tuple[OutputCurve, ...]:
    """Return the curves that a file asks for. Raises ModelFileError."""
    axis = "time" if analysis.moving else "load_factor"

    def file(table: Table, key: str) -> Path:
        try:
            return below(table.source.file.parent, table.text(key))
        except InputError as error:
            raise table.error(str(error), key) from None

    def quantity(table: Table, key: str) -> Quantity:
        if not isinstance(table.values[key], dict):
            name = table.text(key)
            if name not in (axis, *ENERGIES):
                raise table.error(
                    f'must be "{axis}" or {{ point = ..., quantity = ... }}, or an energy of the model: '
                    f'{", ".join(ENERGIES)}; got "{name}"',
                    key,
                )
            return name
        of_point = table.table(key)
        name, point = build(of_point, _of_point, {"point": places.point})
        require_supported(of_point, "quantity", model, point, [name])
        return name, point

    result = []
    for table in root.tables("curves"):
        if not analysis.states:
            raise table.error("this analysis has no states to draw a curve of; curves need static, path or dynamics")
        result.append(build(table, OutputCurve, {"file": file, "x": quantity, "y": quantity}))
    return tuple(result)


def _of_point(point: Point, quantity: str) -> tuple[str, Point]:
    known = (*QUANTITIES, *OF_SECTION)
    if not isinstance(quantity, str):
        raise InputError(f"quantity must be one of {', '.join(known)}, got {quantity!r}")
    require_known(f"there is no quantity {quantity!r} of a point", quantity, known)
    return quantity, point
