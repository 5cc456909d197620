"""What the roofline looks at: residual, tangent, factorisation and solution of a pendulum in motion."""

from typing import Any, NamedTuple

import numpy as np
from peer_cases import STRUCTURAL, pendulum

import beamfem as bf
from beamfem.analysis.equations import point_rows
from beamfem.kernels.block import Block, Layout
from beamfem.model.system import System, system_of

FORMS = {"bilinear, structural": STRUCTURAL, "order 2, structural": bf.CRBF(2), "ANCF, continuum": bf.ANCF()}
RESIDUAL, TANGENT, FACTOR, SOLVE = "residual", "residual and tangent", "factorisation", "solution"
KERNELS = (RESIDUAL, TANGENT, FACTOR, SOLVE)
_STEP = 1e-3  # [s]; weighs the inertia in the tangent


class Case(NamedTuple):
    """Arguments of the kernels.

    balance: all but the residual (n,) and the matrix; band (unknown, width); right: a right-hand side (unknown,);
    window: of the band, see `beamfem.kernels.band`.
    """

    balance: tuple[Any, ...]
    residual: np.ndarray
    band: np.ndarray
    right: np.ndarray
    window: tuple[float, ...]


def case(form: str, elements: int) -> tuple[System, Case]:
    """Return the pendulum in a state somewhat away from its reference, and the arguments of the kernels for it."""
    system = system_of(pendulum(FORMS[form], elements), False)
    rng = np.random.default_rng(6)
    p, v, a = system.reference.copy(), rng.normal(size=system.model.size), rng.normal(size=system.model.size)
    p += 1e-3 / elements * rng.normal(size=len(p))
    unknown, width = len(system.free_dofs), 2 * system.layouts[0].half_width + 1
    weights = np.array([1.0, 2.0 / _STEP, 4.0 / _STEP**2])
    model = system.forms, system.blocks, system.workspaces(), system.point_loads, system.springs, system.layouts
    actions = system.body(0.0), point_rows(system, 0.0), 0
    arguments = (*model, p, v, a, *actions, weights, False)
    window = system.forms[0].window
    return system, Case(arguments, np.empty(len(p)), np.zeros((unknown, width)), rng.normal(size=unknown), window)


def least_traffic(system: System, one: Case) -> dict[str, int]:
    """Return bytes that each kernel moves at least.

    Every array that grows with the model counts once where it is read, twice where it is written or changed.
    """
    block: Block = system.blocks[0]
    layout: Layout = system.layouts[0]
    work = one.balance[2][0]
    tables = (block.node, block.kind, block.beam, block.carrier, block.frame, block.dof)
    state = one.balance[6:9]
    nodal = work.nodes[0].nbytes
    residual = sum(table.nbytes for table in (*tables, *state)) + 2 * (3 * nodal + one.residual.nbytes)
    rest = layout.free.nbytes + layout.slot.nbytes + block.home.nbytes + 2 * (nodal + one.band.nbytes)
    return {
        RESIDUAL: residual,
        TANGENT: residual + rest,
        FACTOR: 2 * one.band.nbytes,
        SOLVE: one.band.nbytes + 4 * one.right.nbytes,
    }
