"""Memory that compiled code works in during one solve, kept for the next one, of whatever model.

Fresh memory costs more than a small solve: the system clears it, page by page.
"""

import numpy as np

_LARGEST = 1_000_000  # numbers of what is kept
_MOST = 4
_kept: list[np.ndarray] = []


def lend(size: int) -> np.ndarray:
    """Return memory of at least some numbers that nobody else has; what it holds means nothing."""
    try:
        found = _kept.pop()
    except IndexError:
        return np.zeros(size)
    return found if len(found) >= size else np.zeros(size)


def take_back(memory: np.ndarray) -> None:
    """Keep memory for the next solve, if it is small."""
    if len(memory) <= _LARGEST and len(_kept) < _MOST:
        _kept.append(memory)
