"""The page of a convergence study."""

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from beamfem.convergence.convergence_figure import plot_errors
from beamfem.convergence.convergence_result import EXPLANATION
from beamfem.tables import Rows, cells
from beamfem.view.html_page import Entry, Part, Table, write_page

if TYPE_CHECKING:
    from beamfem.convergence.convergence_result import Convergence


def write_study(study: "Convergence", path: str | PathLike[str]) -> Path:
    """Write one self-contained HTML file with the picture and the tables; return its path."""
    with TemporaryDirectory() as folder:
        picture = Path(folder) / "errors.svg"
        plot_errors(study, picture)
        reference = "Richardson extrapolation" if study.reference is None else f"the reference {study.reference!r}"
        found = f"Errors against {reference}. {EXPLANATION}"
        entry = Entry(study.error_name.capitalize(), picture, claim="", found=found)
        summary = _table("Curves", *study.summary())
        points = _table("Points", *study.points(rounded=True))
        failed = [Table("Failed calls", ("parameters", "error"), [(f.label, f.error) for f in study.failures])] * bool(
            study.failures
        )
        text = f"{study.function}() called with {study.refine} refined; {len(study.failures)} calls failed."
        return write_page(
            path, study.title, [Part("Picture", text, [entry]), Part("Numbers", "", tables=[summary, points, *failed])]
        )


def _table(title: str, header: Sequence[str], rows: Rows) -> Table:
    return Table(title, header, cells(rows))
