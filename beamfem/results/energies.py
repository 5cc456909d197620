"""Energies of a solution."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from beamfem.brief import brief
from beamfem.model.beam import Beam
from beamfem.model.load import LineLoad, Load, PointLoad, factor
from beamfem.model.mesh import BeamMesh
from beamfem.model.reference import inertia_points, length_points, reference_axis, reference_position
from beamfem.model.returned import forces_of
from beamfem.registry import offered
from beamfem.results import postprocess
from beamfem.results.connected import potential_of_connectors
from beamfem.results.loading import loading
from beamfem.results.turns import rotations

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
        Energy dissipated since the start by sections with history; nan if something else may dissipate too, which is
        not integrated: in motions a retardation time or a dashpot, and always a connector that is not conservative.
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
        return offered(Energy._repr_html_)(self)

    @property
    def total(self) -> np.ndarray:
        """Sum of kinetic, strain and potential energy (steps,) [J]."""
        return self.kinetic + self.strain + self.potential


def potential(solution: "Solution", first_moments: Sequence[np.ndarray]) -> np.ndarray:
    """Return the potential (steps,) [J] of loads, springs and foundations, zero in the reference configuration.

    first_moments: integral of the position over the mass of each beam (steps, 2) [kg m].
    """
    acting = _of_gravity(solution, first_moments) + _of_loads(solution) + _of_springs(solution)
    return acting + potential_of_connectors(solution)


def dissipated(solution: "Solution", by_sections: np.ndarray) -> np.ndarray:
    """Return what was dissipated since the start (steps,) [J]; by_sections: by sections with history.

    What resists rates has no history variable for it, and rows that are not saved cannot be integrated: nan.
    """
    system = loading(solution)[0]
    damped = system.connectors.damp or any(block.damping.any() for block in system.blocks)
    known = system.connectors.conservative and (solution.static or not damped)
    return by_sections if known else np.full(len(solution), np.nan)


def _of_gravity(solution: "Solution", first_moments: Sequence[np.ndarray]) -> np.ndarray:
    result = np.zeros(len(solution))
    for load in solution.model.gravity:
        weights = _factors(solution, load)
        for mesh, moment in zip(solution.model.meshes, first_moments, strict=True):
            result -= weights * ((moment - _reference_moment(mesh)) @ np.array(load.vector))
    return result


def _of_loads(solution: "Solution") -> np.ndarray:
    result = np.zeros(len(solution))
    turned: defaultdict[int, list[PointLoad]] = defaultdict(list)
    for acting in solution.model.point_loads:
        if not acting.conservative:
            continue
        fx, fy, moment = acting.value
        if fx or fy:
            moved = solution.displacement(acting.point)
            result -= _factors(solution, acting) * (moved @ np.array([fx, fy]))
        if moment:
            turned[id(acting.point.beam)].append(acting)
    for moments in turned.values():
        angles = rotations(solution, [acting.point for acting in moments])
        for acting, angle in zip(moments, angles.T, strict=True):
            result -= _factors(solution, acting) * acting.value[2] * angle
    distributed: defaultdict[int, list[LineLoad]] = defaultdict(list)
    for line in solution.model.line_loads:
        if line.conservative:
            distributed[id(line.beam)].append(line)
    for lines in distributed.values():
        moved, weight, arc = _along(solution, lines[0].beam)
        for line in lines:
            work = np.einsum("sqc,qc,q->s", moved, forces_of(line, arc), weight)
            result -= _factors(solution, line) * work
    return result


def _factors(solution: "Solution", load: Load) -> np.ndarray:
    system, times = loading(solution)
    return np.array([factor(load, at, system.static) for at in times])


def _of_springs(solution: "Solution") -> np.ndarray:
    springs = loading(solution)[0].springs
    result = 0.5 * (solution.p[:, springs.dof] - springs.rest) ** 2 @ springs.stiffness
    for support in solution.model.line_supports:
        moved, weight, _ = _along(solution, support.beam)
        result += 0.5 * np.einsum("sqc,c,q->s", moved**2, np.array(support.stiffness), weight)
    return np.asarray(result)


def _along(solution: "Solution", beam: Beam) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return displacements (steps, nq, 2) [m] at points along a beam, and their weights and arc lengths (nq,) [m]."""
    mesh = solution.model.mesh_of(beam.start)
    element, xi, weight = length_points(mesh)
    now = postprocess.axis(mesh, postprocess.nodal_vectors(mesh, solution.p), element, xi).r
    return now - reference_position(mesh, element, xi), weight, mesh.arc_length(element, xi)


def _reference_moment(mesh: BeamMesh) -> np.ndarray:
    """Return the integral of the reference position over the mass (2,) [kg m]."""
    element, xi, inertia = inertia_points(mesh)
    return np.asarray(
        inertia[:, 0] @ reference_position(mesh, element, xi) + inertia[:, 1] @ reference_axis(mesh, element, xi).d
    )
