"""Rigid-body motions among the modes: sorted, and said in words."""

import numpy as np
from scipy.linalg import null_space, svd

from beamfem.analysis.free_motion import describe
from beamfem.analysis.initial import RigidVelocity, start_velocity
from beamfem.analysis.pencil import Pencil
from beamfem.analysis.shapes import nodal_motion

_SMALL = 1e-5  # of a motion: what the eigensolver may leave


def sort_rigid(pencil: Pencil, shapes: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return an M-orthonormal basis (m, n) of the span of rigid shapes (m, n), and what each moves, in words.

    Translations of the whole model come first, then its turn, then what its parts do against each other.
    """
    basis = np.empty((0, len(pencil.p)))
    for candidate in np.vstack([_whole(pencil, shapes), shapes]):
        rest = candidate
        for _ in range(2):
            rest = rest - _product(pencil, basis, rest) @ basis
        size = np.sqrt(_product(pencil, rest, rest))
        if size > _SMALL * np.sqrt(_product(pencil, candidate, candidate)) and len(basis) < len(shapes):
            basis = np.vstack([basis, rest / size])
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
    body = np.array([start_velocity(pencil.system, pencil.p, motion, None) for motion in motions])
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
    """Say what a rigid shape (n,) moves: the whole model, or each beam in turn."""
    motions = []
    for positions, moved in nodal_motion(pencil.system.model, pencil.p, shape):
        centre = positions.mean(axis=0)
        arm = positions - centre
        turn = float((arm[:, 0] * moved[:, 1] - arm[:, 1] * moved[:, 0]).sum() / (arm**2).sum())
        motions.append((moved.mean(axis=0), turn, centre, float(np.hypot(*arm.T).max())))
    sizes = [np.hypot(*translation) + abs(turn) * reach for translation, turn, _, reach in motions]
    said = [
        describe(*motion) if size > _SMALL * max(sizes) else "stays"
        for motion, size in zip(motions, sizes, strict=True)
    ]
    if len(set(said)) == 1:
        return said[0]
    return ", ".join(f"beam {number} {words}" for number, words in enumerate(said))
