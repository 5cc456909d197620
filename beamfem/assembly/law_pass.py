"""A law of a section as a pass over rows of points that compiled code calls, see `kernels.linear_law`."""

from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p, cast
from typing import Any

import numpy as np

from beamfem.kernels.point import POINT_ROWS, RESULTANT, STIFFNESS, STRAIN
from beamfem.kernels.record import ROW
from beamfem.section.law import ElasticLaw

_MEASURES = 4  # stretch, shear, curvature and thickness stretch, which a law does not see
_PAIRS = np.array([(i, j) for i in range(_MEASURES) for j in range(i, _MEASURES)]).T
_KNOWN = np.flatnonzero((_PAIRS < 3).all(axis=0))
_Pass = CFUNCTYPE(None, c_int64, c_int64, *(c_void_p,) * 4)


class LawPass:
    """A law with an address.

    An error in a user's function cannot pass through compiled code: it is kept, resultants become nan, which ends any
    iteration, and `raise_error` raises it.
    """

    def __init__(self, law: ElasticLaw) -> None:
        self._law = law
        self._errors: list[BaseException] = []
        self._pass = _Pass(self._fill)
        self.address = int(cast(self._pass, c_void_p).value or 0)

    def linearised(self, strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (..., 4) and their derivatives (..., 4, 4) at strains (..., 4)."""
        shape = strain.shape[:-1]
        found, slope = self._law.linearised(strain[..., :3].reshape(-1, 3))
        result, stiffness = np.zeros((*shape, _MEASURES)), np.zeros((*shape, _MEASURES, _MEASURES))
        result[..., :3], stiffness[..., :3, :3] = found.reshape(*shape, 3), slope.reshape(*shape, 3, 3)
        return result, stiffness

    def raise_error(self) -> None:
        """Raise the first error since the last call, if there is one."""
        if self._errors:
            first = self._errors[0]
            self._errors.clear()
            raise first

    def _fill(self, count: int, tangent: int, weight: int, c: int, reference: int, x: int) -> None:
        try:
            own = _rows(x, POINT_ROWS)[:, :count]
            try:
                self._fill_rows(own, _rows(weight, 1)[0, :count], _rows(reference, 3)[:, :count], tangent != 0)
            except BaseException:
                own[RESULTANT : RESULTANT + _MEASURES] = np.nan
                raise
        except BaseException as error:
            self._errors.append(error)

    def _fill_rows(self, own: np.ndarray, weight: np.ndarray, reference: np.ndarray, tangent: bool) -> None:
        strain = np.ascontiguousarray((own[STRAIN : STRAIN + 3] - reference).T)
        own[RESULTANT + 3] = 0.0
        if not tangent:
            own[RESULTANT : RESULTANT + 3] = weight * self._law.resultants(strain).T
            return
        found, slope = self._law.linearised(strain)
        own[RESULTANT : RESULTANT + 3] = weight * found.T
        own[STIFFNESS : STIFFNESS + len(_PAIRS[0])] = 0.0
        own[STIFFNESS + _KNOWN] = weight * slope[:, _PAIRS[0, _KNOWN], _PAIRS[1, _KNOWN]].T


def _rows(address: int, count: int) -> np.ndarray:
    """Return rows of numbers at an address (count, ROW)."""
    memory: Any = (c_double * (count * ROW)).from_address(address)
    return np.frombuffer(memory).reshape(count, ROW)
