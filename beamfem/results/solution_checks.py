"""Checks of a solution, whose findings are its warnings, and Python warnings where they are large."""

from collections import Counter
from collections.abc import Iterable
from itertools import chain
from typing import NamedTuple, TypeVar

import numpy as np

from beamfem.curves import Line
from beamfem.element.element import Element
from beamfem.equations.redundant_conditions import in_words as parts_in_words
from beamfem.equations.system import System, system_of
from beamfem.errors import (
    CuspWarning,
    EnergyWarning,
    LargeStrainWarning,
    LockingWarning,
    RoundOffWarning,
    UnitsWarning,
    warn,
)
from beamfem.kernels.block import ELASTIC_LINE, GREEN_LAGRANGE, STRUCTURAL
from beamfem.kernels.neighbouring_nodes import LOCKED, STRAINED, exceeds
from beamfem.kernels.records import address_of
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import energy_points, energy_stiffness_at, reference_axis
from beamfem.mesh.section_stress import layers
from beamfem.model.beam import beam_in_words
from beamfem.model.check_units import doubts_of_units
from beamfem.model.missing_joints import in_words, unjoined_ends
from beamfem.model.model import Model
from beamfem.results import locking
from beamfem.results.axis_points import axis_at, nodal_vectors
from beamfem.results.beam_stress import peak_stress
from beamfem.results.energy_balance import energy_warnings
from beamfem.results.locking import heights, pairs, rows_looked_at
from beamfem.results.postprocess import nodal_rotations
from beamfem.results.solution import Solution
from beamfem.results.solution_system import imposed_measures, loading
from beamfem.results.status import Finding
from beamfem.section.moments import materials_of

_MUCH = 1.5  # [rad]: an element that turns by this much between its ends is far from the curve that it stands for


def advice(model: Model, p: np.ndarray) -> str:
    """Return "; ..." and what to do if an element is bent much in a state p (n,), or a part far stiffer than beams."""
    worst, where = 0.0, 0
    for number, mesh in enumerate(model.meshes):
        rotation = nodal_rotations(mesh, p[None])[0]
        bent = float(np.abs(np.diff(rotation[mesh.node[:, [0, -1]]], axis=1)).max())
        if bent > worst:
            worst, where = bent, number
    if not worst > _MUCH:
        found = _stiff_part(model)
        return f"; round-off of {found.words} hides the stiffness of beams: {_CONDITION}" if found else ""
    return f"; an element of {beam_in_words(model.beams, where)} is bent by {worst:.2g} rad there: use more elements"


class _StiffPart(NamedTuple):
    """A part in words, its stiffness and that of an element against stretching [N/m]."""

    words: str
    stiffness: float
    beams: float


def _stiff_part(model: Model) -> _StiffPart | None:
    """Return the stiffest part if its round-off may hide the stiffness of beams."""
    system = system_of(model, static=True)
    if not system.connectors.items:
        return None
    stiffness = system.connectors.errors[0]
    beams, stiffest = system.residual_errors[0][stiffness == 0.0], int(stiffness.argmax())
    if not (len(beams) and stiffness[stiffest] > _FAR * beams.max()):
        return None
    parts = [item for item in system.connectors.items if stiffest in item.dofs]
    return _StiffPart(parts_in_words(parts), float(stiffness[stiffest]), float(beams.max()))


def rounded(solution: Solution) -> tuple[Finding, ...]:
    """Return a finding if round-off of a stiff part changes the energy of a motion.

    Positions of size L have an error eps L, so that the force of a part of stiffness k has one of f = k eps L, which
    strains beams of stiffness k0 by the energy f^2 / (2 k0).
    """
    part = None if solution.static or solution.loaded is not None else _stiff_part(solution.model)
    if part is None:
        return ()
    system, unit = system_of(solution.model, static=False), solution.model.unit
    force = part.stiffness * float(np.finfo(float).eps) * float(np.abs(solution.p[:, system.positions]).max())
    energy = 0.5 * force**2 / part.beams
    whole = solution.energy()
    largest = float(np.maximum(whole.kinetic, np.abs(whole.strain)).max())
    if energy <= _CHANGED * largest or largest == 0.0:
        return ()
    sentence = (
        f"positions to the last digit leave the force of {part.words} uncertain by {force:.2g} {unit('N')}, which "
        f"strains the beams by {energy:.2g} {unit('J')}, compared with {largest:.2g} {unit('J')} in the motion: "
        f"{_CONDITION}"
    )
    return (Finding(sentence, RoundOffWarning),)


