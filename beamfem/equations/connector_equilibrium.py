"""Equations of an equilibrium with connectors, as a routine that compiled Newton iterations call."""

from collections.abc import Callable
from ctypes import CFUNCTYPE, c_int64, c_void_p, cast
from typing import Any

import numpy as np

from beamfem.equations.assembler import Assembler
from beamfem.equations.callbacks import Deferred, KeptErrors
from beamfem.equations.equations import STATICS, add_coupled
from beamfem.equations.system import System
from beamfem.kernels import model_passes

_Balance = CFUNCTYPE(None, c_int64)


class ConnectedBalance:
    """Assembles residual and band matrix, and adds the forces of connectors and their tangents to them.

    load_factor: of the iteration; address: of the routine. An error of a connector is kept, and the residual becomes
    nan, which ends the iteration.
    """

    def __init__(
        self, system: System, assembler: Assembler, p: np.ndarray, residual: np.ndarray, matrix: np.ndarray
    ) -> None:
        self._system, self._assembler, self._zeros = system, assembler, np.zeros(len(p))
        self._p, self._residual, self._matrix = p, residual, matrix
        self._errors, self.load_factor = KeptErrors(), 0.0
        self._function = _Balance(self._balance)
        self.address = int(cast(self._function, c_void_p).value or 0)

    def call(self, driver: Callable[..., Any], *arguments: int) -> Any:
        """Call a compiled driver and return its result. Raises the error of a connector or a section law in it."""
        with Deferred() as deferred:
            result = driver(*arguments)
        errors = self._errors.take(), self._assembler.take_error()
        deferred.deliver()
        for error in errors:
            if error is not None:
                raise error
        return result

    def _balance(self, equations: int) -> None:
        """See `model_passes.balance`."""
        try:
            model_passes.balance.compiled(equations)
            connectors, motion = self._system.called, (self._p, self._zeros, self._zeros)
            connectors.add_forces(self._residual, motion, self.load_factor)
            if self._assembler.record.tangent:
                add_coupled(self._system, self._matrix, connectors.tangents(motion, self.load_factor, STATICS))
        except BaseException as error:
            self._errors.keep(error)
            self._residual[:] = np.nan
