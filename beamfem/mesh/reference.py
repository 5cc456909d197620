"""The stress-free reference of a beam: axis, section stiffness and inertia at points of elements."""

from itertools import pairwise
from typing import Any

import numpy as np

from beamfem.element.coordinates import across
from beamfem.element.element import Element
from beamfem.element.fields import Axis, cross, d_slots, dot, length_rule, r_slots, section_frame, slots
from beamfem.errors import InputError
from beamfem.mesh.beam_grid import Grid
from beamfem.model.beam import Beam, sections_along
from beamfem.section.protocol import CrossSection
from beamfem.validation import of_package, shown

_SHORT, _INSIDE = 1e-4, 1e-6  # of an element: distance of the points of a curvature, and of the first from the end


def scales(element: Element, lengths: np.ndarray) -> np.ndarray:
    """Return the scale (n, nv) of each nodal vector for mesh lengths (n,): the length for r_x, else 1."""
    vectors, nodes = element.field.vectors, len(element.field.nodes)
    result = np.ones((len(lengths), nodes * len(vectors)))
    if "r_x" in vectors:
        result[:, slots(vectors, nodes, ("r_x",))] = lengths[:, None]
    return result


def reference_vectors(grid: Grid, element: np.ndarray) -> np.ndarray:
    """Return the nodal vectors e (n, nv, 2) of elements (n,), with positions relative to the element's first node."""
    node = grid.node[element]
    tangent = grid.tangent[node]
    if grid.straight:
        # exact: differences of positions far from the origin would cause strains
        along = grid.lengths[element][:, None] * grid.beam.element.field.nodes
        position = along[:, :, None] * tangent
    else:
        position = grid.position[node] - grid.position[node[:, :1]]
    values = {"r": position, "r_x": tangent * grid.speed[node][:, :, None], "r_y": across(tangent)}
    stacked = np.stack([values[name] for name in grid.beam.element.field.vectors], axis=2)
    return np.asarray(stacked.reshape(len(element), -1, 2))


