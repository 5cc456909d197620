"""Section forces of beams from the equilibrium of their elements, at stations and at any other points."""

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.mesh import BeamMesh
from beamfem.results.acting import Rows, rows_of
from beamfem.results.free_bodies import Cuts, Parted, cut_free, parted
from beamfem.results.last_digits import exactly
from beamfem.results.loading import loading
from beamfem.results.neighbours import of_beam
from beamfem.results.postprocess import SectionForces
from beamfem.units import units_of

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_VALUES = 2_000_000  # most values in one array


def section_forces(solution: "Solution", beam: Beam) -> SectionForces:
    """Return the section forces of a beam at the stations listed in `SectionForces`."""
    number = solution.model.number_of(beam)
    mesh = solution.model.meshes[number]
    cuts = stations(mesh)
    arc = mesh.arc_length(cuts.element, cuts.xi)
    normal, shear, moment = of_beam(solution, number, _at_stations)
    return SectionForces(arc, normal, shear, moment, units_of(solution.model.units))


def _at_stations(solution: "Solution", mesh: BeamMesh) -> np.ndarray:
    """Return normal and shear force and moment (3, steps, stations)."""
    return at_points(solution, mesh, stations(mesh)).swapaxes(0, 1)


def at_points(solution: "Solution", mesh: BeamMesh, cuts: Cuts, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Return normal and shear force [N] and moment [N m] (steps, 3, points) of some rows at points of a beam."""
    elements = np.unique(cuts.element)
    own = parted(loading(solution)[0].blocks[mesh.block], mesh.in_block(elements))
    field = mesh.beam.element.field
    size = len(field.nodes) * len(field.vectors) * (len(cuts.xi) + len(elements) * len(field.nodes))
    chunk = max(1, _VALUES // size)
    parts = [np.empty((0, 3, len(cuts.xi)))]
    for numbers in in_parts(len(solution), rows, chunk):
        chunk_rows = rows_of(solution, numbers)
        parts.append(exactly(solution, partial(_at_cuts, chunk_rows, mesh, elements, own, cuts), numbers, own.used))
    return np.concatenate(parts)


def in_parts(count: int, rows: slice | np.ndarray, longest: int) -> Iterator[slice | np.ndarray]:
    """Yield some of `count` rows in parts of a limited length, as slices if they are given as a slice."""
    if not isinstance(rows, slice):
        yield from (rows[first : first + longest] for first in range(0, len(rows), longest))
        return
    chosen = range(count)[rows]
    for first in range(0, len(chosen), longest):
        part = chosen[first : first + longest]
        yield slice(part[0], part[-1] + 1, part.step) if part.step > 0 else np.array(part)


def _at_cuts(rows: Rows, mesh: BeamMesh, elements: np.ndarray, own: Parted, cuts: Cuts, p: np.ndarray) -> np.ndarray:
    return cut_free(rows, mesh, elements, own, p).at(cuts)


def stations(mesh: BeamMesh) -> Cuts:
    """Return the ends and Gauss points of every element of a beam."""
    xi = np.array([0.0, *mesh.beam.element.quadrature()[0], 1.0])
    return Cuts(np.repeat(np.arange(mesh.elements), len(xi)), np.tile(xi, mesh.elements))
