"""From beam meshes to the plain arrays of the kernels."""

import numpy as np

from beamfem.element.element import Element
from beamfem.element.fields import d_slots, r_slots
from beamfem.kernels.block import Block, PointLoads
from beamfem.model.beam import Point
from beamfem.model.mesh import BeamMesh


def scales(element: Element, lengths: np.ndarray) -> np.ndarray:
    """Return the factor (n, nv) of each nodal vector for mesh lengths (n,): the length where it is r_x."""
    vectors = element.field.vectors * len(element.field.nodes)
    return np.stack([lengths if name == "r_x" else np.ones_like(lengths) for name in vectors], axis=1)


def build_block(element: Element, meshes: list[tuple[int, BeamMesh]]) -> Block:
    """Return the block of all beams (number, mesh) that share an element."""
    field = element.field
    rs, ds = r_slots(field), d_slots(field)
    xi, weights = element.quadrature()
    r_xi, d, d_xi = field.centreline(xi, 1), field.director(xi), field.director(xi, 1)
    start, stop = element.coordinates.columns(field.vectors)
    first_kind = 0
    parts: dict[str, list[np.ndarray]] = {}
    for number, mesh in meshes:
        beam = mesh.beam
        unique, kind = _classes(mesh.lengths)
        scale = scales(element, unique)
        jacobian = np.repeat(unique[:, None], len(xi), axis=1)
        stiffness = element.forces.stiffness(beam.section, beam.material, element.coordinates)
        mass, gravity, length = _inertia(mesh, element, unique, scale)
        frame, dof = _nodes(mesh)
        part = {
            "kind": first_kind + kind,
            "scale": scale,
            "jacobian": jacobian,
            "weight": weights * jacobian,
            "stiffness": np.broadcast_to(stiffness, (len(unique), len(xi), *stiffness.shape)),
            "reference": np.zeros((len(unique), len(xi), len(stiffness))),
            "mass": mass,
            "gravity": gravity,
            "length": length,
            "frame": frame,
            "dof": dof,
            "beam": np.full(mesh.elements, number),
        }
        first_kind += len(unique)
        for name, value in part.items():
            parts.setdefault(name, []).append(value)
    joined = {name: np.ascontiguousarray(np.concatenate(values)) for name, values in parts.items()}
    return Block(
        coordinates=element.coordinates.code,
        measures=element.forces.code,
        r_slots=rs,
        d_slots=ds,
        r_xi=r_xi,
        d=d,
        d_xi=d_xi,
        column_start=start,
        column_stop=stop,
        **joined,
    )


def locate_loads(block: Block, element: Element, meshes: list[BeamMesh], points: list[Point]) -> PointLoads:
    """Return the shape functions at the points of loads; meshes[i] is the mesh of points[i]."""
    elements, r, d = [], [], []
    for mesh, point in zip(meshes, points, strict=True):
        local, xi = mesh.locate(point.fraction)
        scale = scales(element, mesh.lengths[local : local + 1])[0]
        elements.append(mesh.first_element + local)
        r.append(element.field.centreline(np.array([xi]))[0] * scale[block.r_slots])
        d.append(element.field.director(np.array([xi]))[0])
    nr, nd = len(block.r_slots), len(block.d_slots)
    return PointLoads(
        np.array(elements, dtype=np.int64),
        np.array(r, dtype=float).reshape(-1, nr),
        np.array(d, dtype=float).reshape(-1, nd),
    )


def _classes(lengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Classes of elements of equal length, to round-off of the arc length: (nc,) lengths and (ne,) class numbers."""
    _, kind = np.unique(np.round(lengths / lengths.max(), 9), return_inverse=True)
    members = np.bincount(kind)
    return np.bincount(kind, weights=lengths) / members, kind.astype(np.int64)


def _inertia(
    mesh: BeamMesh, element: Element, lengths: np.ndarray, scale: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass (nc, nv, nv), its sum against a uniform acceleration (nc, nv) and the loaded length (nc, nv)."""
    field, section = element.field, mesh.beam.section
    points = max(field.degree, field.director_degree) + 1
    xi, weights = np.polynomial.legendre.leggauss(points)
    xi, weights = 0.5 * (xi + 1.0), 0.5 * weights
    r, d = field.centreline(xi), field.director(xi)
    rs, ds = r_slots(field), d_slots(field)
    density = mesh.beam.material.density
    unit = np.zeros((scale.shape[1], scale.shape[1]))
    unit[np.ix_(rs, rs)] = density * section.area * (r.T * weights) @ r
    unit[np.ix_(ds, ds)] = density * section.second_moment * (d.T * weights) @ d
    line = np.zeros(scale.shape[1])
    line[rs] = weights @ r
    length = lengths[:, None] * scale * line
    mass = lengths[:, None, None] * scale[:, :, None] * scale[:, None, :] * unit
    return mass, density * section.area * length, length


def _nodes(mesh: BeamMesh) -> tuple[np.ndarray, np.ndarray]:
    """Reference angle (ne, nn, 2) and coordinates (ne, nn * npn) of the nodes of each element."""
    tangent = mesh.beam.curve.tangent(mesh.node_arc_lengths())
    node = np.arange(mesh.elements)[:, None] * mesh.intervals + np.arange(mesh.intervals + 1)
    per_node = mesh.beam.element.coordinates_per_node
    dof = mesh.first_dof + node[:, :, None] * per_node + np.arange(per_node)
    return tangent[node], dof.reshape(mesh.elements, -1)
