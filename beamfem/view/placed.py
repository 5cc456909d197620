"""Shapes of the loads of a model in a state."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import Beam, Point
from beamfem.model.reference import length_points
from beamfem.model.shapes import Force, ForcesAlong, LoadShape
from beamfem.view.frames import one_row

if TYPE_CHECKING:
    from beamfem.model.load import Load
    from beamfem.results.solution import Solution


class PlacedRow:
    """A row of a solution, as far as shapes ask for it."""

    def __init__(self, solution: "Solution", row: int) -> None:
        self.only = one_row(solution, row)

    def position(self, point: Point) -> np.ndarray:
        """Return where a point is (2,) [m]."""
        return self.only.position(point)[0]

    def rotation(self, point: Point) -> float:
        """Return the rotation of a section from the reference [rad]."""
        return float(self.only.rotation(point)[0])

    def slope(self, point: Point) -> np.ndarray:
        """Return r0' (2,) [-] at a point."""
        return self.only.fields(point).r_x[0]

    def stations(self, beam: Beam) -> np.ndarray:
        """Return the arc lengths (n,) [m] at which loads along a beam are integrated."""
        mesh = self.only.model.mesh_of(beam.start)
        return mesh.arc_length(*length_points(mesh)[:2])

    def shapes(self, load: "Load", weight: float) -> tuple[LoadShape, ...]:
        """Return what a load looks like, times a weight."""
        return load.shapes(weight, self)

    def along(self, forces: ForcesAlong) -> np.ndarray:
        """Return where forces along a beam are (n, 2) [m]."""
        length = forces.beam.curve.length
        return np.array([self.position(forces.beam.at(fraction)) for fraction in forces.arc_length / length])

    def touches(self, force: Force) -> bool:
        """Return whether an arrow's tip touches the beam: inside it, and where the force presses on an end."""
        fraction = force.point.fraction
        if 0.0 < fraction < 1.0:
            return True
        slope = self.slope(force.point)
        outward = slope if fraction == 1.0 else -slope
        return bool(force.vector @ outward < -0.3 * np.linalg.norm(force.vector) * np.linalg.norm(slope))
