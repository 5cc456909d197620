"""Section forces of beams from the equilibrium of their elements, at stations and at any other points."""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.mesh import BeamMesh
from beamfem.results.acting import Rows, rows_of
from beamfem.results.free_bodies import Cuts, cut_free
from beamfem.results.last_digits import exactly
from beamfem.results.postprocess import SectionForces
from beamfem.units import units_of

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_VALUES = 2_000_000  # most values in one array


def section_forces(solution: "Solution", beam: Beam) -> SectionForces:
    """Return the section forces of a beam at the stations listed in `SectionForces`."""
    mesh = solution.model.mesh_of(beam.start)
    cuts = stations(mesh)
    found = at_points(solution, mesh, cuts)
    arc = mesh.arc_length(cuts.element, cuts.xi)
    arc = np.where(cuts.xi == 0.0, mesh.vertices[cuts.element], arc)
    arc = np.where(cuts.xi == 1.0, mesh.vertices[cuts.element + 1], arc)
    return SectionForces(arc, found[:, 0], found[:, 1], found[:, 2], units_of(solution.model.units))


def at_points(solution: "Solution", mesh: BeamMesh, cuts: Cuts, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Return normal and shear force [N] and moment [N m] (steps, 3, points) of some rows at points of a beam."""
    chosen = np.arange(len(solution))[rows]
    elements = np.unique(cuts.element)
    size = mesh.classes.scale.shape[1] * (len(cuts.xi) + len(elements) * len(mesh.beam.element.field.nodes))
    chunk = max(1, _VALUES // size)
    parts = [np.empty((0, 3, len(cuts.xi)))]
    for first in range(0, len(chosen), chunk):
        numbers = chosen[first : first + chunk]
        here = rows_of(solution, numbers)
        parts.append(exactly(solution, partial(_at_cuts, here, mesh, elements, cuts), numbers))
    return np.concatenate(parts)


def _at_cuts(rows: Rows, mesh: BeamMesh, elements: np.ndarray, cuts: Cuts, p: np.ndarray) -> np.ndarray:
    return cut_free(rows, mesh, elements, p).at(cuts)


def stations(mesh: BeamMesh) -> Cuts:
    """Return the ends and Gauss points of every element of a beam."""
    own = np.array([0.0, *mesh.beam.element.quadrature()[0], 1.0])
    return Cuts(np.repeat(np.arange(mesh.elements), len(own)), np.tile(own, mesh.elements))