def jacobians(grid: Grid, element: np.ndarray, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return ds/dxi and its derivative by xi (n,) [m] of the reference at points (element, xi)."""
    if grid.straight:
        lengths = grid.lengths[element]
        return lengths, np.zeros(lengths.shape)
    field = grid.beam.element.field
    local = reference_vectors(grid, element) * scales(grid.beam.element, grid.lengths[element])[:, :, None]
    r = local[:, r_slots(field)]
    slope = np.einsum("qi,qic->qc", field.centreline(xi, 1), r)
    bend = np.einsum("qi,qic->qc", field.centreline(xi, 2), r)
    size = np.linalg.norm(slope, axis=-1)
    return size, dot(slope, bend) / size


def interpolate(grid: Grid, vectors: np.ndarray, element: np.ndarray, xi: np.ndarray) -> Axis:
    """Return the axis (steps, n, 2) at points (element, xi) for nodal vectors of elements (steps, n, nv, 2)."""
    element_type = grid.beam.element
    field = element_type.field
    local = vectors * scales(element_type, grid.lengths[element])[:, :, None]
    r, d = local[:, :, r_slots(field)], local[:, :, d_slots(field)]
    size, bend = jacobians(grid, element, xi)
    slope = 1.0 / size[:, None]

    def sum_over(table: np.ndarray, values: np.ndarray) -> np.ndarray:
        return np.asarray((table[:, None] @ values)[:, :, 0])

    first = field.centreline(xi, 1) * slope
    if element_type.forces.turns_with == "r_x":
        second = (field.centreline(xi, 2) - (bend / size)[:, None] * field.centreline(xi, 1)) * slope**2
        r_ss = sum_over(second, r)
    else:
        r_ss = np.zeros((len(vectors), len(element), 2))
    return Axis(
        sum_over(field.centreline(xi), r),
        sum_over(first, r),
        r_ss,
        sum_over(field.director(xi), d),
        sum_over(field.director(xi, 1) * slope, d),
    )


def reference_axis(grid: Grid, element: np.ndarray, xi: np.ndarray) -> Axis:
    """Return the reference axis (n, 2) at points (element, xi), with positions relative to the element's first node."""
    if grid.straight:
        along = grid.tangent[grid.node[element, 0]]
        none = np.zeros(along.shape)
        return Axis((xi * grid.lengths[element])[:, None] * along, along, none, across(along), none)
    axis = interpolate(grid, reference_vectors(grid, element)[None], element, xi)
    return Axis(*(getattr(axis, name)[0] for name in Axis._fields))


def reference_position(grid: Grid, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Return the positions (n, 2) [m] of points (element, xi) of the axis in the reference.

    On a curved beam they differ from the curve by the interpolation error.
    """
    return np.asarray(grid.position[grid.node[element, 0]] + reference_axis(grid, element, xi).r)


def stations(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return element and xi of the points where section forces are evaluated."""
    element, xi, _ = _points(grid, None, *grid.beam.element.quadrature())
    return element, xi


def energy_points(grid: Grid, element: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return element, xi and weight [m] (n,) of the points of the strain energy, of all elements or some."""
    return _points(grid, element, *grid.beam.element.energy_points())


def energy_stiffness_at(grid: Grid, element: np.ndarray, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the stiffness (n, ns, ns) that enters the energy and the reference strains (n, ns), at its points."""
    element_type = grid.beam.element
    stiffness, reference = stiffness_at(grid, element, xi)
    jacobian = grid.lengths[element] if grid.straight else jacobians(grid, element, xi)[0]
    points = len(element_type.energy_points()[0])
    by_element = stiffness.reshape(-1, points, *stiffness.shape[1:])
    if grid.beam.law is not None:  # it may couple strains that are not coupled at zero strain
        return (by_element * element_type.coupled_fractions).reshape(stiffness.shape), reference
    return element_type.energy_stiffness(by_element, jacobian.reshape(-1, points)).reshape(stiffness.shape), reference


def length_points(grid: Grid, element: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return element, xi and weight [m] of the points that integrate mass exactly on a straight prismatic beam."""
    return _points(grid, element, *length_rule(grid.beam.element.field))


def _stiffness(beam: Beam, section: CrossSection, at: Axis) -> np.ndarray:
    """Return the stiffness (n, ns, ns) of a section at points of the axis. Raises InputError."""
    forces = beam.element.forces
    found = forces.stiffness(section, beam.material, beam.element.coordinates, at)
    kind: Any = type(forces)
    if of_package(kind):
        return found
    shape = (*at.r_s.shape[:-1], len(forces.shear_measures), len(forces.shear_measures))
    right = isinstance(found, np.ndarray) and found.dtype == np.float64 and not isinstance(found, np.ma.MaskedArray)
    if not right or found.shape != shape or not np.isfinite(found).all():
        raise InputError(
            f"stiffness of {kind.__name__} must be an array {shape} of finite floats, got {shown(found)} of shape "
            f"{np.shape(found)}"
        )
    return found


def stiffness_at(grid: Grid, element: np.ndarray, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return section stiffness (n, ns, ns) and strain measures (n, ns) of the reference at points (element, xi)."""
    beam, forces = grid.beam, grid.beam.element.forces
    if grid.straight and beam.prismatic:
        # the same at all points
        along, none = np.array([grid.tangent[0].tolist()]), np.zeros((1, 2))
        at = Axis(none, along, none, across(along), none)
        strains, stiffness = forces.strains(at), _stiffness(beam, beam.section_at(0.0), at)
        return stiffness.repeat(len(element), axis=0), strains.repeat(len(element), axis=0)
    at = reference_axis(grid, element, xi)
    sections = sections_at(grid, element, xi)
    places = np.array_split(np.arange(len(element)), len(sections))
    parts = [
        _stiffness(beam, section, Axis(*(values[some] for values in at)))
        for section, some in zip(sections, places, strict=True)
    ]
    return np.concatenate(parts), forces.strains(at)


def sections_at(grid: Grid, element: np.ndarray, xi: np.ndarray) -> list[CrossSection]:
    """Return the sections at points (element, xi): a single one stands for all along a prismatic beam."""
    return sections_along(grid.beam, np.zeros(1) if grid.beam.prismatic else grid.section_arc_length(element, xi))


def curvature(grid: Grid, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Return the curvature of the curve (n,) [1/m] at points (element, xi), > 0 towards +y.

    It is the slope of a parabola through the tangent's angles at three points next to each other inside the element,
    since there may be a corner at its end.
    """
    if grid.straight:
        return np.zeros(len(element))
    start, end = grid.ends(element)
    near, inside = _SHORT * (end - start), (_SHORT + _INSIDE) * (end - start)
    arc = grid.arc_length(element, xi)
    middle = np.clip(arc, start + inside, end - inside)
    tangents = [grid.tangents(element, middle + side * near) for side in (-1, 0, 1)]
    before, after = (np.arctan2(cross(one, other), dot(one, other)) for one, other in pairwise(tangents))
    return (0.5 * (before + after) + (arc - middle) / near * (after - before)) / near


def inertia_points(grid: Grid) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return element, xi and inertia (n, 3) of the points that integrate mass.

    inertia: mass [kg], its first moment [kg m] and its second [kg m^2] over y, quadrature weight included.
    """
    where, at, weight = length_points(grid)
    return where, at, inertia_at(grid, where, at, weight)


def inertia_at(grid: Grid, where: np.ndarray, at: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Return the inertia (n, 3) at points (where, at) with weights (n,) [m], see `inertia_points`."""
    beam, sections = grid.beam, sections_at(grid, where, at)
    inertias = [section.inertia(beam.material) for section in sections]
    inertia = np.array([[per_length.mass, per_length.first_moment, per_length.rotary] for per_length in inertias])
    if beam.element.forces.fills_body and not grid.straight:
        # det J = alpha + beta y of the curved body
        reference = reference_axis(grid, where, at)
        along, _ = section_frame(reference.d)
        size = np.linalg.norm(reference.d, axis=-1)
        alpha, beta = dot(reference.r_s, along) * size, dot(reference.d_s, along) * size
        # first, second and third mass moment per length over y
        raised = np.array(
            [
                sum(part.density * moments[1:4] for part, moments in section.moments(beam.material))
                for section in sections
            ]
        )
        inertia = alpha[:, None] * inertia + beta[:, None] * raised
    return inertia * weight[:, None]


def reference_angle(grid: Grid) -> np.ndarray:
    """Return the angle of each node's tangent (nodes,) [rad]."""
    return np.arctan2(grid.tangent[:, 1], grid.tangent[:, 0])


def _points(
    grid: Grid, element: np.ndarray | None, xi: np.ndarray, weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    elements = np.arange(grid.elements) if element is None else element
    where, at = elements.repeat(len(xi)), xi[None].repeat(len(elements), axis=0).ravel()
    if grid.straight:
        return where, at, (grid.lengths[elements][:, None] * weights).ravel()
    return where, at, np.tile(weights, len(elements)) * jacobians(grid, where, at)[0]
