"""What the roofline looks at: residual, tangent, factorisation and solution of a pendulum in motion."""

from typing import NamedTuple

import numpy as np

import beamfem as bf
from beamfem.equations.assembler import Assembler
from beamfem.equations.system import System, system_of
from beamfem.kernels.block import Block, Layout
from studies.benchmarks.peer_cases import STRUCTURAL, pendulum

FORMS = {"bilinear, structural": STRUCTURAL, "order 2, structural": bf.CRBF(2), "ANCF, continuum": bf.ANCF()}
RESIDUAL, TANGENT, FACTOR, SOLVE = "residual", "residual and tangent", "factorisation", "solution"
KERNELS = (RESIDUAL, TANGENT, FACTOR, SOLVE)
_STEP = 1e-3  # [s]; weighs the inertia in the tangent


class Case(NamedTuple):
    """What the kernels work on: equations of the pendulum, its state p, p', p'' (3, n), and space.

    band (unknown, width); right: a right-hand side (unknown,); reach (2, unknown): see `kernels.bidirectional_lu`.
    """

    equations: Assembler
    state: np.ndarray
    residual: np.ndarray
    band: np.ndarray
    right: np.ndarray
    reach: np.ndarray

    @property
    def half_width(self) -> int:
        return self.band.shape[1] // 2


def case(form: str, elements: int) -> tuple[System, Case]:
    """Return the pendulum in a state somewhat away from its reference, and what the kernels work on for it."""
    system = system_of(pendulum(FORMS[form], elements), False)
    rng = np.random.default_rng(6)
    state = rng.normal(size=(3, system.model.size))
    state[0] = system.reference + 1e-3 / elements * rng.normal(size=system.model.size)
    unknown, width = len(system.free_dofs), 2 * system.layouts[0].half_width + 1
    equations = system.assembler()
    equations.load(system.loads.at(0.0).body, system.loads.at(0.0).points)
    equations.weigh((1.0, 2.0 / _STEP, 4.0 / _STEP**2))
    residual, band, right = np.empty(len(state[0])), np.zeros((unknown, width)), rng.normal(size=unknown)
    one = Case(equations, state, residual, band, right, system.unknowns.reach)
    place(one, tangent=True)
    return system, one


def place(one: Case, tangent: bool) -> None:
    """Make ready for calls of `balance` on the table of the equations, with the tangent or without."""
    one.equations.require("tangent")
    one.equations.place(*one.state, one.residual, one.band.ravel())
    one.equations.record.tangent = tangent


def least_traffic(system: System, one: Case) -> dict[str, int]:
    """Return bytes that each kernel moves at least.

    Every array that grows with the model counts once where it is read, twice where it is written or changed.
    """
    block: Block = system.blocks[0]
    layout: Layout = system.layouts[0]
    tables = (block.node, block.kind, block.beam, block.frame, block.dof)
    nodal = len(block.dof) * 2 * block.scale.shape[1] // block.node.shape[1] * one.state.itemsize
    residual = sum(table.nbytes for table in (*tables, one.state)) + 2 * (3 * nodal + one.residual.nbytes)
    rest = layout.free.nbytes + layout.slot.nbytes + block.home.nbytes + 2 * (nodal + one.band.nbytes)
    return {
        RESIDUAL: residual,
        TANGENT: residual + rest,
        FACTOR: 2 * one.band.nbytes,
        SOLVE: one.band.nbytes + 4 * one.right.nbytes,
    }
