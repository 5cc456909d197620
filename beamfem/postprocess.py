"""What is derived from states: fields, section forces, energies, momenta; vectorised over steps."""

from dataclasses import dataclass

import numpy as np

from beamfem.element.fields import d_slots, r_slots
from beamfem.model.blocks import scales
from beamfem.model.mesh import BeamMesh


@dataclass(frozen=True)
class Fields:
    """Fields at points of a beam's axis; the leading shape is (steps,) or (steps, points).

    position (..., 2) [m], r_x (..., 2) [-], r_y (..., 2) [-], rotation [rad] of the section from the reference,
    shear_angle [rad] from r_x to r_y less a right angle, green_strain and second Piola-Kirchhoff stress [Pa] at y = 0.
    """

    position: np.ndarray
    r_x: np.ndarray
    r_y: np.ndarray
    rotation: np.ndarray
    shear_angle: np.ndarray
    green_strain: "Components"
    stress: "Components"


@dataclass(frozen=True)
class Components:
    """Components of a symmetric tensor along (x) and across (y) the beam."""

    xx: np.ndarray
    yy: np.ndarray
    xy: np.ndarray


@dataclass(frozen=True)
class SectionForces:
    """Work conjugates at the Gauss points: normal (> 0 in tension) and shear force [N], moment [N m] (steps, stations).

    arc_length (stations,) [m].
    """

    arc_length: np.ndarray
    normal: np.ndarray
    shear: np.ndarray
    moment: np.ndarray


@dataclass(frozen=True)
class Axis:
    """r0, r0', d and d' (steps, points, 2) at points of the axis; primes are by arc length."""

    r: np.ndarray
    r_s: np.ndarray
    d: np.ndarray
    d_s: np.ndarray


def nodal_vectors(mesh: BeamMesh, p: np.ndarray) -> np.ndarray:
    """Return e (steps, nodes, vectors a node, 2) of the states p (steps, n)."""
    table, names = _table(mesh, p)
    field = mesh.beam.element.field
    result = np.empty((len(p), mesh.nodes, len(field.vectors), 2))
    for i, vector in enumerate(field.vectors):
        if f"{vector}^x" in names:
            first = names.index(f"{vector}^x")
            result[:, :, i] = table[:, :, first : first + 2]
        else:
            tangent = mesh.beam.curve.tangent(mesh.node_arc_lengths())
            angle = table[:, :, names.index("theta")] + np.arctan2(tangent[:, 1], tangent[:, 0])
            result[:, :, i] = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
    return result


