"""From beam meshes to the plain arrays of the kernels."""

from collections.abc import Hashable, Sequence

import numpy as np

from beamfem.element.coordinates import columns
from beamfem.element.element import Element
from beamfem.element.fields import d_slots, r_slots
from beamfem.kernels.block import Block
from beamfem.model.classes import Classes, likeness
from beamfem.model.mesh import BeamMesh

_PER_CLASS = tuple(name for name in Classes.__dataclass_fields__ if name != "kind")


def build_block(element: Element, meshes: Sequence[tuple[int, BeamMesh]]) -> Block:
    """Return the block of all beams (number, mesh) that share an element."""
    field = element.field
    xi = np.concatenate([rule[0] for rule in element.energy_rules()])
    width = max(mesh.carried.dof.shape[1] for _, mesh in meshes)
    start, stop = columns(field.vectors)
    first_kind = 0
    known: dict[Hashable, tuple[int, np.ndarray]] = {}  # first class and classes of the elements of like beams
    parts: dict[str, list[np.ndarray]] = {name: [] for name in (*_PER_CLASS, "kind", "carrier", "frame", "dof", "beam")}
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
        parts["carrier"].append(mesh.carried.carrier[mesh.node])
        parts["frame"].append(mesh.carried.frame[mesh.node])
        own = mesh.carried.dof
        if own.shape[1] < width:
            own = np.pad(own, ((0, 0), (0, width - own.shape[1])), constant_values=-1)
        parts["dof"].append(own[mesh.node].reshape(mesh.elements, -1))
        parts["beam"].append(np.full(mesh.elements, number))
    joined = {name: np.ascontiguousarray(np.concatenate(values)) for name, values in parts.items()}
    return Block(
        measures=element.forces.code,
        r_slots=r_slots(field),
        d_slots=d_slots(field),
        r_xi=field.centreline(xi, 1),
        r_xixi=field.centreline(xi, 2),
        d=field.director(xi),
        d_xi=field.director(xi, 1),
        column_start=start[:, :width].copy(),
        column_stop=stop[:, :width].copy(),
        **joined,
    )
