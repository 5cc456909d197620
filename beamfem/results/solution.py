"""A solution: states of a model over load factor or time, and the results derived from them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any, Literal, Unpack, overload

import numpy as np

from beamfem.brief import brief
from beamfem.curves import BSpline, spline_through_hermite, without_removable_knots
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.contribution import Contribution
from beamfem.model.model import Model
from beamfem.registry import offered
from beamfem.results import postprocess
from beamfem.results.beam_stress import BeamStress, Part, Peak, beam_stress, peak_stress
from beamfem.results.connected import connector_force, kinetic_of_connectors, momenta_of_connectors, multipliers
from beamfem.results.drawing_options import FilmOptions, PageOptions, PictureOptions, ShapeOptions, WindowOptions
from beamfem.results.energies import Energy, potential
from beamfem.results.energy_drift import EnergyDrift, drift_warnings, energy_drift
from beamfem.results.fitting import require_rows, require_state
from beamfem.results.imposed import imposed_measures
from beamfem.results.last_digits import remainders
from beamfem.results.locking import locking_warnings
from beamfem.results.postprocess import Fields, SectionForces
from beamfem.results.reactions import reaction, support_forces
from beamfem.results.section_forces import Cuts, at_points, section_forces
from beamfem.results.self_stress import self_stress
from beamfem.results.status import Statistics, Status
from beamfem.results.turns import start_rotations, turned_of
from beamfem.validation import number_below, shown, whole


@dataclass(frozen=True, eq=False)
class State:
    """Coordinates p (n,) of a model, their rates v (n,) [1/s] and a (n,) [1/s^2], at a load factor or a time [s].

    turned (m,) [rad]: see `turns.start_rotations`; None if not known.
    """

    p: np.ndarray
    v: np.ndarray
    a: np.ndarray
    at: float
    model: Model
    turned: np.ndarray | None = field(default=None, kw_only=True)

    __repr__ = brief

    def __post_init__(self) -> None:
        require_state(self)

    def _repr_html_(self) -> str:
        return offered(State._repr_html_)(self)


@dataclass(frozen=True, eq=False)
class Solution:
    """States of a model: row 0 is the start, the last row the end.

    at (steps,): load factors or times [s]; p, v, a (steps, n); stability (steps,): whether each row is a stable
    equilibrium, if the solver knows it; turned (steps, m) [rad]: see `turns.start_rotations`, if the solver has counted
    them between the rows; loaded (steps,): load factor of the loads in a motion about an equilibrium.
    """

    model: Model
    static: bool
    at: np.ndarray
    p: np.ndarray
    v: np.ndarray
    a: np.ndarray
    statistics: Statistics
    stability: np.ndarray | None = None
    turned: np.ndarray | None = None
    loaded: np.ndarray | None = None

    def __post_init__(self) -> None:
        require_rows(self)

    def __repr__(self) -> str:
        what = "load factor" if self.static else "time"
        span = f"{what} {self.at[0]:g} to {self.at[-1]:g}" if len(self.at) else "empty"
        unstable = "" if self.stability is None or self.stability.all() else f"{(~self.stability).sum()} unstable, "
        drift = "" if self.energy_drift is None else f"; {self.energy_drift}"
        return f"{type(self).__name__}({len(self.at)} states, {unstable}{span}, of {self.model!r}{drift})"

    def __len__(self) -> int:
        return len(self.at)

    @overload
    def __getitem__(self, row: int) -> State: ...
    @overload
    def __getitem__(self, row: slice) -> "Solution": ...
    def __getitem__(self, row: int | slice) -> "State | Solution":
        """Return the state of a row, or a Solution of the rows of a slice with the statistics of the whole solve.

        Raises InputError for an empty slice or any other key, IndexError beyond the last row.
        """
        if isinstance(row, slice):
            return self._rows(row)
        number = whole("a row of a solution, or a slice such as solution[2:5],", row)
        if not -len(self) <= number < len(self):
            raise IndexError(f"the solution has {len(self)} rows, so there is no row {number}")
        return self._state(number)

    def _state(self, row: int) -> State:
        turned = start_rotations(self)[row]
        return State(self.p[row], self.v[row], self.a[row], float(self.at[row]), self.model, turned=turned)

    def _rows(self, rows: slice) -> "Solution":
        try:
            chosen = range(len(self))[rows]
        except (TypeError, ValueError) as error:
            raise InputError(f"rows of a solution are selected by whole numbers, got {shown(rows)}: {error}") from None
        if not chosen:
            first, last, stride = ("" if value is None else value for value in (rows.start, rows.stop, rows.step))
            text = f"{first}:{last}" + (f":{stride}" if stride != "" else "")
            raise InputError(f"solution[{text}] selects no row; this solution has rows 0 to {len(self) - 1}")
        parts = (self.at[rows], self.p[rows], self.v[rows], self.a[rows])
        stability, loaded = (None if values is None else values[rows] for values in (self.stability, self.loaded))
        turned = start_rotations(self)[rows]
        return Solution(self.model, self.static, *parts, self.statistics, stability, turned, loaded)

    @property
    def status(self) -> Status:
        """How the solve ended."""
        return self.statistics.status

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings to heed before using the results, on locking too, in sentences; empty if there are none."""
        return (*self.statistics.warnings, *locking_warnings(self), *drift_warnings(self))

    @cached_property
    def stable(self) -> np.ndarray:
        """Whether each row is a stable equilibrium (steps,): no small motion about it grows.

        Without follower loads: the tangent stiffness has no negative eigenvalue (Lagrange-Dirichlet theorem). With
        them: no mode of vibration diverges or flutters. Raises InputError for a motion.
        """
        if not self.static:
            raise InputError("stable is defined for static solutions only; this one is a motion")
        if self.stability is not None:
            return self.stability
        return self._stable_rows()

    @property
    def time(self) -> np.ndarray:
        """Times (steps,) [s]. Raises InputError for a static solution."""
        if self.static:
            raise InputError("a static solution has no time; use load_factor")
        return self.at

    @property
    def load_factor(self) -> np.ndarray:
        """Load factors (steps,). Raises InputError for a motion."""
        if not self.static:
            raise InputError("a motion has no load factor; use time")
        return self.at

    @property
    def iterations(self) -> int:
        """Total number of Newton iterations."""
        return self.statistics.iterations

    def fields(self, point: Point) -> Fields:
        """Return position, gradients, rotation, shear angle, strain and stress at a point, over the steps.

        Where two elements meet or a load acts, strain and stress are those on the side towards the beam's end.
        """
        mesh = self.model.mesh_of(point)
        element, xi = (np.array([place]) for place in mesh.locate(point.fraction))
        forces = at_points(self, mesh, Cuts(element, xi))
        own = self_stress(self, mesh, element, xi, None, np.zeros((1, 1)))
        found = postprocess.fields(mesh, self.p, element, xi, forces, own, turned_of(self, mesh))
        return Fields(*(postprocess.at_single_point(getattr(found, name)) for name in Fields.__dataclass_fields__))

    def position(self, point: Point) -> np.ndarray:
        """Return the position of a point (steps, 2) [m]."""
        return postprocess.position(self.model.mesh_of(point), self.p, point.fraction)

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point from the reference configuration (steps, 2) [m]."""
        mesh = self.model.mesh_of(point)
        return self.position(point) - postprocess.start(mesh, point.fraction)

    def velocity(self, point: Point) -> np.ndarray:
        """Return the velocity of a point (steps, 2) [m/s]."""
        return self._axis(point, postprocess.nodal_velocities(self.model.mesh_of(point), self.p, self.v)).r[:, 0]

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section (steps,) [rad], counter-clockwise positive, full turns included."""
        mesh = self.model.mesh_of(point)
        element, xi = (np.array([place]) for place in mesh.locate(point.fraction))
        now = self._axis(point, postprocess.nodal_vectors(mesh, self.p))
        return postprocess.turning(mesh, self.p, now, element, xi, turned_of(self, mesh))[:, 0]

    def _axis(self, point: Point, vectors: np.ndarray) -> postprocess.Axis:
        mesh = self.model.mesh_of(point)
        element, xi = mesh.locate(point.fraction)
        return postprocess.axis(mesh, vectors, np.array([element]), np.array([xi]))

    def reaction(self, point: Point) -> np.ndarray:
        """Return the reaction on the beam (steps, 3): fx, fy [N], m [N m]. Raises InputError without a support."""
        return reaction(self, point)

    def connector_force(self, connector: Contribution) -> np.ndarray:
        """Return the forces of a connector on its points (steps, m, 3): fx, fy [N], m [N m]. Raises InputError."""
        return connector_force(self, connector)

    def multipliers(self, connector: Contribution) -> np.ndarray:
        """Return the additional unknowns of a connector (steps, k), such as multipliers. Raises InputError."""
        return multipliers(self, connector)

    @cached_property
    def support_forces(self) -> np.ndarray:
        """Generalized forces of all supports and springs (steps, n) [N, N m]."""
        return support_forces(self)

    @cached_property
    def remainders(self) -> np.ndarray:
        """Corrections below the last digit of the coordinates of a static solution (steps, n), see `last_digits`."""
        return remainders(self)

    def section_forces(self, beam: Beam) -> SectionForces:
        """Return normal force, shear force and moment of a beam (steps, stations), see `SectionForces`."""
        self.model.number_of(beam)  # rejects beams of other models
        return section_forces(self, beam)

    def stresses(self, beam: Beam) -> BeamStress:
        """Return the extreme stresses of the sections of a beam (steps, stations), see `BeamStress`."""
        self.model.number_of(beam)
        return beam_stress(self, beam)

    def peak_stress(self, part: Part = "von_mises") -> Peak:
        """Return the peak of a stress over all beams and rows, with its beam, see `BeamStress.peak`."""
        return peak_stress(self, part)

    @cached_property
    def _momenta(self) -> tuple[postprocess.Momenta, ...]:
        return tuple(postprocess.momenta(mesh, self.p, self.v) for mesh in self.model.meshes)

    def energy(self) -> Energy:
        """Return kinetic, strain, potential and total energy (steps,) [J].

        The potential is zero in the reference configuration.
        """
        kinetic = sum((m.kinetic for m in self._momenta), kinetic_of_connectors(self))
        parts = (postprocess.strain_energy(mesh, self.p, imposed_measures(self, mesh)) for mesh in self.model.meshes)
        strain = sum(parts, np.zeros(len(self)))
        return Energy(kinetic, strain, potential(self, [m.first_moment for m in self._momenta]), self.model.unit("J"))

    @cached_property
    def energy_drift(self) -> EnergyDrift | None:
        """Energy error over a motion on which nothing does work, else None; see `energy_drift.EnergyDrift`."""
        return energy_drift(self) if len(self) else None

    def linear_momentum(self) -> np.ndarray:
        """Return the linear momentum (steps, 2) [kg m/s]."""
        return np.asarray(sum(m.linear for m in self._momenta) + momenta_of_connectors(self)[:, :2])

    def angular_momentum(self) -> np.ndarray:
        """Return the angular momentum about the origin (steps,) [kg m^2/s]."""
        return np.asarray(sum(m.angular for m in self._momenta) + momenta_of_connectors(self)[:, 2])

    def spline(self, beam: Beam, row: int = -1) -> BSpline:
        """Return the exact deformed axis of a beam of cubic elements in a row as a cubic B-spline.

        Knots are those of the beam's own spline, or arc lengths. Raises InputError for other elements.
        """
        mesh = self.model.meshes[self.model.number_of(beam)]
        if "r_x" not in mesh.vectors or mesh.nodes != len(mesh.parameter):
            raise InputError(
                f"the axis of {beam.element.name} elements is no cubic spline; use cubic elements such as ANCF"
            )
        number = number_below("row", row, len(self), -len(self))
        e = postprocess.nodal_vectors(mesh, self.p[number][None])[0]
        return without_removable_knots(spline_through_hermite(mesh.parameter, e[:, 0], mesh.rate * e[:, 1]))

    def to_vtk(
        self,
        path: str | PathLike[str],
        *,
        geometry: Literal["deformed", "reference"] = "deformed",
        fields: Sequence[str] | None = None,
        single: bool = False,
    ) -> None:
        """Write solids, centrelines, supports and loads for ParaView; `path` ends in .pvd or .vtkhdf (default)."""
        offered(Solution.to_vtk)(self, path, geometry=geometry, fields=fields, single=single)

    def to_xarray(self, beam: Beam | None = None) -> Any:
        """Return the results along a beam, or along all beams, over the steps as an xarray.Dataset."""
        return offered(Solution.to_xarray)(self, beam)

    def to_pandas(self, beam: Beam | None = None) -> Any:
        """Return the results along a beam, or along all beams, over the steps as a pandas.DataFrame."""
        return offered(Solution.to_pandas)(self, beam)

    def to_html(self, path: str | PathLike[str], **options: Unpack[PageOptions]) -> Path:
        """Write an HTML page with a slider over the steps: a single file that works offline."""
        return offered(Solution.to_html)(self, path, **options)

    def plot(self, path: str | PathLike[str] | None = None, **options: Unpack[ShapeOptions]) -> Any:
        """Draw deformed shapes, to a file if `path` is given; return the figure."""
        return offered(Solution.plot)(self, path, **options)

    def plot_history(
        self,
        point: Point | Sequence[Point] | None = None,
        quantity: str = "displacement",
        path: str | PathLike[str] | None = None,
    ) -> Any:
        """Plot a quantity of points, or "energy", over the steps; return the figure."""
        return offered(Solution.plot_history)(self, point, quantity, path)

    def plot_curve(self, x: Any, y: Any, path: str | PathLike[str] | None = None) -> Any:
        """Plot y over x, quantities of points such as ("fx", beam.start) and ("ux", beam.end); return the figure."""
        return offered(Solution.plot_curve)(self, x, y, path)

    def plot_load_displacement(
        self, point: Point, quantity: str = "uy", path: str | PathLike[str] | None = None
    ) -> Any:
        """Plot the load factor over a displacement; return the figure."""
        return offered(Solution.plot_load_displacement)(self, point, quantity, path)

    def animate(self, path: str | PathLike[str], **options: Unpack[FilmOptions]) -> Path:
        """Write an animation as GIF or MP4, according to the suffix of `path`."""
        return offered(Solution.animate)(self, path, **options)

    def show(self, **options: Unpack[WindowOptions]) -> Any:
        """Open a window with the solid and a slider over the steps."""
        return offered(Solution.show)(self, **options)

    def picture(self, path: str | PathLike[str], **options: Unpack[PictureOptions]) -> Path:
        """Write a picture of the solid without opening a window."""
        return offered(Solution.picture)(self, path, **options)

    def save(self, path: str | PathLike[str]) -> None:
        """Write model and states to one HDF5 file."""
        offered(Solution.save)(self, path)

    def _repr_html_(self) -> str:
        return offered(Solution._repr_html_)(self)

    def _stable_rows(self) -> np.ndarray:
        return offered(Solution._stable_rows)(self)
