"""Self-equilibrated stress over a section whose layers hinder each other's thermal expansion."""

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.joined_mesh import JoinedMesh
from beamfem.model.along_beam import jumps_along
from beamfem.model.imposed_strains import heat_of
from beamfem.results.solution import Solution
from beamfem.results.solution_system import imposing
from beamfem.section.protocol import CrossSection
from beamfem.section.thermal import expands_evenly, thermal_strain


def self_stress(
    solution: Solution,
    mesh: BeamMesh,
    element: np.ndarray,
    xi: np.ndarray,
    layer: int | None,
    y: np.ndarray,
    rows: slice | np.ndarray = slice(None),
) -> np.ndarray | float:
    """Return E (eps - y kappa - alpha T(y)) (steps, n, heights) [Pa] at points (element, xi); 0 if there is none.

    eps, kappa: free strains of the section; y (n, heights) [m]; layer: the one, of several, to which y belongs; None:
    the one at the axis. It does not contribute to section forces.
    """
    if not any(part.beam in solution.model.imposed_on for part in mesh.parts):
        return 0.0
    if isinstance(mesh, JoinedMesh):
        result = np.zeros((len(solution.computed(imposing)[rows]), *y.shape))
        for part, points, own in mesh.by_beam(element):
            result[:, points] = self_stress(solution, part, own, xi[points], layer, y[points], rows)
        return result
    beam = mesh.beam
    imposed = solution.model.imposed_on[beam]
    arc = mesh.section_arc_length(element, xi)
    sections = [beam.section_at(s) for s in (arc[:1] if beam.prismatic else arc).tolist()]
    if all(expands_evenly(section, beam.material) for section in sections):
        return 0.0
    each = sections * len(y) if len(sections) == 1 else sections
    units = np.array([_units(section, mesh, layer, heights) for section, heights in zip(each, y, strict=True)])
    factors = solution.computed(imposing)[rows]
    result = np.zeros((len(factors), *y.shape))
    for number, load in imposed:
        inside = mesh.arc_length_inside(element, xi, jumps_along(load))
        result += factors[:, number, None, None] * np.einsum("nhc,nc->nh", units, heat_of(load, inside))
    return result


def _units(section: CrossSection, mesh: BeamMesh, layer: int | None, y: np.ndarray) -> np.ndarray:
    """Return the stress (heights, 2) [Pa] for a change of 1 K and a gradient of 1 K/m."""
    material = mesh.beam.material
    if layer is None:
        materials = [part for part, present in section.materials_at(np.zeros(1), material) if present.any()]
    else:
        parts = section.moments(material)
        materials = [parts[min(layer, len(parts) - 1)][0]]
    free = thermal_strain(section, material)
    hindered = free[0] - y[:, None] * free[1] - materials[0].thermal_expansion * np.column_stack([np.ones_like(y), y])
    return np.asarray(materials[0].youngs_modulus * hindered)
