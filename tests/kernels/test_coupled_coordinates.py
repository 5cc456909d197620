"""Coordinates that parts at points couple."""

import numpy as np
import pytest

from beamfem.physics.compiled_connections import in_python
from beamfem.physics.connections import CONNECTIONS, TURNING


@pytest.mark.parametrize("connection", CONNECTIONS, ids=lambda connection: connection.name)
def test_x_and_y_are_coupled_but_where_rotations_alone_act(connection):
    """In states anywhere, with each coordinate and rate moved on its own; conditions are coupled with all of them."""
    rng, acts = np.random.default_rng(1), np.zeros(connection.size, dtype=bool)
    own = connection.multipliers + connection.prescribed
    for _ in range(50):
        q, v, a = 2.0 * rng.standard_normal((3, connection.size))
        multipliers, gravity = rng.standard_normal(own), rng.standard_normal(2)
        data = rng.uniform(0.1, 1.0, len(connection.data) + len(connection.memory))

        def force(q, v, a, data=data, multipliers=multipliers, gravity=gravity):
            angles = q[2::3] if connection.coordinates == 3 else q[:0]
            turned, out = np.column_stack([np.cos(angles), np.sin(angles)]).ravel(), np.zeros(connection.size + own)
            in_python(connection)(q, v, a, multipliers, turned, data, gravity, out)
            return out

        before = force(q, v, a)
        acts |= before[: connection.size] != 0.0
        for number in range(connection.size):
            step = np.eye(connection.size)[number]
            acts[number] |= any((force(*moved) != before).any() for moved in ((q + step, v, a), (q, v + step, a)))
    in_plane = np.arange(connection.size) % connection.coordinates < 2
    assert (acts[in_plane] == (connection not in TURNING)).all()
