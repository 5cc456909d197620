"""Generalized forces of a state without compiled kernels: derivatives of the energy by complex steps, loads by hand.

Strains are written out once more; B = de/dp, shape functions and what sections and rules are come from the package.
"""

from dataclasses import dataclass

import numpy as np

import beamfem as bf
from beamfem.element.coordinates import Gradients, labels, nodal_rates
from beamfem.element.fields import d_slots, r_slots
from beamfem.mesh.reference import (
    energy_points,
    energy_stiffness_at,
    inertia_points,
    interpolate,
    length_points,
    reference_axis,
    reference_position,
    scales,
)
from beamfem.model.along_beam import jumps_along
from beamfem.model.load_base import factor
from beamfem.results.axis_points import axis, nodal_vectors

_STEP = 1e-40


def dot(a, b):
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def across(a):
    return np.stack([-a[..., 1], a[..., 0]], axis=-1)


def strains(name: str, at) -> np.ndarray:
    """Strain measures of complex axes, as they are defined."""
    r, d, e = at.r_s, at.d, at.d_s
    if name == "structural":
        size = np.sqrt(dot(d, d))
        parts = cross(r, d) / size - 1.0, dot(r, d) / size, cross(d, e) / size**2, size - 1.0
    elif name == "elastic-line":
        square = dot(r, r)
        parts = np.sqrt(square) - 1.0, cross(r, at.r_ss) / square, dot(r, d), 0.5 * (dot(d, d) - 1.0)
    else:
        parts = 0.5 * (dot(r, r) - 1.0), dot(r, e), 0.5 * dot(e, e), 0.5 * (dot(d, d) - 1.0), dot(r, d), dot(d, e)
    return np.stack(parts, axis=-1)


def imposed(mesh, model: bf.Model, at: float, static: bool) -> np.ndarray | float:
    """Strain measures (points, measures) of the beam when nothing hinders what loads impose, less the reference's."""
    loads = [load for load in model.loads if isinstance(load, bf.Actuation | bf.Temperature)]
    own = [load for load in loads if load.beam is mesh.beam]
    if not own:
        return 0.0
    element, xi, _ = energy_points(mesh)
    free = 0.0
    for load in own:
        arc = mesh.arc_length_inside(element, xi, jumps_along(load))
        free = free + factor(load, at, static) * load.free_strain(arc)
    stretch, shear, curvature, thickness = free.T
    thickness = thickness * isinstance(mesh.beam.element.coordinates, Gradients)
    name, start = mesh.beam.element.forces.name, reference_axis(mesh, element, xi)
    if name == "structural":
        return np.stack([stretch, shear, curvature, thickness], axis=-1)
    if name == "elastic-line":
        return np.stack([stretch, curvature, shear, thickness + 0.5 * thickness**2], axis=-1)
    upward = start.d / np.hypot(*start.d.T)[:, None]
    normal = -across(upward)
    r_s = start.r_s + stretch[:, None] * normal + shear[:, None] * upward
    d, d_s = ((1.0 + thickness)[:, None] * vector for vector in (start.d, start.d_s))
    free = start._replace(r_s=r_s, d=d, d_s=d_s - curvature[:, None] * normal)
    return strains(name, free) - strains(name, start)


def elastic_force(mesh, e: np.ndarray, taken: np.ndarray | float = 0.0) -> np.ndarray:
    """Derivative (elements, nv, 2) of the strain energy by the nodal vectors e (nodes, vectors, 2) of each element.

    taken: see `imposed`.
    """
    element, xi, weight = energy_points(mesh)
    stiffness, reference = energy_stiffness_at(mesh, element, xi)
    local = e[mesh.node].reshape(mesh.elements, -1, 2)
    count = local.shape[1]
    moved = np.tile(local.astype(complex), (2 * count, 1, 1, 1))
    for slot in range(count):
        for c in (0, 1):
            moved[2 * slot + c, :, slot, c] += 1j * _STEP
    eps = strains(mesh.beam.element.forces.name, interpolate(mesh, moved[:, element], element, xi)) - reference - taken
    density = 0.5 * np.einsum("sqi,qij,sqj->sq", eps, stiffness, eps) * weight
    energy = density.reshape(2 * count, mesh.elements, -1).sum(axis=2)
    return np.moveaxis((energy.imag / _STEP).reshape(count, 2, mesh.elements), 2, 0)


