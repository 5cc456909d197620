"""Shapes of the loads of a model in a state."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import Beam, Point
from beamfem.model.load_shapes import Force, ForcesAlong, LoadShape, drawn
from beamfem.model.reference import length_points
from beamfem.results.stations import StationsOfRows
from beamfem.view.frames import one_row

if TYPE_CHECKING:
    from beamfem.model.load_base import Load
    from beamfem.results.solution import Solution


class PlacedRow:
    """A row of a solution, with the members that shapes need."""

    def __init__(self, solution: "Solution", row: int) -> None:
        self.only = one_row(solution, row)

    def position(self, point: Point) -> np.ndarray:
        """Return the position of a point (2,) [m]."""
        return self.only.position(point)[0]

    def at(self, point: Point) -> StationsOfRows:
        """Return the state at a point."""
        return self._stations(point.beam, [point.fraction])

    def along(self, beam: Beam, arc_length: np.ndarray) -> StationsOfRows:
        """Return the state at arc lengths (n,) [m] of a beam."""
        return self._stations(beam, (arc_length / beam.curve.length).tolist())

    def _stations(self, beam: Beam, fractions: list[float]) -> StationsOfRows:
        mesh = self.only.model.mesh_of(beam.start)
        element, xi = map(np.array, zip(*map(mesh.locate, fractions), strict=True))
        return StationsOfRows(self.only, mesh, element, xi)

    def stations(self, beam: Beam) -> np.ndarray:
        """Return the arc lengths (n,) [m] at which loads along a beam are integrated."""
        mesh = self.only.model.mesh_of(beam.start)
        return mesh.arc_length(*length_points(mesh)[:2])

    def shapes(self, load: "Load", weight: float) -> tuple[LoadShape, ...]:
        """Return the shapes of a load, times a weight. Raises InputError for an unknown shape."""
        return drawn(load, load.shapes(weight, self), LoadShape)

    def positions(self, forces: ForcesAlong) -> np.ndarray:
        """Return the positions of forces along a beam (n, 2) [m]."""
        length = forces.beam.curve.length
        return np.array([self.position(forces.beam.at(fraction)) for fraction in forces.arc_length / length])

    def touches(self, force: Force) -> bool:
        """Return whether the arrow's tip touches the beam: inside the beam, and at ends if the force pushes."""
        fraction = force.point.fraction
        if 0.0 < fraction < 1.0:
            return True
        slope = self.at(force.point).slope[0, 0]
        outward = slope if fraction == 1.0 else -slope
        return bool(force.vector @ outward < -0.3 * np.linalg.norm(force.vector) * np.linalg.norm(slope))
