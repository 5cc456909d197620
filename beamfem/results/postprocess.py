"""Results derived from states: fields, section forces, energies; vectorised over steps."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from beamfem.element import coordinates, forces
from beamfem.element.fields import Axis, cross, dot, section_frame
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import (
    energy_points,
    energy_stiffness_at,
    reference_angle,
    reference_axis,
)
from beamfem.reprs import brief
from beamfem.results.axis_points import AxisPoints, axis_at, has_angles, nodal_angles, nodal_vectors
from beamfem.section.law import THICKNESS, ConstitutiveLaw


@dataclass(frozen=True)
class Fields:
    """Fields at points of a beam's axis; the leading shape (...) is (steps,) or (steps, points).

    Where a field jumps, between elements or at a load, its value is that on the side towards the beam's end.

    Parameters
    ----------
    position : array, [m], (..., 2)
        Position.
    r_x : array, [-], (..., 2)
        Derivative of the position by arc length.
    r_y : array, [-], (..., 2)
        Direction of the section.
    rotation : array, [rad], (...)
        Rotation of the section from the reference configuration.
    shear_angle : array, [rad], (...)
        A right angle less the angle from r_x to r_y; it has the sign of the shear strain.
    green_strain : Components, [-]
        Green-Lagrange strain of the field at y = 0.
    stress : Components, [Pa]
        Stress at y = 0: Cauchy stress along the normal of the rotated section (x) and in it (y), per undeformed area,
        as the section distributes the section forces; yy = 0 as in beam theory; nan if the section does not define a
        stress there.

    Examples
    --------
    >>> fields = solution.fields(beam.at(0.5))
    >>> fields.rotation.round(4)
    array([ 0.    , -0.0171])
    """

    position: np.ndarray
    r_x: np.ndarray
    r_y: np.ndarray
    rotation: np.ndarray
    shear_angle: np.ndarray
    green_strain: "Components"
    stress: "Components"

    __repr__ = brief


@dataclass(frozen=True)
class Components:
    """Components (...) of a symmetric tensor along the beam (x) and across it (y), strain [-] or stress [Pa]."""

    xx: np.ndarray
    yy: np.ndarray
    xy: np.ndarray

    __repr__ = brief


def position(mesh: BeamMesh, p: np.ndarray, fraction: float) -> np.ndarray:
    """Return the position (steps, 2) [m] of a point of the axis; at a node without interpolation."""
    node = mesh.node_near(fraction)
    if node is not None:
        return np.asarray(p[:, mesh.kinematics.dof[node, :2]])
    return AxisPoints.at(mesh, [fraction]).now(p).r[:, 0]


def start(mesh: BeamMesh, fraction: float) -> np.ndarray:
    """Return the position (2,) [m] of a point of the axis in the reference configuration; at a node likewise."""
    node = mesh.node_near(fraction)
    if node is not None:
        return np.asarray(mesh.position[node])
    return AxisPoints.at(mesh, [fraction]).reference[0]


def direction(mesh: BeamMesh, now: Axis) -> np.ndarray:
    """Return the unit normal (..., 2) of the section: normal to d, or along r_x if the curvature is based on r_xx."""
    if mesh.beam.element.forces.turns_with == "r_x":
        return now.r_s / np.linalg.norm(now.r_s, axis=-1, keepdims=True)
    return section_frame(now.d)[0]


def section_rotation(
    mesh: BeamMesh, p: np.ndarray, now: Axis, element: np.ndarray, xi: np.ndarray, turned: np.ndarray | None = None
) -> np.ndarray:
    """Return the rotation of the section (steps, points) [rad], full turns included.

    turned (steps, beams) [rad]: see `nodal_rotations`.
    """
    start = direction(mesh, reference_axis(mesh, element, xi))
    normal = direction(mesh, now)
    angle = np.arctan2(cross(start, normal), dot(start, normal))
    inner = mesh.node.shape[1] - 1
    node = mesh.node[element, np.round(xi * inner).astype(int)]
    if has_angles(mesh):
        near = nodal_angles(mesh, p, node)
    else:  # rotations are unwrapped along each beam of a mesh
        counted = [None] * len(mesh.parts) if turned is None else turned.T
        parts = [nodal_rotations(part, p, begin) for part, begin in zip(mesh.parts, counted, strict=True)]
        near = np.concatenate(parts, axis=1)[:, node]
    return np.asarray(angle + 2.0 * np.pi * np.round((near - angle) / (2.0 * np.pi)))


def nodal_rotations(mesh: BeamMesh, p: np.ndarray, turned: np.ndarray | None = None) -> np.ndarray:
    """Return the rotation of each node's section from the reference configuration (steps, nodes) [rad].

    Nodal angles are coordinates and hold full turns. Gradients determine a rotation only up to full turns: it is
    unwrapped along the beam from its first nodal angle, or from its start if there is none. The rotation of the start
    is the one nearest to `turned` (steps,) [rad], counted by the solver; without it, the rotation is unwrapped over the
    states, the first within half a turn.
    """
    table = mesh.table(p)
    result = np.empty(table.shape[:2])
    known = np.zeros(mesh.nodes, dtype=bool)
    for node_kind, nodes in mesh.node_kinds:
        names = coordinates.labels(node_kind, mesh.vectors)
        if names[-1] == "theta":
            result[:, nodes] = table[:, nodes, len(names) - 1]
            known[nodes] = True
    by_slope = mesh.beam.element.forces.turns_with == "r_x"
    if known.all() and not by_slope:
        return result
    e = nodal_vectors(mesh, p)
    vector = e[:, :, mesh.vectors.index("r_x")] if by_slope else -coordinates.across(e[:, :, -1])
    angle = np.unwrap(np.arctan2(vector[..., 1], vector[..., 0]) - reference_angle(mesh), axis=1)
    if known.any():
        anchor = int(np.flatnonzero(known)[0])
        shift = result[:, anchor] - angle[:, anchor]
        return np.asarray(angle + 2.0 * np.pi * np.round(shift / (2.0 * np.pi))[:, None])
    if turned is not None:
        return np.asarray(angle + 2.0 * np.pi * np.round((turned - angle[:, 0]) / (2.0 * np.pi))[:, None])
    start = np.unwrap(angle[:, 0])
    start -= 2.0 * np.pi * np.round(start[0] / (2.0 * np.pi))
    return np.asarray(angle + (start - angle[:, 0])[:, None])


def shear_angle(now: Axis) -> np.ndarray:
    """Return a right angle less the angle [rad] from r_x to r_y, which has the sign of the shear strain."""
    return np.asarray(np.arctan2(dot(now.r_s, now.d), cross(now.r_s, now.d)))


def strain_at_axis(points: AxisPoints, now: Axis) -> Components:
    """Return the Green-Lagrange strain (steps, points) at y = 0."""
    strain = green_strain(now, reference_axis(points.mesh, points.element, points.xi), np.zeros(1))
    return Components(strain.xx[..., 0], strain.yy[..., 0], strain.xy[..., 0])


def green_strain(now: Axis, reference: Axis, y: np.ndarray) -> Components:
    """Return the Green-Lagrange strain (..., heights) at heights y (heights,) [m] in the frame of the reference."""
    xx, yy, xy = forces.green_strain(now, reference, y)
    return Components(xx, yy, 0.5 * xy)


def strain_energies(mesh: BeamMesh, p: np.ndarray, imposed: np.ndarray | float = 0.0) -> np.ndarray:
    """Return the strain energy of a beam and what its section with history has dissipated (steps, 2) [J].

    imposed: see `imposed_measures`. Self-stress between layers with different free strains is not included.
    """
    element, xi, weight = energy_points(mesh)
    now = axis_at(mesh, p, element, xi)
    stiffness, reference = energy_stiffness_at(mesh, element, xi)
    strains = mesh.beam.element.forces.strains(now) - reference - imposed
    if mesh.beam.law is not None:
        result = _energies_of_law(mesh, mesh.beam.law, p, strains, weight)
        result[:, 0] += 0.5 * strains[..., THICKNESS] ** 2 @ (stiffness[:, THICKNESS, THICKNESS] * weight)
        return result
    stored = 0.5 * np.einsum("sqi,qij,sqj->sq", strains, stiffness, strains) @ weight
    return np.stack([stored, np.zeros(len(p))], axis=-1)


def _energies_of_law(
    mesh: BeamMesh, law: ConstitutiveLaw, p: np.ndarray, strains: np.ndarray, weight: np.ndarray
) -> np.ndarray:
    """Return the energy that a section law has stored and dissipated (steps, 2) [J], without thickness stretch.

    strains (steps, points, 4): from the stress-free state; weight (points,) [m].
    """
    rows, points = len(strains), mesh.beam.element.law_points
    acting = strains.reshape(rows, mesh.elements, -1, strains.shape[-1])[:, :, :points, :3]
    weights = weight.reshape(mesh.elements, -1)[:, :points].ravel()
    history = p[:, mesh.history].reshape(rows * len(weights), mesh.history.shape[-1])
    energies = law.energy(acting.reshape(-1, 3), history)
    return np.einsum("sqi,q->si", energies.reshape(rows, len(weights), 2), weights)


def part_of(fields: Fields, index: Any) -> Fields:
    """Return the fields at an index of their steps and points."""

    def taken(value: Any) -> Any:
        if isinstance(value, Components):
            return Components(value.xx[index], value.yy[index], value.xy[index])
        return value[index]

    return Fields(*(taken(getattr(fields, name)) for name in Fields.__dataclass_fields__))
