"""Parts at points as compiled code takes them: a record for each kind, with a row of numbers for each part."""

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from beamfem.assembly.connectors import Connector
from beamfem.kernels.record import Parts
from beamfem.physics.compiled_connections import passes_of
from beamfem.physics.connections import Connection


def records_of(parts: Iterable[tuple[Connector, np.ndarray]]) -> list[Parts]:
    """Return the records of compiled parts, each given with the positions (n, n) of its tangent's entries, or -1."""
    kinds: defaultdict[Connection, list[tuple[Connector, np.ndarray]]] = defaultdict(list)
    for item, places in parts:
        assert item.compiled is not None
        kinds[item.compiled].append((item, places))
    records = []
    for connection, alike in kinds.items():
        first, (force, tangent) = alike[0][0], passes_of(connection)
        record = Parts(
            count=len(alike),
            coordinates=len(first.dofs),
            per_point=first.per_point,
            multipliers=len(first.own),
            unknowns=len(first.all),
            numbers=np.array([item.all for item, _ in alike], dtype=np.int64),
            data_size=len(first.data),
            data=np.array([item.data for item, _ in alike], dtype=float),
            history_size=len(first.memory),
            history=np.array([item.memory for item, _ in alike], dtype=np.int64),
            places=np.array([places for _, places in alike], dtype=np.int64),
            force=force,
            tangent=tangent,
        )
        records.append(record)
    return records