def nodal_velocities(mesh: BeamMesh, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return e' = B p' (steps, nodes, vectors a node, 2)."""
    table, names = _table(mesh, v)
    result = np.empty((len(p), mesh.nodes, len(mesh.beam.element.field.vectors), 2))
    for i, vector in enumerate(mesh.beam.element.field.vectors):
        if f"{vector}^x" in names:
            first = names.index(f"{vector}^x")
            result[:, :, i] = table[:, :, first : first + 2]
        else:
            turned = nodal_vectors(mesh, p)[:, :, i]
            spin = table[:, :, names.index("theta"), None]
            result[:, :, i] = spin * np.stack([-turned[..., 1], turned[..., 0]], axis=-1)
    return result


def axis(mesh: BeamMesh, vectors: np.ndarray, element: np.ndarray, xi: np.ndarray) -> Axis:
    """Interpolate nodal vectors (steps, nodes, vectors, 2) at points (element, xi), both (points,)."""
    field = mesh.beam.element.field
    inside = element[:, None] * mesh.intervals + np.arange(mesh.intervals + 1)
    local = vectors[:, inside].reshape(len(vectors), len(element), -1, 2)
    lengths = mesh.lengths[element]
    local = local * scales(mesh.beam.element, lengths)[:, :, None]
    r, d = local[:, :, r_slots(field)], local[:, :, d_slots(field)]

    def sum_over(table: np.ndarray, values: np.ndarray) -> np.ndarray:
        return np.einsum("qi,sqic->sqc", table, values)

    slope = 1.0 / lengths[:, None]
    return Axis(
        sum_over(field.centreline(xi), r),
        sum_over(field.centreline(xi, 1) * slope, r),
        sum_over(field.director(xi), d),
        sum_over(field.director(xi, 1) * slope, d),
    )


def turning(mesh: BeamMesh, p: np.ndarray, now: Axis, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Rotation of the section from the reference (steps, points) [rad], continuous over steps."""
    reference = mesh.beam.curve.tangent(mesh.vertices[element] + xi * mesh.lengths[element])
    start = np.arctan2(reference[:, 1], reference[:, 0])
    angle = np.arctan2(-now.d[..., 0], now.d[..., 1]) - start
    node = element * mesh.intervals + np.round(xi * mesh.intervals).astype(int)
    near = nodal_rotations(mesh, p)[:, node]
    return np.asarray(angle + 2.0 * np.pi * np.round((near - angle) / (2.0 * np.pi)))


def nodal_rotations(mesh: BeamMesh, p: np.ndarray) -> np.ndarray:
    """Return the rotation of each node's section from the reference (steps, nodes) [rad].

    Gradients know a rotation up to full turns only: it is continued along the beam from its start, and there over the
    states, the first of them within half a turn. Rotations are coordinates of their own.
    """
    table, names = _table(mesh, p)
    if "theta" in names:
        return table[:, :, names.index("theta")]
    d = nodal_vectors(mesh, p)[:, :, mesh.beam.element.field.vectors.index("r_y")]
    tangent = mesh.beam.curve.tangent(mesh.node_arc_lengths())
    angle = np.arctan2(-d[..., 0], d[..., 1]) - np.arctan2(tangent[:, 1], tangent[:, 0])
    angle = np.unwrap(angle, axis=1)
    start = np.unwrap(angle[:, 0])
    start -= 2.0 * np.pi * np.round(start[0] / (2.0 * np.pi))
    return np.asarray(angle + (start - angle[:, 0])[:, None])


def fields(mesh: BeamMesh, p: np.ndarray, element: np.ndarray, xi: np.ndarray) -> Fields:
    """Return the fields at points (element, xi), both (points,); arrays (steps, points, ...)."""
    now = axis(mesh, nodal_vectors(mesh, p), element, xi)
    cross = now.r_s[..., 0] * now.d[..., 1] - now.r_s[..., 1] * now.d[..., 0]
    dot = (now.r_s * now.d).sum(-1)
    strain = green_strain(now, np.zeros(1))
    strain = Components(strain.xx[..., 0], strain.yy[..., 0], strain.xy[..., 0])
    return Fields(
        now.r,
        now.r_s,
        now.d,
        turning(mesh, p, now, element, xi),
        np.arctan2(dot, cross),
        strain,
        stress(mesh, strain),
    )


def green_strain(now: Axis, y: np.ndarray) -> Components:
    """Return the Green-Lagrange strain (..., len(y)) at heights y [m]; straight reference."""
    r_x = now.r_s[..., None, :] + y[:, None] * now.d_s[..., None, :]
    d = now.d[..., None, :]
    xx = 0.5 * ((r_x * r_x).sum(-1) - 1.0)
    yy = np.broadcast_to(0.5 * ((d * d).sum(-1) - 1.0), xx.shape)
    return Components(xx, yy, 0.5 * (r_x * d).sum(-1))


def stress(mesh: BeamMesh, strain: Components) -> Components:
    """Return the stress [Pa] that the elastic forces give to a strain."""
    found = mesh.beam.element.forces.stress(strain.xx, strain.yy, strain.xy, mesh.beam.material)
    return Components(*found)


def gauss_points(mesh: BeamMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return element, xi and weight [m] of every quadrature point of a beam."""
    xi, weights = mesh.beam.element.quadrature()
    element = np.repeat(np.arange(mesh.elements), len(xi))
    return element, np.tile(xi, mesh.elements), np.tile(weights, mesh.elements) * mesh.lengths[element]


def section_forces(mesh: BeamMesh, p: np.ndarray) -> SectionForces:
    """Return normal and shear force dW/dr0' along and across the section's normal, and the moment d x dW/dd'."""
    element, xi, _ = gauss_points(mesh)
    now = axis(mesh, nodal_vectors(mesh, p), element, xi)
    resultant = _resultants(mesh, now)
    force, couple = mesh.beam.element.forces.conjugates(resultant, now.r_s, now.d, now.d_s)
    across = now.d / np.linalg.norm(now.d, axis=-1, keepdims=True)
    along = np.stack([across[..., 1], -across[..., 0]], axis=-1)
    moment = now.d[..., 0] * couple[..., 1] - now.d[..., 1] * couple[..., 0]
    arc = mesh.vertices[element] + xi * mesh.lengths[element]
    return SectionForces(arc, (force * along).sum(-1), (force * across).sum(-1), moment)


def strain_energy(mesh: BeamMesh, p: np.ndarray) -> np.ndarray:
    """Return the strain energy of a beam (steps,) [J]."""
    element, xi, weight = gauss_points(mesh)
    now = axis(mesh, nodal_vectors(mesh, p), element, xi)
    strains = mesh.beam.element.forces.strains(now.r_s, now.d, now.d_s)
    return np.asarray(0.5 * (strains * _resultants(mesh, now)).sum(-1) @ weight)


@dataclass(frozen=True)
class Momenta:
    """Kinetic energy [J], linear (steps, 2) [kg m/s] and angular momentum about the origin [kg m^2/s], mass moment.

    first_moment (steps, 2) [kg m] is the integral of the position over the mass.
    """

    kinetic: np.ndarray
    linear: np.ndarray
    angular: np.ndarray
    first_moment: np.ndarray


def momenta(mesh: BeamMesh, p: np.ndarray, v: np.ndarray) -> Momenta:
    """Return what the mass of a beam carries."""
    field, section = mesh.beam.element.field, mesh.beam.section
    points = max(field.degree, field.director_degree) + 1
    local, weights = np.polynomial.legendre.leggauss(points)
    element = np.repeat(np.arange(mesh.elements), points)
    xi = np.tile(0.5 * (local + 1.0), mesh.elements)
    mass = np.tile(0.5 * weights, mesh.elements) * mesh.lengths[element] * mesh.beam.material.density * section.area
    turn = mass * section.second_moment / section.area
    now = axis(mesh, nodal_vectors(mesh, p), element, xi)
    rate = axis(mesh, nodal_velocities(mesh, p, v), element, xi)

    def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

    kinetic = 0.5 * ((rate.r**2).sum(-1) @ mass + (rate.d**2).sum(-1) @ turn)
    linear = np.einsum("sqc,q->sc", rate.r, mass)
    angular = cross(now.r, rate.r) @ mass + cross(now.d, rate.d) @ turn
    return Momenta(kinetic, linear, angular, np.einsum("sqc,q->sc", now.r, mass))


def _resultants(mesh: BeamMesh, now: Axis) -> np.ndarray:
    forces = mesh.beam.element.forces
    stiffness = forces.stiffness(mesh.beam.section, mesh.beam.material, mesh.beam.element.coordinates)
    return np.asarray(forces.strains(now.r_s, now.d, now.d_s) @ stiffness)


def _table(mesh: BeamMesh, p: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """Coordinates of a beam (steps, nodes, npn) and their names."""
    table = p[:, mesh.first_dof : mesh.first_dof + mesh.size].reshape(len(p), mesh.nodes, -1)
    return table, mesh.beam.element.coordinates.labels(mesh.beam.element.field.vectors)
