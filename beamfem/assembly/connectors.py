"""Contributions of all connectors of a model to residual and tangent, energies and momenta."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from beamfem.assembly.connector import COMPLEX_STEP, Connector, Motion
from beamfem.assembly.connector_rates import TIMES, follows_time, gravity_of, resists_rates, somewhere_near
from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.model.contribution import remembered, uses_rotations
from beamfem.model.load_base import factor
from beamfem.model.model import Model

_ROUND_OFF = 1e-13  # relative to the largest stiffness of a contribution
_COORDINATES = ("r^x", "r^y", "theta")
_TURNED = np.array([0.0, 0.0, 0.1])  # arbitrary
_NO_NUMBERS, _NOTHING = np.empty(0, dtype=np.int64), np.empty(0)


@dataclass(frozen=True, eq=False)
class Connectors:
    """All connectors of a model."""

    model: Model
    static: bool
    items: tuple[Connector, ...]

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Numbers (k,) of the multipliers."""
        return np.concatenate([_NO_NUMBERS, *(item.own for item in self.items)]) if self.items else _NO_NUMBERS

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
        return self.conservative and not self.damp and not any(any(follows_time(item)) for item in self.items)

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
            np.add.at(residual, item.all, item.force(item.at(motion, time, gravity)).real)

    def tangents(self, motion: Motion, time: float, weights: Sequence[float]) -> list[np.ndarray]:
        """Return the tangent (d + k, d + k) of each connector for weights of p, p' and p''."""
        gravity = self.gravity(time) if self.items else np.zeros(2)
        return [item.tangent(motion, time, gravity, weights) for item in self.items]

    def energies(self, motion: Motion, time: float) -> tuple[float, float]:
        """Return the total kinetic and potential energy [J]."""
        gravity = self.gravity(time)
        energies = [item.energy(item.at(motion, time, gravity)) for item in self.items]
        kinetic, potential = np.array(energies).reshape(-1, 2).real.sum(axis=0).tolist()
        return kinetic, potential

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
            for (x, y), (px, py, turn) in zip(
                item.by_point(motion[0][item.dofs])[:, :2], item.by_point(momenta), strict=True
            ):
                result += px, py, x * py - y * px + turn
        return result

    def conditions(self, p: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the residuals (k,) of all constraint conditions in a state p (n,), and their rates for p' (n,)."""
        zeros, gravity = np.zeros(len(p)), np.zeros(2)
        moved = p + 1j * COMPLEX_STEP * rate
        residuals = [item.force(item.at((moved, zeros, zeros), 0.0, gravity))[len(item.dofs) :] for item in self.items]
        values = np.concatenate(residuals)
        return values.real, values.imag / COMPLEX_STEP

    @cached_property
    def errors(self) -> np.ndarray:
        """Residual (2, n) per unit relative error: in positions of 1 m [1/m], and in directions."""
        result = np.zeros((2, self.model.size))
        if not self.items:
            return result
        for item, stiffness in zip(self.items, self._stiffness, strict=True):
            turns = np.append(item.turns, np.ones(len(item.own), dtype=bool))
            for row, columns in zip(result, (~turns, turns), strict=True):
                np.add.at(row, item.all, np.abs(stiffness[:, columns]).sum(axis=1))
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
            result.append((item, item.by_point(motions).reshape(len(motions), item.reference.size)))
        return result

    @cached_property
    def _stiffness(self) -> list[np.ndarray]:
        """Tangent of each connector in the reference."""
        p, zeros = np.zeros(self.model.size), np.zeros(self.model.size)
        for item in self.items:
            p[item.dofs] = item.undeformed
        p[self.memory] = self.start
        return self.tangents((p, zeros, zeros), 0.0, (1.0, 0.0, 0.0))


def connectors_of(model: Model, static: bool) -> Connectors:
    """Return the connectors of a model with their coordinates. Raises InputError for wrong shapes."""
    if not model.connectors:
        return Connectors(model, static, ())
    if "connectors" not in model.tables:  # checked once for statics and motions
        model.tables["connectors"] = _checked_connectors(model)
    return Connectors(model, static, model.tables["connectors"])


def _checked_connectors(model: Model) -> tuple[Connector, ...]:
    """Return the connectors of a model, evaluated once to check shapes and finite values."""
    first, connectors = model.coordinates, []
    behind = first + sum(item.unknowns for item in model.connectors)
    for item in model.connectors:
        dofs, positions = [], []
        for point in item.points:
            mesh = model.mesh_of(point)
            node = mesh.node_at(point.fraction)
            numbers = mesh.coordinates_of(node)
            dofs += [numbers[name] for name in _COORDINATES[: 3 if uses_rotations(item) else 2]]
            positions.append([*mesh.position[node].tolist(), 0.0])
        multipliers = np.arange(first, first + item.unknowns)
        first += item.unknowns
        memory = np.arange(behind, behind + len(remembered(item)))
        behind += len(memory)
        connectors.append(Connector(item, np.array(dofs, dtype=np.int64), multipliers, memory, np.array(positions)))
    for connector in connectors:
        _require_finite(connector.alone)
    return tuple(connectors)


def _require_finite(item: Connector) -> None:
    """Raise InputError if the force of a connector is not finite near the reference, or a shape is wrong.

    Points are turned even without rotations, so that moments which rotations would cause are refused too.
    """
    at = item.at(somewhere_near(item), TIMES[0], gravity_of(item))
    if item.per_point == 2:
        at = replace(at, q=at.q + _TURNED, v=at.v + _TURNED, a=at.a + _TURNED)
    if not (np.isfinite(item.force(at)).all() and np.isfinite(item.energy(at)).all()):
        raise InputError(f"force or energy of {item.name} is not finite near the reference")
