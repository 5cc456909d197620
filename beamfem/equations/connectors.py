"""All connectors of a model: forces, tangents, energies, momenta, conditions and history."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import coo_array, csr_array

from beamfem.cached_properties import cached_property
from beamfem.equations.bound_connector import COMPLEX_STEP, Connector, Motion
from beamfem.equations.connector_nodes import checked_connectors
from beamfem.equations.connector_traits import follows_time, resists_rates
from beamfem.equations.equation_numbering import Mesh
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.model.contribution import is_one_sided, remembered
from beamfem.model.load_base import factor
from beamfem.model.model import Model

SHORT_TIME = 1e-4  # [s] of the differences that give rates of conditions
_FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0  # functions of time need not be defined before the start
_ROUND_OFF = 1e-13  # relative to the largest stiffness of a contribution
_NO_NUMBERS, _NOTHING = np.empty(0, dtype=np.int64), np.empty(0)


@dataclass(frozen=True, eq=False)
class Connectors:
    """All connectors of a model.

    left_out (d,): numbers of the multipliers of redundant conditions, which are no unknowns.
    """

    model: Model
    static: bool
    items: tuple[Connector, ...]
    left_out: np.ndarray = field(default_factory=lambda: _NO_NUMBERS)

    @cached_property
    def every_multiplier(self) -> np.ndarray:
        """Numbers of all multipliers."""
        return np.concatenate([_NO_NUMBERS, *(item.multipliers for item in self.items)])

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Numbers (k,) of the multipliers that are unknowns."""
        every = self.every_multiplier
        return every[~np.isin(every, self.left_out)] if len(self.left_out) else every

    @cached_property
    def one_sided(self) -> np.ndarray:
        """Numbers (k,) of the multipliers whose conditions come and go."""
        return np.concatenate([_NO_NUMBERS, *(item.multipliers for item in self.items if is_one_sided(item.item))])

    def gradients(self, p: np.ndarray, load_factor: float) -> csr_array:
        """Return the gradients (k, n) of the conditions that come and go, in a state p (n,)."""
        zeros, gravity, size = np.zeros(len(p)), np.zeros(2), (len(self.one_sided), len(p))
        entries, places, first = [_NOTHING], [np.empty((2, 0), dtype=np.int64)], 0
        for item in (each for each in self.items if is_one_sided(each.item)):
            d = len(item.dofs)
            rates = item.tangent((p, zeros, zeros), load_factor, gravity, (1.0, 0.0, 0.0))[d:, :d]
            row, column = np.indices(rates.shape)
            entries.append(rates.ravel())
            places.append(np.stack([first + row.ravel(), item.dofs[column.ravel()]]))
            first += len(rates)
        return csr_array(coo_array((np.concatenate(entries), tuple(np.concatenate(places, axis=1))), shape=size))

    @property
    def bodies(self) -> list[Mesh]:
        """The parts with amplitudes, as meshes of one element: nodes of three coordinates, and of one."""
        found = []
        for item in (each for each in self.items if len(each.amplitudes)):
            alone = np.column_stack([item.amplitudes, np.full((len(item.amplitudes), 2), -1)])
            dof = np.vstack([item.dofs[: -len(alone)].reshape(-1, 3), alone])
            found.append(Mesh(np.arange(len(dof))[None], dof))
        return found

    @cached_property
    def memory(self) -> np.ndarray:
        """Numbers (h,) of the history variables."""
        return np.concatenate([_NO_NUMBERS, *(item.memory for item in self.items)]) if self.items else _NO_NUMBERS

    @cached_property
    def start(self) -> np.ndarray:
        """Initial values (h,) of the history variables."""
        return np.concatenate([_NOTHING, *(remembered(item.item) for item in self.items)]) if self.items else _NOTHING

    def remember(self, motion: Motion, time: float) -> np.ndarray:
        """Return the history variables (h,) after an accepted step to this state."""
        gravity = self.gravity(time)
        return np.concatenate([np.empty(0), *(item.remember(item.at(motion, time, gravity)) for item in self.items)])

    @property
    def conservative(self) -> bool:
        return all(item.item.conservative for item in self.items)

    @cached_property
    def keep_energy(self) -> bool:
        """Whether no connector adds energy to a motion or dissipates it."""
        return self.conservative and not self.damp and not self.follow_time

    @cached_property
    def follow_time(self) -> bool:
        """Whether a force or a condition depends on time other than by gravity or a prescribed value."""
        return any(any(follows_time(item)) for item in self.items)

    @cached_property
    def conditions_follow_time(self) -> bool:
        """Whether a condition depends on time other than by a prescribed value."""
        return any(follows_time(item)[1] for item in self.items)

    @cached_property
    def driving(self) -> "Connectors":
        """Those whose forces do work; others conserve energy or dissipate it."""

        def drives(item: Connector) -> bool:
            return (not item.item.conservative and not len(item.dissipated)) or any(follows_time(item))

        return Connectors(self.model, self.static, tuple(filter(drives, self.items)))

    @cached_property
    def damp(self) -> bool:
        """Whether a connector resists rates."""
        return any(resists_rates(item) for item in self.items)

    def gravity(self, time: float) -> np.ndarray:
        """Return the acceleration (2,) [m/s^2] of all gravity loads at a time."""
        result = np.zeros(2)
        for load in self.model.gravity:
            result += np.array(load.vector) * factor(load, time, self.static)
        return result

    def add_forces(self, residual: np.ndarray, motion: Motion, time: float) -> None:
        """Add the forces of all connectors to a residual (n,)."""
        gravity = self.gravity(time) if self.items else np.zeros(2)
        for item in self.items:
            np.add.at(residual, item.all, item.force_in(motion, time, gravity))

    def tangents(self, motion: Motion, time: float, weights: Sequence[float]) -> list[np.ndarray]:
        """Return the tangent (d + k, d + k) of each connector for weights of p, p' and p''."""
        gravity = self.gravity(time) if self.items else np.zeros(2)
        return [item.tangent(motion, time, gravity, weights) for item in self.items]

    def energies(self, motion: Motion, times: np.ndarray) -> np.ndarray:
        """Return the total kinetic and potential energy (rows, 2) [J] in motions p, p', p'' (rows, n) at times."""
        result = np.zeros((len(times), 2))
        if not self.items:
            return result
        gravity = np.array([self.gravity(time) for time in times.tolist()]).reshape(-1, 2)
        return sum((item.energies(motion, times, gravity) for item in self.items), result)

    def momenta(self, motion: Motion, time: float) -> np.ndarray:
        """Return the linear momentum [kg m/s] and the angular momentum about the origin [kg m^2/s] (3,)."""
        gravity, result = self.gravity(time), np.zeros(3)
        for item in self.items:
            momenta = np.empty(len(item.dofs))
            for number in range(len(item.dofs)):
                p, v, a = item.own_motion(motion)
                v[number] += 1j * COMPLEX_STEP
                moved = p.real, v, a.real
                momenta[number] = np.imag(item.energy(item.alone.at(moved, time, gravity))[0]) / COMPLEX_STEP
            q = item.by_point(motion[0][item.dofs])
            for (x, y, _), (px, py, turn) in zip(q, item.on_points(momenta, q), strict=False):
                result += px, py, x * py - y * px + turn
        return result

    def conditions(self, p: np.ndarray, rate: np.ndarray, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the residuals (k,) of all conditions in a state p (n,) at a time, and their rates for p' (n,)."""
        zeros, gravity = np.zeros(len(p)), np.zeros(2)
        values, rates = [_NOTHING], [_NOTHING]
        for item in (each for each in self.items if len(each.own)):
            d, motion = len(item.dofs), (p, zeros, zeros)
            rows, moved = slice(d, d + len(item.multipliers)), rate[item.all]
            moved[rows] = 0.0
            values.append(item.force_in(motion, time, gravity)[rows])
            rates.append(item.tangent(motion, time, gravity, (1.0, 0.0, 0.0))[rows] @ moved)
            if item.compiled is None:
                later = [item.force_in(motion, time + k * SHORT_TIME, gravity)[rows] for k in range(len(_FORWARD))]
                rates[-1] += _FORWARD @ later / SHORT_TIME
        return np.concatenate(values), np.concatenate(rates)

    @cached_property
    def errors(self) -> np.ndarray:
        """Residual (2, n) per unit relative error: in positions of 1 m [1/m], and in directions.

        Parts turn: what is stiff along one axis in the reference may be so along another one later.
        """
        result = np.zeros((2, self.model.size))
        if not self.items:
            return result
        for item, stiffness in zip(self.items, self._stiffness, strict=True):
            turns = np.append(item.turns, np.ones(len(item.own), dtype=bool))
            for row, columns in zip(result, (~turns, turns), strict=True):
                values = np.abs(stiffness[:, columns]).sum(axis=1)
                values[~turns] = values[~turns].max(initial=0.0)
                np.add.at(row, item.all, values)
        return result

    def stopped(self) -> list[tuple[Connector, np.ndarray]]:
        """Return each connector with the normalised motions (r, 3 m) of its points that it resists in the reference."""
        result = []
        for item, stiffness in zip(self.items, self._stiffness, strict=True):
            forces = stiffness[: len(item.dofs), : len(item.dofs)].copy()
            # makes moments comparable with forces
            length = max(point.beam.curve.length for point in item.item.points)
            forces[item.turns] /= length
            sizes = np.abs(forces).max(axis=1, initial=0.0)
            forces[sizes <= _ROUND_OFF * sizes.max(initial=0.0)] = 0.0
            conditions = stiffness[len(item.dofs) :, : len(item.dofs)]
            rows = np.vstack([forces, conditions])
            sizes = np.abs(rows).max(axis=1, initial=0.0)
            motions = rows[sizes > 0.0] / sizes[sizes > 0.0, None]
            result.append(
                (item, item.on_points(motions, item.reference).reshape(len(motions), 3 * len(item.item.points)))
            )
        return result

    @cached_property
    def _stiffness(self) -> list[np.ndarray]:
        """Tangent of each connector in the reference."""
        p, zeros = np.zeros(self.model.size), np.zeros(self.model.size)
        for item in self.items:
            p[item.dofs] = item.undeformed
        p[self.memory] = self.start
        try:
            return self.tangents((p, zeros, zeros), 0.0, (1.0, 0.0, 0.0))
        except LinAlgError as error:
            raise InputError(f"{error} in the reference: a number of it is too large or too small") from error


def connectors_of(model: Model, static: bool) -> Connectors:
    """Return the connectors of a model with their coordinates. Raises InputError for wrong shapes."""
    if not model.at_points:
        return Connectors(model, static, ())
    if "connectors" not in model.tables:  # checked once for statics and motions
        model.tables["connectors"] = checked_connectors(model)
    return Connectors(model, static, model.tables["connectors"])


def same_connectors(own: Connectors, others: Connectors, beams: Mapping[Beam, Beam]) -> dict[Connector, Connector]:
    """Return the connectors of a model that are in another one, too, each with the one there.

    They are the same objects, or equal ones at the same points. beams: those of the model by those of the other one.
    """
    known = {id(item.item): item for item in others.items}
    result = {item: known[id(item.item)] for item in own.items if id(item.item) in known}
    left = [item for item in others.items if item not in result.values()]
    for item in own.items:
        same = None if item in result else next((each for each in left if _same(each.item, item.item, beams)), None)
        if same is not None:
            result[item] = same
            left.remove(same)
    return result


def _same(one: Any, other: Any, beams: Mapping[Beam, Beam]) -> bool:
    """Return whether two parts of different models, or what they hold, are equal; beams: see `same_connectors`."""
    if isinstance(one, Beam):
        return beams.get(one) is other
    if one is other or type(one) is not type(other):
        return one is other
    if is_dataclass(one):
        return all(_same(getattr(one, each.name), getattr(other, each.name), beams) for each in fields(one))
    if isinstance(one, tuple | list):
        return len(one) == len(other) and all(_same(*pair, beams) for pair in zip(one, other, strict=True))
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else bool(one == other)
