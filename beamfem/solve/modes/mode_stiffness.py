"""Sizes of mode shapes, and their stiffness free of the round-off of an assembled tangent."""

import numpy as np
from scipy.sparse import csr_array

from beamfem.equations.equations import linearise_at_rest, predicted_stresses
from beamfem.equations.redundant_conditions import in_words
from beamfem.equations.stress_resultants import resultants, strain_group
from beamfem.equations.system import System, system_of
from beamfem.errors import ConvergenceError
from beamfem.linalg.tangent import UNROTATED
from beamfem.model.model import Model
from beamfem.results.axis_points import nodal_vectors


def nodal_motion(model: Model, p: np.ndarray, shape: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return for each beam the nodes' positions and, per unit of a real shape (n,), their displacements (nodes, 2)."""
    result = []
    for mesh in model.meshes:
        slot = mesh.beam.element.field.vectors.index("r")
        positions = nodal_vectors(mesh, p[None])[0, :, slot]
        result.append((positions, nodal_vectors(mesh, p[None], v=shape[None])[0, :, slot]))
    return result


def largest_translation(model: Model, p: np.ndarray, shape: np.ndarray) -> float:
    """Return the largest displacement of a node in a shape (n,), real or complex; where no node moves, 1 rad counts."""
    parts = [np.concatenate([u for _, u in nodal_motion(model, p, part)]) for part in (shape.real, shape.imag)]
    moved = float(np.hypot(*(np.linalg.norm(part, axis=1) for part in parts)).max())
    system = system_of(model, static=True)
    largest = float(np.abs(shape / system.scale).max())
    return moved if moved > 1e-9 * largest * system.extent else largest


def upright(model: Model, shapes: np.ndarray) -> np.ndarray:
    """Return shapes (m, n) each with its entry that is largest in any units positive, real where shapes are complex."""
    if shapes.size == 0:
        return shapes
    largest = np.abs(shapes / system_of(model, static=True).scale).argmax(axis=1)
    largest = np.take_along_axis(shapes, largest[:, None], axis=1)
    return np.asarray(shapes * (np.conj(largest) / np.abs(largest)))


def stiffness_of_modes(
    system: System, p: np.ndarray, load_factor: float, modes: np.ndarray, correction: np.ndarray | None = None
) -> np.ndarray:
    """Return the symmetric part (m, m) of modes K modes^T for changes (m, n) of the coordinates.

    K: tangent in the state p (n,), sum B^T C B over the quadrature points plus the contributions of stresses, springs
    and loads; correction (n,): the remaining correction of the state.
    """
    zeros, count = np.zeros(len(p)), len(modes)
    result = np.zeros((count, count))
    imposing = system.loads.imposing(load_factor)
    for block in system.blocks:
        before, *after = resultants(strain_group(block, len(p)), p, [zeros, *modes], imposing)
        strains = (np.array(after) - before).reshape(count, *before.shape)
        stressed = np.einsum("eq,eqij,meqj->meqi", block.weight[block.kind], block.linearised(before, p), strains)
        result += stressed.reshape(count, -1) @ strains.reshape(count, -1).T
    stresses = stresses_of(system, p, zeros if correction is None else correction, load_factor)
    free = modes[:, system.free_dofs]
    result += free @ (weak_stiffness(system, p, load_factor, stresses) @ free.T)
    return np.asarray(0.5 * (result + result.T))


def stresses_of(system: System, p: np.ndarray, correction: np.ndarray, load_factor: float) -> tuple[np.ndarray, ...]:
    """Return the stress resultants of a state in each block (ne, nq, ns); in the reference only imposed ones."""
    if np.array_equal(p, system.reference) and not system.loads.imposing(load_factor).any():
        return tuple(np.zeros_like(stresses) for stresses in system.assembler().stresses)
    return predicted_stresses(system, p, correction, load_factor)


def weak_stiffness(system: System, p: np.ndarray, load_factor: float, stresses: tuple[np.ndarray, ...]) -> csr_array:
    """Return the tangent (unknown, unknown) without sum B^T C B: the contributions of stresses, springs and loads."""
    weak = system.without_stiffness
    return linearise_at_rest(system, p, load_factor, stresses, weak)[1].sparse(UNROTATED)


def refuse_lost_digits(
    system: System, dofs: np.ndarray, stiffness: csr_array, x: np.ndarray, most: float, what: str
) -> None:
    """Raise ConvergenceError if the round-off of an assembled stiffness (m, m) makes x^T K x uncertain by over `most`.

    Terms of opposite signs cancel out in a shape x (m,) that hardly deforms a stiff part. dofs (m,): numbers of the
    coordinates, -1 for amplitudes of modes; what: what loses its digits, in words.
    """
    own = stiffness.tocoo()
    terms = np.where(own.row == own.col, 0.0, np.abs(own.data * x[own.row] * x[own.col]))  # squares do not cancel out
    if np.finfo(float).eps * np.linalg.norm(terms) <= most:  # rounded at random
        return
    worst = dofs[own.row[terms.argmax()]]
    stiff = [item for item in system.connectors.items if worst in item.dofs]
    raise ConvergenceError(
        f"round-off leaves {what} no three digits, because stiffnesses differ by too many orders of magnitude"
        + (f", that of {in_words(stiff)} most" if stiff else ""),
        remedy="Describe what hardly deforms by a Link, a Weld or another condition" if stiff else "",
    )