_FAR = 1e8  # times the stiffness of an element against stretching; against bending it is far less stiff
_CHANGED = 1e-5  # of the largest kinetic or strain energy
_CONDITION = "describe what hardly deforms by a Link, a Weld or another condition"
_ROUND_OFF = 1e-6  # of the displacements


def unjoined_warnings(solution: Solution) -> tuple[str, ...]:
    """Return a warning of the first two points at one place that move apart in the last row, if there are any."""
    model = solution.model
    straight = len(model.beams) == 1 and type(model.beams[0].curve) is Line
    if straight or not len(solution):
        return ()
    tied = [Counter(id(point.beam) for point in connector.points) for connector in model.at_points]
    for pair in unjoined_ends(model):
        if any(Counter(id(point.beam) for point in pair) <= beams for beams in tied):
            continue
        one, other = (solution.displacement(point)[-1] for point in pair)
        apart = float(np.hypot(*(one - other)))
        if apart > _ROUND_OFF * max(np.hypot(*one), np.hypot(*other)):
            moved = f"they move {apart:.3g} {model.unit('m')} apart"
            return (f"{in_words(model, pair)}, and {moved}. If they belong together, add a Rigid or a Hinge",)
    return ()


_LARGE = 0.2  # strain beyond which no material is linear


def may_turn_back(element: Element) -> bool:
    """Return whether r_x is a coordinate and the curvature comes from r_xx: r_x may then jump at joints and corners."""
    return element.forces.code == ELASTIC_LINE and "r_x" in element.field.vectors


def turned_back(mesh: BeamMesh, p: np.ndarray) -> np.ndarray:
    """Return r_x at both ends of each element times the chord (steps, ne, 2) for p (steps, n); negative at a cusp."""
    e = nodal_vectors(mesh, p)
    r, slope = (e[:, mesh.node[:, [0, -1]], mesh.vectors.index(name)] for name in ("r", "r_x"))
    return np.asarray(np.einsum("sec,senc->sen", r[:, :, 1] - r[:, :, 0], slope))


def cusps(solution: Solution) -> tuple[Finding, ...]:
    """Return a warning of the worst node whose r_x points away from the next node, where the axis has a cusp."""
    for number, mesh in enumerate(solution.model.meshes):
        if not may_turn_back(mesh.beam.element):
            continue
        rows = rows_looked_at(solution)
        along = turned_back(mesh, solution.p[rows])
        if along.min(initial=1.0) < 0.0:
            row, element, end = np.unravel_index(np.argmin(along), along.shape)
            place = _where(solution, number, float(mesh.vertices[element + end]), range(len(solution))[rows][row])
            what = "this equilibrium" if solution.static else "this state of the motion"
            sentence = (
                f"the axis turns back on itself {place}: {what} has a cusp, and is not the one that the "
                "loads lead to. Take more steps, or more elements"
            )
            return (Finding(sentence, CuspWarning),)
    return ()


# of a section: shortening of interpolated ones above which `warnings` has a sentence, and there is a Python warning
_SHORT, _MUCH_SHORTER = 0.001 / 3.0, 0.01 / 3.0  # bending stiffness goes with the third power


def short_sections(solution: Solution) -> tuple[Finding, ...]:
    """Return a warning of the curved beam whose interpolated reference has the shortest sections between its nodes.

    Continuum forces and their mass fill the interpolated body, which is lighter and softer then, without locking.
    """
    worst, where = 0.0, 0
    for number, mesh in enumerate(solution.model.meshes):
        if mesh.beam.element.forces.fills_body and not mesh.straight:
            element, xi, weight = energy_points(mesh)
            sizes = np.linalg.norm(reference_axis(mesh, element, xi).d, axis=-1)
            short = 1.0 - float(weight @ sizes / weight.sum())
            if short > worst:
                worst, where = short, number
    if worst <= _SHORT:
        return ()
    beam = beam_in_words(solution.model.beams, where)
    sentence = (
        f"sections of {beam} are {100.0 * worst:.2g} % too short between the nodes of its curved elements, which are "
        "too light by as much and too soft by three times that. Use more elements, or structural forces"
    )
    return (Finding(sentence, LockingWarning if worst > _MUCH_SHORTER else None),)