@dataclass(frozen=True, eq=False)
class Forces:
    """Forces at points (element, xi) of a beam: on r, on d [N m] and moments [N m] on the section's direction."""

    element: np.ndarray
    xi: np.ndarray
    on_r: np.ndarray
    on_d: np.ndarray
    moment: np.ndarray


def external(mesh, model: bf.Model, solution: bf.Solution, row: int, at: float, static: bool) -> list[Forces]:
    """All loads, foundations and inertia on a beam."""
    e = nodal_vectors(mesh, solution.p[row][None])
    found = []

    def add(element, xi, on_r, on_d=None, moment=None):
        none = np.zeros((len(element), 2))
        parts = none + on_r, none if on_d is None else on_d, np.zeros(len(element)) if moment is None else moment
        found.append(Forces(element, xi, *parts))

    def turned(element, xi, force):
        now, start = axis(mesh, e, element, xi), reference_axis(mesh, element, xi)
        by_slope = mesh.beam.element.forces.turns_with == "r_x"
        g, g0 = (now.r_s[0], start.r_s) if by_slope else (now.d[0], start.d)
        size = np.hypot(*g.T) * np.hypot(*g0.T)
        co, si = dot(g0, g) / size, cross(g0, g) / size
        return co[:, None] * force + si[:, None] * across(force)

    for load in model.loads:
        weight = factor(load, at, static)
        if isinstance(load, bf.Gravity):
            element, xi, inertia = inertia_points(mesh)
            pull = weight * np.array(load.vector)
            add(element, xi, inertia[:, :1] * pull, inertia[:, 1:2] * pull)
        elif isinstance(load, bf.PointForce | bf.PointMoment):
            if load.point.beam is not mesh.beam:
                continue
            element, xi = mesh.locate(np.array([load.point.fraction]))
            if isinstance(load, bf.PointMoment):
                add(element, xi, np.zeros((1, 2)), None, np.array([weight * load.moment]))
            else:
                force = weight * np.array([load.vector])
                add(element, xi, turned(element, xi, force) if load.follower else force)
        elif load.beam is mesh.beam and not isinstance(load, bf.Actuation | bf.Temperature):
            element, xi, length = length_points(mesh)
            values = weight * load.values(mesh.arc_length(element, xi))
            if isinstance(load, bf.Pressure):
                add(element, xi, (length * values)[:, None] * across(axis(mesh, e, element, xi).r_s[0]))
            else:
                force = length[:, None] * values
                add(element, xi, turned(element, xi, force) if load.follower else force)
    for support in model.supports:
        if isinstance(support, bf.Foundation) and support.beam is mesh.beam:
            element, xi, length = length_points(mesh)
            moved = axis(mesh, e, element, xi).r[0] - reference_position(mesh, element, xi)
            add(element, xi, -length[:, None] * np.array(support.stiffness) * moved)
    if not static or solution.v[row].any() or solution.a[row].any():
        element, xi, inertia = inertia_points(mesh)
        now = axis(mesh, accelerations(mesh, solution, row)[None], element, xi)
        mass, first, rotary = (column[:, None] for column in inertia.T)
        add(element, xi, -mass * now.r[0] - first * now.d[0], -first * now.r[0] - rotary * now.d[0])
    return found


