"""Rows of a motion on the conditions of joints, with velocities and accelerations that keep them there."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpbsv

from beamfem.equations.bound_connector import COMPLEX_STEP, Connector
from beamfem.equations.equations import INERTIA, inertias
from beamfem.equations.system import System
from beamfem.linalg.bordered import BorderedTangent
from beamfem.linalg.lapack import LinAlgError
from beamfem.linalg.tangent import SaddleTangent
from beamfem.parts.at_points import ANALYTIC
from beamfem.physics.connections import MASS
from beamfem.solve.motion.constraints import CENTRAL
from beamfem.solve.motion.start_acceleration import initial_acceleration

_ENTRIES = 1_000_000  # of gradients at a time
_OFF = 1e-12  # of the model: gap of a condition that is corrected
_CORRECTIONS = 3  # of positions, at most
_NEAR = 2.0**-7  # of the model, or rad: step of differences along the velocity
_LARGEST = 1e6  # ratio of impulses to rates, above which conditions depend on each other in a state
_TURN = 1.0  # [rad], by which the inertia of beams is compared
_ROUND_OFF = 1e-9  # of accelerations, which coordinates with other natural units may lose
_SINGULAR = 1e-10  # of the largest compliance of the conditions


class _Compliance(NamedTuple):
    """Coordinates (u,) that conditions and bodies act on, and the accelerations (n, u) by forces on them.

    varies: whether these change as beams turn, as shear-rigid ones and those beside their axes do, not by bodies alone;
    conditions, bodies: their parts with the places of their coordinates among these; of a part with conditions also
    which of them count, and their rows among all; still: inertia (u, u) of the bodies in the reference; numbers (k,):
    those of the multipliers.
    """

    dofs: np.ndarray
    moved: np.ndarray
    varies: bool
    conditions: tuple[tuple[Connector, np.ndarray, np.ndarray, slice], ...]
    bodies: tuple[tuple[Connector, np.ndarray], ...]
    still: np.ndarray
    numbers: np.ndarray


def finished_rows(
    system: System, times: Sequence[float], states: np.ndarray, jumps: Collection[float] = ()
) -> np.ndarray:
    """Return states p, p', p'' (rows, 3, n) at times [s] on all conditions, changed in place.

    jumps: times [s] of jumps of loads. Steps end before these, rows have the accelerations under the loads of their
    times.
    """
    for row in np.flatnonzero(np.isin(times, list(jumps))).tolist():
        states[row, 2] = initial_acceleration(system, states[row], times[row])
    states = on_conditions(system, states)
    states[:, 0] = system.finished(states[:, 0], times)
    return states


def on_conditions(system: System, states: np.ndarray) -> np.ndarray:
    """Return states p, p', p'' (rows, 3, n) on the conditions with multipliers, changed in place.

    Steps satisfy conditions of positions; those of p' and p'', G p' + dg/dt = 0 and its rate, are met to the error of
    the integrator only. What is added is M^-1 G' times multipliers, which changes neither momentum nor the motion
    along what is free, and the multipliers of p'' join those of the equations. Conditions in Python, and models with
    coordinates without mass, are left as they are.
    """
    found = system.table(_compliance) if len(system.connectors.multipliers) else None
    if found is not None:
        some = max(1, _ENTRIES // (len(found.numbers) * len(found.dofs)))
        for first in range(0, len(states), some):
            _put_onto_conditions(system, found, *states[first : first + some].swapaxes(0, 1))
    return states


def _put_onto_conditions(system: System, found: _Compliance, p: np.ndarray, v: np.ndarray, a: np.ndarray) -> None:
    """Do what `on_conditions` does for p, p' and p'' (rows, n)."""
    for _ in range(_CORRECTIONS):
        gaps = _values(found, p)
        off = np.flatnonzero(np.abs(gaps).max(axis=1) > _OFF * system.extent)
        if not len(off):
            break
        p[off] -= _Impulses(found, system, p[off]).by(gaps[off])[0]
    impulses = _Impulses(found, system, p)
    v -= impulses.by(impulses.rates(v))[0]
    change, multipliers = impulses.by(impulses.rates(a) + _turning(found, system, p, v))
    a -= change
    p[:, found.numbers] += multipliers


