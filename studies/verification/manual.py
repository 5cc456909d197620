"""The verification manual: a page with every case, and its reference values as a table for other codes.

python -m studies.verification.manual
"""

import csv
from collections.abc import Callable
from pathlib import Path

from beamfem.atomic_write import whole
from beamfem.view.html_page import Part, Table, write_page
from studies.verification import motion, stability, statics, vibration
from studies.verification.case import Case

CASES: tuple[Callable[[], Case], ...] = (*statics.CASES, *stability.CASES, *vibration.CASES, *motion.CASES)
OUT = Path("out/verification")


def summary(cases: list[Case]) -> Part:
    """Return a table of the largest difference of each case."""
    rows = [
        [case.title, case.source, case.mesh, f"{max(value.difference for value in case.values):.0e}"] for case in cases
    ]
    text = "Published values, closed forms, and values computed without beam elements, beside what beamfem gives."
    return Part(
        "All cases", text, [], [Table("Largest differences", ["case", "reference", "mesh", "difference"], rows)]
    )


def write_references(cases: list[Case], path: Path) -> None:
    """Write the reference values as CSV."""
    with whole(path) as partial, open(partial, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["case", "problem", "source", "quantity", "value"])
        for case in cases:
            table.writerows([case.title, case.problem, case.source, v.name, float(v.reference)] for v in case.values)


def main(folder: Path = OUT) -> list[Case]:
    """Compute every case, write the page and the table, and return the cases."""
    cases = [case() for case in CASES]
    write_references(cases, folder / "references.csv")
    parts = [summary(cases), *(case.part(folder / "figures") for case in cases)]
    print("open", write_page(folder / "index.html", "Verification manual", parts))
    return cases


if __name__ == "__main__":
    main()
