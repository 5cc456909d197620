"""Unknowns without stiffness or mass: analyses that do not support them, and redundant conditions."""

import numpy as np

from beamfem.assembly.connectors import damps_at_rest
from beamfem.assembly.equations import STATICS, linearise
from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.linalg.lapack import qr

_DEPENDENT = 1e-10  # of a condition of unit size: its part that is independent of all others


def refuse_multipliers(system: System, analysis: str) -> None:
    """Raise InputError if a connector has unknowns of its own."""
    for item in system.connectors.items:
        if len(item.own):
            raise InputError(
                f"{analysis} does not support connectors with unknowns of their own, such as {item.name}; solve_static "
                "and simulate do. A stiff spring in its place has none"
            )


def refuse_memory(system: System, analysis: str) -> None:
    """Raise InputError if a connector or a section law has history, so that states do not depend on the load alone."""
    for kind, name in system.history.holders:
        raise InputError(
            f"{analysis} does not support {kind} with history, such as {name}; solve_static and simulate do"
        )


def refuse_dampers(system: System) -> None:
    """Raise InputError if the force of a connector depends on velocities about rest, which free vibrations neglect."""
    for item in system.connectors.items:
        if damps_at_rest(item):
            raise InputError(
                f"solve_modes finds undamped vibrations, but the force of {item.name} depends on velocities; leave it "
                "out, or let simulate show how the motion decays"
            )


def require_independent(system: System, p: np.ndarray) -> None:
    """Raise InputError if conditions of connectors, supports and joints are redundant in a state p (n,)."""
    multipliers = len(system.connectors.multipliers)
    if multipliers == 0:
        return
    zeros = np.zeros(len(p))
    tangent = linearise(system, p, zeros, zeros, 0.0, STATICS)[1].sparse(system.rotated)
    scale = system.scale[system.free_dofs][:-multipliers]
    rows = (tangent[-multipliers:, :-multipliers].toarray() * scale).T
    sizes = np.linalg.norm(rows, axis=0)
    diagonal = np.abs(np.diagonal(qr(rows / np.where(sizes > 0.0, sizes, 1.0), mode="r", pivoting=True)[0]))
    if len(diagonal) < multipliers or np.any(diagonal <= _DEPENDENT):
        raise InputError(dependent(system))


def dependent(system: System) -> str:
    """Return the message that conditions of connectors are linearly dependent."""
    names = ", ".join(sorted({item.name for item in system.connectors.items if len(item.own)}))
    return (
        f"conditions of connectors ({names}) are redundant, among themselves or with supports and joints: their "
        "multipliers are not unique; leave out those that are not needed"
    )
