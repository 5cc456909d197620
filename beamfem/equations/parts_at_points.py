"""Parts at points as compiled code takes them, in a record for each kind.

Those of the package are evaluated by compiled passes, with a row of numbers for each part, and others by Python: their
pass is a callback.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from ctypes import CFUNCTYPE, c_int64, c_void_p, cast
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.bound_connector import Connector
from beamfem.equations.callbacks import KeptErrors
from beamfem.equations.equation_numbering import Unknowns
from beamfem.equations.model_coordinates import COORDINATES
from beamfem.kernels.compiler.value_types import REALS
from beamfem.kernels.connection_passes import add_parts, commit
from beamfem.kernels.model_record import Parts, System
from beamfem.kernels.records import memory_at
from beamfem.model.model import Model
from beamfem.parts.at_points import ANALYTIC
from beamfem.physics.compiled_connections import in_python, passes_of, remembering
from beamfem.physics.connections import COORDINATE_SPRING, Connection

_IMAGINARY = 1e-30j  # step of complex differences, which are exact
_SLACK = 1e-9  # of a depth, ten times what is remembered of it in excess


class Alike(NamedTuple):
    """Parts of one kind: numbers (n, u) of coordinates and unknowns, history (n, h), and data (n, k).

    places (n, u, u): positions of the entries of their tangents in the matrix, -1 for none; alternatives: rows that
    each part has, one at a time; position_step: see `kernels.model_record.Parts`.
    """

    connection: Connection
    numbers: np.ndarray
    data: np.ndarray
    history: np.ndarray
    places: np.ndarray
    alternatives: int = 1
    position_step: int = 0

    @property
    def record(self) -> Parts:
        """The record that compiled code takes."""
        coordinates, (force, tangent, root) = self.connection.size, passes_of(self.connection)
        remember = remembering(self.connection)
        return Parts(
            count=len(self.numbers) // self.alternatives,
            alternatives=self.alternatives,
            rows=len(self.numbers),
            position_step=self.position_step,
            coordinates=coordinates,
            rotations=self.connection.points if self.connection.coordinates == 3 else 0,
            multipliers=self.numbers.shape[1] - coordinates,
            unknowns=self.numbers.shape[1],
            data_size=self.data.shape[1],
            history_size=self.history.shape[1],
            force=force,
            tangent=tangent,
            root=root,
            add=add_parts,
            **({} if remember is None else {"remember": remember, "commit": commit}),
            **{name: np.ascontiguousarray(getattr(self, name)) for name in ("numbers", "data", "history", "places")},
        )

    def forces(self, p: np.ndarray) -> np.ndarray:
        """Return the resisting forces (..., n, u) at rest in states p (..., n); none may be of rotations."""
        q = np.moveaxis(p[..., self.numbers], -1, 0)
        out, still = np.empty_like(q), np.zeros_like(q)
        in_python(self.connection)(q, still, still, (), (), self.data.T, (0.0, 0.0), out)
        return np.moveaxis(out, 0, -1)

    def potential(self, p: np.ndarray) -> np.ndarray:
        """Return the potential (...) [J] in states p (..., n)."""
        if not len(self.numbers):
            return np.zeros(p.shape[:-1])
        q = np.moveaxis(p[..., self.numbers], -1, 0)
        points = list(q.reshape(self.connection.points, self.connection.coordinates, *q.shape[1:]))
        assert self.connection.potential is not None
        return np.asarray(self.connection.potential(points, self.data.T, (0.0, 0.0), ANALYTIC).sum(axis=-1))

    def kinks(self, q: np.ndarray, v: np.ndarray, history: np.ndarray, changed: np.ndarray) -> np.ndarray:
        """Return the numbers (rows, k) whose positive parts forces contain, for its coordinates and rates (rows, n, u).

        Forces have kinks where these change their sign, and those of a part that dissipates where its rate is 0, as it
        sticks or turns back. history (rows, n, h): at the start of the step; changed (rows, n, h): whether it changes
        in it.
        """
        own, rows, found = self.connection, q.shape[:2], [np.empty((len(q), 0))]

        def positive(x: np.ndarray) -> np.ndarray:
            found.append(np.broadcast_to(x, rows))
            return np.asarray(ANALYTIC.positive(x))

        if self.alternatives == 1:
            f = ANALYTIC._replace(positive=positive, rate=np.zeros_like)
            q, v = (np.moveaxis(x, -1, 0) for x in (q, v))
            # a state that is at its deepest is remembered by a hair deeper, which it does not have to pass again
            slack = [1.0 - _SLACK * ("deepest" in name) for name in own.memory]
            places, data = own.split(q), [*self.data.T, *np.moveaxis(history * slack, -1, 0)]
            if own.potential is not None:
                own.potential(places, data, (0.0, 0.0), f)
            if own.force is not None:
                own.force(places, own.split(v), [*data, *q[own.size :]], f)
            if own.along is not None and own.memory:
                rate = own.along(own.split(q + _IMAGINARY * v), data, ANALYTIC).imag / _IMAGINARY.imag
                dissipates = changed[..., own.memory.index("dissipated") if "dissipated" in own.memory else 0]
                found.append(np.where(dissipates, rate, 0.0))
        return np.concatenate(found, axis=1)

    def changes(self, q: np.ndarray, v: np.ndarray, history: np.ndarray) -> np.ndarray:
        """Return whether history (rows, n, h) would change in a step to coordinates and rates (rows, n, u)."""
        own = self.connection
        if own.remember is None:
            return np.zeros(history.shape, dtype=bool)
        q, v, before = (np.moveaxis(x, -1, 0) for x in (q, v, history))
        data = [*self.data.T, *before, *q[own.size :]]
        after = own.remember(own.split(q), own.split(v), data, ANALYTIC)
        return np.moveaxis(np.array([now != then for now, then in zip(after, before, strict=True)]), 0, -1)


def springs_to_ground(model: Model, unknowns: Unknowns, reference: np.ndarray) -> Alike:
    """Return the springs of supports, which are unstressed at the coordinates `reference` (n,)."""
    found = []
    for support in model.point_supports:
        if springs := support.springs():
            mesh = model.mesh_of(support.point)
            dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            found += [(dofs[COORDINATES[direction]], stiffness) for direction, stiffness in springs.items()]
    numbers, stiffness = (np.array([row[i] for row in found], dtype=kind) for i, kind in enumerate((np.int64, float)))
    places = unknowns.free[numbers]
    places[places >= 0] = unknowns.diagonal(places[places >= 0])
    data, none = np.column_stack([stiffness, reference[numbers]]), np.empty((len(found), 0), dtype=np.int64)
    return Alike(COORDINATE_SPRING, numbers[:, None], data, none, places[:, None, None])


def by_kind(parts: Iterable[tuple[Connector, Sequence[np.ndarray]]], size: int) -> "list[Alike | PartsInPython]":
    """Return parts by kind, each given with the positions (u, u) of the entries of each row in the matrix, or -1.

    size: number of coordinates.
    """
    kinds: defaultdict[tuple[Connection | None, int], list[tuple[Connector, Sequence[np.ndarray]]]] = defaultdict(list)
    for item, places in parts:
        kinds[item.definition, len(places)].append((item, places))
    called = [(item, places[0]) for item, places in kinds.pop((None, 1), [])]
    found: list[Alike | PartsInPython] = [
        Alike(
            connection,
            np.array([row.numbers for item, _ in some for row in item.rows], dtype=np.int64),
            np.array([row.data for item, _ in some for row in item.rows], dtype=float),
            np.array([item.memory for item, _ in some], dtype=np.int64),
            np.array([own for _, places in some for own in places], dtype=np.int64),
            alternatives,
            some[0][0].position_step,
        )
        for (connection, alternatives), some in kinds.items()
        if connection is not None
    ]
    return [*found, PartsInPython(called, size)] if called else found


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
            weights = own.weight_p, own.weight_v, own.weight_a
            for item, mask, places in self._parts:
                if own.tangent:
                    force, tangent = item.linearised(motion, time, gravity, weights)
                    np.add.at(self._seen(own, "matrix", own.entries), places, tangent[mask])
                else:
                    force = item.force_in(motion, time, gravity)
                np.add.at(residual, item.all, force)
        except BaseException as error:
            residual[:] = np.nan
            if not isinstance(error, LinAlgError):  # of a tangent that is not finite
                self._errors.keep(error)
            elif own.tangent:
                self._seen(own, "matrix", own.entries)[:] = np.nan
