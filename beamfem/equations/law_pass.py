"""A section law as a pass over rows of points that compiled code can call, see `kernels.linear_law`."""

from ctypes import CFUNCTYPE, c_int64, c_void_p, cast
from typing import Any

import numpy as np

from beamfem.equations.callbacks import KeptErrors
from beamfem.errors import InputError
from beamfem.kernels.compiler.value_types import REALS
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import POINT_ROWS, RESULTANT, STIFFNESS, STRAIN
from beamfem.kernels.records import memory_at
from beamfem.kernels.user_law import MOST_HISTORY, user_resultants
from beamfem.section.law import THICKNESS, ConstitutiveLaw

_MEASURES = 4  # stretch, shear, curvature and thickness stretch; a law has only the first three
_PAIRS = np.array([(i, j) for i in range(_MEASURES) for j in range(i, _MEASURES)]).T
_KNOWN = np.flatnonzero((_PAIRS < 3).all(axis=0))
_ENTRIES = len(_PAIRS[0])
_Pass = CFUNCTYPE(None, *(c_int64,) * 6, *(c_void_p,) * 4)
_Past = tuple[np.ndarray, float]  # committed history variables (count, k), and the time step since then [s]
_NOTHING: _Past = (np.empty((0, 0)), 0.0)


class LawPass:
    """A section law that compiled code calls by its address.

    points: number of points of an element where it acts; thickness: whether thickness stretch, which laws do not have,
    is resisted, by the linear stiffness in the tables of the compiled code.

    A law in C is called without Python, see `kernels.user_law`; results still call its functions in Python.

    An error in a user's function cannot propagate through compiled code: it is stored, the resultants become nan, which
    stops any iteration, and `take_error` returns it.
    """

    def __init__(self, law: ConstitutiveLaw, points: int, thickness: bool) -> None:
        self._law, self._points, self._thickness = law, points, thickness
        self._errors = KeptErrors()
        self._pass, self.fields, compiled = _Pass(self._fill), dict[str, Any](), law.compiled
        self.in_python, self.address = compiled is None, int(cast(self._pass, c_void_p).value or 0)
        if len(law.start) > MOST_HISTORY and compiled is not None:
            raise InputError(f"{law.name} has more than {MOST_HISTORY} history variables, too many for a law in C")
        if compiled is not None:
            self.address = user_resultants.address
            self.fields = {"law_acts": points, "thickens": thickness, "user_law": compiled[0], "law_data": compiled[1]}

    def linearised(
        self, strain: np.ndarray, history: np.ndarray, stiffness: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (ne, nq, 4) and their derivatives (ne, nq, 4, 4), see `kernels.block.Law`."""
        acting = strain[:, : self._points, :3]
        shape, flat = acting.shape, acting.reshape(-1, 3)
        resultants, slope = self._law.linearised(flat, history.reshape(len(flat), -1))
        result, slopes = np.zeros(strain.shape), np.zeros(stiffness.shape)
        slopes[..., THICKNESS, THICKNESS] = stiffness[..., THICKNESS, THICKNESS]
        result[..., THICKNESS] = slopes[..., THICKNESS, THICKNESS] * strain[..., THICKNESS]
        result[:, : self._points, :3] = resultants.reshape(shape)
        slopes[:, : self._points, :3, :3] = slope.reshape(*shape, 3)
        return result, slopes

    def take_error(self) -> BaseException | None:
        """Return the first error of this thread since the last call, if there is one."""
        return self._errors.take()

    def _fill(
        self, group: int, system: int, first: int, point: int, count: int, stiff: int, w: int, c: int, eps0: int, x: int
    ) -> None:
        """See `kernels.linear_law`."""
        try:
            own = _rows(x, POINT_ROWS)[:, :count]
            try:
                weights, natural = _rows(w, 1)[0, :count], _rows(eps0, _MEASURES)[:, :count]
                own[RESULTANT : RESULTANT + _MEASURES] = 0.0
                if stiff:
                    own[STIFFNESS : STIFFNESS + _ENTRIES] = 0.0
                if self._thickness:
                    thickness = weights * _rows(c, _ENTRIES)[_ENTRIES - 1, :count]
                    own[RESULTANT + THICKNESS] = thickness * (own[STRAIN + THICKNESS] - natural[THICKNESS])
                    if stiff:
                        own[STIFFNESS + _ENTRIES - 1] = thickness
                if point < self._points:
                    past = _NOTHING
                    if self._law.remembers:
                        state, history = System.at(system), Group.at(group).history
                        past = state.p[history[first : first + count, point]], state.since_committed
                    self._fill_rows(own, weights, natural[:3], past, stiff != 0)
            except BaseException:
                own[RESULTANT : RESULTANT + _MEASURES] = np.nan
                raise
        except BaseException as error:
            self._errors.keep(error)

    def _fill_rows(self, own: np.ndarray, weight: np.ndarray, natural: np.ndarray, past: _Past, tangent: bool) -> None:
        strain = np.ascontiguousarray((own[STRAIN : STRAIN + 3] - natural).T)
        if not tangent:
            own[RESULTANT : RESULTANT + 3] = weight * self._law.resultants(strain, *past).T
            return
        resultants, slope = self._law.linearised(strain, *past)
        own[RESULTANT : RESULTANT + 3] = weight * resultants.T
        own[STIFFNESS + _KNOWN] = weight * slope[:, _PAIRS[0, _KNOWN], _PAIRS[1, _KNOWN]].T


def _rows(address: int, count: int) -> np.ndarray:
    """Return rows of floats at an address (count, ROW)."""
    return memory_at(address, REALS, count, ROW)
