"""A solution: states of a model over load factor or time, and the results derived from them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self, SupportsIndex, TypeVar, overload

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves import BSpline, spline_through_hermite, without_removable_knots
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.contribution import Contribution
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.reprs import brief
from beamfem.results import postprocess
from beamfem.results.axis_points import AxisPoints, has_angles, nodal_angles
from beamfem.results.postprocess import Fields
from beamfem.results.status import Statistics, Status, counted
from beamfem.validation import number_below, shown, whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from beamfem.results.beam_stress import BeamStress, Part, Peak
    from beamfem.results.energies import Energy
    from beamfem.results.energy_balance import EnergyDrift
    from beamfem.results.motion_state import Occurrence
    from beamfem.results.section_forces import SectionForces


_Value = TypeVar("_Value")


@dataclass(frozen=True, eq=False)
class State:
    """Coordinates of a model and their rates at a load factor or a time, such as those of a row of a solution.

    The solution has the results of its rows, such as `solution.displacement(point)[-1]`; a `PathState`, as `until` of
    `trace_equilibrium` gets it, has its own.

    Parameters
    ----------
    p : array, (n,)
        Coordinates.
    v : array, [1/s], (n,)
        Their rates.
    a : array, [1/s^2], (n,)
        Their second derivatives.
    at : float
        Load factor, or time [s].
    model : Model
        The model.
    turned : array, [rad], (m,), optional
        Rotations at the starts of beams, see `full_turns.start_rotations`; None if not known.

    Examples
    --------
    >>> state = solution[-1]
    >>> state.at
    1.0
    """

    p: np.ndarray = field(repr=False)
    v: np.ndarray = field(repr=False)
    a: np.ndarray = field(repr=False)
    at: float
    model: Model
    turned: np.ndarray | None = field(default=None, kw_only=True, repr=False)

    __repr__ = brief

    def __post_init__(self) -> None:
        from beamfem.results.check_arrays import require_state

        require_state(self)

    def as_row(self, static: bool) -> "Solution":
        """Return the state as a solution of one row."""
        rows = (np.array([self.at]), self.p[None], self.v[None], self.a[None])
        turned = None if self.turned is None else self.turned[None]
        return Solution(self.model, static, *rows, Statistics(0, 0, 0, "one state"), turned=turned)

    def _repr_html_(self) -> str:
        from beamfem.view.summary import state_table

        return state_table(self)


@dataclass(frozen=True, eq=False)
class Solution:
    """States of a model: row 0 is the start, the last row the end.

    Parameters
    ----------
    model : Model
        The model.
    static : bool
        Whether the rows are static equilibria; otherwise they are states of a motion.
    at : array, (steps,)
        Load factors, or times [s].
    p, v, a : array, (steps, n)
        Coordinates and their rates. Like `at`, they are read-only, since derived results are cached; for other
        values, `dataclasses.replace(solution, p=...)` makes another solution.
    statistics : Statistics
        How the solve went.
    stability : array of bool, (steps,), optional
        Whether each row is a stable equilibrium, if the solver knows it.
    turned : array, [rad], (steps, m), optional
        Rotations at the starts of beams, see `full_turns.start_rotations`, if the solver has counted them between rows.
    loaded : array, [-], (steps,), optional
        Load factor of the loads in a motion about an equilibrium.
    events : tuple of Occurrence, optional
        Events of a motion in the order of time, see `simulate`.
    exchanged : array, [J], (steps, 2), optional
        Work done and energy dissipated since the start by steps that were divided, beyond what the rows tell.

    Examples
    --------
    >>> solution = bf.solve_static(model)
    >>> solution.at
    array([0., 1.])
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
    events: tuple["Occurrence", ...] = ()
    exchanged: np.ndarray | None = None

    def __post_init__(self) -> None:
        from beamfem.results.check_arrays import require_rows

        require_rows(self)

    def __repr__(self) -> str:
        what = "load factor" if self.static else "time"
        unit = "" if self.static else f" {self.model.unit('s')}"
        span = f"{what} {self.at[0]:g} to {self.at[-1]:g}{unit}" if len(self.at) else "empty"
        unstable = ""
        if self.stability is not None and not self.stability.all():
            first = self.at[self.stability.argmin()]
            unstable = f"{(~self.stability).sum()} unstable, the first at load factor {first:.6g}, "
        drift = "" if self.energy_drift is None else f"; {self.energy_drift}"
        warned = f"; {counted(len(self.warnings), 'warning')}, see its warnings" if self.warnings else ""
        return f"{type(self).__name__}({len(self.at)} states, {unstable}{span}, of {self.model!r}{drift}{warned})"

    def __len__(self) -> int:
        return len(self.at)

    @overload
    def __getitem__(self, row: SupportsIndex) -> State: ...
    @overload
    def __getitem__(self, row: slice) -> "Solution": ...
    def __getitem__(self, row: SupportsIndex | slice) -> "State | Solution":
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
        from beamfem.results.full_turns import start_rotations

        turned = start_rotations(self)[row]
        return State(self.p[row], self.v[row], self.a[row], float(self.at[row]), self.model, turned=turned)

    def _rows(self, rows: slice) -> "Solution":
        from beamfem.results.full_turns import start_rotations

        try:
            chosen = range(len(self))[rows]
        except (TypeError, ValueError) as error:
            raise InputError(f"rows of a solution are selected by whole numbers, got {shown(rows)}: {error}") from None
        if not chosen:
            first, last, stride = ("" if value is None else value for value in (rows.start, rows.stop, rows.step))
            text = f"{first}:{last}" + (f":{stride}" if stride != "" else "")
            raise InputError(f"solution[{text}] selects no row; this solution has rows 0 to {len(self) - 1}")
        parts = (self.at[rows], self.p[rows], self.v[rows], self.a[rows])
        optional = (self.stability, start_rotations(self), self.loaded, self.exchanged)
        stability, turned, loaded, exchanged = (None if values is None else values[rows] for values in optional)
        others: dict[str, Any] = {"stability": stability, "turned": turned, "loaded": loaded, "exchanged": exchanged}
        return Solution(self.model, self.static, *parts, self.statistics, **others)

    @property
    def status(self) -> Status:
        """How the solve ended, as a member of `Status`."""
        return self.statistics.status

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings to heed before using the results, in sentences; empty if there are none.

        A solve has issued those of errors of 1 % and more as Python warnings too, each with a category.
        """
        from beamfem.results.solution_checks import findings

        return (*self.statistics.warnings, *(finding.sentence for finding in findings(self)))

    @cached_property
    def stable(self) -> np.ndarray:
        """Whether each row is a stable equilibrium (steps,), about which no small motion grows.

        Without follower loads: the tangent stiffness has no negative eigenvalue (Lagrange-Dirichlet theorem). With
        them: no mode of vibration diverges or flutters. Raises InputError for a motion.
        """
        from beamfem.solve.stability.stability import stable_rows

        if not self.static:
            raise InputError("stable is defined for static solutions only; this one is a motion")
        if self.stability is not None:
            return self.stability
        return stable_rows(self)

    @property
    def time(self) -> np.ndarray:
        """Times (steps,) [s]. Raises InputError for a static solution."""
        if self.static:
            raise InputError("a static solution has no time; use load_factor")
        return self.at

    @property
    def load_factor(self) -> np.ndarray:
        """Load factors (steps,) [-]. Raises InputError for a motion."""
        if not self.static:
            raise InputError("a motion has no load factor; use time")
        return self.at

    @property
    def iterations(self) -> int:
        """Total number of Newton iterations."""
        return self.statistics.iterations

    def fields(self, point: Point) -> Fields:
        """Return position, gradients, rotation, shear angle, strain and stress at a point over the steps.

        Where two elements meet or a load acts, strain and stress are those on the side towards the beam's end.
        """
        from beamfem.results.axis_fields import fields

        return postprocess.part_of(fields(self._at(point), self), (slice(None), 0))

    def _at(self, point: Point) -> AxisPoints:
        return AxisPoints.at(self.model.mesh_of(point), [point.fraction])

    def error(self, quantity: "Callable[[Solution], Any] | Point | None" = None, row: int = -1) -> Any:
        """Return an estimate of the discretisation error of a result: its change with a much finer mesh.

        The equilibrium next to that of a row is found on an enriched space: elements of order k + 1 instead of k = 1
        or 2, and halves of other ones; k + 2 for one element, and thirds for one or two cubic ones, between nodes that
        other parts need. Newton's method starts from the state itself, so this is less work than a solve.
        An element of order k is off by about L (turn of an element / n)^2k at its nodes, with the power k + 1 between
        them, so that nearly all of the error disappears there; where the mesh is so coarse that it does not, the
        estimate is too small. Section laws and connectors with history are led through the rows before, with one load
        step each.

        Parameters
        ----------
        quantity : callable or Point, optional
            A function of a solution of one row that returns a number, or an array of the same shape on every mesh, and
            may use the points, beams, supports and connectors of this model; or a point, for its displacement [m].
            By default the positions along all beams. For largest values along a beam take `SectionForces.peak` and
            `BeamStress.peak`: the maximum over stations misses values between them, and differs from mesh to mesh.
        row : int, default -1
            Row of the solution.

        Returns
        -------
        float or array
            Value on the enriched space less the value of the row, to be added to it; by default the largest change of
            a position [m], between nodes as well.

        Raises
        ------
        InputError
            For a motion, or a quantity that is not a number.
        ConvergenceError
            If there is no equilibrium nearby on finer elements: the mesh is too coarse, or the state is a limit point.

        Warns
        -----
        CoarseMeshWarning
            If sections, loads or imposed strains vary within elements so much that the enriched ones miss 2 %, too.

        Examples
        --------
        >>> moment = solution.error(lambda s: s.reaction(beam.start)[-1, 2])
        >>> abs(moment) < 1e-3 * solution.reaction(beam.start)[-1, 2].item()
        True
        """
        from beamfem.solve.accuracy.error_estimate import error
        from beamfem.solve.accuracy.narrow_features import warn_of_unseen

        result = error(self, quantity, row)
        self.computed(warn_of_unseen)
        return result

    def error_shares(self, beam: Beam, row: int = -1) -> np.ndarray:
        """Return the share (ne,) [-] of each element of a beam in the discretisation error of a row, see `error`.

        The shares of all beams sum to 1, or are 0 where nothing is strained. Refine elements with large ones. As
        pictures: `plot(colour="error_share")`; see also `to_vtk`, `to_pandas` and `to_xarray`. Raises what `error`
        does.

        >>> int(solution.error_shares(beam).argmax())  # the element at the clamp
        0
        """
        from beamfem.solve.accuracy.error_estimate import beam_shares

        return beam_shares(self, beam, row)

    def position(self, point: Point) -> np.ndarray:
        """Return the position (x, y) of a point (steps, 2) [m]."""
        return postprocess.position(self.model.mesh_of(point), self.p, point.fraction)

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement (ux, uy) of a point from the reference configuration (steps, 2) [m].

        Examples
        --------
        >>> solution.displacement(beam.end)[-1].round(4)
        array([-0.0003, -0.0305])
        """
        mesh = self.model.mesh_of(point)
        return self.position(point) - postprocess.start(mesh, point.fraction)

    def velocity(self, point: Point) -> np.ndarray:
        """Return the velocity (vx, vy) of a point (steps, 2) [m/s]."""
        return self._at(point).velocities(self.p, self.v)[:, 0]

    def acceleration(self, point: Point) -> np.ndarray:
        """Return the acceleration (ax, ay) of a point (steps, 2) [m/s^2]; in a rotating frame relative to it."""
        return self._at(point).accelerations(self.p, self.v, self.a)[:, 0]

    def angular_velocity(self, point: Point) -> np.ndarray:
        """Return the angular velocity of the section (steps,) [rad/s]."""
        return self._at(point).angular_velocities(self.p, self.v)[:, 0]

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section (steps,) [rad], counter-clockwise positive, full turns included."""
        from beamfem.results.full_turns import rotation

        mesh = self.model.mesh_of(point)
        if (node := mesh.node_near(point.fraction)) is not None and has_angles(mesh):
            return nodal_angles(mesh, self.p, np.array([node]))[:, 0]
        return rotation(self._at(point), self)[:, 0]

    def reaction(self, point: Point) -> np.ndarray:
        """Return fx, fy [N] and m [N m] of supports and springs on the beam at a point (steps, 3).

        Supports at joined points of other beams are not included. Raises InputError if the point has no support.

        Examples
        --------
        >>> solution.reaction(beam.start)[-1, 1:].round()  # fy, m
        array([10000., 19997.])
        """
        from beamfem.results.reactions import reaction

        return reaction(self, point)

    def connector_force(self, connector: Contribution) -> np.ndarray:
        """Return fx, fy [N] and m [N m] of a connector on each of its m points (steps, m, 3).

        Raises InputError for a connector that is not in the model.
        """
        from beamfem.results.reactions import connector_force

        return connector_force(self, connector)

    def joint_force(self, joint: Joint | Contribution | Load) -> np.ndarray:
        """Return fx, fy [N] and m [N m] that a joint exerts on its second point `b`, in global axes (steps, 3).

        It exerts the opposite force on `a`. For `Hinge`, `Rigid` and other joints at which beams share coordinates, the
        force follows from equilibrium of the nodes on the side of `b` with their elements, inertia, loads, supports and
        connectors; a hinge transmits no moment. For connectors with two points, such as `Link`, `Slider`, `Weld` and
        `Gear`, it is the force on the second point, for a `Motor` its torque. A `Cable` or `SpringDamper` that ends on
        the ground pulls there; tension is the length of the force. Raises InputError for anything else, and if further
        joints connect the same points.

        Parameters
        ----------
        joint : Joint, Contribution or Motor
            One of `model.joints`, a connector with two points, or a motor.

        Examples
        --------
        >>> post = bf.Beam(bf.Line((2, 0), (2, -1)), 2, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
        >>> hinge = bf.Hinge(beam.end, post.start)
        >>> frame = bf.Model([beam, post], [bf.Clamp(beam.start), bf.Clamp(post.end)], model.loads, [hinge])
        >>> round(float(bf.solve_static(frame).joint_force(hinge)[-1, 1]))  # fy
        -9997
        """

        from beamfem.results.reactions import joint_force

        return joint_force(self, joint)

    def multipliers(self, connector: Contribution) -> np.ndarray:
        """Return the k additional unknowns of a connector, such as multipliers (steps, k).

        Raises InputError for a connector that is not in the model, or has none.
        """
        from beamfem.results.reactions import multipliers

        return multipliers(self, connector)

    def history(self, connector: Contribution) -> dict[str, np.ndarray]:
        """Return the history variables of a connector in each row by name, those of a user-defined one by number.

        Of friction, "slip" [m or rad], "dissipated" [J] and, if its limit varies, the "limit" [N] at which it slips and
        the "force" [N]; of stops with a coefficient of restitution, the "deepest" [m or rad] since they were hit, of
        `HingeStop` and `SliderStop` "low_deepest" and "high_deepest". Raises InputError for a connector without
        history, or of another model.

        Parameters
        ----------
        connector : Contribution
            One of `model.connectors` or `model.joints`, with history.

        Returns
        -------
        dict of str to array, (steps,)
            Values after the step that led to each row.

        Examples
        --------
        >>> table = bf.Stop(beam.end, (0.0, -0.01), (0, 1), stiffness=1e8, friction=0.3)
        >>> held = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e4))], connectors=[table])
        >>> sorted(bf.solve_static(held).history(table))
        ['dissipated', 'force', 'limit', 'slip']
        """
        from beamfem.results.reactions import history

        return history(self, connector)

    def __getstate__(self) -> dict[str, object]:
        """Return all but what `computed` keeps, which copies compute anew."""
        return {name: value for name, value in vars(self).items() if name != "_computed"}

    @cached_property
    def _computed(self) -> dict[Any, Any]:
        return {}

    def with_statistics(self, **told: Any) -> Self:
        """Return the same solution with some other statistics; what has been computed of it is kept."""
        other = replace(self, statistics=replace(self.statistics, **told))
        vars(other)["_computed"] = self._computed
        return other

    def computed(self, build: "Callable[[Solution], _Value]") -> _Value:
        """Return build(solution), computed once for each solution."""
        if build not in self._computed:
            self._computed[build] = build(self)
        value: _Value = self._computed[build]
        return value

    @cached_property
    def support_forces(self) -> np.ndarray:
        """Generalized forces of all supports and springs (steps, n) [N, N m]."""
        from beamfem.results.reactions import support_forces

        return _read_only(support_forces(self))

    @cached_property
    def remainders(self) -> np.ndarray:
        """Corrections (steps, n) of the coordinates of a static solution that are smaller than their last digit.

        In a stiff part of a model they may change the forces noticeably; zero where they do not, and for a motion.
        """
        from beamfem.results.solution_system import remainders

        return _read_only(remainders(self))

    def section_forces(self, beam: Beam) -> "SectionForces":
        """Return normal and shear force [N] and moment [N m] along a beam. Raises InputError for another beam."""
        from beamfem.results.section_forces import section_forces

        return section_forces(self, beam)

    def stresses(self, beam: Beam) -> "BeamStress":
        """Return the extreme stresses of the sections along a beam. Raises InputError for a beam of another model."""
        from beamfem.results.beam_stress import beam_stress

        return beam_stress(self, beam)

    def peak_stress(self, part: "Part" = "von_mises") -> "Peak":
        """Return the peak of a stress over all beams and rows, with its beam; nan if no value is known.

        part: see `BeamStress.peak`. Warns with `UnknownStressWarning` if sections of some beams define no stress, such
        as moments without a height.

        Examples
        --------
        >>> peak = solution.peak_stress()
        >>> round(peak.value / 1e6), peak.beam is beam  # MPa
        (240, True)
        """
        from beamfem.results.beam_stress import peak_stress

        return peak_stress(self, part)

    def safety_factor(self, beam: Beam | None = None) -> float:
        """Return the strength over the largest von Mises stress of a beam, or of all beams, over the rows [-].

        Warns with UnknownStressWarning of beams without a known strength or stress, which are left out. Raises
        InputError if there are no others.

        Examples
        --------
        >>> strong = bf.Material(2.1e11, 0.3, 7850.0, strength=3.6e8)
        >>> shelf = bf.Beam(bf.Line((0, 0), (2, 0)), 4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), strong)
        >>> loads = [bf.PointForce(shelf.end, (0.0, -1e4))]
        >>> round(bf.solve_static(bf.Model([shelf], [bf.Clamp(shelf.start)], loads)).safety_factor(), 2)
        1.5
        """
        from beamfem.results.beam_stress import safety_factor

        return safety_factor(self, beam)

    def energy(self) -> "Energy":
        """Return kinetic, strain, potential, total and dissipated energy, and work (steps,) [J], see `Energy`.

        The potential is zero in the reference configuration.

        Examples
        --------
        >>> energy = solution.energy()
        >>> energy.strain.round(1)
        array([  0. , 152.6])
        >>> energy.of(beam).strain.round(1)
        array([  0. , 152.6])
        """
        from beamfem.results.energies import energy

        return energy(self)

    @cached_property
    def energy_drift(self) -> "EnergyDrift | None":
        """Change of the total energy [J] over a motion on which no work is done: an error of the time steps.

        None for a static solution, and for a motion on which work is done.
        """
        from beamfem.results.energy_balance import energy_drift

        return energy_drift(self) if len(self) else None

    def linear_momentum(self) -> np.ndarray:
        """Return the linear momentum in x and y (steps, 2) [kg m/s]."""
        from beamfem.results.energies import momenta

        return momenta(self)[:, :2]

    def angular_momentum(self) -> np.ndarray:
        """Return the angular momentum about the origin (steps,) [kg m^2/s]."""
        from beamfem.results.energies import momenta

        return momenta(self)[:, 2]

    def spline(self, beam: Beam, row: int = -1) -> BSpline:
        """Return the exact deformed axis of a beam of cubic elements in a row as a cubic B-spline.

        Its knots are those of the beam's own spline, or arc lengths. Raises InputError for other elements.

        Examples
        --------
        >>> cubic = bf.Beam(bf.Line((0, 0), (2, 0)), 4, bf.ShearRigid(), bf.Rectangle(0.05, 0.1), steel)
        >>> bent = bf.solve_static(bf.Model([cubic], [bf.Clamp(cubic.start)], [bf.PointForce(cubic.end, (0.0, -1e4))]))
        >>> bent.spline(cubic).degree
        3
        """
        mesh = self.model.meshes[self.model.number_of(beam)]
        if "r_x" not in mesh.vectors or mesh.nodes != len(mesh.parameter):
            raise InputError(
                f"the axis of {beam.element.name} elements is no cubic spline; use cubic elements such as ANCF"
            )
        number = number_below("row", row, len(self), -len(self))
        e = postprocess.nodal_vectors(mesh, self.p[number][None])[0]
        return without_removable_knots(spline_through_hermite(mesh.parameter, e[:, 0], mesh.rate * e[:, 1]))

    def to_html(
        self,
        path: str | PathLike[str] | None = None,
        *,
        title: str | None = None,
        frames: int = 60,
        colour: str | None = None,
    ) -> Path:
        """Write an HTML page with a slider over the steps and return the path; the file works offline.

        The body moves with its supports, optionally coloured by a section force [N, N m], a stress [Pa], the
        utilisation [-], rotation [rad], displacement [m] or speed [m/s]; a curve of the largest displacement in each
        row and the statistics are shown beside it. The file is smaller than 1 MB: for large models only the axes and
        fewer steps are drawn. path: file to write, .html, by default a temporary one; notebooks display the path that
        is returned. title: heading of the page; frames: largest number of steps; colour: the field that is shown first,
        by default none. Raises InputError for another suffix, or a field that the page does not have.

        Examples
        --------
        >>> page = solution.to_html("cantilever.html", title="Cantilever", colour="moment")
        """
        from beamfem.view.player import write_player

        return write_player(self, path, title, frames, colour)

    def plot(
        self,
        path: str | PathLike[str] | None = None,
        *,
        colour: str | None = None,
        shapes: int | None = None,
        undeformed: bool = True,
        supports: bool = True,
        loads: bool = True,
        ax: Any = None,
    ) -> "Figure":
        """Draw the deformed body, at several steps later ones darker, and return the figure.

        path: file to write (PNG, SVG, PDF); folders are created. colour: by default the time or load factor; or a field
        along the beams, whose extreme value is marked: "moment" [N m], "normal", "shear" [N], "rotation" [rad],
        "displacement" [m], "speed" [m/s], "axial_strain" [-] (Green strain xx of the axis), "shear_angle" [rad],
        "error_share" [-], see `error_shares`; of the stress [Pa] "stress" or "von_mises" (von Mises stress over the
        height), of each section "upper", "lower" (faces), "outer" (the larger of both, "upper" if equal), "tension",
        "compression", "shear_stress" (extremes); or "utilisation" [-] of the strength, over the height. shapes: number
        of steps, one of them the last; by default the last alone, of motions and paths 9. undeformed, supports, loads:
        whether to draw the reference axes dashed, and symbols, each load on the shape at which it is largest. ax: axes
        of matplotlib to draw in; by default a new figure, which `plt.show()` opens where there is a display, and which
        notebooks display, if no path is given. Raises InputError for an unknown option or value, MissingPackageError
        without matplotlib.

        Examples
        --------
        >>> figure = solution.plot("cantilever.png", colour="moment", loads=False)
        """
        from beamfem.view.drawing import plot_shapes

        return plot_shapes(self, path, colour, shapes, undeformed, supports, loads, ax)

    def plot_history(
        self,
        point: Point | Sequence[Point] | None = None,
        quantity: str = "displacement",
        path: str | PathLike[str] | None = None,
        *,
        ax: Any = None,
    ) -> "Figure":
        """Plot a quantity at one or several points against time or load factor and return the figure.

        quantity: "displacement", "ux", "uy", "position" [m], "velocity" [m/s], "acceleration" [m/s^2], "rotation"
        [rad]; at supports "force" [N] and "reaction_moment" [N m]; without a point "energy" [J]. path: file to write
        (PNG, SVG, PDF); ax: axes to draw in, see `plot`. Raises InputError for an unknown quantity, or one that needs a
        point; MissingPackageError without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_history(beam.end, "uy", "tip.png")
        """
        from beamfem.view.quantity_curve import plot_history

        return plot_history(self, point, quantity, path, ax)

    def plot_along(
        self,
        beam: Beam,
        name: str = "moment",
        path: str | PathLike[str] | None = None,
        *,
        row: int = -1,
        ax: Any = None,
    ) -> "Figure":
        """Draw the diagram of a section force, a stress or another field along a beam and return the figure.

        name: one of `colour` in `plot`; path: file to write (PNG, SVG, PDF); row: load step or time; ax: axes to draw
        in, see `plot`. Raises InputError for an unknown field, beam or row, MissingPackageError without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_along(beam, "moment", "moment.png")
        """
        from beamfem.view.quantity_curve import plot_along

        return plot_along(self, beam, name, path, row, ax)

    def plot_curve(self, x: Any, y: Any, path: str | PathLike[str] | None = None, *, ax: Any = None) -> "Figure":
        """Plot one quantity against another, one point per row, and return the figure.

        A quantity is a pair of a name and a point, such as ("uy", beam.end), with the names "ux", "uy", "x", "y" [m],
        "rotation" [rad], "vx", "vy" [m/s], "ax", "ay" [m/s^2], "normal", "shear" [N], "moment" [N m], those of stresses
        in `plot` [Pa] and, at supports, "fx", "fy" [N] and "m" [N m]; or a pair of "fx", "fy" or "m" and a load at a
        point, for the applied force, or a joint or connector, for its `joint_force`; or "tension" [N] and a connector
        of two places, such as a Cable; or "load_factor" or "time" [s]; or "kinetic", "strain", "potential" or "total"
        energy [J]; or a pair of a label and numbers (steps,); or numbers. Where a section force jumps, its value is
        that on the side towards the beam's end. path: file to write (PNG, SVG, PDF); ax: axes to draw in, see `plot`.
        Raises InputError for an unknown quantity, MissingPackageError without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_curve(("uy", beam.end), ("fy", beam.start), "curve.png")
        """
        from beamfem.view.quantity_curve import plot_curve

        return plot_curve(self, x, y, path, ax)

    def plot_load_displacement(
        self, point: Point, quantity: str = "uy", path: str | PathLike[str] | None = None, *, ax: Any = None
    ) -> "Figure":
        """Plot the load factor against "ux", "uy" [m] or "rotation" [rad] of a point and return the figure.

        Limit points (circles) and bifurcations (diamonds) of a `Path` are marked, each with its load factor. path: file
        to write (PNG, SVG, PDF); ax: axes to draw in, see `plot`. Raises InputError for another quantity or a motion,
        MissingPackageError without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_load_displacement(beam.end, "uy", "path.png")
        """
        from beamfem.view.quantity_curve import plot_load_displacement

        return plot_load_displacement(self, point, quantity, path, ax)

    def animate(
        self,
        path: str | PathLike[str] | None = None,
        *,
        fps: float = 15.0,
        seconds: float = 4.0,
        colour: str | None = None,
        undeformed: bool = True,
        supports: bool = True,
        loads: bool = True,
        dpi: int = 100,
    ) -> Path:
        """Write an animation as GIF or MP4, according to the suffix of `path`, and return the path.

        path: by default a temporary GIF; notebooks display the path that is returned. About fps * seconds [s] rows are
        shown, equally spaced in time (in statics by row); with fewer rows each is shown longer. Loads are drawn in each
        frame with their current amplitude. colour: a field along the beams, see `plot`; undeformed, supports, loads:
        whether to draw the reference axes dashed and symbols; dpi: pixels per inch, of a frame 4 to 8 inches wide.
        Raises InputError for another suffix; MissingPackageError without matplotlib, for .mp4 without imageio-ffmpeg.

        Examples
        --------
        >>> film = solution.animate("cantilever.gif", seconds=1.0, colour="moment")
        """
        from beamfem.view.animation import animate

        return animate(self, path, fps, seconds, colour, undeformed, supports, loads, dpi)

    def show(self, *, colour: str | None = None, size: tuple[int, int] = (1400, 900)) -> Any:
        """Open a window with the solid body and a slider over the steps, and wait until it is closed.

        colour: a field along the beams, see `plot`; size: width and height in pixels. Returns the plotter of PyVista;
        without a display, or if VTK cannot render, a matplotlib figure, and a warning is given. In a notebook, the
        view is displayed below the cell: by PyVista where trame is installed, else pictures with a slider of ipywidgets
        where these are installed, else the page of `to_html`. Raises InputError for an invalid option.
        """
        from beamfem.view.solid_pyvista import show

        return show(self, colour=colour, size=size)

    def picture(
        self,
        path: str | PathLike[str] | None = None,
        *,
        colour: str | None = None,
        size: tuple[int, int] = (1400, 900),
        row: int = -1,
    ) -> Path:
        """Write a picture (.png) of the solid body in a row without opening a window, and return the path.

        path: by default a temporary file; notebooks display the path that is returned. colour: a field along the beams,
        see `plot`; size: width and height in pixels. Rendering is tried in a child process first; if VTK cannot render,
        matplotlib draws the same row in the plane and a warning is given. Raises InputError for another suffix or an
        invalid option.
        """
        from beamfem.view.solid_pyvista import picture

        return picture(self, path, row, colour, size)

    def to_vtk(
        self,
        path: str | PathLike[str],
        *,
        geometry: Literal["deformed", "reference"] = "deformed",
        fields: Sequence[str] | None = None,
        single: bool = False,
    ) -> None:
        """Write solids, centrelines, supports and loads for ParaView.

        The body is written into `path`; centrelines, and supports and loads, into <stem>_centreline and <stem>_boundary
        beside it. .vtkhdf (the default suffix): all steps in one file, for ParaView 5.12 or newer; .pvd: a collection
        of .vtu files, one per step, in the folder <stem>. geometry: "reference" writes the reference positions of the
        points, to be warped by `displacement`. fields: names of those to write, by default all but the stress tensors
        of bodies and `error_shares`: VTK draws curved cells with at most 18 numbers at a point and drops what is more.
        single: numbers of four bytes, half the size, seven digits. Names and units of the fields are listed in
        docs/paraview.md. Raises InputError for another suffix and for unknown fields, MissingPackageError without VTK,
        and for .vtkhdf without h5py. Warns with `UnknownStressWarning` if the shape of a section, and so its stress, is
        not known.

        Examples
        --------
        >>> solution.to_vtk("cantilever.pvd", fields=["displacement"])
        """
        from beamfem.io.vtk import write_vtk

        write_vtk(self, path, geometry=geometry, fields=fields, single=single)

    def to_xarray(self, beam: Beam | None = None, *, errors: bool = False) -> "Dataset":
        """Return an xarray.Dataset of results along a beam, or along all beams, over the steps.

        Positions, rotations, section forces, stresses if sections have them, and energies; the statistics are its
        attributes. For one beam the arc length is a dimension: at a node between elements there are two stations, the
        first one lower by one unit in the last place. errors: include `error_shares`, which cost one solve a row.
        Raises InputError for a beam of another model, MissingPackageError without xarray.

        Examples
        --------
        >>> data = solution.to_xarray(beam)
        >>> data["uy"].dims
        ('load_factor', 'arc_length')
        """
        from beamfem.io.table import to_xarray

        return to_xarray(self, beam, errors)

    def to_pandas(self, beam: Beam | None = None, *, forces: bool = False, errors: bool = False) -> "DataFrame":
        """Return a pandas.DataFrame of results along a beam, or along all beams, with a row for each step and station.

        Its index is time [s] or load_factor, number of the beam and arc_length [m]. A node between two elements has two
        rows, one for each side. To keep the index unique, the arc length of the first one, like the load factor of the
        row before a jump, is lower by one unit in the last place. errors: include `error_shares`, which cost one solve
        a row.

        With `forces`, there is a row for each step and point at which a support, connector or joint acts, with role and
        kind of the part, position x, y [m], and what it exerts on the beam there, fx, fy [N] and moment [N m]. Raises
        InputError for a beam of another model, MissingPackageError without pandas.

        Examples
        --------
        >>> table = solution.to_pandas(beam)
        >>> list(table.index.names)
        ['load_factor', 'beam', 'arc_length']
        >>> list(solution.to_pandas(forces=True).columns)
        ['role', 'kind', 'x', 'y', 'fx', 'fy', 'moment']
        """
        from beamfem.io.table import to_pandas

        return to_pandas(self, beam, forces, errors)

    def save(self, path: str | PathLike[str]) -> None:
        """Write model and states to one HDF5 file with checksums, which `load` reads; folders are created.

        An earlier file is replaced when the new one is complete. Raises InputError for a model with parts that cannot
        be saved, FileError if the system refuses to write, MissingPackageError without h5py.
        """
        from beamfem.io.results_hdf5 import save

        save(self, path)

    def _repr_html_(self) -> str:
        from beamfem.view.summary import solution_table

        return solution_table(self)


def _read_only(values: np.ndarray) -> np.ndarray:
    """Return values that are kept, which nobody is to change."""
    values.setflags(write=False)
    return values
