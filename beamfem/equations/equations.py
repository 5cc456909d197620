"""Residual and tangent of a system in a state: the interface between solvers and kernels."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, hstack

from beamfem.equations.applied_loads import LoadsAt
from beamfem.equations.assembler import Assembler, Equations
from beamfem.equations.bound_connector import Motion
from beamfem.equations.differences import differentiated
from beamfem.equations.frame_inertia import absolute, right_angle, right_angle_of_unknowns, speeds
from beamfem.equations.system import Proven, System
from beamfem.kernels.energy_passes import OF_BEAM, add_energies
from beamfem.linalg.bordered import Border, BorderedTangent
from beamfem.linalg.tangent import UNROTATED, BandTangent, SaddleTangent, SparseTangent, Tangent
from beamfem.precision.mixed_tangent import MixedTangent, mixed

STATICS = (1.0, 0.0, 0.0)
INERTIA = (0.0, 0.0, 1.0)
ROUND_OFF = 4.0 * float(np.finfo(float).eps)  # of a coordinate: each term of a strain is rounded, and so is the sum
_EMPTY = np.empty(0)
_KEPT = 200_000  # floats of the largest workspace whose allocation is a noticeable part of an evaluation


Weights = tuple[float, float, float]  # ck, cv, ca: of p, p' and p''
Stresses = tuple[np.ndarray, ...]  # resultants (ne, nq, ns) of each block


def residual(
    system: System,
    p: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    time: float,
    dt: float = 0.0,
    loads: LoadsAt | None = None,
) -> np.ndarray:
    """Return inertia + elastic - external generalized forces (n,) [N, N m]; at prescribed coordinates, the reactions.

    dt [s]: time step since the committed history, 0 in an accepted state; loads: others than those at the time.
    """
    if system.model.frame is None:
        result = _residual(system, p, v, a, time, dt, loads)
    else:
        at = [(weight, absolute(system, p, v, a, speed)) for weight, speed in speeds(system, time)]
        result = np.asarray(sum(weight * _residual(system, p, *rates, time, dt, loads) for weight, rates in at))
    if not len(system.connectors.one_sided):
        return result
    return released(system, p, result, system.connectors.gradients(p, time), inactive_conditions(system, p, result))


def inactive_conditions(system: System, p: np.ndarray, unbalanced: np.ndarray) -> np.ndarray:
    """Return the multipliers (m,) of one-sided conditions g that do not act in a state p (n,): g + s l <= 0.

    unbalanced (n,): residual with all conditions active, which has their values.
    """
    numbers = system.connectors.one_sided
    closed = unbalanced[numbers] + _compliance(system, numbers) * p[numbers]
    return np.asarray(numbers[closed <= 0.0])


def inactive_after(
    system: System, p: np.ndarray, step: np.ndarray, unbalanced: np.ndarray, gradients: csr_array, inactive: np.ndarray
) -> np.ndarray:
    """Return the multipliers that are inactive after a linearised step (n,) from p (n,) with `inactive` ones.

    unbalanced: see `inactive_conditions`; gradients: see `Connectors.gradients`.
    """
    numbers = system.connectors.one_sided
    off = np.isin(numbers, inactive)
    opens = np.where(off, unbalanced[numbers] + gradients @ step, -(p + step)[numbers])
    return np.asarray(numbers[off == (opens <= 0.0)])


def released(
    system: System, p: np.ndarray, unbalanced: np.ndarray, gradients: csr_array, inactive: np.ndarray
) -> np.ndarray:
    """Return the residual (n,) without inactive conditions, whose equations are -s l = 0; see `inactive_after`."""
    numbers, result = system.connectors.one_sided, unbalanced.copy()
    result -= gradients.T @ np.where(np.isin(numbers, inactive), p[numbers], 0.0)
    result[inactive] = -_compliance(system, inactive) * p[inactive]
    return result


def without(system: System, tangent: Tangent, inactive: np.ndarray, weight: float = 1.0) -> Tangent:
    """Return a tangent with the equations -s l = 0 of inactive multipliers (m,); weight: of p.

    So each of them has a negative eigenvalue, as an active condition has, whatever the set.
    """
    if not len(inactive):
        return tangent
    assert isinstance(tangent, BorderedTangent | SaddleTangent)
    numbers = system.unknowns.free[inactive] - len(system.unknowns.dofs)
    return tangent.without(numbers, -weight * _compliance(system, inactive))


def _compliance(system: System, multipliers: np.ndarray) -> np.ndarray:
    """Return s (m,) of multipliers, by which conditions and forces are compared."""
    return np.asarray(system.extent / system.scale[multipliers])


def residual_at_rest(system: System, p: np.ndarray, time: float) -> np.ndarray:
    """Return the residual (n,) [N, N m] of a state p (n,) at rest at a time or load factor, see `residual`."""
    zeros = np.zeros(len(p))
    return residual(system, p, zeros, zeros, time)


def residual_under(system: System, p: np.ndarray, time: float, factors: np.ndarray) -> np.ndarray:
    """Return the residual (n,) of a state p (n,) at rest in a frame at rest, with factors (k,) of `model.acting`."""
    zeros = np.zeros(len(p))
    return _residual(system, p, zeros, zeros, time, 0.0, system.loads.of(time, factors))


def imposed_forces(system: System, time: float) -> np.ndarray:
    """Return the forces (n,) that would hold the beams in their reference against the strains imposed on them."""
    loads = system.loads
    return residual_under(system, system.reference, time, np.where(loads.imposes, loads.factors(time), 0.0))


def residuals(
    system: System,
    rows: Sequence[Sequence[np.ndarray]],
    times: Sequence[float],
    loads: Sequence[LoadsAt] | None = None,
) -> np.ndarray:
    """Return the residuals (k, n) of states p, p' and p'' (k) at times [s], see `residual`."""
    if system.model.frame is None and not len(system.connectors.one_sided):
        return _residuals(system, rows, times, 0.0, loads or map(system.loads.at, times))
    acting = loads or [system.loads.at(time) for time in times]
    each = zip(rows, times, acting, strict=True)
    return np.array([residual(system, p, v, a, time, loads=own) for (p, v, a), time, own in each])


