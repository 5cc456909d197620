"""Sparsity pattern of a matrix, and the positions of entries in its data."""

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csc_array


def sparsity_pattern(numbers: Sequence[np.ndarray], unknown: int) -> tuple[csc_array, list[np.ndarray]]:
    """Return the sparsity pattern of matrices with equation numbers (ne, k), and the positions of their entries.

    It includes the diagonal.
    """
    rows, columns, masks = [], [], []
    for number in (table.astype(np.int32) for table in numbers):
        i, j = np.broadcast_arrays(number[:, :, None], number[:, None, :])
        mask = (i >= 0) & (j >= 0)
        rows.append(i[mask])
        columns.append(j[mask])
        masks.append(mask)
    diagonal = np.arange(unknown, dtype=np.int32)
    row, column = np.concatenate([*rows, diagonal]), np.concatenate([*columns, diagonal])
    order = _sorted_by(row, unknown)
    order = order[_sorted_by(column[order], unknown)]
    row, column = row[order], column[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (row[1:] != row[:-1]) | (column[1:] != column[:-1])
    position = np.empty(len(order), dtype=np.int32)
    position[order] = np.cumsum(new, dtype=np.int32) - 1
    starts = np.concatenate([[0], np.cumsum(np.bincount(column[new], minlength=unknown))])
    entries = np.ones(int(new.sum()), dtype=np.int8), row[new], starts.astype(np.int32)
    slots, begin = [], 0
    for mask in masks:
        end = begin + int(mask.sum())
        slot = np.full(mask.shape, -1, dtype=np.int32)
        slot[mask] = position[begin:end]
        slots.append(slot)
        begin = end
    return csc_array(entries, shape=(unknown, unknown)), slots


def _sorted_by(keys: np.ndarray, count: int) -> np.ndarray:
    """Return the stable sorting order of keys (n,) below a count, in linear time."""
    single = np.arange(len(keys) + 1, dtype=np.int32)
    # with one column per key, the conversion from CSC to CSR is a counting sort
    return csc_array((np.ones(len(keys), dtype=np.int8), keys, single), shape=(count, len(keys))).tocsr().indices