def accelerations(mesh, solution: bf.Solution, row: int) -> np.ndarray:
    """Second rates of the nodal vectors (nodes, vectors, 2), by differentiating e(p) twice by hand."""
    p, v, a = (mesh.table(values[row][None]) for values in (solution.p, solution.v, solution.a))
    e = nodal_vectors(mesh, solution.p[row][None])
    result = np.zeros(e.shape[1:])
    for carrier, nodes in mesh.node_kinds:
        names = labels(carrier, mesh.vectors)
        frame = mesh.kinematics.frame[nodes]
        result[nodes] = nodal_rates(carrier, mesh.vectors, p[:, nodes], a[:, nodes], frame)[0]
        if names[-1] != "theta":
            continue
        spin = v[0, nodes, len(names) - 1][:, None]
        for i, vector in enumerate(mesh.vectors):
            if f"{vector}^x" in names:
                continue
            own = e[0, nodes, i]
            result[nodes, i] -= spin**2 * own
            if vector == "r_x" and "s" in names:
                result[nodes, i] += 2.0 * v[0, nodes, 2][:, None] * spin * across(own) / p[0, nodes, 2][:, None]
    return result


def nodal_force(mesh, forces: Forces, e: np.ndarray) -> np.ndarray:
    """Forces (elements, nv, 2) on the nodal vectors of each element, by virtual work."""
    own = mesh.beam.element
    scale = scales(own, mesh.lengths[forces.element])
    r_table, d_table, s_table = (np.zeros_like(scale) for _ in range(3))
    r_table[:, r_slots(own.field)] = own.field.centreline(forces.xi)
    d_table[:, d_slots(own.field)] = own.field.director(forces.xi)
    r_table, d_table = r_table * scale, d_table * scale
    result = np.zeros((mesh.elements, scale.shape[1], 2))
    work = r_table[:, :, None] * forces.on_r[:, None] + d_table[:, :, None] * forces.on_d[:, None]
    if forces.moment.any():
        by_slope = own.forces.turns_with == "r_x"
        if by_slope:
            s_table[:, r_slots(own.field)] = own.field.centreline(forces.xi, 1)
        table = s_table * scale if by_slope else d_table
        g = np.einsum("qi,qic->qc", table, e[mesh.node[forces.element]].reshape(len(forces.xi), -1, 2))
        turn = forces.moment[:, None] * across(g) / dot(g, g)[:, None]
        work = work + table[:, :, None] * turn[:, None]
    np.add.at(result, forces.element, work)
    return result


def to_coordinates(mesh, p: np.ndarray, force: np.ndarray, size: int) -> np.ndarray:
    """B^T times forces (elements, nv, 2) on nodal vectors, over all coordinates of the model."""
    nodal = np.zeros((mesh.nodes, len(mesh.vectors), 2))
    np.add.at(nodal, mesh.node, force.reshape(mesh.elements, mesh.node.shape[1], -1, 2))
    table, result = mesh.table(p[None]), np.zeros(size)
    for carrier, nodes in mesh.node_kinds:
        names, frame = labels(carrier, mesh.vectors), mesh.kinematics.frame[nodes]
        for column in range(len(names)):
            unit = np.zeros(table[:, nodes].shape)
            unit[:, :, column] = 1.0
            rates = nodal_rates(carrier, mesh.vectors, table[:, nodes], unit, frame)[0]
            np.add.at(result, mesh.kinematics.dof[nodes, column], np.einsum("nvc,nvc->n", rates, nodal[nodes]))
    return result


def elastic(model: bf.Model, p: np.ndarray, at: float, static: bool) -> np.ndarray:
    """Generalized elastic forces (n,) of all beams, at a load factor or time for strains that loads impose."""
    parts = []
    for mesh in model.meshes:
        force = elastic_force(mesh, nodal_vectors(mesh, p[None])[0], imposed(mesh, model, at, static))
        parts.append(to_coordinates(mesh, p, force, model.size))
    return np.sum(parts, axis=0)


def sprung(model: bf.Model, moved: np.ndarray) -> np.ndarray:
    """Generalized forces (n,) of springs at points when coordinates are moved by so much from the reference."""
    result = np.zeros(model.size)
    for support in model.supports:
        if isinstance(support, bf.Spring):
            mesh = model.mesh_of(support.point)
            dofs = mesh.coordinates_of(mesh.node_at(support.point.fraction))
            springs = zip(("r^x", "r^y", "theta"), (*support.stiffness, support.rotational), strict=True)
            for name, stiffness in springs:
                if stiffness:
                    result[dofs[name]] -= stiffness * moved[dofs[name]]
    return result
