"""Factorisations by LAPACK and SuperLU."""

from collections.abc import Callable
from ctypes import c_char_p, c_void_p, py_object, pythonapi
from functools import wraps
from typing import Any

import numpy as np
import scipy.linalg
import scipy.linalg.cython_lapack
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dsytrf, dsytrf_lwork
from scipy.sparse import csc_array
from scipy.sparse.csgraph import structural_rank
from scipy.sparse.linalg import SuperLU, splu


def _told_apart(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of scipy that raises LinAlgError instead of ValueError if one of its arrays is not finite."""

    @wraps(function)
    def called(*arguments: Any, **options: Any) -> Any:
        try:
            return function(*arguments, **options)
        except LinAlgError:
            raise
        except ValueError as error:
            arrays = [values for values in (*arguments, *options.values()) if isinstance(values, np.ndarray)]
            if all(np.isfinite(values).all() for values in arrays):
                raise
            raise LinAlgError("a matrix has numbers that are not finite") from error

    return called


cholesky = _told_apart(scipy.linalg.cholesky)
eig = _told_apart(scipy.linalg.eig)
eigh = _told_apart(scipy.linalg.eigh)
null_space = _told_apart(scipy.linalg.null_space)
qr = _told_apart(scipy.linalg.qr)
solve_banded = _told_apart(scipy.linalg.solve_banded)
solve_triangular = _told_apart(scipy.linalg.solve_triangular)
svd = _told_apart(scipy.linalg.svd)


def lapack_address(name: str) -> int:
    """Return the address of a function of LAPACK, which takes pointers only."""
    capsule = scipy.linalg.cython_lapack.__pyx_capi__[name]
    name_of, pointer_of = pythonapi.PyCapsule_GetName, pythonapi.PyCapsule_GetPointer
    name_of.argtypes, name_of.restype = [py_object], c_char_p
    pointer_of.argtypes, pointer_of.restype = [py_object, c_char_p], c_void_p
    return int(pointer_of(capsule, name_of(capsule)))


def symmetric_factors(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the factors L and D (n, n) of a symmetric matrix L D L^T, and the row exchanges (n,), as by dsytrf.

    They are in the lower triangle; exchanges are negative for both rows of a 2 x 2 block of D. Raises LinAlgError if
    entries are not finite.
    """
    if not np.isfinite(matrix).all():
        raise LinAlgError("a matrix has numbers that are not finite")
    work, _ = dsytrf_lwork(len(matrix), lower=1)
    factored, exchanged, _ = dsytrf(matrix, lower=1, lwork=int(work))
    return factored, exchanged


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
