"""From beam meshes to the plain arrays of the kernels."""

from collections.abc import Hashable, Sequence

import numpy as np

from beamfem.element.element import Element
from beamfem.element.fields import d_slots, r_slots
from beamfem.kernels.block import ELASTIC_LINE, Block, Work
from beamfem.model.classes import Classes, likeness
from beamfem.model.mesh import BeamMesh

_PER_CLASS = tuple(name for name in Classes.__dataclass_fields__ if name != "kind")

_PER_ELEMENT = ("kind", "node", "beam", "carrier", "frame", "dof", "home")


def build_block(element: Element, meshes: Sequence[tuple[int, BeamMesh]]) -> Block:
    """Return the block of all beams (number, mesh) that share an element."""
    field = element.field
    xi = np.concatenate([rule[0] for rule in element.energy_rules()])
    width = max(mesh.carried.dof.shape[1] for _, mesh in meshes)
    first_kind, first_node, first_element = 0, 0, 0
    known: dict[Hashable, tuple[int, np.ndarray]] = {}  # first class and classes of the elements of like beams
    parts: dict[str, list[np.ndarray]] = {name: [] for name in (*_PER_CLASS, *_PER_ELEMENT)}
    for number, mesh in meshes:
        like = likeness(mesh) or number
        if like not in known:
            classes = mesh.classes
            for name in _PER_CLASS:
                parts[name].append(getattr(classes, name))
            known[like] = first_kind, classes.kind
            first_kind += len(classes.scale)
        first, kind = known[like]
        parts["kind"].append(first + kind)
        parts["node"].append(first_node + mesh.node)
        parts["beam"].append(np.full(mesh.elements, number))
        parts["carrier"].append(mesh.carried.carrier)
        parts["frame"].append(mesh.carried.frame)
        own = mesh.carried.dof
        if own.shape[1] < width:
            own = np.pad(own, ((0, 0), (0, width - own.shape[1])), constant_values=-1)
        parts["dof"].append(own)
        home = np.empty((mesh.nodes, 2), dtype=np.int64)
        for place, nodes in enumerate(mesh.node.T):
            home[nodes, 0], home[nodes, 1] = first_element + np.arange(mesh.elements), place
        parts["home"].append(home)
        first_node += mesh.nodes
        first_element += mesh.elements
    joined = {name: np.ascontiguousarray(np.concatenate(values)) for name, values in parts.items()}
    table = np.zeros((len(xi), len(field.nodes) * len(field.vectors)))
    curved = np.zeros_like(table)
    table[:, r_slots(field)], table[:, d_slots(field)] = field.centreline(xi, 1), field.director(xi, 1)
    curved[:, r_slots(field)] = field.centreline(xi, 2)
    # from derivatives by xi to those by arc length
    scale, inverse = joined["scale"][:, None, :], 1.0 / joined["jacobian"][:, :, None]
    second = (curved - joined.pop("jacobian_xi")[:, :, None] * inverse * table) * scale * inverse**2
    bends = element.forces.code == ELASTIC_LINE
    return Block(
        measures=element.forces.code,
        slope=np.ascontiguousarray(table * scale * inverse),
        second=np.ascontiguousarray(second) if bends else np.empty((0, 0, 0)),
        director=np.ascontiguousarray(field.director(xi)),
        **joined,
    )


def workspace(block: Block, stress: np.ndarray | None = None) -> Work:
    """Return space for the kernels of a block; stress (ne, nq, ns): resultants for the geometric tangent."""
    vectors, nodes = block.scale.shape[1], block.node.shape[1]
    return Work(
        np.empty((4, max(len(block.dof), nodes), 2 * vectors // nodes)),
        np.empty((2 * vectors, 2 * vectors)),
        np.empty(nodes * block.dof.shape[1], dtype=np.int64),
        np.empty((0, 0, 0)) if stress is None else stress,
    )
