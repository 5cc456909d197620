"""Estimate of how far locking changes a result from that of the same mesh without locking."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.element.coordinates import KINEMATICS, Gradients, ShearFree, labels
from beamfem.element.element import Element, has_stations
from beamfem.equations.assembler import Equations
from beamfem.equations.blocks import build_block
from beamfem.equations.equations import STATICS, linearise, predicted_stresses, residual
from beamfem.equations.system import System, system_of
from beamfem.errors import LockingWarning
from beamfem.kernels.block import GREEN_LAGRANGE
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import beam_in_words, sections_along
from beamfem.model.model import Model
from beamfem.precision.roundoff import row_floors
from beamfem.results import postprocess
from beamfem.results.solution import Solution, State
from beamfem.results.solution_system import imposed_measures
from beamfem.results.status import Finding

ROWS = 32  # of a solution that are looked at


class Pairs(NamedTuple):
    """Neighbouring nodes (m,) of elements.

    numbers (m, 8): of their coordinates, as `kernels.neighbouring_nodes` takes them; at_rest (m, 3): inverse of the
    chord and of r_y at both ends in the reference, as complex numbers; length (m,) [m]; curved (m,): largest angle
    [rad] of the chord against the axis at its ends in the reference; mesh (m,): number of the beam.
    """

    numbers: np.ndarray
    at_rest: np.ndarray
    length: np.ndarray
    curved: np.ndarray
    mesh: np.ndarray


def rows_looked_at(solution: Solution) -> slice:
    """Return up to `ROWS` rows of a solution, the last one among them, and of few all but the first, its start."""
    count = len(solution)
    stride = -(-count // ROWS)
    return slice((count - 1) % stride if stride > 1 else min(1, count - 1), None, stride)


def pairs(system: System) -> Pairs:
    """Return the neighbouring nodes of all elements of a model."""
    ends, columns, frames, meshes = [], [], [], []
    for number, mesh in enumerate(system.model.meshes):
        nodes = np.stack([mesh.node[:, :-1].ravel(), mesh.node[:, 1:].ravel()])
        ends.append(mesh.kinematics.dof[:, :2][nodes])
        columns.append(_section_columns(mesh)[nodes])
        frames.append(mesh.kinematics.frame[nodes])
        meshes.append(np.full(nodes.shape[1], number))
    positions, sections = np.concatenate(ends, axis=1), np.concatenate(columns, axis=1)
    frame, p = np.concatenate(frames, axis=1), system.reference
    chord = _vectors(p[positions[1]] - p[positions[0]])
    directed = sections[..., 1] >= 0
    at_rest = np.ones((3, len(chord)), dtype=complex)
    at_rest[0] /= chord
    at_rest[1:][directed] /= _vectors(p[sections[directed]])
    return Pairs(
        np.hstack([*positions, *sections]),
        at_rest.T.copy(),
        np.abs(chord),
        np.abs(np.angle(_vectors(frame) / chord)).max(axis=0),
        np.concatenate(meshes),
    )


def _vectors(components: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2 or more) as complex numbers."""
    return np.asarray(components[..., 0] + 1j * components[..., 1])


def _section_columns(mesh: BeamMesh) -> np.ndarray:
    """Return the numbers (nodes, 2) of the coordinates of the section of each node: its angle and -1, or r_y."""
    result = np.empty((mesh.nodes, 2), dtype=np.int64)
    for node_kind, nodes in mesh.node_kinds:
        last = len(labels(node_kind, mesh.vectors)) - 1
        dof = mesh.kinematics.dof[nodes]
        result[nodes, 0] = dof[:, last if node_kind in KINEMATICS else last - 1]
        result[nodes, 1] = -1 if node_kind in KINEMATICS else dof[:, last]
    return result


def heights(system: System) -> np.ndarray:
    """Return the height (m,) [m] of the section in the middle of the elements of neighbouring nodes."""
    parts = []
    for mesh in system.model.meshes:
        arc = 0.5 * (mesh.vertices[1:] + mesh.vertices[:-1])
        own = np.array([np.ptp(section.bounds) for section in sections_along(mesh.beam, arc)])
        parts.append(np.repeat(np.broadcast_to(own, len(arc)), mesh.node.shape[1] - 1))
    return np.concatenate(parts)


