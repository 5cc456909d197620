"""Section forces of beams from the equilibrium of their elements, at stations and at any other points."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import get_args

import numpy as np

from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Beam, beam_in_words
from beamfem.reprs import brief
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import of_beam
from beamfem.results.extremes import Force, Measure, Part, Peak, extreme
from beamfem.results.free_bodies import Parted, Rows, cut_free, parted, rows_of
from beamfem.results.solution import Solution
from beamfem.results.solution_system import exactly, loading
from beamfem.units import Units, units_of
from beamfem.validation import require_known, shown

_VALUES = 2_000_000  # most values in one array
FORCES: tuple[Force, ...] = get_args(Force)
Values = Callable[[Solution, AxisPoints, np.ndarray], np.ndarray]  # of some rows (rows, points)


@dataclass(frozen=True)
class SectionForces:
    """Section forces at the start, the Gauss points, the middle and the end of every element of a beam.

    Nodes, and points where loads act, are listed twice: just before and just after them. Section forces balance each
    other and all loads on the deformed beam, inertia included, exactly on any mesh. Between stations they
    may be larger: `peak` finds their extremes there too.

    Parameters
    ----------
    arc_length : array, [m], (stations,)
        Arc lengths of the stations.
    normal : array, [N], (steps, stations)
        Force along the section's normal, > 0 in tension.
    shear : array, [N], (steps, stations)
        Force across the normal.
    moment : array, [N m], (steps, stations)
        Moment about the axis, > 0 if it increases the rotation along the beam.
    units : Units
        Units of the model, for tables.
    beam : Beam
        The beam.
    solution : Solution
        The solution, which `peak` evaluates between stations.

    Examples
    --------
    >>> forces = solution.section_forces(beam)
    >>> round(float(forces.shear[-1, 0]), -1)  # at the clamp
    -10000.0
    """

    arc_length: np.ndarray
    normal: np.ndarray
    shear: np.ndarray
    moment: np.ndarray
    units: Units = field(default=Units(), repr=False)
    beam: Beam = field(repr=False, kw_only=True)
    solution: Solution = field(repr=False, kw_only=True)

    __repr__ = brief

    def peak(self, part: Force = "moment") -> Peak:
        """Return the section force of largest magnitude along the beam, at and between its stations, and over the rows.

        part: "normal", "shear" or "moment". Raises InputError for another one.

        Examples
        --------
        >>> value, arc_length, row = solution.section_forces(beam).peak("moment")
        >>> round(value, -1), round(arc_length, 3)  # at the clamp
        (-20000.0, 0.0)
        """
        require_known(f"there is no section force {shown(part)}", part, FORCES)
        return extreme_force(self, part, np.abs)

    def _unit_of(self, name: str) -> str:
        return self.units.of({"arc_length": "m", "moment": "N m"}.get(name, "N"))

    def _repr_html_(self) -> str:
        from beamfem.view.summary import section_forces_table

        return section_forces_table(self)


def section_forces(solution: Solution, beam: Beam) -> SectionForces:
    """Return the section forces of a beam at the stations listed in `SectionForces`."""
    number = solution.model.number_of(beam)
    arc = stations(solution.model.meshes[number]).arc_length
    normal, shear, moment = of_beam(solution, number, _at_stations)
    units = units_of(solution.model.units)
    return SectionForces(arc, normal, shear, moment, units, beam=beam, solution=solution)


def extreme_force(forces: SectionForces, part: Force, measure: Measure) -> Peak:
    """Return the section force of largest measure, at and between stations."""
    number = FORCES.index(part)

    def at(solution: Solution, points: AxisPoints, rows: np.ndarray) -> np.ndarray:
        return at_points(solution, points, rows)[:, number]

    values, unit = np.atleast_2d(getattr(forces, part)), "N m" if part == "moment" else "N"  # a state has no rows
    return peak_of(forces.solution, forces.beam, (part, unit), values, measure, at)


def peak_of(
    solution: Solution, beam: Beam, named: tuple[Part | Force, str], values: np.ndarray, measure: Measure, at: Values
) -> Peak:
    """Return the peak of a quantity of a beam: the value of largest measure, at and between stations.

    named: the quantity and its SI unit; values (rows, stations).
    """
    model, number = solution.model, solution.model.number_of(beam)
    mesh = model.meshes[number]

    def in_row(row: int, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
        return at(solution, AxisPoints(mesh, element, xi), np.array([row]))[0]

    value, row, element, xi = extreme(*stations(mesh).by_element(values), measure, in_row)
    part, unit = named
    place = (np.nan, -1, np.nan)
    if row >= 0:
        arc = mesh.arc_length(np.array([element]), np.array([xi]))
        place = float(arc[0]), row, float(solution.at[row])
    called = beam_in_words(model.beams, number)
    return Peak(value, *place, beam, part, solution.static, units_of(model.units), unit, called)


def _at_stations(solution: Solution, mesh: BeamMesh) -> np.ndarray:
    """Return normal and shear force and moment (3, steps, stations)."""
    return at_points(solution, stations(mesh)).swapaxes(0, 1)


def at_points(solution: Solution, points: AxisPoints, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Return normal and shear force [N] and moment [N m] (steps, 3, points) of some rows at points of a beam."""
    mesh, elements = points.mesh, np.unique(points.element)

    def at_cuts(chunk: Rows, own: Parted, p: np.ndarray) -> np.ndarray:
        return cut_free(chunk, mesh, elements, own, p).at(points)

    return of_elements(solution, mesh, elements, at_cuts, (3, len(points.xi)), rows)


def of_elements(
    solution: "Solution",
    mesh: BeamMesh,
    elements: np.ndarray,
    values: Callable[[Rows, Parted, np.ndarray], np.ndarray],
    shape: tuple[int, ...],
    rows: slice | np.ndarray = slice(None),
) -> np.ndarray:
    """Return the values of elements (ne,) of a beam, in ascending order, in some rows (steps, ...).

    values: function of rows, of the elements without shared nodes and of their coordinates; shape: of its result in a
    row, by the size of which the rows that are evaluated at once are limited.
    """
    own = parted(loading(solution)[0].blocks[mesh.block], mesh.in_block(elements))
    field = mesh.beam.element.field
    size = len(field.nodes) * len(field.vectors) * (math.prod(shape) + len(elements) * len(field.nodes))
    chunk = max(1, _VALUES // size)
    parts = [np.empty((0, *shape))]
    for numbers in in_parts(len(solution), rows, chunk):
        evaluated = partial(values, rows_of(solution, numbers), own)
        parts.append(exactly(solution, evaluated, numbers, own.used))
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


def stations(mesh: BeamMesh) -> AxisPoints:
    """Return the ends, the Gauss points and the middle of every element of a beam."""
    gauss = mesh.beam.element.quadrature()[0]
    middle = [] if len(gauss) % 2 else [0.5]  # a Gauss point of odd rules
    return AxisPoints.on_each(mesh, np.sort(np.concatenate([[0.0], gauss, middle, [1.0]])))
