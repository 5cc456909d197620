"""The unknowns of a band and the routines that solve for them, as compiled drivers take them."""

from functools import cache
from typing import Any

import numpy as np

from beamfem.equations.equation_numbering import Unknowns
from beamfem.kernels.band import band
from beamfem.kernels.bidirectional_lu import SHORT, bidirectional_lu
from beamfem.kernels.motion_record import MotionRoutines, MotionSolver
from beamfem.kernels.newton_loop import NewtonRoutines, NewtonSolver


def _fields(unknowns: Unknowns, rotated: tuple[np.ndarray, np.ndarray], scale: np.ndarray) -> dict[str, Any]:
    """Return the fields of `kernels.record.Solver` that are no workspace; arguments: see `newton_solver`."""
    half = unknowns.layouts[0].half_width
    return {
        "size": len(scale),
        "unknown": len(unknowns.dofs),
        "free_dofs": np.ascontiguousarray(unknowns.dofs, dtype=np.int64),
        "first_free": unknowns.first,
        "half": half,
        "width": 2 * half + 1,
        "rollers": len(rotated[0]),
        "roller_first": np.ascontiguousarray(rotated[0], dtype=np.int64),
        "roller_normal": np.ascontiguousarray(rotated[1], dtype=float),
        "scale": np.ascontiguousarray(scale, dtype=float),
        "inverse_scale": 1.0 / scale,
        "reach": unknowns.reach,
    }


def newton_solver(
    unknowns: Unknowns, rotated: tuple[np.ndarray, np.ndarray], scale: np.ndarray, multipliers: np.ndarray
) -> NewtonSolver:
    """Return the solver of Newton's iteration without workspace.

    rotated: equation numbers (nt,) and normals (nt, 2) of inclined rollers; scale (n,): scale of the coordinates;
    multipliers: numbers (k,) of those whose rows are no forces.
    """
    fields = _fields(unknowns, rotated, scale)
    if len(multipliers):
        fields["scale"] = scale.copy()
        fields["scale"][multipliers] = 0.0
    return NewtonSolver(routines=_newton_routines(fields["half"]), **fields)


def motion_solver(
    unknowns: Unknowns, rotated: tuple[np.ndarray, np.ndarray], scale: np.ndarray, prescribed: np.ndarray
) -> MotionSolver:
    """Return the solver of time steps without workspace; prescribed: numbers of coordinates."""
    fields = _fields(unknowns, rotated, scale)
    routines = _motion_routines(fields["half"], fields["unknown"] < SHORT)
    return MotionSolver(routines=routines, prescribed=len(prescribed), prescribed_dofs=prescribed, **fields)


@cache
def _newton_routines(half_width: int) -> NewtonRoutines:
    """Return the routines of Newton's iteration for a band of a half width."""
    own = band(half_width)
    return NewtonRoutines.usual(factor=own.factor, solve_upper=own.solve_upper)


@cache
def _motion_routines(half_width: int, short: bool) -> MotionRoutines:
    """Return the routines of time steps for a band of a half width."""
    own = bidirectional_lu(half_width, short)
    return MotionRoutines.usual(factor=own.factor, solve_both=own.solve)