_TOLD = 1e-3  # relative change of a result above which `warnings` has a sentence
_WARNED = 1e-2  # and above which there is a Python warning
# repeated with the stresses of the last prediction: the large locking stresses would restrain the first step
_PREDICTIONS = 3
_LEAST = 1e-9  # of a length: height of a section without one
_SHORT = 0.1  # of the height of the section: length of elements that do not lock
_ROWS = 32  # rows of a solution among which the most strained is assessed
_THICKNESS = (3, 5)  # eyy and g1 = d.d' of `GREEN_LAGRANGE`


def locking(solution: Solution) -> tuple[Finding, ...]:
    """Return a warning if locking changes the displacements by more than 1e-3 of the largest."""
    if not len(solution) or not _unlocked(solution.model):
        return ()
    rows = np.unique(np.linspace(0, len(solution) - 1, _ROWS).astype(int))
    energy = sum(
        postprocess.strain_energies(mesh, solution.p[rows], imposed_measures(solution, mesh, rows))[:, 0]
        for mesh in solution.model.meshes
    )
    span = None if solution.static else float(np.ptp(solution.at))
    change, work = _change(solution[int(rows[np.argmax(energy)])], span)
    return _found(solution.model, change, work, "the largest displacement")


def stiffness_locking(state: State, shapes: np.ndarray, power: float, what: str) -> tuple[Finding, ...]:
    """Return a warning if locking changes a result, from the Rayleigh quotient with locking-free strains.

    state: the state about which the shapes (m, n), over all coordinates, were found; power: of their stiffness, with
    which the result grows.
    """
    if not _unlocked(state.model):
        return ()
    system = system_of(state.model, static=True)
    zeros, free = np.zeros(len(state.p)), system.free_dofs
    at, unlocked = (state.p, zeros, zeros, state.at), system.table(_unlocked_equations)
    _, _, predicted = _step(system, at, STATICS, unlocked)
    before, after = (
        linearise(system, *at, STATICS, stresses, equations)[1].sparse(system.rotated)
        for equations, stresses in ((system.equations, None), (unlocked, predicted))
    )
    change, work = 0.0, zeros.copy()
    for shape in np.real(shapes[:, free]):
        excess, stiffness = shape * ((before - after) @ shape), float(shape @ (before @ shape))
        if stiffness > 0.0 and (found := power * abs(float(excess.sum())) / stiffness) > change:
            change, work[free] = found, excess
    return _found(state.model, change, work, what)


def weights(system: System) -> np.ndarray:
    """Return weights (2, m), the second that of an angle of 1, of angles between neighbouring nodes.

    While their sum is below 1, locking changes displacements by less than 1 %. Cubic elements lock by at most about
    half of a^2 (1 + (l / h)^2), where a is the largest angle between the sections at their ends, now and in the
    reference, in sum. A director between unit vectors with the angle 2 a between them is shorter by a^2 / 2, which
    changes the moment by 3/2 a^2 (l / h)^2. Full integration of other fields locks by about (l / h)^2 / 3 at most,
    however little they bend.
    """
    neighbours = system.table(pairs)
    ratio = neighbours.length / np.maximum(system.table(heights), _LEAST * neighbours.length)
    result, unlocked = np.zeros((2, len(ratio))), _unlocked(system.model)
    for number, mesh in enumerate(system.model.meshes):
        own = neighbours.mesh == number
        if mesh.block not in unlocked:
            continue
        element = mesh.beam.element
        bends = has_stations(element.field) and not isinstance(element.coordinates, ShearFree)
        if bends or (_resists_its_director(element) and element.integration == "reduced"):
            result[0, own] = 2.0 * np.hypot(1.0, ratio[own]) / np.sqrt(_WARNED)
            result[1, own] = result[0, own] * neighbours.curved[own]
        else:
            result[1, own] = np.inf if ratio[own].max() > _SHORT else 0.0
    return result


def _change(state: State, span: float | None) -> tuple[float, np.ndarray]:
    """Return the largest change of a position in a Newton step to the locking-free mesh, over the displacement.

    The second result is the work (n,) [J] of the excess forces along each coordinate.
    span: duration [s] of a motion, whose inertia keeps the tangent of an unsupported body regular; None in statics.
    """
    system = system_of(state.model, span is None)
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    moved = float(np.linalg.norm((state.p - system.reference)[nodes], axis=1).max())
    if moved == 0.0 or span == 0.0:
        return 0.0, np.zeros(len(state.p))
    weights = STATICS if span is None else (1.0, 0.0, 1.0 / span**2)
    unlocked = system.table(_unlocked_equations)
    step, work, _ = _step(system, (state.p, state.v, state.a, state.at), weights, unlocked)
    return float(np.linalg.norm(step[nodes], axis=1).max()) / moved, work


