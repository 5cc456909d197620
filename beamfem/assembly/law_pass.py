"""A section law as a pass over rows of points that compiled code can call, see `kernels.linear_law`."""

from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p, cast
from math import prod
from typing import Any

import numpy as np

from beamfem.kernels import record
from beamfem.kernels.point import POINT_ROWS, RESULTANT, STIFFNESS, STRAIN
from beamfem.kernels.record import ROW
from beamfem.section.law import ConstitutiveLaw

_MEASURES = 4  # stretch, shear, curvature and thickness stretch; a law has only the first three
_PAIRS = np.array([(i, j) for i in range(_MEASURES) for j in range(i, _MEASURES)]).T
_KNOWN = np.flatnonzero((_PAIRS < 3).all(axis=0))
_Pass = CFUNCTYPE(None, *(c_int64,) * 6, *(c_void_p,) * 4)
_Past = tuple[np.ndarray, float]  # committed history variables (count, k), and the time step since then [s]
_NOTHING: _Past = (np.empty((0, 0)), 0.0)


class LawPass:
    """A section law that compiled code calls by its address.

    An error in a user's function cannot propagate through compiled code: it is stored, the resultants become nan, which
    stops any iteration, and `raise_error` raises it.
    """

    def __init__(self, law: ConstitutiveLaw) -> None:
        self._law = law
        self._errors: list[BaseException] = []
        self._pass = _Pass(self._fill)
        self.address = int(cast(self._pass, c_void_p).value or 0)

    def linearised(self, strain: np.ndarray, history: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (..., 4) and their derivatives (..., 4, 4) at strains (..., 4) and history (..., k)."""
        shape, flat = strain.shape[:-1], strain[..., :3].reshape(-1, 3)
        resultants, slope = self._law.linearised(flat, history.reshape(len(flat), -1))
        result, stiffness = np.zeros((*shape, _MEASURES)), np.zeros((*shape, _MEASURES, _MEASURES))
        result[..., :3], stiffness[..., :3, :3] = resultants.reshape(*shape, 3), slope.reshape(*shape, 3, 3)
        return result, stiffness

    def raise_error(self) -> None:
        """Raise the first error since the last call, if there is one."""
        if self._errors:
            first = self._errors[0]
            self._errors.clear()
            raise first

    def _fill(
        self,
        group: int,
        system: int,
        first: int,
        number: int,
        count: int,
        tangent: int,
        weight: int,
        c: int,
        reference: int,
        x: int,
    ) -> None:
        try:
            point_rows = _rows(x, POINT_ROWS)[:, :count]
            try:
                past = _NOTHING
                if self._law.remembers:
                    past = _past(group, system, slice(first, first + count), number)
                rows = _rows(weight, 1)[0, :count], _rows(reference, 3)[:, :count]
                self._fill_rows(point_rows, *rows, past, tangent != 0)
            except BaseException:
                point_rows[RESULTANT : RESULTANT + _MEASURES] = np.nan
                raise
        except BaseException as error:
            self._errors.append(error)

    def _fill_rows(
        self, own: np.ndarray, weight: np.ndarray, reference: np.ndarray, past: _Past, tangent: bool
    ) -> None:
        strain = np.ascontiguousarray((own[STRAIN : STRAIN + 3] - reference).T)
        own[RESULTANT + 3] = 0.0
        if not tangent:
            own[RESULTANT : RESULTANT + 3] = weight * self._law.resultants(strain, *past).T
            return
        resultants, slope = self._law.linearised(strain, *past)
        own[RESULTANT : RESULTANT + 3] = weight * resultants.T
        own[STIFFNESS : STIFFNESS + len(_PAIRS[0])] = 0.0
        own[STIFFNESS + _KNOWN] = weight * slope[:, _PAIRS[0, _KNOWN], _PAIRS[1, _KNOWN]].T


def _past(group: int, system: int, elements: slice, number: int) -> _Past:
    """Return the committed history at a quadrature point of some elements, and the time step since then."""
    b, s = _wholes(group, record.BLOCK_FIELDS).tolist(), _wholes(system, record.SYSTEM_FIELDS).tolist()
    table = _wholes(b[record.HISTORY], b[record.ELEMENTS], b[record.POINTS], b[record.VARIABLES])
    state, factors = _reals(s[record.COORDINATES_P], s[record.SIZE]), _reals(s[record.FACTORS], record.FACTOR_COUNT)
    return state[table[elements, number]], float(factors[-1])


def _rows(address: int, count: int) -> np.ndarray:
    """Return rows of floats at an address (count, ROW)."""
    return _reals(address, count * ROW).reshape(count, ROW)


def _reals(address: int, count: int) -> np.ndarray:
    """Return floats at an address (count,)."""
    memory: Any = (c_double * count).from_address(address)
    return np.frombuffer(memory)


def _wholes(address: int, *shape: int) -> np.ndarray:
    """Return integers at an address (shape)."""
    memory: Any = (c_int64 * prod(shape)).from_address(address)
    return np.frombuffer(memory, dtype=np.int64).reshape(shape)
