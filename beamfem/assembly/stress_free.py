"""The coordinates of the stress-free state of a model."""

from collections.abc import Sequence

import numpy as np

from beamfem.assembly.columns import columns_of
from beamfem.element.coordinates import across
from beamfem.kernels.block import Block
from beamfem.model.model import Model


def stress_free(model: Model, blocks: Sequence[Block]) -> np.ndarray:
    """Return the coordinates (n,) of a model in its reference; multipliers and history variables are zero."""
    p = np.zeros(model.size)
    for number, (element, block) in enumerate(zip(model.groups, blocks, strict=True)):
        own = [mesh for mesh in model.meshes if mesh.block == number]
        position, tangent, speed = (
            np.concatenate([getattr(mesh, name) for mesh in own]) for name in ("position", "tangent", "speed")
        )
        values = {"r": position}
        for label, nodes, dofs in columns_of(block.node_kind, block.dof, element.field.vectors):
            if label == "s":
                p[dofs] = speed[nodes]
            elif label != "theta":
                name, axis = label.split("^")
                if name not in values:
                    values[name] = tangent * speed[:, None] if name == "r_x" else across(tangent)
                p[dofs] = values[name][nodes, "xy".index(axis)]
    return p
