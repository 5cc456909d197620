"""Find the rigid motions that the supports of a static model leave free."""

import numpy as np

from beamfem.errors import FreeMotionError
from beamfem.model.system import System


def require_support(system: System) -> None:
    """Raise FreeMotionError naming the beam and the motion where the supports leave a rigid motion free."""
    held = set(system.held_dofs.tolist())
    for number, mesh in enumerate(system.model.meshes):
        dofs = np.arange(mesh.first_dof, mesh.first_dof + mesh.size)
        modes = _rigid_motions(system, number)
        rows = modes[[dof in held for dof in dofs]]
        inclined = [(dof - mesh.first_dof, normal) for dof, normal in system.inclined if dof in dofs]
        rows = np.vstack([rows, *(normal @ modes[dof : dof + 2] for dof, normal in inclined)])
        rank_rows = rows if len(rows) else np.zeros((1, 3))
        _, singular, basis = np.linalg.svd(rank_rows)
        rank = int((singular > 1e-9).sum())
        if rank < 3:
            length, start = mesh.beam.curve.length, mesh.beam.start.reference
            motions = ", ".join(f"it {describe(m[:2] * length, m[2], start, length)}" for m in basis[rank:])
            raise FreeMotionError(
                f"beam {number} can move freely: {motions}. A static solve needs supports that hold it "
                "(a Clamp, or a Pin and a Roller); without them, use simulate"
            )


def _rigid_motions(system: System, number: int) -> np.ndarray:
    """Change of a beam's coordinates (size, 3) with a translation in x, in y [lengths] and a turn about its start."""
    mesh = system.model.meshes[number]
    length = mesh.beam.curve.length
    table = system.reference[mesh.first_dof : mesh.first_dof + mesh.size].reshape(mesh.nodes, -1)
    labels = mesh.beam.element.coordinates.labels(mesh.beam.element.field.vectors)
    modes = np.zeros((mesh.nodes, len(labels), 3))
    for column, label in enumerate(labels):
        if label == "theta":
            modes[:, column, 2] = 1.0
            continue
        name, axis = label.split("^")
        other = labels.index(f"{name}^{'y' if axis == 'x' else 'x'}")
        sign = -1.0 if axis == "x" else 1.0
        start = table[0, other] if name == "r" else 0.0
        modes[:, column, 2] = sign * (table[:, other] - start) / (length if name == "r" else 1.0)
        if name == "r":
            modes[:, column, "xy".index(axis)] = 1.0
    return modes.reshape(-1, 3)


def describe(translation: np.ndarray, turn: float, origin: np.ndarray, reach: float) -> str:
    """Say a rigid motion in words: the velocity (2,) of the point `origin` and the turn; reach: size of the body."""
    if abs(turn) * reach < 1e-6 * np.hypot(*translation):
        x, y = translation / np.hypot(*translation)
        if max(abs(x), abs(y)) > 1.0 - 1e-9:
            return f"translates along {'x' if abs(x) > abs(y) else 'y'}"
        return f"translates along ({abs(x):.3g}, {np.copysign(y, x * y):.3g})"
    centre = origin + np.array([-translation[1], translation[0]]) / turn
    x, y = np.where(np.abs(centre) < 1e-6 * reach, 0.0, centre)
    return f"turns about ({x:.6g}, {y:.6g})"
