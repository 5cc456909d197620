"""Generalized forces per unit factor of loads."""

from collections.abc import Sequence

import numpy as np

from beamfem.equations.applied_loads import LoadsAt
from beamfem.equations.system import System
from beamfem.model.imposed_strains import ImposedStrain
from beamfem.model.load_base import BodyLoad, LineLoad, Load, factor, forces_of

_LARGE = 2.0**30  # factor of a load beside which internal forces are round-off
_WIDTH = 2.0**-14  # of the factor of an imposed strain, to which laws of sections may respond nonlinearly


def input_forces(system: System, p: np.ndarray, loads: Sequence[Load], time: float) -> np.ndarray:
    """Return the external forces (n, loads) [N, N m] per unit factor of loads of the model in a state p (n,).

    The forces of follower loads have the directions of the state; those of imposed strains are -dr/d(factor).
    """
    return np.array([_force(system, p, load, time) for load in loads]).reshape(len(loads), len(p)).T


def _force(system: System, p: np.ndarray, load: Load, time: float) -> np.ndarray:
    """Return the external force (n,) per unit factor of a load, by a central difference; it is linear but for laws."""
    imposed = isinstance(load, ImposedStrain)
    middle, width = (factor(load, time, system.static), _WIDTH) if imposed else (0.0, _LARGE)
    ends = [_residual(system, p, load, middle + side * width) for side in (-1.0, 1.0)]
    return (ends[0] - ends[1]) / (2.0 * width)


def _residual(system: System, p: np.ndarray, load: Load, size: float) -> np.ndarray:
    """Return the residual (n,) at rest under one load alone, with its factor `size`."""
    assembler, result, zeros = system.assembler(), np.empty(len(p)), np.zeros(len(p))
    assembler.take(_alone(system, load, size))
    assembler.weigh((1.0, 0.0, 0.0))
    assembler.balance(p, zeros, zeros, result, np.empty(0), False)
    gravity = size * np.array(load.vector) if isinstance(load, BodyLoad) else np.zeros(2)
    for item in system.called.items:
        np.add.at(result, item.all, item.force_in((p, zeros, zeros), 0.0, gravity))
    return result


def _alone(system: System, load: Load, size: float) -> LoadsAt:
    """Return a load with its factor `size`, without all other loads."""
    model, body = system.model, np.zeros((len(system.model.beams), 4))
    if isinstance(load, BodyLoad):
        body[:, :2] = size * np.array(load.vector)
    if isinstance(load, LineLoad) and load.even:
        body[model.number_of(load.beam), 2:] = size * forces_of(load, np.zeros(1))[0]
    points = []
    for actions in system.actions:
        # a load that is listed twice is one input
        rows = [number for number, own in enumerate(actions.loads) if own is load][:1]
        points.append(size * actions.unit * np.isin(actions.source, rows)[:, None])
    numbers = [number for number, (_, own) in enumerate(model.imposing) if own is load][:1]
    imposing = np.zeros(len(model.imposing))
    imposing[numbers] = size
    return LoadsAt(body, tuple(points), imposing)
