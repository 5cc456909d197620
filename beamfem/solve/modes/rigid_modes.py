"""Rigid motions of a model or its parts: those without resistance, sorted and described in words."""

import numpy as np

from beamfem.equations.equations import residual_at_rest
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.linalg.lapack import cholesky, null_space, solve_triangular, svd
from beamfem.model.beam import beam_in_words
from beamfem.precision.roundoff import row_floors
from beamfem.solve.modes.mode_stiffness import nodal_motion, stresses_of, weak_stiffness
from beamfem.solve.modes.pencil import Pencil
from beamfem.solve.start.mechanisms import Conditions, bodies_of, describe, mechanisms

_SMALL = 1e-5  # of a motion
_UNBALANCED = 1e-8  # of the largest force: acceptable residual of an equilibrium, and its change by a rotation


def unresisted(pencil: Pencil) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the rigid motions (m, n) without resistance about the state, M-orthonormal, and what each moves, in words.

    These are motions of the bodies that supports, springs and joints do not constrain and that cause no force: the
    rotation of a pendulum is resisted by its weight, that of an unloaded body is not resisted.
    """
    system, p = pencil.system, pencil.p
    conditions = Conditions(system, bodies_of(system.model), p)
    shapes = np.array([conditions.rates(p, motion) for motion in mechanisms(conditions)]).reshape(-1, len(p))
    if not len(shapes):
        return shapes, ()
    shapes /= np.abs(shapes / system.scale).max(axis=1)[:, None]
    free = system.free_dofs
    loads = weak_stiffness(system, p, pencil.load_factor, stresses_of(system, p, np.zeros_like(p), pencil.load_factor))
    resistance = loads @ shapes[:, free].T * system.scale[free][:, None]
    _, sizes, combinations = svd(resistance, full_matrices=False)
    mask = sizes <= _negligible_force(pencil) * system.extent * np.sqrt(resistance.size)
    rigid = combinations[mask] @ shapes
    if not len(rigid):
        return rigid, ()
    return sort_rigid(pencil, solve_triangular(cholesky(_product(pencil, rigid, rigid), lower=True), rigid, lower=True))


def _negligible_force(pencil: Pencil) -> float:
    """Return the force [N] that a unit rotation of the state may cause by round-off and by the residual of Newton."""
    system, p, zeros = pencil.system, pencil.p, np.zeros_like(pencil.p)
    forces = [*system.loads.at(pencil.load_factor).points, residual_at_rest(system, p, pencil.load_factor)]
    forces += [stresses[..., 0] for stresses in stresses_of(system, p, zeros, pencil.load_factor)]
    largest = max(float(np.abs(values).max(initial=0.0)) for values in forces)
    return _UNBALANCED * largest + float(row_floors(system, p).max(initial=0.0))


def sort_rigid(pencil: Pencil, shapes: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return an M-orthonormal basis (m, n) of the span of rigid shapes (m, n), and what each moves, in words.

    Translations of the whole model come first, then its rotation, then relative motions of its parts.
    """
    basis = np.empty((0, len(pencil.p)))
    for candidate in np.vstack([_whole(pencil, shapes), shapes]):
        remainder = candidate
        for _ in range(2):
            remainder = remainder - _product(pencil, basis, remainder) @ basis
        size = np.sqrt(_product(pencil, remainder, remainder))
        if size > _SMALL * np.sqrt(_product(pencil, candidate, candidate)) and len(basis) < len(shapes):
            basis = np.vstack([basis, remainder / size])
    return basis, tuple(_words(pencil, shape) for shape in basis)


def _product(pencil: Pencil, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a M b^T of shapes (..., n)."""
    free = pencil.system.free_dofs
    return np.asarray(a[..., free] @ (pencil.mass @ b[..., free].T))


def _whole(pencil: Pencil, shapes: np.ndarray) -> np.ndarray:
    """Return the motions of the whole model as one body (k, n) that lie in the span of the shapes (m, n)."""
    model = pencil.system.model
    nodes = np.concatenate([positions for positions, _ in nodal_motion(model, pencil.p, pencil.p)])
    centre = nodes.mean(axis=0)
    reach = np.abs(nodes - centre).max()
    motions = [RigidVelocity((1.0, 0.0)), RigidVelocity((0.0, 1.0)), RigidVelocity((0.0, 0.0), 1.0 / reach, centre)]
    body = np.array([rigid_rates(pencil.system, motion, pencil.p) for motion in motions])
    inside = _product(pencil, body, shapes) @ shapes
    _, outside, combinations = svd((body - inside).T / np.abs(body).max(), full_matrices=False)
    combinations = combinations[outside < _SMALL * np.sqrt(len(pencil.p))]
    turning = combinations[:, 2:]
    straight = combinations
    if np.any(np.abs(turning) > _SMALL):
        straight = null_space(turning.T).T @ combinations
    if len(straight) == 2:
        straight = np.eye(3)[:2]
    return np.asarray(np.vstack([straight, combinations]) @ inside)


def _words(pencil: Pencil, shape: np.ndarray) -> str:
    """Return in words what a rigid shape (n,) moves: the whole model, or each beam."""
    motions = []
    for positions, moved in nodal_motion(pencil.system.model, pencil.p, shape):
        centre = positions.mean(axis=0)
        arm = positions - centre
        turn = float((arm[:, 0] * moved[:, 1] - arm[:, 1] * moved[:, 0]).sum() / (arm**2).sum())
        motions.append((moved.mean(axis=0), turn, centre, float(np.hypot(*arm.T).max())))
    sizes = [np.hypot(*translation) + abs(turn) * reach for translation, turn, _, reach in motions]
    descriptions = [
        describe(*motion) if size > _SMALL * max(sizes) else "stays"
        for motion, size in zip(motions, sizes, strict=True)
    ]
    if len(set(descriptions)) == 1:
        return descriptions[0]
    beams = pencil.system.model.beams
    return ", ".join(f"{beam_in_words(beams, number)} {words}" for number, words in enumerate(descriptions))