def _compliance(system: System) -> _Compliance | None:
    """Return what conditions need, None if one is in Python, or if there is a coordinate without mass."""
    items, zeros = system.connectors.items, np.zeros(system.model.size)
    kept = [item for item in items if np.isin(item.multipliers, system.connectors.multipliers).any()]
    if any(item.compiled is None or item.compiled.conditions is None for item in kept):
        return None
    bodies = []
    for item in items:
        if item.compiled is None and item.tangent((system.reference, zeros, zeros), 0.0, zeros[:2], INERTIA).any():
            return None
        if item.compiled is not None and item.compiled.kinetic is not None and item.compiled != MASS:
            bodies.append(item)
    dofs, multipliers = (
        np.unique(np.concatenate([item.dofs for item in (*kept, *bodies)])),
        system.connectors.multipliers,
    )
    units, turned = np.eye(system.model.size)[dofs], np.where(system.positions, 0.0, _TURN) + system.reference
    try:
        moved, elsewhere = _accelerations(system, np.array([system.reference, turned]), np.array([units, units]))
    except LinAlgError:
        return None
    if not np.isfinite(moved).all():
        return None
    chosen = [np.flatnonzero(np.isin(item.multipliers, multipliers)) for item in kept]
    ends = np.cumsum([len(own) for own in chosen]).tolist()
    conditions = tuple(
        (item, np.searchsorted(dofs, item.dofs), own, slice(end - len(own), end))
        for item, own, end in zip(kept, chosen, ends, strict=True)
    )
    moving = tuple((item, np.searchsorted(dofs, item.dofs)) for item in bodies)
    found = _Compliance(dofs, moved, False, conditions, moving, np.zeros((len(dofs), len(dofs))), multipliers)
    still, inertia = _inertia(found, np.array([system.reference, turned]))
    by_beams = elsewhere + elsewhere @ (inertia - still) @ moved[dofs]
    varies = bool(np.any(np.abs(by_beams - moved).max(axis=0) > _ROUND_OFF * np.abs(moved).max(axis=0)))
    return found._replace(still=still, varies=varies)


