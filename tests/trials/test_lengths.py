"""A part beside the package, with its test, needs no more than 60 lines."""

from pathlib import Path


def test_each_trial_is_a_file_of_at_most_60_lines():
    for file in Path(__file__).parent.glob("test_*.py"):
        assert len(file.read_text().splitlines()) <= 60, file.name
