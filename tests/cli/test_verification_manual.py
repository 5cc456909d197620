"""Cases of the verification manual: differences from references are as small as it says."""

import csv

import pytest

from studies.verification import manual

LONG = {"catenary", "lee", "timoshenko"}


@pytest.mark.parametrize(
    "solve",
    [pytest.param(case, marks=pytest.mark.slow if case.__name__ in LONG else ()) for case in manual.CASES],
    ids=lambda case: case.__name__,
)
def test_a_case_is_as_near_to_its_reference_as_expected(solve, tmp_path):
    case = solve()
    assert len(case.values) > 0
    for value in case.values:
        assert value.difference < case.within, f"{value.name}: {value.computed} instead of {value.reference}"
    part = case.part(tmp_path)
    assert part.entries[0].picture.stat().st_size > 1000
    assert [row[0] for row in part.tables[0].rows] == [value.name for value in case.values]


def test_references_are_written_with_all_digits(tmp_path):
    cases = [manual.CASES[0](), manual.CASES[2]()]
    manual.write_references(cases, tmp_path / "references.csv")
    with open(tmp_path / "references.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    expected = [(case.title, value.name, value.reference) for case in cases for value in case.values]
    assert [(row["case"], row["quantity"], float(row["value"])) for row in rows] == expected
