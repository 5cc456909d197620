"""Resultants at the quadrature points of a group of elements, outside of a solve."""

from collections.abc import Iterable

import numpy as np

from beamfem.equations.assembler import Assembler, Equations
from beamfem.equations.element_group import ElementGroup, make_group
from beamfem.kernels.block import Block, Layout, Stations
from beamfem.kernels.model_record import CONSTANTS


def free_group(block: Block, size: int) -> ElementGroup:
    """Return the group of a block without loads or matrix, in a model with `size` coordinates."""
    none = np.empty((0, 0, 0), dtype=np.int32)
    table, empty = np.empty((0, block.scale.shape[1])), np.empty(0, dtype=np.int64)
    no_loads = Stations(empty, table, table, empty, np.empty((0, CONSTANTS)))
    return make_group(block, Layout(np.arange(size), 0, none), no_loads)


def strain_group(block: Block, size: int) -> ElementGroup:
    """Return the group of a block with unit stiffness: its resultants are strains from the stress-free state."""
    unit = np.broadcast_to(np.eye(block.stiffness.shape[-1]), block.stiffness.shape)
    return free_group(block.resisting(unit), size)


def resultants(
    group: ElementGroup, p: np.ndarray, steps: Iterable[np.ndarray], imposing: np.ndarray
) -> list[np.ndarray]:
    """Return C (eps + (d eps / dp) dp) (ne, nq, ns) at p (n,) for each dp (n,); imposed strains are subtracted.

    imposing (k,): factors of the loads that impose strains.
    """
    assembler, result = Assembler(Equations((group,), len(p))), []
    assembler.impose(imposing)
    for step in steps:
        assembler.predict(p, np.ascontiguousarray(step))
        result.append(assembler.stresses[0].copy())
    return result


def elastic_forces(
    block: Block, p: np.ndarray, v: np.ndarray, a: np.ndarray, imposing: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return e, e'' and elastic and damping forces (steps, N, per_node) of a block in states p, p', p'' (steps, n).

    imposing (steps, k): factors of the loads that impose strains.
    """
    assembler = Assembler(Equations((free_group(block, p.shape[1]),), p.shape[1]))
    size = 2 * block.scale.shape[1] // block.node.shape[1]
    e, acceleration, force = np.empty((3, len(p), len(block.dof), size))
    for step in range(len(p)):
        assembler.impose(imposing[step])
        e[step], acceleration[step], force[step] = assembler.elastic(p[step], v[step], a[step])
    return e, acceleration, force
