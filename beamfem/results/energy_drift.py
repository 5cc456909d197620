"""Energy drift of a conservative motion: the error of its time integration."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.assembly.system import system_of
from beamfem.results.full_turns import start_rotations

if TYPE_CHECKING:
    from beamfem.results.energies import Energy
    from beamfem.results.solution import Solution

_ROWS = 100  # rows at which the exchanged energy is evaluated
FIRST = 32  # rows at which it is evaluated besides: what a sudden start gives rise to may last for a few steps only


@dataclass(frozen=True)
class EnergyDrift:
    """Change of the total energy over a motion on which no work is done.

    Parameters
    ----------
    change : float, [J]
        Change of the total energy from start to end.
    exchanged : float, [J]
        Largest energy exchanged between its kinetic, strain and potential part.
    unit : str
        Name of the model's unit of energy.
    """

    change: float
    exchanged: float
    unit: str = "J"

    @property
    def digits(self) -> float:
        """Decimal digits of the exchanged energy that the change leaves correct; inf if the change is zero."""
        if self.change == 0.0:
            return np.inf
        return float(np.log10(self.exchanged / abs(self.change))) if self.exchanged > 0.0 else 0.0

    def __str__(self) -> str:
        return f"energy drifts by {self.change:.2g} {self.unit} of {self.exchanged:.3g} {self.unit}"


def energy_drift(solution: "Solution") -> EnergyDrift | None:
    """Return the energy drift of a motion; None if work is done on it.

    Work is done by loads with an amplitude, follower loads and pressures, moving supports and damping.
    """
    if solution.static or solution.loaded is not None or not _conservative(solution):
        return None
    energy = _energy_of_rows(solution)
    return EnergyDrift(float(energy.total[-1] - energy.total[0]), _exchanged(energy), solution.model.unit("J"))


def _energy_of_rows(solution: "Solution") -> "Energy":
    """Return the energies of at most `_ROWS` rows, of the first `FIRST` ones, and of the fastest one."""
    fastest = np.argmax(np.einsum("sn,sn->s", solution.v, solution.v))
    spread, first = np.linspace(0, len(solution) - 1, _ROWS).astype(int), np.arange(min(FIRST, len(solution)))
    rows = np.unique(np.concatenate([spread, first, [fastest]]))
    return with_rows(solution, rows).energy()


def with_rows(solution: "Solution", rows: Any) -> "Solution":
    """Return the rows of a motion that an index of arrays selects."""
    at, p, v, a = (values[rows] for values in (solution.at, solution.p, solution.v, solution.a))
    return replace(solution, at=at, p=p, v=v, a=a, stability=None, turned=start_rotations(solution)[rows])


def _exchanged(energy: "Energy") -> float:
    return float(max(energy.kinetic.max(), np.ptp(energy.strain), np.ptp(energy.potential)))


def _conservative(solution: "Solution") -> bool:
    system = system_of(solution.model, static=False)
    damped = any(block.damping.any() for block in system.blocks)
    return not driven(solution) and not damped and not system.history.laws


def driven(solution: "Solution") -> bool:
    """Return whether loads or supports may do work on a motion, or connectors dissipate or add energy."""
    system = system_of(solution.model, static=False)
    moved = any(callable(item.value) for item in system.prescribed)
    loaded = any(load.amplitude is not None or not load.conservative for load in solution.model.loads)
    return moved or loaded or not system.connectors.keep_energy
