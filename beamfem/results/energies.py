"""Energies of a solution."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.load_base import Load, factor
from beamfem.model.model import Model
from beamfem.reprs import brief
from beamfem.results.connector_results import potential_of_connectors
from beamfem.results.displacements import Displacements
from beamfem.results.solution_system import loading

if TYPE_CHECKING:
    from beamfem.results.solution import Solution


@dataclass(frozen=True)
class Energy:
    """Energies of a solution.

    Parameters
    ----------
    kinetic : array, [J], (steps,)
        Kinetic energy.
    strain : array, [J], (steps,)
        Strain energy.
    potential : array, [J], (steps,)
        Potential of gravity, other constant dead loads, springs and foundations; follower forces and pressures have
        none.
    dissipated : array, [J], (steps,)
        Energy dissipated since the start by sections and stops with history; nan if something else may dissipate too,
        which is not integrated: in motions a retardation time or a dashpot, and always another connector that is not
        conservative.
    unit : str
        Name of the model's unit of energy.
    """

    kinetic: np.ndarray
    strain: np.ndarray
    potential: np.ndarray
    dissipated: np.ndarray
    unit: str = field(default="J", repr=False)

    __repr__ = brief

    def _unit_of(self, name: str) -> str:
        return self.unit

    def _repr_html_(self) -> str:
        from beamfem.view.result_tables import energy_table

        return energy_table(self)

    @property
    def total(self) -> np.ndarray:
        """Sum of kinetic, strain and potential energy (steps,) [J]."""
        return self.kinetic + self.strain + self.potential


def potential(solution: "Solution", first_moments: Sequence[np.ndarray]) -> np.ndarray:
    """Return the potential (steps,) [J] of loads, springs and foundations, zero in the reference configuration.

    first_moments: integral of the position over the mass of each beam (steps, 2) [kg m].
    """
    displaced = Displacements(solution, first_moments)
    return _of_loads(solution, displaced) + _of_supports(solution, displaced) + potential_of_connectors(solution)


def dissipated(solution: "Solution", by_sections: np.ndarray) -> np.ndarray:
    """Return what was dissipated since the start (steps,) [J]; by_sections: by sections with history.

    What resists rates has no history variable for it, and rows that are not saved cannot be integrated: nan.
    """
    system = loading(solution)[0]
    items = system.connectors.items
    damped = system.connectors.damp or system.damped
    recorded = [item.dissipated for item in items]
    losing = any(not item.item.conservative and not len(own) for item, own in zip(items, recorded, strict=True))
    if losing or (damped and not solution.static):
        return np.full(len(solution), np.nan)
    return by_sections + sum(solution.p[:, own].sum(axis=1) for own in recorded)


def _of_loads(solution: "Solution", displaced: Displacements) -> np.ndarray:
    result = np.zeros(len(solution))
    for load in sorted(solution.model.loads, key=partial(_number_of_beam, solution.model)):
        if load.conservative:
            result -= _factors(solution, load) * load.work(displaced)
    return result


def _number_of_beam(model: Model, load: Load) -> int:
    """Return the number of the beam that a load acts on, -1 for all mass: displacements are kept for a beam."""
    place = load.place
    if place is None:
        return -1
    return model.number_of(place.beam if isinstance(place, Point) else place)


def _factors(solution: "Solution", load: Load) -> np.ndarray:
    system, times = loading(solution)
    return np.array([factor(load, at, system.static) for at in times])


def _of_supports(solution: "Solution", displaced: Displacements) -> np.ndarray:
    springs = loading(solution)[0].springs
    result = 0.5 * (solution.p[:, springs.dof] - springs.rest) ** 2 @ springs.stiffness
    for support in solution.model.supports:
        result += support.energy(displaced)
    return np.asarray(result)
