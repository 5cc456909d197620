"""Parts at points in the form that compiled code expects: a table for each kind, a row of numbers for each part."""

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from beamfem.assembly.connectors import Connector
from beamfem.kernels import connection_passes as passes
from beamfem.kernels.pointers import address_of
from beamfem.physics.compiled_connections import passes_of
from beamfem.physics.connections import Connection


class ConnectionTable:
    """Compiled parts, each with the positions (n, n) of its tangent's entries in the matrix, -1 for those without one.

    table (kinds, fields): see `kernels.connection_passes`.
    """

    def __init__(self, parts: Iterable[tuple[Connector, np.ndarray]]) -> None:
        kinds: defaultdict[Connection, list[tuple[Connector, np.ndarray]]] = defaultdict(list)
        for item, places in parts:
            assert item.compiled is not None
            kinds[item.compiled].append((item, places))
        self.table = np.zeros((len(kinds), passes.FIELDS), dtype=np.int64)
        self._kept: list[np.ndarray] = []
        for row, (connection, alike) in zip(self.table, kinds.items(), strict=True):
            first, compiled = alike[0][0], passes_of(connection)
            arrays = (
                np.array([item.all for item, _ in alike], dtype=np.int64),
                np.array([item.data for item, _ in alike], dtype=float),
                np.array([places for _, places in alike], dtype=np.int64),
            )
            self._kept += arrays
            row[[passes.NUMBERS, passes.DATA, passes.PLACES]] = [address_of(array) for array in arrays]
            row[[passes.COUNT, passes.DATA_SIZE]] = arrays[1].shape
            row[passes.COORDINATES], row[passes.MULTIPLIERS] = len(first.dofs), len(first.own)
            row[passes.PER_POINT] = first.per_point
            row[[passes.FORCE, passes.TANGENT_PASS]] = compiled.force.address, compiled.tangent.address
