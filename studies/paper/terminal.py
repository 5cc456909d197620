"""A study's part of the page as text."""

from beamfem.tables import as_text
from beamfem.view.html_page import Part


def show(part: Part) -> None:
    """Print the tables of a part, with their remarks."""
    print(f"{part.heading}\n{part.text}")
    for table in part.tables:
        print(f"\n{as_text(table.header, table.rows, title=table.title)}")
        if table.remark:
            print(table.remark)
