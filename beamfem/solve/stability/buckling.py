"""Buckling: load factors at which the tangent of a loaded structure becomes singular."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError, RoundOffWarning
from beamfem.linalg.eigenpairs import digits_for
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.quadrature import interpolation_weights
from beamfem.results.locking import stiffness_locking
from beamfem.results.solution import Solution, State
from beamfem.results.solution_checks import advice, may_lock, warn_of
from beamfem.results.status import Finding, Statistics, Status
from beamfem.solve.accuracy.adapted_mesh import Shares, prepared, refined_until, require_unlocked
from beamfem.solve.accuracy.carried_start import carried
from beamfem.solve.accuracy.error_estimate import enriched, enriched_state, mode_shares
from beamfem.solve.continuation.bifurcations import Crossing, bifurcations, condensed
from beamfem.solve.continuation.continuation import Continuation, PathPoint, begin
from beamfem.solve.continuation.critical_points import DISTANCE, Segment, SegmentLostError
from beamfem.solve.continuation.steps import Refused, Step, longest_accepted, longest_step, take_step
from beamfem.solve.modes.mode_stiffness import largest_translation, upright
from beamfem.solve.newton.newton import Newton, Termination
from beamfem.solve.stability.linearised import (
    largest_displacement,
    linear_reach,
    linear_solution,
    linearised_loads,
    size_of,
)
from beamfem.solve.stability.stability import stable_start
from beamfem.solve.start.mechanisms import require_independent, require_support
from beamfem.solve.start.start_checks import refuse_memory
from beamfem.solve.start.start_state import last_state
from beamfem.tables import as_pandas
from beamfem.validation import count as whole_number
from beamfem.validation import number_below, positive, squared

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

_LARGEST_MOVEMENT = 2.0  # of the model, as if it were turned over: the path is followed no further
_LARGEST_LOAD = 300.0  # times the load factors of linear analysis: the path is followed no further
_MOST_POINTS = 300
BIFURCATION, LIMIT_POINT = "bifurcation", "limit point"
_SHOWN = 6  # critical points in a text
_FIRST_STEP = 0.02
_ITERATIONS = 15
_MODES = 3  # softest ones, of which one may lose its stiffness and gain it again
_KEPT = 0.3  # of the least stiffness of a mode at the points of a step: with less in between it may lose it
_GRID = np.linspace(0.0, 1.0, 65)
_DISTANCES = 0.5, 2.0, 0.8  # of the usual one
_ABOVE = 1.2  # times the change of the load by which it is critical, as predicted: what gives a warning
_UNCERTAIN = 1e-4  # of a load factor: a larger uncertainty gives a warning


@dataclass(frozen=True, eq=False)
class Buckling:
    """Critical points of a loading path, in the order of the path, with ascending load factors.

    Parameters
    ----------
    model : Model
        The model.
    load_factors : array, [-], (m,)
        Load factors at which the tangent stiffness is singular, m <= count.
    kinds : tuple of str, (m,)
        "bifurcation", where another path crosses, or "limit point", the largest load factor of the path, with which it
        ends.
    linearised : array, [-], (k,)
        Load factors, k <= count, of linear buckling analysis, K0 phi = -(lambda - lambda0) K_sigma phi, with the
        geometric stiffness K_sigma of the stress resultants of the linear solution, and the load stiffness of
        pressures. Empty if the loads have no slope at the start.
    modes : array, (m, n)
        Critical shapes over all coordinates; the largest displacement of a node is 1.
    states : array, (m, n)
        Equilibria at `load_factors`.
    uncertainty : array, [-], (m,)
        Relative error of a load factor by round-off and interpolation.
    ended : str
        Why there are no more critical points.
    status : Status
        STOPPED if there may be more: the path was lost, the beam would be turned inside out, or the search ended at its
        limits of movement, load or length.
    warnings : tuple of str
        Warnings to heed before using the load factors, in sentences.
    about : State, optional
        The state that the search was told to start from.

    Examples
    --------
    >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e3, 0.0))])
    >>> bf.solve_buckling(column)
    Buckling(bifurcation at load factor 539.15711; ended because the requested number, 1, was found)
    """

    model: Model
    load_factors: np.ndarray
    kinds: tuple[str, ...]
    linearised: np.ndarray
    modes: np.ndarray
    states: np.ndarray
    uncertainty: np.ndarray
    ended: str
    status: Status = Status.COMPLETED
    warnings: tuple[str, ...] = ()
    about: State | None = None

    def __repr__(self) -> str:
        points = list(zip(self.kinds, self.load_factors, strict=True))
        listed = ", ".join(f"{kind} at load factor {value:.8g}" for kind, value in points[:_SHOWN])
        more = f" and {len(self) - _SHOWN} more" if len(self) > _SHOWN else ""
        return f"Buckling({listed or 'no critical point'}{more}; ended because {self.ended})"

    def _repr_html_(self) -> str:
        from beamfem.view.summary import buckling_table

        return buckling_table(self)

    def __len__(self) -> int:
        return len(self.load_factors)

    def error(self, mode: int = 0) -> float:
        """Return an estimate of the discretisation error of a critical load factor: its change on an enriched space.

        The path is followed with elements of order k + 1 instead of k = 1 or 2, and halves of other ones; critical
        points are compared by their number.

        Parameters
        ----------
        mode : int, default 0
            Row of the critical point.

        Returns
        -------
        float, [-]
            Load factor on the enriched space less that of the critical point, to be added to it.

        Raises
        ------
        InputError
            If there is no such critical point.
        ConvergenceError
            If there are fewer critical points on finer elements.

        Examples
        --------
        >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e3, 0.0))])
        >>> abs(bf.solve_buckling(column).error()) < 0.01
        True
        """
        number = number_below("mode", mode, len(self), -len(self)) % len(self)
        about = None if self.about is None else enriched_state(self.about)
        finer = solve_buckling(enriched(self.model), number + 1, about)
        if len(finer) <= number:
            raise ConvergenceError(
                f"the error cannot be estimated: on finer elements there are {len(finer)} critical points, as "
                f"{finer.ended}",
                remedy="The mesh is too coarse for this one",
            )
        return float(finer.load_factors[number] - self.load_factors[number])

    def solution(self, mode: int = 0, amplitude: float | None = None) -> Solution:
        """Return the critical state and the same state with a mode added, as a Solution to draw or export.

        amplitude [m]: largest displacement, by default a tenth of the longest beam. Raises InputError if there is no
        critical point.
        """
        if len(self) == 0:
            raise InputError(f"there is no critical point: {self.ended}")
        mode = number_below("mode", mode, len(self))
        if amplitude is None:
            amplitude = 0.1 * max(beam.curve.length for beam in self.model.beams)
        p = self.states[mode] + np.outer([0.0, squared(positive)("amplitude", amplitude)], self.modes[mode])
        at = np.full(2, self.load_factors[mode])
        statistics = Statistics(0, 1, 0, "a critical state and its mode")
        return Solution(self.model, True, at, p, np.zeros_like(p), np.zeros_like(p), statistics)

    def to_pandas(self) -> "DataFrame":
        """Return load factor, kind and uncertainty of the critical points as a table, one row per point.

        Raises MissingPackageError without pandas.
        """
        rows = list(zip(self.load_factors.tolist(), self.kinds, self.uncertainty.tolist(), strict=True))
        return as_pandas(("load_factor", "kind", "uncertainty"), rows)

    def to_xarray(self, beam: Beam | None = None) -> "Dataset":
        """Return load factors [-], kinds and uncertainty (mode,), and shapes ux, uy (mode, station), as a Dataset.

        Shapes are along a beam, or along all beams, scaled as `modes`. Raises InputError for a beam of another model,
        MissingPackageError without xarray.
        """
        from beamfem.io.table import buckling_to_xarray

        return buckling_to_xarray(self, beam)

    def plot(self, path: str | PathLike[str] | None = None, *, most: int = 6, ax: Any = None) -> "Figure":
        """Draw at most `most` modes, each with its load factor, and return the figure.

        Pale: the critical state; dark: the same state plus the mode; dashed: the reference. path: file to write (PNG,
        SVG, PDF); ax: as many axes as modes are drawn, see `Solution.plot`. Raises InputError if there are no modes to
        draw, or for another number of axes; MissingPackageError without matplotlib.
        """
        from beamfem.view.mode_shapes import plot_buckling

        return plot_buckling(self, path, most, ax)


def solve_buckling(
    model: Model, count: int = 1, about: State | Solution | None = None, *, accuracy: float | None = None
) -> Buckling:
    """Find the first points of the loading path at which the tangent stiffness is singular.

    The true equilibria are followed up to their largest load factor, and negative pivots of the tangent are counted, so
    that no change of their number is missed. If there are fewer points than asked for, all of them are returned;
    `ended` and `status` of the result say whether there may be more, beyond a movement by twice the size of the model
    or 300 times the load factors of linear analysis.

    Parameters
    ----------
    model : Model
        Beams, supports and loads; loads with scale=True grow with the load factor.
    count : int, default 1
        Number of critical points.
    about : State or Solution, optional
        Stable equilibrium to start from, a solution for its last state; by default the equilibrium at load factor 0.
    accuracy : float, [-], optional
        Refine the mesh, as `solve_static` does, until the estimated relative error of every critical load factor, see
        `Buckling.error`, is at most this number.

    Raises
    ------
    InputError
        If no load factor is critical, or the loads do nothing or follow the beam; for an accuracy and elements that
        lock.
    FreeMotionError
        If the model can move without resistance.
    ConvergenceError
        If the path was lost before the first critical point; its `solution` has the equilibria found. If no mesh
        reaches the accuracy.

    Warns
    -----
    RoundOffWarning
        If a load factor has less than four reliable digits.
    LockingWarning
        If locking changes a critical load factor by 1 % or more.

    Examples
    --------
    >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e3, 0.0))])
    >>> float(bf.solve_buckling(column).load_factors[0].round(1))  # Euler: pi^2 E I / (4 L^2) = 539.7 kN
    539.2
    """
    whole_number("count", count)
    model, accuracy = prepared(model, accuracy, about)
    if accuracy is None:
        buckling, findings = _buckling(model, count, about)
    else:
        buckling, findings = refined_until(model, accuracy, lambda model: _attempt(model, count, about))
    warn_of(findings)
    return buckling


_Judged = tuple[Buckling, Sequence[Finding]]


def _attempt(model: Model, count: int, about: State | Solution | None) -> tuple[_Judged | None, float, Shares]:
    """Return the critical points, and the largest relative error of their load factors that is estimated."""
    if len(system_of(model, static=True).free_dofs) < 2 * count:
        return None, np.inf, None
    buckling, findings = _buckling(model, count, carried(about, model))
    require_unlocked(findings)
    richer = enriched(model)
    finer = _buckling(richer, count, carried(about, richer))[0]
    if len(finer) != len(buckling):
        return None, np.inf, None
    change = np.abs(buckling.load_factors - finer.load_factors) / np.abs(finer.load_factors)
    shapes = zip(_shapes(buckling), _shapes(finer), strict=True)
    shares = mode_shares(((*a, *b) for a, b in shapes), change, np.zeros_like(change))
    return (buckling, findings), float(np.max(change, initial=0.0)), shares or None


def _shapes(buckling: Buckling) -> Iterator[tuple[State, np.ndarray]]:
    """Yield state and shape of each critical point."""
    for p, at, shape in zip(buckling.states, buckling.load_factors.tolist(), buckling.modes, strict=True):
        yield State(p, np.zeros_like(p), np.zeros_like(p), at, buckling.model), shape


def _buckling(model: Model, count: int, about: State | Solution | None) -> _Judged:
    """Return the critical points, and warnings of them."""
    system = system_of(model, static=True)
    system.forget_digits()
    refuse_memory(system, "solve_buckling")
    require_support(system)
    require_independent(system, system.reference)
    unknown = len(system.free_dofs)
    if count > unknown:
        raise InputError(f"count is {count}, but this model has only {unknown} unknown coordinates")
    with digits_for("critical load factors"):
        p, load_factor = stable_start(system, about)
        line, start = begin(system, p, load_factor, Newton(iterations=_ITERATIONS))
        linear = linear_solution(system, p, load_factor)
        linearised = np.empty(0) if linear is None else linearised_loads(system, p, load_factor, linear, count)
    reach = 1.0 if linear is None else linear_reach(system, linear, linearised - load_factor)
    path = _LoadingPath(line, [start], count, load_factor + _LARGEST_LOAD * reach)
    with digits_for("critical load factors"):
        ended, status = path.follow()
    criticals = path.criticals
    if not criticals and path.lost:
        raise ConvergenceError(
            f"the loading path was lost before any load factor was critical: {ended}"
            + advice(model, path.points[-1].y[:-1]),
            path.solution(),
        )
    uncertainty, found = np.array([point.uncertainty for point in criticals]), list[Finding]()
    if np.any(uncertainty > _UNCERTAIN):
        errors = ", ".join(f"{value:.0e}" for value in uncertainty)
        message = f"round-off leaves few digits of critical load factors, relative errors are up to {errors}"
        found.append(Finding(message, RoundOffWarning))
    first = criticals[0].load_factor if criticals else load_factor
    if len(linearised) and first - load_factor > _ABOVE * (linearised[0] - load_factor) > 0.0:
        message = (
            f"linearised stability predicts a critical load factor of {linearised[0]:.6g}, where the path bends "
            f"without one, as that of an imperfect structure does; the first critical point is at {first:.6g}. Look at "
            "the displacements of trace_equilibrium"
        )
        found.append(Finding(message, UserWarning))
    shapes = [point.mode / largest_translation(model, point.p, point.mode) for point in criticals]
    if may_lock(system, p) and shapes:
        at_start = State(p, np.zeros_like(p), np.zeros_like(p), load_factor, model)
        found += stiffness_locking(at_start, np.array(shapes), 1.0, "a critical load factor")
    return Buckling(
        model,
        np.array([point.load_factor for point in criticals]),
        tuple(point.kind for point in criticals),
        linearised,
        upright(model, np.array(shapes).reshape(-1, model.size)),
        np.array([point.p for point in criticals]).reshape(-1, model.size),
        uncertainty,
        ended,
        status,
        tuple(finding.sentence for finding in found),
        last_state(about, "about"),
    ), found


@dataclass(frozen=True, eq=False)
class _Critical:
    """A singular point of a loading path: kind, load factor, state p (n,), mode (n,), and relative error."""

    kind: str
    load_factor: float
    p: np.ndarray
    mode: np.ndarray
    uncertainty: float


@dataclass(eq=False)
class _LoadingPath:
    """The path through the first of its points towards larger load factors, up to its first limit point.

    count: number of critical points that are sought; farthest: largest load factor.
    """

    line: Continuation
    points: list[PathPoint]
    count: int
    farthest: float
    criticals: list[_Critical] = field(default_factory=list)
    lost: bool = False

    def follow(self) -> tuple[str, Status]:
        """Find critical points in the order of the path; return why there are no more, and the status."""
        size = _FIRST_STEP
        while len(self.points) < _MOST_POINTS:
            point = self.points[-1]
            taken = self._step(point, size)
            if isinstance(taken, str):
                self.lost = taken != Termination.INVERTED.value
                where = f"beyond load factor {point.load_factor:.6g}"
                inverted = f"{where} the beam would be turned inside out"
                lost = f"{where} no step along the path is accepted: {taken}"
                return lost if self.lost else inverted, Status.STOPPED
            step, criticals = taken
            after = step.segment.after
            for critical in criticals:
                # what a step happens to find beyond the limits depends on its length
                beyond = self._beyond(critical.p, critical.load_factor)
                if beyond or len(self.criticals) == self.count:
                    break
                self.criticals.append(critical)
                if critical.kind == LIMIT_POINT:
                    return "the path has its largest load factor there", Status.COMPLETED
            else:
                beyond = self._beyond(after.y[:-1], after.load_factor)
            self.line, point = self.line.rescaled(after)
            self.points.append(point)
            size = step.next_size * self.line.length(after.tangent)
            if len(self.criticals) == self.count:
                return f"the requested number, {self.count}, was found", Status.COMPLETED
            if beyond:
                return beyond, Status.STOPPED
        return f"the {_MOST_POINTS} points of the path are used up", Status.STOPPED

    def _step(self, point: PathPoint, size: float) -> tuple[Step, list[_Critical]] | str:
        """Return the longest accepted step from a point with its critical points, or why the last one was refused."""

        def attempt(point: PathPoint, size: float) -> tuple[Step, list[_Critical]] | Refused:
            outcome = take_step(self.line, point, size, strict=False, sought=self.count - len(self.criticals))
            if isinstance(outcome, Refused):
                return outcome
            try:
                return outcome, [each for part in _parts(outcome) for each in _critical_points(part)]
            except SegmentLostError as error:
                return Refused(str(error), outcome.iterations)

        found, reasons, _ = longest_accepted(self.line, point, min(size, longest_step(self.line, point)), attempt)
        return found or reasons[-1]

    def _beyond(self, p: np.ndarray, load_factor: float) -> str:
        """Return which limit of the search a state p (n,) is beyond, nothing if none."""
        system = self.line.system
        if largest_displacement(system, p - self.points[0].y[:-1]) > _LARGEST_MOVEMENT * size_of(system):
            return f"the search goes no further than a movement by {_LARGEST_MOVEMENT:g} times the size of the model"
        if load_factor > self.farthest:
            times = f"{_LARGEST_LOAD:g} times the load factors of linear analysis"
            return f"the search goes no further than {times}, {self.farthest:.6g}"
        return ""

    def solution(self) -> Solution:
        """Return the points found, as a solution."""
        rows = np.array([point.y for point in self.points])
        p, none = rows[:, :-1], np.zeros((len(rows), rows.shape[1] - 1))
        ended = "the equilibria that were found on the loading path"
        statistics = Statistics(0, len(rows) - 1, 0, ended, Status.STOPPED)
        model = self.line.system.model
        return Solution(model, True, rows[:, -1], p, none, none.copy(), statistics)


_Part = tuple[Segment, list[float], list[Crossing]]


def _parts(step: Step) -> list[_Part]:
    """Return the segments of a step, divided where a mode loses its stiffness and gains it again, and what is on them.

    Raises SegmentLostError.
    """
    segment = step.segment
    counts = [end.negative_pivots for end in (segment.before, segment.after)]
    inside = (segment.at(x) for x in (0.5, _softest_place(segment)) if x is not None)
    hidden = [point for point in inside if not min(counts) <= point.negative_pivots <= max(counts)]
    if not hidden:
        return [(segment, step.limits, step.crossings)]
    ends = segment.before, hidden[0], segment.after
    halves = [Segment(segment.line, *pair) for pair in pairwise(ends)]
    limits = [half.limit_points() for half in halves]
    return [(half, own, bifurcations(half, own)) for half, own in zip(halves, limits, strict=True)]


def _softest_place(segment: Segment) -> float | None:
    """Return the fraction where by parabolas through three points a mode keeps the least fraction of its stiffness.

    None if all modes keep more of it than a fraction, or round-off hides the stiffnesses. Raises SegmentLostError.
    """
    at = np.array([0.0, 0.5, 1.0])
    try:
        modes = segment.line.softest_modes(segment.before.factors, _MODES)
        stiffness = [condensed(segment.line, segment.at(x), modes).stiffness for x in at.tolist()]
        eigenvalues = np.linalg.eigvalsh(np.array(stiffness))
    except LinAlgError:
        return None
    steady = eigenvalues[:, (eigenvalues > 0.0).all(axis=0) | (eigenvalues < 0.0).all(axis=0)]
    if not steady.size:
        return None
    least = steady[np.abs(steady).argmin(axis=0), np.arange(steady.shape[1])]
    kept = interpolation_weights(at, _GRID) @ (steady / least)
    return float(_GRID[kept.min(axis=1).argmin()]) if kept.min() <= _KEPT else None


def _critical_points(part: _Part) -> list[_Critical]:
    """Return the critical points of a part of a path in order, a bifurcation at a limit point before it.

    Their uncertainty is the change of the result with the distance of the points between which is interpolated.
    """
    (segment, limits, crossings), again = part, list[float]()
    for factor in _DISTANCES if crossings else ():
        with suppress(SegmentLostError):
            again = [float(other.y[-1]) for other in bifurcations(segment, limits, factor * DISTANCE)]
        if len(again) == len(crossings):
            break
    else:
        again = [segment.before.load_factor] * len(crossings)
    found = []
    for crossing, other in zip(crossings, again, strict=True):
        y, mode = crossing.y, crossing.mode[:-1]
        found.append((crossing.fraction, _Critical(BIFURCATION, float(y[-1]), y[:-1], mode, _change(y[-1], other))))
    for x in limits:
        y, (beside, tangent) = segment.critical(x), segment.interpolated(x)
        found.append((x, _Critical(LIMIT_POINT, float(y[-1]), y[:-1], tangent[:-1], _change(y[-1], beside[-1]))))
    return [critical for _, critical in sorted(found, key=lambda row: (row[0], row[1].kind == LIMIT_POINT))]


def _change(load_factor: float, other: float) -> float:
    return abs(other / load_factor - 1.0) if load_factor != 0.0 else np.inf