def _residuals(
    system: System,
    rows: Sequence[Sequence[np.ndarray]],
    times: Sequence[float],
    dt: float,
    loads: Iterable[LoadsAt],
) -> np.ndarray:
    """Return the residuals (k, n) in a frame at rest, see `residuals`."""
    size, assembler = len(system.reference), _acquired(system)
    result, (p, v, a, forces) = np.empty((len(times), size)), np.empty((4, size))
    assembler.weigh((1.0, 1.0, 1.0), dt)
    assembler.prepare(p, v, a, forces, _EMPTY, False)
    for row, (p[:], v[:], a[:]), time, acting in zip(result, rows, times, loads, strict=True):
        assembler.take(acting, time)
        assembler.evaluate()
        row[:] = forces
    _return_assembler(system, assembler)
    return result


def inertias(system: System, p: np.ndarray) -> Iterator[Tangent]:
    """Yield the inertia of states p (rows, n) at rest, in a frame at rest; the next one overwrites its numbers."""
    matrix, assembler, place = np.empty(system.unknowns.entries), _acquired(system), np.empty(p.shape[1])
    zeros, forces = np.zeros((2, p.shape[1]))
    assembler.take(system.loads.at(0.0), 0.0)
    assembler.weigh(INERTIA)
    assembler.prepare(place, zeros, zeros, forces, matrix, False)
    tangent = tangent_of(system, matrix)
    for place[:] in p:
        assembler.evaluate()
        yield tangent
    _return_assembler(system, assembler)


def _residual(
    system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, time: float, dt: float, loads: LoadsAt | None = None
) -> np.ndarray:
    """Return the residual (n,) in a frame at rest, see `residual`."""
    return _residuals(system, [(p, v, a)], [time], dt, [loads or system.loads.at(time)])[0]


