"""Residual that rounded coordinates cause in each row: digits cancel in strains, and stiffness amplifies the error.

A position of size |r| has an error eps |r|, a slope of the axis over an element of length l therefore eps |r| / l; a
unit vector or an angle has an error eps, whatever the size of the model.
"""

from collections.abc import Sequence

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.kernels.block import ELASTIC_LINE, SHEAR_RIGID, STRETCH, STRUCTURAL, Block, PointLoads, Springs


def residual_errors(
    blocks: Sequence[Block],
    vectors: Sequence[tuple[str, ...]],
    springs: Springs,
    points: Sequence[PointLoads],
    size: int,
) -> np.ndarray:
    """Return the residual (2, n) per unit relative error: in positions of 1 m [1/m], and in directions.

    vectors: names of the nodal vectors of each block.
    """
    result = np.zeros((2, size))
    for block, names, loads in zip(blocks, vectors, points, strict=True):
        nodes = _of_nodes(block, _of_slots(block, names))
        for i in np.flatnonzero(loads.spring.any(axis=1)):
            own = block.node[loads.element[i]]
            nodes[0][own] += loads.spring[i].max() * np.abs(loads.position[i]).reshape(len(own), -1)
        for node_kind in np.bincount(block.node_kind).nonzero()[0].tolist():
            here, columns = np.flatnonzero(block.node_kind == node_kind), labels(node_kind, names)
            values = nodes[:, here][:, :, [_slot(label, names) for label in columns]]
            if node_kind in (STRETCH, SHEAR_RIGID):  # the angle turns r_x as well
                values[:, :, columns.index("theta")] += nodes[:, here, 1]
            dofs = block.dof[here, : len(columns)].ravel()
            # contributions of nodes that share a coordinate add up
            for part, own in zip(result, values, strict=True):
                part += np.bincount(dofs, own.ravel(), size)
    np.add.at(result[0], springs.dof, springs.stiffness)
    return result


def _slot(label: str, names: tuple[str, ...]) -> int:
    """Return the index of the nodal vector that a coordinate changes."""
    if label == "theta":
        return len(names) - 1
    return 1 if label == "s" else names.index(label.split("^")[0])


def stress_errors(block: Block, names: tuple[str, ...]) -> np.ndarray:
    """Return the stress resultants (2, nc, nq, ns) for unit errors of positions, and of all other vectors."""
    slope, last = _by_vector(block.slope, names), len(names) - 1
    erring = _by_vector(block.second, names) if block.measures == ELASTIC_LINE else None
    strain = np.zeros((2, *block.reference.shape))
    for part, own in enumerate((slice(0, 1), slice(1, last))):
        of_r = _sum(slope[:, :, :, own])
        of_d = np.abs(block.director).sum(axis=1) + np.zeros_like(of_r) if part else np.zeros_like(of_r)
        if erring is not None:
            of_e = _sum(erring[:, :, :, own])
        else:
            of_e = _sum(slope[:, :, :, last:]) if part else np.zeros_like(of_r)
        for measure, error in enumerate(_strain_errors(block.measures, of_r, of_d, of_e)):
            strain[part, :, :, measure] = error
    return np.einsum("cqij,pcqj->pcqi", np.abs(block.stiffness), strain)


def _by_vector(table: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Return the sizes of a table (nc, nq, nv) by node and nodal vector (nc, nq, nn, vpn)."""
    return np.abs(table).reshape(*table.shape[:2], -1, len(names))


def _sum(values: np.ndarray) -> np.ndarray:
    """Return the sums (nc, nq) over nodes and nodal vectors."""
    return values.reshape(*values.shape[:2], -1).sum(axis=2)


def _of_slots(block: Block, names: tuple[str, ...]) -> np.ndarray:
    """Return the force (2, nc, nv) on nodal vectors for unit errors of positions, and of all other vectors."""
    per_node, slot = len(names), np.arange(block.scale.shape[1])
    along, across = slot[slot % per_node < per_node - 1], slot[per_node - 1 :: per_node]
    slope, stress = np.abs(block.slope), stress_errors(block, names).transpose(3, 0, 1, 2)
    on_r, on_d, on_e = (block.weight * force for force in _forces(block.measures, stress))
    result = np.zeros((2, *block.scale.shape))
    result[:, :, along] = np.einsum("pcq,cqi->pci", on_r, slope[:, :, along])
    if block.measures == ELASTIC_LINE:
        result[:, :, along] += np.einsum("pcq,cqi->pci", on_e, np.abs(block.second)[:, :, along])
    else:
        result[:, :, across] = np.einsum("pcq,cqi->pci", on_e, slope[:, :, across])
    result[:, :, across] += np.einsum("pcq,qi->pci", on_d, np.abs(block.director))
    return result


def _strain_errors(measures: int, of_r: np.ndarray, of_d: np.ndarray, of_e: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the errors of the strain measures for errors of r0', d and the third argument, which are of size one."""
    if measures == STRUCTURAL:
        return of_r + of_d, of_r + of_d, of_e, of_d
    if measures == ELASTIC_LINE:
        return of_r, of_e, of_r + of_d, of_d
    return of_r, of_e, np.zeros_like(of_r), of_d, of_r + of_d, of_e


def _forces(measures: int, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the sizes of the forces on r0', d and the third argument for stress resultants (ns, nc, nq)."""
    if measures == STRUCTURAL:
        return s[0] + s[1], s[0] + s[1] + s[3], s[2]
    if measures == ELASTIC_LINE:
        return s[0] + s[2], s[2] + s[3], s[1]
    return s[0] + s[4], s[3] + s[4], s[1] + s[5]


def _of_nodes(block: Block, errors: np.ndarray) -> np.ndarray:
    """Return the force (k, N, vpn) on the vectors of each node; errors (k, nc, nv): forces by class of elements."""
    count, nodes = block.node.shape[1], len(block.node_kind)
    own = errors.reshape(len(errors), errors.shape[1], count, -1)
    result = np.zeros((len(errors), nodes, own.shape[3]))
    for place in range(count):
        here, found = block.node[:, place], own[:, :, place]
        if found.shape[1] == 1:  # all elements are of one class
            result += np.bincount(here, minlength=nodes)[:, None] * found
            continue
        for part, values in zip(result, found, strict=True):
            spread = values[block.kind]
            for slot in range(own.shape[3]):
                part[:, slot] += np.bincount(here, spread[:, slot], nodes)
    return result
