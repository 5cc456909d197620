"""Warnings of strains beyond a linear law, and of stresses beyond the strength of a material."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import InputError, LargeStrainWarning
from beamfem.kernels.block import GREEN_LAGRANGE, STRUCTURAL
from beamfem.material import Material
from beamfem.model.beam_mesh import BeamMesh
from beamfem.model.beam_names import beam_in_words
from beamfem.model.reference import energy_points, energy_stiffness_at
from beamfem.model.section_stress import layers
from beamfem.results.beam_stress import peak_stress
from beamfem.results.element_shapes import heights, pairs, rows_looked_at
from beamfem.results.finding import Finding
from beamfem.results.imposed_measures import imposed_measures
from beamfem.results.nodal import axis, nodal_vectors
from beamfem.section.protocol import CrossSection

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_LARGE = 0.2  # strain beyond which no material is linear


def large_strains(solution: "Solution") -> tuple[Finding, ...]:
    """Return a warning of the largest strain of linear laws, if beyond 0.2, and of the largest utilisation above 1."""
    sentences = (_strained(solution), _overloaded(solution)) if len(solution) else ()
    return tuple(Finding(sentence, LargeStrainWarning) for sentence in sentences if sentence)


def weights(system: System) -> np.ndarray:
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
        for material in _materials(beam.section_at(place * beam.curve.length), beam.material)
    ]
    known = [material.youngs_modulus / material.strength for material in materials if material.strength is not None]
    return max(known, default=0.0)


def _strained(solution: "Solution") -> str:
    """Return a sentence on the largest strain, empty if it is small."""
    rows, largest, where = np.arange(len(solution))[rows_looked_at(solution)], _LARGE, ""
    for number, mesh in enumerate(solution.model.meshes):
        if mesh.beam.law is not None:
            continue
        element, xi, _ = energy_points(mesh)
        strains = _strains(solution, mesh, rows)
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


def _strains(solution: "Solution", mesh: BeamMesh, rows: np.ndarray) -> np.ndarray:
    """Return the largest normal strain at the faces, or the shear strain if larger (rows, points), at energy points."""
    element, xi, _ = energy_points(mesh)
    now, forces = axis(mesh, nodal_vectors(mesh, solution.p[rows]), element, xi), mesh.beam.element.forces
    strains = forces.strains(now) - energy_stiffness_at(mesh, element, xi)[1] - imposed_measures(solution, mesh, rows)
    y = layers(mesh, element, xi)[:, [0, -1], [0, 1]]
    components = np.moveaxis(strains, -1, 0)[..., None]
    if forces.code == GREEN_LAGRANGE:
        along, sheared = components[0] + y * (components[1] + y * components[2]), 0.5 * components[4]
    elif forces.code == STRUCTURAL:
        along, sheared = components[0] - y * components[2], components[1]
    else:
        along, sheared = components[0] - y * components[1], 0.0 * components[0]
    return np.fmax(np.abs(along).max(axis=-1), np.abs(sheared)[..., 0])


def _overloaded(solution: "Solution") -> str:
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


def _where(solution: "Solution", number: int, arc: float, row: int) -> str:
    model, at = solution.model, solution.at[row]
    when = f"load factor {at:.4g}" if solution.static else f"t = {at:.4g} {model.unit('s')}"
    return f"at {arc:.4g} {model.unit('m')} of {beam_in_words(model.beams, number)} in row {row}, {when}"


def _materials(section: CrossSection, material: Material | None) -> list[Material]:
    try:
        return [own for own, _ in section.moments(material)]
    except InputError:  # the section is defined by its stiffness and has no materials
        return []
