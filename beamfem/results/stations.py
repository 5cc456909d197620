"""Points of a beam in the rows of a solution, with the directions that loads follow there."""

from dataclasses import dataclass

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.axis import Axis
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.results import postprocess
from beamfem.results.full_turns import turned_of
from beamfem.results.nodal import axis_at
from beamfem.results.solution import Solution


@dataclass(frozen=True, eq=False)
class StationsOfRows:
    """Points (n,) of a beam, given by element and xi, in the rows of a solution."""

    solution: Solution
    mesh: BeamMesh
    element: np.ndarray
    xi: np.ndarray

    @property
    def rotation(self) -> np.ndarray:
        """Rotations of the sections from the reference (steps, n) [rad]."""
        turned = turned_of(self.solution, self.mesh)
        return postprocess.section_rotation(self.mesh, self.solution.p, self._now, self.element, self.xi, turned)

    @property
    def slope(self) -> np.ndarray:
        """Derivatives r0' (steps, n, 2) [-]."""
        return self._now.r_s

    @cached_property
    def _now(self) -> Axis:
        return axis_at(self.mesh, self.solution.p, self.element, self.xi)