def large_strains(solution: Solution) -> tuple[Finding, ...]:
    """Return a warning of the largest strain of linear laws, if beyond 0.2, and of the largest utilisation above 1."""
    sentences = (_strained(solution), _overloaded(solution)) if len(solution) else ()
    return tuple(Finding(sentence, LargeStrainWarning) for sentence in sentences if sentence)


def strain_weights(system: System) -> np.ndarray:
    """Return weights (2, m) of the stretch and the angle between neighbouring nodes: below 1 in sum, nothing is large.

    The angle counts as a shear strain too.
    """
    neighbours, meshes = system.table(pairs), system.model.meshes
    linear = np.array([mesh.beam.law is None for mesh in meshes])[neighbours.mesh] / _LARGE
    loaded = np.array([_strain_per_utilisation(mesh) for mesh in meshes])[neighbours.mesh]
    bent = 3.0 * system.table(heights) / neighbours.length
    return np.stack([np.maximum(linear, loaded), np.maximum(np.fmax(bent, 1.0) * linear, bent * loaded)])


def hindered(system: System) -> bool:
    """Return whether loads impose strains on materials whose strength is known; such stresses may move no node."""
    return bool(system.model.imposing) and any(map(_strain_per_utilisation, system.model.meshes))


def _strain_per_utilisation(mesh: BeamMesh) -> float:
    """Return the largest ratio of Young's modulus to strength of the materials of a beam; 0 if no strength is given."""
    beam = mesh.beam
    places = (0.0,) if beam.prismatic else (0.0, 0.5, 1.0)
    materials = [
        material
        for place in places
        for material in materials_of(beam.section_at(place * beam.curve.length), beam.material)
    ]
    known = [material.youngs_modulus / material.strength for material in materials if material.strength is not None]
    return max(known, default=0.0)


def _strained(solution: Solution) -> str:
    """Return a sentence on the largest strain, empty if it is small."""
    rows, largest, where = np.arange(len(solution))[rows_looked_at(solution)], _LARGE, ""
    for number, (mesh, at) in enumerate(
        zip(solution.model.meshes, loading(solution)[0].table(_strained_points), strict=True)
    ):
        if mesh.beam.law is not None:
            continue
        element, xi, *_ = at
        strains = _strains(solution, mesh, at, rows)
        row, point = np.unravel_index(int(strains.argmax()), strains.shape)
        if strains[row, point] > largest:
            largest = float(strains[row, point])
            arc = float(mesh.arc_length(element[[point]], xi[[point]])[0])
            where = _where(solution, number, arc, int(rows[row]))
    if not where:
        return ""
    return (
        f"strains reach {largest:.3g} {where}: beyond {_LARGE:g} no material follows a linear law. Check units and "
        "loads, or give the section a law of its own"
    )


def _strained_points(system: System) -> list[tuple[np.ndarray, ...]]:
    """Return element, xi (points,), reference strains (points, ns) and y of the faces (points, 2) of each beam."""
    meshes = system.model.meshes
    places = [energy_points(mesh)[:2] for mesh in meshes]
    return [
        (*at, energy_stiffness_at(mesh, *at)[1], layers(mesh, *at)[:, [0, -1], [0, 1]])
        for mesh, at in zip(meshes, places, strict=True)
    ]


def _strains(solution: Solution, mesh: BeamMesh, at: tuple[np.ndarray, ...], rows: np.ndarray) -> np.ndarray:
    """Return the largest normal strain at the faces, or the shear strain if larger (rows, points), at energy points."""
    element, xi, reference, y = at
    now, forces = axis_at(mesh, solution.p[rows], element, xi), mesh.beam.element.forces
    strains = forces.strains(now) - reference - imposed_measures(solution, mesh, rows)
    components = np.moveaxis(strains, -1, 0)[..., None]
    if forces.code == GREEN_LAGRANGE:
        along, sheared = components[0] + y * (components[1] + y * components[2]), 0.5 * components[4]
    elif forces.code == STRUCTURAL:
        along, sheared = components[0] - y * components[2], components[1]
    else:
        along, sheared = components[0] - y * components[1], 0.0 * components[0]
    return np.fmax(np.abs(along).max(axis=-1), np.abs(sheared)[..., 0])


