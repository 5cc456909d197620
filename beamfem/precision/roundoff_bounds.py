"""Residual that rounded coordinates cause in each row: digits cancel in strains, and stiffness amplifies the error.

A position of size |r| has an error eps |r|, a slope of the axis over an element of length l therefore eps |r| / l; a
unit vector or an angle has an error eps, whatever the size of the model.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np

from beamfem.element.coordinates import labels
from beamfem.kernels.block import ELASTIC_LINE, SHEAR_RIGID, STRETCH, Block, Stations
from beamfem.physics.kinematics import MEASURES, evaluate
from beamfem.physics.stations import GROUNDED

_COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted


def residual_errors(
    blocks: Sequence[Block],
    vectors: Sequence[tuple[str, ...]],
    stations: Sequence[Stations],
    size: int,
) -> np.ndarray:
    """Return the residual (2, n) per unit relative error: in positions of 1 m [1/m], and in directions.

    vectors: names of the nodal vectors of each block.
    """
    result = np.zeros((2, size))
    for block, names, own in zip(blocks, vectors, stations, strict=True):
        nodes = _of_nodes(block, _of_slots(block, names))
        for i in np.flatnonzero(own.kind == GROUNDED):
            held = block.node[own.element[i]]
            nodes[0][held] += own.constants[i, :2].max() * np.abs(own.position[i]).reshape(len(held), -1)
        for kind in np.unique(block.node_kind).tolist():
            number, columns = np.flatnonzero(block.node_kind == kind), labels(kind, names)
            values = nodes[:, number][:, :, [_slot(label, names) for label in columns]]
            if kind in (STRETCH, SHEAR_RIGID):  # the angle, which is last, turns r_x as well
                values[:, :, -1] += nodes[:, number, 1]
            # contributions of nodes that share a coordinate add up
            dofs = block.dof[number, : len(columns)].ravel()
            for total, contribution in zip(result, values, strict=True):
                total += np.bincount(dofs, contribution.ravel(), size)
    return result


def _slot(label: str, names: tuple[str, ...]) -> int:
    """Return the index of the nodal vector that a coordinate changes."""
    if label == "theta":
        return len(names) - 1
    return 1 if label == "s" else names.index(label.split("^")[0])


def stress_errors(block: Block, names: tuple[str, ...]) -> np.ndarray:
    """Return the stress resultants (2, nc, nq, ns) for unit errors of positions, and of all other vectors."""
    slope, last = _sums(block.slope, names), len(names) - 1
    of_r, of_d, of_e = errors = np.zeros((3, 2, *block.weight.shape))
    of_r[:last], of_d[1] = slope[:last], np.abs(block.director).sum(axis=1)
    if block.measures == ELASTIC_LINE:
        of_e[:last] = _sums(block.second, names)[:last]
    else:
        of_e[1] = slope[last]
    strain = np.einsum("vpcq,vj->pcqj", errors, depends(block.measures))
    return np.einsum("cqij,pcqj->pcqi", np.abs(block.stiffness), strain)


def _sums(table: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Return the sums of sizes (vpn, nc, nq) of a table (nc, nq, nv) for each nodal vector."""
    sizes = np.abs(table).reshape(*table.shape[:2], -1, len(names))
    return np.ascontiguousarray(sizes.transpose(3, 0, 1, 2)).sum(axis=3)


def _of_slots(block: Block, names: tuple[str, ...]) -> np.ndarray:
    """Return the force (2, nc, nv) on nodal vectors for unit errors of positions, and of all other vectors."""
    slot, per_node = np.arange(block.scale.shape[1]), len(names)
    along, across = slot[slot % per_node < per_node - 1], slot[per_node - 1 :: per_node]  # interpolate r0, and d
    slope, stress = np.abs(block.slope), stress_errors(block, names)
    on_r, on_d, on_e = block.weight * np.einsum("vj,pcqj->vpcq", depends(block.measures), stress)
    result = np.empty((2, *block.scale.shape))
    on_along = np.einsum("pcq,cqi->pci", on_r, slope[:, :, along])
    on_across = np.einsum("pcq,qi->pci", on_d, np.abs(block.director))
    if block.measures == ELASTIC_LINE:
        on_along += np.einsum("pcq,cqi->pci", on_e, np.abs(block.second)[:, :, along])
    else:
        on_across += np.einsum("pcq,cqi->pci", on_e, slope[:, :, across])
    result[:, :, along], result[:, :, across] = on_along, on_across
    return result


@cache
def depends(measures: int) -> np.ndarray:
    """Return 1 where a strain measure depends on r0', d or a third vector that is small, else 0 (3, ns)."""
    vectors = np.array([[0.8, 0.3], [-0.4, 0.9], [0.0, 0.0]])
    steps = vectors + _COMPLEX_STEP * 1j * np.eye(6).reshape(6, 3, 2)
    slopes = evaluate(MEASURES[measures], *np.moveaxis(steps, 1, 0)).imag.reshape(3, 2, -1)
    return np.any(slopes != 0.0, axis=1).astype(float)


def _of_nodes(block: Block, errors: np.ndarray) -> np.ndarray:
    """Return the force (k, N, vpn) on the vectors of each node; errors (k, nc, nv): forces by class of elements."""
    count, nodes = block.node.shape[1], len(block.node_kind)
    forces = errors.reshape(len(errors), errors.shape[1], count, -1)
    if forces.shape[1] == 1:  # all elements are of one class
        positions = (block.node + nodes * np.arange(count)).ravel()
        times = np.bincount(positions, minlength=count * nodes).reshape(count, nodes)
        return np.einsum("jn,pjv->pnv", times, forces[:, 0])
    result = np.zeros((len(errors), nodes, forces.shape[3]))
    for local in range(count):
        numbers, local_forces = block.node[:, local], forces[:, :, local]
        for total, values in zip(result, local_forces, strict=True):
            spread = values[block.kind]
            for slot in range(forces.shape[3]):
                total[:, slot] += np.bincount(numbers, spread[:, slot], nodes)
    return result
