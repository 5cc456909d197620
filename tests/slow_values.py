"""Parameters of tests of which most values are left to the slow verification."""

import pytest


def mostly_slow(names, values, quick=(0,), **options):
    """Parametrise a test of which only the values at the indices `quick` are not slow."""
    several = not isinstance(names, str)
    return pytest.mark.parametrize(
        names,
        [
            pytest.param(*(value if several else [value]), marks=() if index in quick else pytest.mark.slow)
            for index, value in enumerate(values)
        ],
        **options,
    )
