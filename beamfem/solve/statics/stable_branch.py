"""The stable branch on which a static solve continues where its path loses stability at a bifurcation."""

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import LimitPointError
from beamfem.solve.newton.iteration import Newton, Termination
from beamfem.solve.statics.load_path import LOCATED, BifurcatesError
from beamfem.solve.statics.snap_through import rest_state
from beamfem.solve.statics.static_record import StaticRecord

BESIDE = 1e-4  # of the load factor of a critical point, which is located to about 1e-8
_ASIDE = 1e-3  # lengths of the model, radians: push along the modes
_RATIO = 0.6  # of the pushes along modes that become soft at once, so that none of their symmetries remains


def leave(system: System, done: StaticRecord, at: BifurcatesError, end: float, newton: Newton) -> None:
    """Add a row at a bifurcation, and the stable equilibrium just beyond it to which its modes lead.

    The record describes that state by the node that moves farthest.

    end: the largest load factor allowed. Raises LimitPointError.
    """
    load_factor = float(at.y[-1])
    done.rows[:] = [row for row in done.rows if row[0] <= (1.0 + LOCATED) * load_factor]
    if done.reached < (1.0 - LOCATED) * load_factor:
        done.add(load_factor, at.y[:-1], 0, Termination.CONVERGED)
    else:  # the last row is the bifurcation, whose pivots have any sign
        load_factor = done.reached
        done.rows[-1] = load_factor, done.state, 0
    start = np.append(at.y[:-1], min((1.0 + BESIDE) * load_factor, end))
    way = _RATIO ** np.arange(len(at.modes)) @ at.modes
    way *= _ASIDE / float(np.max(np.abs(way[:-1]) / system.scale))
    result = rest_state(system, start, start + way, newton)
    done.iterations += result.iterations
    if not result.ended.good:
        raise LimitPointError(f"{at}, and no state of rest was found beyond it", load_factor, done.solution())
    done.add(float(start[-1]), result.state, 0, result.ended, result.digits)
    moved = _farthest(system, result.state - start[:-1])
    done.left.append(f"{at}, which it leaves for the stable state in which {moved}")


def _farthest(system: System, change: np.ndarray) -> str:
    """Return the node that a change (n,) moves farthest, by its place in the reference, and its displacement."""
    nodes = np.concatenate([block.dof[:, :2] for block in system.blocks])
    x, y = nodes[np.argmax(np.hypot(*change[nodes].T))]
    place, moved = (f"({a[x]:.4g}, {a[y]:.4g})" for a in (system.reference, change))
    return f"the node at {place} {system.model.unit('m')} is displaced by a further {moved} {system.model.unit('m')}"
