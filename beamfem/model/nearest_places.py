"""The nearest of ascending numbers, by bisection, so that many places on a long beam are found in little time."""

import numpy as np


def nearest(ascending: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the number (n,) of the nearest of ascending numbers to each value (n,), the first of equally near ones."""
    after = np.minimum(np.searchsorted(ascending, values), len(ascending) - 1)
    before = np.searchsorted(ascending, ascending[np.maximum(after - 1, 0)])
    return np.where(np.abs(ascending[before] - values) <= np.abs(ascending[after] - values), before, after)


def distances(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the distance (n,) of each value (n,) to the nearest place (m,), infinite if there are no places."""
    if not len(places):
        return np.full(len(values), np.inf)
    ascending = np.sort(places)
    return np.abs(ascending[nearest(ascending, values)] - values)
