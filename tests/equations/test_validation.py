"""Limits of what is checked: the last value that passes and the first that does not."""

import pytest

import beamfem as bf
from beamfem.validation import count, number_below, shown


def test_counts_end_where_floats_no_longer_count():
    assert count("n", 2**53) == 2**53
    with pytest.raises(bf.InputError, match=r"n must be at most 2\^53"):
        count("n", 2**53 + 1)


def test_numbers_below_a_size_begin_at_the_lowest():
    assert [number_below("n", value, 3, -3) for value in (-3, 2)] == [-3, 2]
    for value in (-4, 3):
        with pytest.raises(bf.InputError, match="n must be between -3 and 2"):
            number_below("n", value, 3, -3)


def test_a_long_value_is_cut_in_a_message():
    assert shown("x" * 198) == repr("x" * 198)  # 200 characters with its quotation marks
    assert shown("x" * 199) == repr("x" * 199)[:200] + "..."
