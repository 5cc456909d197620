"""Stress of sections: measures of it, strength, self-stress of layers, and a warning where none is defined."""

from collections.abc import Sequence

import numpy as np

from beamfem.element.fields import Axis
from beamfem.errors import UnknownStressWarning, warn
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.joined_mesh import JoinedMesh
from beamfem.mesh.reference import sections_at
from beamfem.model.along_beam import jumps_along
from beamfem.model.beam import Beam, names
from beamfem.model.imposed_strains import heat_of
from beamfem.results.axis_points import AxisPoints
from beamfem.results.solution import Solution
from beamfem.results.solution_system import imposing
from beamfem.section.moments import materials_of
from beamfem.section.protocol import CrossSection
from beamfem.section.thermal import expands_evenly, thermal_strain


def von_mises(along: np.ndarray, sheared: np.ndarray) -> np.ndarray:
    """Return the von Mises stress sqrt(sigma^2 + 3 tau^2) [Pa] of a normal and a shear stress."""
    return np.sqrt(along**2 + 3.0 * sheared**2)


def in_the_plane(along: np.ndarray, sheared: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the stress tensor (steps, points, heights, 6) [Pa] in global axes: xx, yy, zz, xy, yz, xz.

    along, sheared (steps, points, heights) [Pa]: along the normal (steps, points, 2) of the section, and in it.
    """
    x, y = normal[..., None, 0], normal[..., None, 1]
    zero = np.zeros_like(along)
    both = along * x * y + sheared * (x**2 - y**2)
    parts = (along * x**2 - 2.0 * sheared * x * y, along * y**2 + 2.0 * sheared * x * y, zero, both, zero, zero)
    return np.stack(parts, axis=-1)


def second_piola_kirchhoff(cauchy: np.ndarray, now: Axis, reference: Axis, y: np.ndarray) -> np.ndarray:
    """Return the second Piola-Kirchhoff stress (steps, points, heights, 6) [Pa] for a Cauchy stress, in this order.

    S = det(F) F^-1 sigma F^-T in global axes, with F = (r0' + y d', d) J^-1 and J the same for the reference
    configuration; nan where F is singular.
    """
    (ax, ay), (bx, by) = _derivatives(now, y)
    (jx, jy), (kx, ky) = _derivatives(reference, y)
    xx, yy, xy = (cauchy[..., component] for component in (0, 1, 3))
    # det(G) G^-1 sigma G^-T det(G) with the columns a and b of G: minors instead of the inverse avoid a division
    first = by**2 * xx - 2.0 * bx * by * xy + bx**2 * yy
    second = ay**2 * xx - 2.0 * ax * ay * xy + ax**2 * yy
    mixed = (ax * by + ay * bx) * xy - ay * by * xx - ax * bx * yy
    size = (ax * by - ay * bx) * (jx * ky - jy * kx)
    size = np.where(size == 0.0, np.nan, size)
    of_x, of_y, zero = (jx, kx), (jy, ky), np.zeros_like(xx)

    def component(one: tuple[np.ndarray, ...], other: tuple[np.ndarray, ...]) -> np.ndarray:
        (j, k), (n, m) = one, other
        return (j * n * first + (j * m + n * k) * mixed + k * m * second) / size

    parts = (component(of_x, of_x), component(of_y, of_y), zero, component(of_x, of_y), zero, zero)
    return np.stack(parts, axis=-1)


def _derivatives(axis: Axis, y: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return components x and y (..., points, heights) of the derivatives of the position by arc length and by y."""
    along = axis.r_s[..., None, :] + y[..., None] * axis.d_s[..., None, :]
    up = np.broadcast_to(axis.d[..., None, :], along.shape)
    return [along[..., 0], along[..., 1]], [up[..., 0], up[..., 1]]


def strengths(grid: Grid, element: np.ndarray, xi: np.ndarray, layers: int) -> np.ndarray:
    """Return the strength (layers, n) [Pa] of each layer of the sections at points (element, xi); nan if none is given.

    Sections with fewer layers repeat the last one.
    """
    prismatic = isinstance(grid.beam.section, CrossSection)
    sections = [grid.beam.section_at(0.0)] if prismatic else sections_at(grid, element, xi)
    rows = []
    for section in sections:
        own = [material.strength for material in materials_of(section, grid.beam.material)] or [None]
        rows.append((own + own[-1:] * layers)[:layers])  # the last one counts for missing layers too
    values = np.array(rows, dtype=float).T
    return np.broadcast_to(values, (layers, len(element))) if prismatic else values


_NAMED = 10  # beams that the warning names


def warn_of_unknown_stress(beams: Sequence[Beam], unknown: Sequence[int], what: str) -> None:
    """Warn of beams by their numbers, if there are any; what: what becomes of their stress, such as "left out"."""
    if not unknown:
        return
    called = names(beams)
    shown = ", ".join(called[number] for number in unknown[:_NAMED]) + (", ..." if len(unknown) > _NAMED else "")
    warn(
        f"the stress of {len(unknown)} of {len(beams)} beams ({shown}) is not known and is {what}: their sections are "
        "given by a stiffness, a law of their own, or moments without a height; Section(..., height=) gives it",
        UnknownStressWarning,
    )


def stress_in_layer(
    solution: Solution,
    points: AxisPoints,
    layer: int | None,
    y: np.ndarray,
    forces: np.ndarray,
    rows: slice | np.ndarray = slice(None),
) -> tuple[np.ndarray, np.ndarray]:
    """Return normal and shear stress (steps, n, heights) [Pa] of section forces (steps, 3, n), see `self_stress`."""
    along = points.distributions.normal_stress(layer, y, forces[:, 0], forces[:, 2])
    along = along + self_stress(solution, points, layer, y, rows)
    return along, points.distributions.shear_stress(layer, y, forces[:, 1])


def self_stress(
    solution: Solution, points: AxisPoints, layer: int | None, y: np.ndarray, rows: slice | np.ndarray = slice(None)
) -> np.ndarray | float:
    """Return E (eps - y kappa - alpha T(y)) (steps, n, heights) [Pa] at points of a beam; 0 if there is none.

    eps, kappa: free strains of the section; y (n, heights) [m]; layer: the one, of several, to which y belongs; None:
    the one at the axis. It does not contribute to section forces.
    """
    mesh, element, xi = points.mesh, points.element, points.xi
    if not any(part.beam in solution.model.imposed_on for part in mesh.parts):
        return 0.0
    if isinstance(mesh, JoinedMesh):
        result = np.zeros((len(solution.computed(imposing)[rows]), *y.shape))
        for part, some, own in mesh.by_beam(element):
            result[:, some] = self_stress(solution, AxisPoints(part, own, xi[some]), layer, y[some], rows)
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
