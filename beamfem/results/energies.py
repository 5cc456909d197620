"""Energies of a solution."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.mesh.reference import inertia_points, length_points, reference_axis, reference_position
from beamfem.model.beam import Beam, Point
from beamfem.model.load_base import factor
from beamfem.reprs import brief
from beamfem.results.axis_points import AxisPoints
from beamfem.results.postprocess import momenta
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading


@dataclass(frozen=True)
class Energy:
    """Energies of a solution (steps,) [J], and the name of the model's unit of energy.

    potential: of gravity, other constant dead loads, springs and foundations; follower forces and pressures have none.
    recorded: dissipated since the start by sections and stops with history; solution: the one over whose rows `work`
    and `dissipated` are integrated.
    """

    kinetic: np.ndarray
    strain: np.ndarray
    potential: np.ndarray
    recorded: np.ndarray
    unit: str = field(default="J", repr=False)
    solution: Solution | None = field(default=None, repr=False)

    __repr__ = brief

    def _unit_of(self, name: str) -> str:
        return self.unit

    def _repr_html_(self) -> str:
        from beamfem.view.summary import energy_table

        return energy_table(self)

    @property
    def total(self) -> np.ndarray:
        """Sum of kinetic, strain and potential energy (steps,) [J]."""
        return self.kinetic + self.strain + self.potential

    @cached_property
    def _exchange(self) -> tuple[np.ndarray, np.ndarray]:
        """Work, nan for equilibria, and what rates dissipate since the first row (steps,) [J]."""
        from beamfem.results.work_and_losses import exchange, forces_without_potential

        solution = self.solution
        if solution is None or solution.static or solution.loaded is not None or not len(solution):
            return np.full_like(self.kinetic, np.nan), np.zeros_like(self.kinetic)
        own = exchange(solution, forces_without_potential(solution))
        work, lost = (np.append(0.0, np.cumsum(change)) for change in (own.work + own.given + own.stored, own.lost))
        return work, lost

    @property
    def work(self) -> np.ndarray:
        """Work (steps,) [J] done on a motion since its first row; nan for equilibria.

        It is that of moving supports, follower loads and pressures, loads that change with time, imposed strains, and
        connectors that follow time or are not conservative: the mean of the forces in two rows times the displacement
        between them. The work of constant dead loads is in `potential`.
        """
        return self._exchange[0]

    @property
    def dissipated(self) -> np.ndarray:
        """Energy (steps,) [J] dissipated since the start by history, and since the first row by rates.

        Damping of beams and dampers resist rates; the mean of their power in two rows, times the time between them. In
        statics, there is only what sections and stops with history have recorded, and nan if connectors that are not
        conservative may dissipate too.
        """
        return self.recorded + self._exchange[1]

    @property
    def error(self) -> np.ndarray:
        """Work less the changes of `total` and of `dissipated` since the first row (steps,) [J]; nan for equilibria.

        It is the error of the time steps, such as numerical damping, and of the integration over the rows.
        """
        return self.work - (self.total - self.total[:1]) - (self.dissipated - self.dissipated[:1])


@dataclass(frozen=True, eq=False)
class Displacements:
    """The rows of a solution, with the members that the work of loads and the energy of supports need.

    first: integral of the position over the mass of each beam (steps, 2) [kg m].
    """

    solution: Solution
    first: Sequence[np.ndarray]

    def __len__(self) -> int:
        return len(self.solution)

    @property
    def first_moments(self) -> Iterator[np.ndarray]:
        """Integral of the displacement over the mass of each beam (steps, 2) [kg m]."""
        for mesh, first in zip(self.solution.model.meshes, self.first, strict=True):
            element, xi, inertia = inertia_points(mesh)
            at_rest = inertia[:, 0] @ reference_position(mesh, element, xi)
            yield first - (at_rest + inertia[:, 1] @ reference_axis(mesh, element, xi).d)

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point (steps, 2) [m]."""
        return self.solution.displacement(point)

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section at a point (steps,) [rad]."""
        return self.solution.rotation(point)

    def along(self, beam: Beam) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return displacements (steps, n, 2) [m] at points along a beam, and their weights and arc lengths (n,) [m]."""
        element, xi, weight = length_points(mesh := self.solution.model.mesh_of(beam.start))
        points = AxisPoints(mesh, element, xi)
        return points.positions(self.solution.p)[0] - points.reference, weight, points.arc_length


def potential(solution: Solution, first_moments: Sequence[np.ndarray]) -> np.ndarray:
    """Return the potential (steps,) [J] of loads, springs and foundations, zero in the reference configuration.

    Connectors are not included.

    first_moments: integral of the position over the mass of each beam (steps, 2) [kg m].
    """
    displaced, (system, times) = Displacements(solution, first_moments), loading(solution)
    loads, springs = np.zeros(len(solution)), system.springs.potential(solution.p)
    for load in solution.model.loads:
        if load.conservative:
            loads -= np.array([factor(load, at, system.static) for at in times]) * load.work(displaced)
    for support in solution.model.supports:
        springs += support.energy(displaced)
    return np.asarray(loads + springs + _of_frame(solution))


def recorded(solution: Solution, by_sections: np.ndarray) -> np.ndarray:
    """Return what history variables record as dissipated (steps,) [J]; by_sections: by sections with history.

    In statics nan if a connector that is not conservative has no record.
    """
    system = loading(solution)[0]
    items = system.connectors.items
    own = [item.dissipated for item in items]
    if system.static and any(
        not item.item.conservative and not len(each) for item, each in zip(items, own, strict=True)
    ):
        return np.full(len(solution), np.nan)
    return by_sections + sum(solution.p[:, each].sum(axis=1) for each in own)


def _of_frame(solution: Solution) -> np.ndarray:
    """Return the potential (steps,) [J] of centrifugal forces, less the kinetic energy of the rotation of the frame."""
    frame = solution.model.frame
    if frame is None:
        return np.zeros(len(solution))
    system, times = loading(solution)
    unit = RigidVelocity(angular=1.0, about=frame.about)
    p = np.vstack([solution.p, system.reference])
    spin = np.array([rigid_rates(system, unit, row) for row in p])
    moments = sum((momenta(mesh, p, spin).kinetic for mesh in solution.model.meshes), np.zeros(len(p)))
    zeros = np.zeros(p.shape[1])
    moments += [system.connectors.energies((row, rate, zeros), 0.0)[0] for row, rate in zip(p, spin, strict=True)]
    factors = times if system.static else np.ones(len(times))
    return -(frame.speed**2) * factors * (moments[:-1] - moments[-1])
