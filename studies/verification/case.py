"""A case of the verification manual, and its part of the page."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import beamfem as bf
from beamfem.view.html_page import Entry, Part, Table

Draw = Callable[[Path], object]


class Value(NamedTuple):
    """A quantity with its unit, its reference value, the computed one, and what their difference is compared with.

    size: by default the reference, or 1 if it is 0.
    """

    name: str
    reference: float
    computed: float
    size: float | None = None

    @property
    def difference(self) -> float:
        """Relative difference."""
        return abs(self.computed - self.reference) / (self.size or abs(self.reference) or 1.0)


@dataclass(frozen=True)
class Case:
    """A problem with independent values; draw: writes its picture; within: the differences that are expected."""

    title: str
    problem: str
    source: str
    model: bf.Model
    values: tuple[Value, ...]
    draw: Draw
    within: float = 1e-6

    @property
    def mesh(self) -> str:
        """Elements of the model, such as "8 x CRBF-4"."""
        kinds = Counter(f"{beam.elements} x {beam.element.name}" for beam in self.model.beams)
        return ", ".join(f"{beams} beams of {kind}" if beams > 1 else kind for kind, beams in kinds.items())

    def part(self, folder: Path) -> Part:
        """Draw the case into a folder and return its part of a page."""
        name = self.title.lower().replace(" ", "_").replace("'", "")
        picture = folder / f"{name}.svg"
        self.draw(picture)
        header = ["quantity", "reference", "beamfem", "difference"]
        rows = [[v.name, f"{v.reference:.10g}", f"{v.computed:.10g}", f"{v.difference:.0e}"] for v in self.values]
        table = Table(f"Mesh: {self.mesh}", header, rows, f"Differences below {self.within:g} are expected.")
        return Part(self.title, self.problem, [Entry("Reference", picture, "", self.source)], [table])