def _accelerations(system: System, p: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Return accelerations (rows, n, c) of states p (rows, n) at rest by forces (rows, c, n). Raises LinAlgError."""
    free, k = system.free_dofs, len(system.connectors.multipliers)
    result = np.zeros((*p.shape, forces.shape[1]))
    for mass, given, moved in zip(inertias(system, p), forces[:, :, free].swapaxes(1, 2), result, strict=True):
        own, coordinates = free, mass
        assert isinstance(mass, BorderedTangent | SaddleTangent)
        if isinstance(mass, BorderedTangent) and not mass.border.entries.any():
            own, coordinates = free[:-k], mass.band
            half = mass.band.rows[:, mass.band.rows.shape[1] // 2 :]
            _, moved[own], failed = dpbsv(half.T, given[: len(own)], lower=1)
            if not (failed or len(system.rotated[0])):
                continue
        else:
            coordinates = mass.without(np.arange(-k, 0), np.ones(k))
        factors = coordinates.factorised(system.rotated)
        moved[own] = np.array([factors.solve(force) for force in given[: len(own)].T]).T
    return result


def _conditions(item: Connector, chosen: np.ndarray, q: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Return the chosen conditions (rows, c) of a part with coordinates q (rows, d), without prescribed values."""
    connection, data = item.compiled, (*item.data.tolist(), *p[:, item.memory].T)
    assert connection is not None
    assert connection.conditions is not None
    values = connection.conditions(connection.split(list(q.T)), data, ANALYTIC)
    return np.array([np.broadcast_to(values[number], len(q)) for number in chosen.tolist()]).T


def _values(found: _Compliance, p: np.ndarray) -> np.ndarray:
    """Return the gaps (rows, k) of conditions."""
    gaps = []
    for item, _, chosen, _ in found.conditions:
        gap = _conditions(item, chosen, p[:, item.dofs], p)
        given = chosen < len(item.values)
        gap[:, given] -= p[:, item.values[chosen[given]]]
        gaps.append(gap)
    return np.concatenate(gaps, axis=1)


def _along(found: _Compliance, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return G p' (rows, k) of coordinates alone."""
    moved = (
        (item, chosen, p[:, item.dofs] + 1j * COMPLEX_STEP * v[:, item.dofs]) for item, _, chosen, _ in found.conditions
    )
    return np.concatenate([_conditions(item, chosen, q, p).imag for item, chosen, q in moved], axis=1) / COMPLEX_STEP


def _turning(found: _Compliance, system: System, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return (dG/dt) p' (rows, k)."""
    speed = np.abs(v[:, found.dofs] / system.held.scale[found.dofs]).max(axis=1, keepdims=True)
    width, result = _NEAR / np.where(speed > 0.0, speed, 1.0), np.zeros((len(p), len(found.numbers)))
    for number, weight in enumerate(CENTRAL, 1):
        result += weight * (_along(found, p + number * width * v, v) - _along(found, p - number * width * v, v))
    return result / width


def _inertia(found: _Compliance, p: np.ndarray) -> np.ndarray:
    """Return the inertia (rows, u, u) of the bodies: their kinetic energy is quadratic in rates."""
    result = np.zeros((len(p), len(found.dofs), len(found.dofs)))
    for item, places in found.bodies:
        connection, data = item.compiled, (*item.data.tolist(), *p[:, item.memory].T)
        assert connection is not None
        assert connection.kinetic is not None
        q, units = connection.split(list(p[:, item.dofs].T)), np.eye(len(item.dofs))
        energies = [[connection.kinetic(q, connection.split(i + j), data, ANALYTIC) for j in units] for i in units]
        for i, row in enumerate(places):
            for j, column in enumerate(places):
                result[:, row, column] += energies[i][j] - 0.25 * (energies[i][i] + energies[j][j])
    return result


class _Impulses:
    """Changes of rates in states p (rows, n) by impulses along the gradients of conditions."""

    def __init__(self, found: _Compliance, system: System, p: np.ndarray) -> None:
        self._found, self.gradients = found, np.zeros((len(p), len(found.numbers), len(found.dofs)))
        for item, places, chosen, rows in found.conditions:
            q = p[:, item.dofs].astype(complex)
            for column, place in enumerate(places.tolist()):
                q[:, column] += 1j * COMPLEX_STEP
                self.gradients[:, rows, place] += _conditions(item, chosen, q, p).imag / COMPLEX_STEP
                q[:, column] = q[:, column].real
        here, along = found.moved[found.dofs], self.gradients.swapaxes(1, 2)
        few = [(np.unique(places), rows) for _, places, _, rows in found.conditions]  # coordinates of each condition
        self._moved: np.ndarray = found.moved[None]
        self._along: np.ndarray = along
        if found.varies:
            forces = np.zeros((len(p), len(found.numbers), p.shape[1]))
            forces[:, :, found.dofs] = self.gradients
            self._moved = _accelerations(system, p, forces)
            self._along, moved = np.eye(len(found.numbers)), self._moved[:, found.dofs]
        elif found.bodies:
            change = (_inertia(found, p) - found.still) @ here
            self._along = np.linalg.solve(np.eye(len(here)) + change, along)
            moved = here @ self._along
        else:
            moved = np.concatenate([here[:, own] @ along[:, own, rows] for own, rows in few], axis=2)
        self._compliance = np.concatenate([self.gradients[:, rows, own] @ moved[:, own] for own, rows in few], axis=1)

    def rates(self, rates: np.ndarray) -> np.ndarray:
        """Return G p' less the rates of prescribed values (rows, k) for p' (rows, n), or the same of p''."""
        result = (self.gradients @ rates[:, self._found.dofs, None])[..., 0]
        for item, _, chosen, rows in self._found.conditions:
            given = np.flatnonzero(chosen < len(item.values))
            result[:, rows.start + given] -= rates[:, item.values[chosen[given]]]
        return result

    def by(self, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the changes (rows, n) of p' that change conditions by rates (rows, k), and their impulses."""
        sizes = np.sqrt(np.diagonal(self._compliance, axis1=1, axis2=2))
        sizes = np.where(sizes > 0.0, sizes, 1.0)
        scaled, wanted = self._compliance / (sizes[:, :, None] * sizes[:, None, :]), rates / sizes
        try:
            found = np.linalg.solve(scaled, wanted[..., None])[..., 0]
        except np.linalg.LinAlgError:
            found = np.full_like(wanted, np.inf)
        singular = ~(np.abs(found).max(axis=1) <= _LARGEST * np.abs(wanted).max(axis=1))
        if singular.any():  # as in dead points: along what conditions determine
            values, vectors = np.linalg.eigh(scaled[singular])
            inverse = np.where(values > _SINGULAR * values[:, -1:], 1.0 / np.where(values > 0.0, values, 1.0), 0.0)
            turned = vectors.swapaxes(1, 2) @ wanted[singular][..., None]
            found[singular] = (vectors @ (inverse[..., None] * turned))[..., 0]
        impulses = found / sizes
        return (self._moved @ (self._along @ impulses[..., None]))[..., 0], impulses
