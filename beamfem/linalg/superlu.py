"""Factors of sparse matrices by SuperLU, which is only given matrices that it can factorise."""

from typing import Any

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.csgraph import structural_rank
from scipy.sparse.linalg import SuperLU, splu

from beamfem.linalg.lapack import LinAlgError


def superlu(matrix: csc_array, full_diagonal: bool = False, **settings: Any) -> SuperLU:
    """Return the factors of a square sparse matrix; settings: see `scipy.sparse.linalg.splu`.

    SuperLU reads and writes outside of its arrays, up to the death of the process, if entries are not finite, or if
    zeros that are not stored make the matrix singular whatever the values of the others are. full_diagonal: all
    diagonal entries are stored, so that there are no such zeros to look for. Raises LinAlgError.
    """
    if not np.isfinite(matrix.data).all():
        raise LinAlgError("a matrix has numbers that are not finite")
    if not full_diagonal and structural_rank(matrix) < matrix.shape[0]:
        raise LinAlgError("the tangent is singular")
    try:
        return splu(matrix, **settings)
    except RuntimeError as error:
        raise LinAlgError("the tangent is singular") from error
