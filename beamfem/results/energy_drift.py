"""Energy drift of a conservative motion: the error of its time integration."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from beamfem.assembly.system import system_of
from beamfem.results.turns import start_rotations

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_MUCH = 0.1  # fraction of the exchanged energy; a larger drift makes the results meaningless
_ROWS = 100  # rows at which the exchanged energy is evaluated


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
    rows = np.unique(np.linspace(0, len(solution) - 1, _ROWS).astype(int))
    at, p, v, a = (values[rows] for values in (solution.at, solution.p, solution.v, solution.a))
    some = replace(solution, at=at, p=p, v=v, a=a, stability=None, turned=start_rotations(solution)[rows])
    energy = some.energy()
    total, parts = energy.total, (energy.kinetic.max(), np.ptp(energy.strain), np.ptp(energy.potential))
    return EnergyDrift(float(total[-1] - total[0]), float(max(parts)), solution.model.unit("J"))


def drift_warnings(solution: "Solution") -> tuple[str, ...]:
    """Return a warning if the energy of a motion rises although no work is done on it."""
    drift = solution.energy_drift
    if drift is None or not drift.change > _MUCH * drift.exchanged:
        return ()
    return (
        f"the energy rises by {drift.change:.3g} {drift.unit}, compared with {drift.exchanged:.3g} {drift.unit} "
        "exchanged at most, although no work is done on the motion: the time steps do not resolve its high-frequency "
        "vibration. Use smaller steps",
    )


def _conservative(solution: "Solution") -> bool:
    system = system_of(solution.model, static=False)
    moved = any(callable(item.value) for item in system.prescribed)
    driven = any(load.amplitude is not None or not load.conservative for load in solution.model.loads)
    damped = any(block.damping.any() for block in system.blocks)
    lossless = system.connectors.keep_energy and not system.history.laws
    return not moved and not driven and not damped and lossless