def _step(
    system: System,
    at: tuple[np.ndarray, np.ndarray, np.ndarray, float],
    weights: tuple[float, float, float],
    unlocked: Equations,
) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, ...] | None]:
    """Return a Newton step (n,) to the locking-free mesh, the work (n,) [J] of the excess forces, and the stresses.

    They are None, and the step zero, where there is nothing to unlock.
    """
    free, step, work = system.free_dofs, np.zeros(len(at[0])), np.zeros(len(at[0]))
    stresses: tuple[np.ndarray, ...] | None = None
    floors = row_floors(system, at[0])[free]
    for _ in range(_PREDICTIONS):
        other, tangent = linearise(system, *at, weights, stresses, unlocked)
        excess = (other - residual(system, *at))[free]
        if np.all(np.abs(excess) <= 2.0 * floors):
            break
        try:
            found = tangent.solve(-excess, system.rotated)
        except LinAlgError:
            return np.zeros(len(step)), np.zeros(len(step)), None
        step[free], work[free] = found, -excess * found
        stresses = predicted_stresses(system, at[0], step, at[3], unlocked)
    return step, work, stresses


def _unlocked(model: Model) -> dict[int, Element]:
    """Return the element of each block that may lock, by its number, with an integration rule that avoids locking."""
    result, first = {}, {mesh.block: mesh for mesh in reversed(model.meshes)}
    for number, element in enumerate(model.groups):
        other = element.without_locking
        # the history at the points of another rule is not known
        compared = first[number].beam.law is None or (other.law_points > 0 and not first[number].history.size)
        if (other != element or _resists_its_director(element)) and compared:
            result[number] = other
    return result


def _resists_its_director(element: Element) -> bool:
    """Return whether a director that the field makes shorter between unit nodal vectors causes thickness strain."""
    unit = not isinstance(element.coordinates, Gradients)
    return unit and element.forces.code == GREEN_LAGRANGE and not has_stations(element.field)


def _unlocked_equations(system: System) -> Equations:
    """Return the equations without locking."""
    blocks = list(system.blocks)
    for number, other in _unlocked(system.model).items():
        meshes = [(i, mesh) for i, mesh in enumerate(system.model.meshes) if mesh.block == number]
        changed = [(i, replace(mesh, beam=replace(mesh.beam, element=other))) for i, mesh in meshes]
        blocks[number] = build_block(other, changed, system.model.imposing)
        if _resists_its_director(other):
            stiffness = blocks[number].stiffness.copy()
            stiffness[..., _THICKNESS, :] = stiffness[..., _THICKNESS] = 0.0
            blocks[number] = blocks[number]._replace(stiffness=stiffness)
    return system.equations_of(blocks)


def _found(model: Model, change: float, work: np.ndarray, what: str) -> tuple[Finding, ...]:
    if change <= _TOLD:
        return ()
    unlocked = _unlocked(model)
    elements = [model.groups[number] for number in unlocked]
    names = ", ".join(dict.fromkeys(f"{element.name} ({element.forces.name} forces)" for element in elements))
    cures = " or ".join(dict.fromkeys(_cure(model.groups[number], other) for number, other in unlocked.items()))
    size = f"about {100.0 * change:.2g} %" if change < 1.0 else "more than 100 %"
    shares = [
        work[np.unique(mesh.kinematics.dof[mesh.kinematics.dof >= 0])].sum() if mesh.block in unlocked else -np.inf
        for mesh in model.meshes
    ]
    place = f", most in {beam_in_words(model.beams, int(np.argmax(shares)))}" if len(shares) > 1 else ""
    sentence = (
        f"elements lock{place}: {names}; without locking {what} would change by {size} on this mesh. Use {cures}, or "
        "more elements"
    )
    return (Finding(sentence, LockingWarning if change >= _WARNED else None),)


def _cure(element: Element, other: Element) -> str:
    rule = f'integration="{other.integration}"'
    if not _resists_its_director(element):
        return rule
    return "structural forces or a higher order" if other == element else f"{rule} with structural forces"