def _overloaded(solution: Solution) -> str:
    """Return a sentence on the largest utilisation, empty if it is at most 1 or no strength is given."""
    if not any(map(_strain_per_utilisation, solution.model.meshes)):
        return ""
    rows = rows_looked_at(solution)
    peak = peak_stress(solution[rows], "utilisation")
    if not peak.value > 1.0:
        return ""
    number = solution.model.number_of(peak.beam)
    where = _where(solution, number, peak.arc_length, int(np.arange(len(solution))[rows][peak.row]))
    return (
        f"the utilisation of the strength reaches {peak.value:.3g} {where}: the material would yield or break, which "
        "is not part of the model"
    )


def _where(solution: Solution, number: int, arc: float, row: int) -> str:
    model, at = solution.model, solution.at[row]
    when = f"load factor {at:.4g}" if solution.static else f"t = {at:.4g} {model.unit('s')}"
    return f"at {arc:.4g} {model.unit('m')} of {beam_in_words(model.beams, number)} in row {row}, {when}"


_Solution = TypeVar("_Solution", bound=Solution)


def findings(solution: Solution) -> tuple[Finding, ...]:
    """Return all that is found wrong with a solution, besides what its solver has found."""
    found = chain(*map(solution.computed, (locking.locking, large_strains, cusps, short_sections, rounded)))
    energy = [Finding(sentence, EnergyWarning) for sentence in solution.computed(energy_warnings)]
    doubts = doubts_of_units(solution.model.beams, solution.model.loads, solution.model.units)
    units = [Finding(sentence, UnitsWarning) for sentence in doubts]
    return (*found, *energy, *units, *map(Finding, unjoined_warnings(solution)))


def warned(solution: _Solution) -> _Solution:
    """Return a solution that has just been found, after Python warnings of what is wrong with it by 1 % and more."""
    warn_of((*solution.computed(cusps), *solution.computed(short_sections), *solution.computed(rounded)))
    found = _found(loading(solution)[0], solution.p[rows_looked_at(solution)])
    if found & LOCKED:
        warn_of(solution.computed(locking.locking))
    if found & STRAINED:
        warn_of(solution.computed(large_strains))
    return solution


def warned_motion(solution: _Solution) -> _Solution:
    """Return a motion that has just been found, after Python warnings of its energy and of what `warned` looks for."""
    for sentence in solution.computed(energy_warnings):
        warn(sentence, EnergyWarning)
    return warned(solution)


def warn_of(found: Iterable[Finding]) -> None:
    """Issue a Python warning for every finding with a category."""
    for finding in found:
        if finding.kind is not None:
            warn(finding.sentence, finding.kind)


def _bounds(system: System) -> tuple[np.ndarray, ...]:
    """Return the table of `exceeds` and the arrays that it has the addresses of.

    Within its bounds no strains are large, and no result changes by 1 % without locking.
    """
    neighbours, known = system.table(pairs), STRAINED if hindered(system) else 0
    weights = np.vstack([locking.weights(system), strain_weights(system)])
    arrays = neighbours.numbers, np.hstack([neighbours.at_rest.view(float), weights.T])
    table = [system.model.size, len(arrays[1]), known, *map(address_of, arrays)]
    return np.array(table, dtype=np.int64), *arrays


def _found(system: System, p: np.ndarray, times: int = 1) -> int:
    """Return what may be wrong with states p (rows, n), see `exceeds`; times: factor of angles for locking."""
    states = np.array(p)  # those of a solution cannot be written to, which makes addresses slow
    return int(exceeds.compiled(address_of(system.table(_bounds)[0]), address_of(states), len(states), times))


def may_lock(system: System, p: np.ndarray) -> bool:
    """Return whether locking may change frequencies about a state p (n,) by 1 %, which are sensitive twice as much."""
    return bool(_found(system, p[None], 2) & LOCKED)