def energies_of_beams(
    system: System, p: np.ndarray, v: np.ndarray, imposing: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return numbers of each beam (rows, beams, 9) in states p and p' (rows, n), see `energy_passes`.

    And the positions (rows, nl, 2) [m] of the stations of each block. imposing (rows, k): see `Assembler.impose`.
    Strain energies of section laws other than the linear one are zero.
    """
    assembler, beams, rows = _acquired(system), len(system.model.beams), (_plain(p), _plain(v))
    result = np.zeros((len(p), beams, OF_BEAM))
    places = [np.zeros((len(p), work.record.stations, 2)) for work in assembler.works]
    assembler.impose(imposing)
    assembler.require()
    assembler.record.fill(v=np.zeros(len(system.reference)), tangent=0, predicted=0)
    for work, own in zip(assembler.works, places, strict=True):
        strained = work.group.law is None
        add_energies(work.record, assembler.record, len(p), beams, strained, *rows, result, own)
    assembler.record.forget("p", "v", "a")
    _return_assembler(system, assembler)
    return result, places


def _acquired(system: System, equations: Equations | None = None) -> Assembler:
    """Return an assembler whose workspace no other evaluation uses: a spare one, or a new one."""
    try:
        assembler: Assembler = (system.spare(Assembler) if equations is None else equations.spare).pop()
    except IndexError:
        assembler = system.assembler() if equations is None else Assembler(equations)
    return assembler


def _return_assembler(system: System, assembler: Assembler, equations: Equations | None = None) -> None:
    """Keep an assembler for the next evaluation if its workspace is small."""
    if assembler.numbers <= _KEPT:
        (system.spare(Assembler) if equations is None else equations.spare).append(assembler)


def _plain(state: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(state, dtype=float)


def linearise(
    system: System,
    p: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    time: float,
    coefficients: Weights,
    stresses: Stresses | None = None,
    equations: Equations | None = None,
    dt: float = 0.0,
    moving: bool = False,
    all_active: bool = False,
) -> tuple[np.ndarray, Tangent]:
    """Return residual (n,) and tangent; `coefficients` are the weights of p, p' and p'' (`STATICS`, `INERTIA`).

    stresses: resultants (ne, nq, ns) of each block for the geometric part of the tangent; equations: those of other
    blocks, used instead of those of the system; dt [s]: see `residual`; moving: whether there are inertia forces where
    p'' has no weight, which statics lacks; all_active: whether one-sided conditions are all active, and not those that
    the state shows.
    """
    asked = _Asked(time, coefficients, stresses, equations, dt, moving)
    linearised = _linearise if system.model.frame is None else _linearise_turning
    result, tangent = linearised(system, (p, v, a), asked)
    if len(system.connectors.one_sided) and not all_active:
        inactive = inactive_conditions(system, p, result)
        result = released(system, p, result, system.connectors.gradients(p, time), inactive)
        tangent = without(system, tangent, inactive, coefficients[0])
    if Proven.LOSES_DIGITS in system.proven and coefficients[0] != 0.0 and equations is None:
        tangent = with_stresses(system, (p, v, a), time, coefficients, stresses, tangent)
    return result, tangent


def linearise_at_rest(
    system: System, p: np.ndarray, time: float, stresses: Stresses | None = None, equations: Equations | None = None
) -> tuple[np.ndarray, Tangent]:
    """Return residual (n,) and static tangent of a state p (n,) at rest, see `linearise`."""
    zeros = np.zeros(len(p))
    return linearise(system, p, zeros, zeros, time, STATICS, stresses, equations)


class _Asked(NamedTuple):
    """What is to be linearised, see `linearise`."""

    time: float
    coefficients: Weights
    stresses: Stresses | None
    equations: Equations | None
    dt: float
    moving: bool


def _linearise(system: System, motion: Motion, asked: _Asked) -> tuple[np.ndarray, Tangent]:
    """Return residual and tangent of a motion at rest, see `linearise`."""
    matrix, result = np.empty(system.unknowns.entries), np.empty(len(motion[0]))
    assembler = _acquired(system, asked.equations)
    own = assembler.stresses
    if asked.stresses is not None:
        assembler.take_stresses(asked.stresses)
    assembler.take(system.loads.at(asked.time), asked.time)
    assembler.weigh(asked.coefficients, asked.dt, asked.moving)
    p, v, a = map(_plain, motion)
    assembler.balance(p, v, a, result, matrix, asked.stresses is not None)
    assembler.take_stresses(own)
    _return_assembler(system, assembler, asked.equations)
    return result, tangent_of(system, matrix)


def _linearise_turning(system: System, motion: Motion, asked: _Asked) -> tuple[np.ndarray, Tangent]:
    """Return residual and tangent in a rotating frame, see `rotating_frame`, by the chain rule.

    dR/dp = K + w C J + w^2 M J^2 and dR/dp' = C + 2 w M J with the derivatives K, C and M of the motion at rest.
    """
    (ck, cv, _), time, (p, v, a) = asked.coefficients, asked.time, motion
    free, unknown = system.free_dofs, len(system.free_dofs)
    taken, turn = right_angle_of_unknowns(system)
    twice = csr_array(right_angle(system)[free] @ right_angle(system)[:, free])
    result, whole = np.zeros(len(p)), csr_array((unknown, unknown))
    for weight, speed in speeds(system, time):
        state = p, *absolute(system, p, v, a, speed)
        forces, tangent = _linearise(system, state, asked._replace(moving=True))
        by_rates = []
        for rate in ((0.0, 1.0, 0.0), INERTIA):
            own = _linearise(system, state, asked._replace(coefficients=rate, stresses=None, moving=True))[1]
            by_rates.append(csr_array(hstack([own.sparse(UNROTATED), _by_rates(system, state, time, taken, rate)])))
        damping, mass = by_rates
        added = speed * (ck * damping + 2.0 * cv * mass) @ turn + ck * speed**2 * mass[:, :unknown] @ twice
        result, whole = result + weight * forces, whole + weight * (tangent.sparse(UNROTATED) + added)
    # SuperLU needs every entry of the diagonal, zeros included
    entries, diagonal = coo_array(whole), np.arange(unknown)
    places = np.append(entries.row, diagonal), np.append(entries.col, diagonal)
    full = csc_array(coo_array((np.append(entries.data, np.zeros(unknown)), places), shape=whole.shape))
    multipliers = len(system.connectors.multipliers)
    return result, SaddleTangent(SparseTangent(full), multipliers) if multipliers else SparseTangent(full)


def _by_rates(system: System, state: Motion, time: float, dofs: np.ndarray, rate: Weights) -> np.ndarray:
    """Return the derivatives (unknown, k) of the residual by p' or p'' of prescribed coordinates (k,).

    They are differences, which are exact as the residual is quadratic in p' and linear in p''.
    """
    columns = []
    for dof in dofs.tolist():
        change = np.zeros((3, len(state[0])))
        change[:, dof] = rate
        change *= max(1.0, float(np.abs(state[1]).max()), float(np.abs(state[2]).max()))
        ends = []
        for side in (1.0, -1.0):
            p, v, a = np.array(state) + side * change
            ends.append(_residual(system, p, v, a, time, 0.0))
        columns.append((ends[0] - ends[1])[system.free_dofs] / (2.0 * change[:, dof].max()))
    return np.array(columns).reshape(len(dofs), len(system.free_dofs)).T


def linearise_after(system: System, p: np.ndarray, step: np.ndarray, time: float) -> Tangent:
    """Return the static tangent in p (n,) with the stress resultants predicted by a linear step (n,) from p."""
    zeros = np.zeros(len(p))
    one_sided = len(system.connectors.one_sided) > 0
    if Proven.LOSES_DIGITS in system.proven or system.model.frame is not None or one_sided:
        return linearise_at_rest(system, p, time, predicted_stresses(system, p, step, time))[1]
    matrix, assembler = np.empty(system.unknowns.entries), _acquired(system)
    assembler.take(system.loads.at(time), time)
    assembler.weigh(STATICS)
    assembler.predict(p, step)
    assembler.balance(p, zeros, zeros, np.empty(len(p)), matrix, True)
    _return_assembler(system, assembler)
    return tangent_of(system, matrix)


def tangent_of(system: System, matrix: np.ndarray) -> Tangent:
    """Return the tangent with the entries of a matrix, flat as compiled code fills them."""
    unknowns, multipliers = system.unknowns, len(system.connectors.multipliers)
    pattern = unknowns.pattern
    if pattern is None:
        width, size = 2 * system.layouts[0].half_width + 1, unknowns.border_size
        band = BandTangent(matrix[: unknowns.banded * width].reshape(-1, width), unknowns.reach[0])
        if size == 0:
            return band
        behind = len(unknowns.dofs) * width
        entries = matrix[behind : behind + size**2].reshape(size, size)
        return BorderedTangent(band, Border(unknowns.border, multipliers, entries))
    whole = csc_array((matrix, pattern.indices, pattern.indptr), shape=pattern.shape)
    return SaddleTangent(SparseTangent(whole), multipliers) if multipliers else SparseTangent(whole)


def with_stresses(
    system: System, state: Motion, time: float, coefficients: Weights, stresses: Stresses | None, plain: Tangent
) -> MixedTangent:
    """Return the mixed form of the tangent `plain` in p, p', p'': with stress resultants as additional unknowns."""
    p = state[0]
    resultants = stresses or _sure_stresses(system, p, time)
    loads, zeros = linearise(system, *state, time, coefficients, resultants, system.without_stiffness)
    return mixed(system, p, time, coefficients[0], loads[system.free_dofs], zeros, plain)


def _sure_stresses(system: System, p: np.ndarray, time: float) -> Stresses:
    """Return the stress resultants (ne, nq, ns) of each block in a state, with those that may be round-off set to zero.

    Round-off in a stiff part could otherwise buckle, or stiffen, an adjacent soft part.
    """
    result = predicted_stresses(system, p, np.zeros(len(p)), time)
    reach, turn = sizes(system, p)
    for block, errors, stress in zip(system.blocks, system.stress_errors, result, strict=True):
        round_off = ROUND_OFF * (reach * errors[0] + turn * errors[1])
        stress[np.abs(stress) <= round_off[block.kind]] = 0.0
    return result


def sizes(system: System, p: np.ndarray) -> tuple[float, float]:
    """Return the largest position [m], at least the size of the model, and the largest other coordinate, at least 1."""
    positions, others = system.table(_positions_and_others)
    reach, turn = (float(np.abs(p[dofs]).max(initial=0.0)) for dofs in (positions, others))
    return max(reach, system.extent), max(turn, 1.0)


def _positions_and_others(system: System) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of the coordinates that are positions, and of the others, without multipliers and history."""
    others = ~system.positions
    others[system.history.numbers] = others[system.connectors.every_multiplier] = False
    return np.flatnonzero(system.positions), np.flatnonzero(others)


def predicted_stresses(
    system: System,
    p: np.ndarray,
    step: np.ndarray,
    time: float,
    equations: Equations | None = None,
    rates: tuple[np.ndarray, Weights] | None = None,
    dt: float = 0.0,
) -> Stresses:
    """Return the stress resultants (ne, nq, ns) of each block after a linearised step (n,) from p (n,).

    time: at the end of the step, for imposed strains; equations: those of other blocks, used instead of those of the
    system; rates: in dynamics, p' (n,) and the weights of p, p' and p'' in the tangent; dt [s]: see `residual`.
    """
    assembler = _acquired(system, equations)
    assembler.impose(system.loads.imposing(time))
    assembler.weigh((0.0, 0.0, 0.0) if rates is None else rates[1], dt)
    assembler.predict(_plain(p), _plain(step), None if rates is None else _plain(rates[0]))
    stresses = tuple(stress.copy() for stress in assembler.stresses)
    _return_assembler(system, assembler, equations)
    return stresses


def load_change(system: System, p: np.ndarray, before: float, after: float) -> np.ndarray:
    """Return the change of the residual (n,) [N, N m] between two load factors, with prescribed motions.

    That for prescribed motions is linear, by a difference of fourth order at small strains, because slender parts
    stiffen within any width.
    """
    prescribed = system.prescribed_dofs
    change = residual_at_rest(system, p, after) - residual_at_rest(system, p, before)
    motion = np.zeros(len(p))
    motion[prescribed] = system.prescribed_values(after) - system.prescribed_values(before)
    if not motion.any():
        return change
    middle = 0.5 * (before + after)
    return np.asarray(change + residual_change(system, p, motion, middle))


def residual_change(system: System, p: np.ndarray, step: np.ndarray, load_factor: float) -> np.ndarray:
    """Return the linear change of the residual (n,) for a step (n,) that may be below the round-off of p (n,)."""
    return differentiated(system, lambda q: residual_at_rest(system, q, load_factor), p, step)
