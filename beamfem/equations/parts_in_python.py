"""Parts at points whose forces Python computes, in a record like those of compiled parts: their pass is a callback."""

from collections.abc import Iterable
from ctypes import CFUNCTYPE, c_int64, c_void_p, cast

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.callbacks import KeptErrors
from beamfem.equations.connectors import Connector
from beamfem.kernels.compiler.value_types import REALS
from beamfem.kernels.record import Parts, System
from beamfem.kernels.records import memory_at

_MOST = 64  # places in memory of which views are kept, which are most of the cost of a call
_Add = CFUNCTYPE(None, c_int64, c_int64)


class PartsInPython:
    """Such parts, each given with the positions (u, u) of its tangent's entries in the matrix, -1 for none.

    record: for compiled code. An error of a part is kept, and the residual becomes nan, which ends any iteration.
    """

    def __init__(self, parts: Iterable[tuple[Connector, np.ndarray]], size: int) -> None:
        self._parts = [(item, places >= 0, places[places >= 0]) for item, places in parts]
        self._zeros, self._errors, self._function = np.zeros(size), KeptErrors(), _Add(self._add)
        self._views, self._records = dict[tuple[int, int], np.ndarray](), dict[int, System]()
        self.record = Parts(add=int(cast(self._function, c_void_p).value or 0))

    def take_error(self) -> BaseException | None:
        """Return the first error of this thread since the last call, if there is one."""
        return self._errors.take()

    def _seen(self, own: System, name: str, size: int) -> np.ndarray:
        """Return the first numbers (size,) of an array of a record, where compiled code has it now."""
        address = int(own.memory[System.fields[name].place])
        if (address, size) not in self._views:
            self._views[address, size] = memory_at(address, REALS, size)
        return self._views[address, size]

    def _add(self, parts: int, system: int) -> None:
        """See `connection_passes.add_parts`."""
        if len(self._views) > _MOST:
            self._views.clear()
            self._records.clear()
        if system not in self._records:
            self._records[system] = System.at(system)
        own, n = self._records[system], len(self._zeros)
        residual = self._seen(own, "residual", n)
        try:
            if self._errors.waiting:
                raise LinAlgError
            v, a = (
                self._seen(own, x, n) if wanted else self._zeros for x, wanted in (("v", own.rated), ("a", own.moving))
            )
            motion, time = (self._seen(own, "p", n), v, a), own.time
            gravity = self._seen(own, "body", 2)  # of the first beam: it acts on all mass
            for item, _, _ in self._parts:
                np.add.at(residual, item.all, item.force_in(motion, time, gravity))
            if own.tangent:
                weights, matrix = (own.weight_p, own.weight_v, own.weight_a), self._seen(own, "matrix", own.entries)
                for item, mask, places in self._parts:
                    np.add.at(matrix, places, item.tangent(motion, time, gravity, weights)[mask])
        except BaseException as error:
            residual[:] = np.nan
            if not isinstance(error, LinAlgError):  # of a tangent that is not finite
                self._errors.keep(error)
            elif own.tangent:
                self._seen(own, "matrix", own.entries)[:] = np.nan
