"""An equilibrium path: its states, its limit points and its bifurcations."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, SupportsIndex, overload

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.results.motion_state import StateWithResults
from beamfem.results.postprocess import Fields, part_of
from beamfem.results.solution import Solution

if TYPE_CHECKING:
    from beamfem.results.section_forces import SectionForces


_SHOWN = 6  # critical points of each kind in the text of a path
_STILL = 1e-10  # of the coordinates: change between two rows that may be round-off
_DETOUR = 1.1  # of the distance between two rows: the way from one to the other over a point that is between them


@dataclass(frozen=True, eq=False)
class PathState(StateWithResults):
    """One state of a path: results as those of a Solution, without the axis of steps.

    Parameters
    ----------
    p, v, a, at, model, turned
        See `State`; `at` is the load factor [-], rotations are counted along the path.
    stability : bool, optional
        Whether the state is a stable equilibrium, None if not known; critical points are not stable.
    """

    stability: bool | None = field(default=None, kw_only=True)
    static: ClassVar[bool] = True

    def __repr__(self) -> str:
        known = {True: ", stable", False: ", not stable", None: ""}[self.stability]
        return f"{type(self).__name__}(load factor {self.at:.6g}{known}, of {self.model!r})"

    @property
    def load_factor(self) -> float:
        """Load factor [-] of the state."""
        return self.at

    @property
    def stable(self) -> bool:
        """Whether it is a stable equilibrium, see `Solution.stable`."""
        return bool(self.alone.stable[0]) if self.stability is None else self.stability

    def reaction(self, point: Point) -> np.ndarray:
        """Return fx, fy [N] and m [N m] (3,) of the supports at a point. Raises InputError if there are none."""
        return np.asarray(self.alone.reaction(point)[0])

    def fields(self, point: Point) -> Fields:
        """Return position, gradients, rotation, shear angle, strain and stress at a point, without an axis of steps."""
        return part_of(self.alone.fields(point), 0)

    def section_forces(self, beam: Beam) -> "SectionForces":
        """Return normal force, shear force [N] and moment [N m] (stations,) of a beam."""
        forces = self.alone.section_forces(beam)
        return replace(forces, normal=forces.normal[0], shear=forces.shear[0], moment=forces.moment[0])


@dataclass(frozen=True, eq=False)
class Bifurcation(PathState):
    """A bifurcation point, where another branch crosses the path.

    Parameters
    ----------
    p, v, a, at, model, turned, stability
        See `PathState`.
    mode : array, (n,)
        Null vector of the tangent stiffness, with root mean square 1 in lengths of the model and radians, and its
        largest component positive.
    tangent : array, (n + 1,)
        Direction of the path, the load factor last.
    """

    mode: np.ndarray
    tangent: np.ndarray

    __repr__ = PathState.__repr__

    def __post_init__(self) -> None:
        from beamfem.results.check_arrays import require_crossing

        super().__post_init__()
        require_crossing(self)


@dataclass(frozen=True, eq=False)
class Path(Solution):
    """The equilibria along a path, in order; load factors may decrease.

    Row i is the state `path[i]`; limit points and bifurcations lie between the rows. The bifurcation point at which a
    branch starts does not count as stable.

    Parameters
    ----------
    model, static, at, p, v, a, statistics, stability, turned, loaded, events, exchanged
        See `Solution`.
    limit_points : tuple of PathState
        Points at which the load factor has an extremum. The structure may fail before the first of them, by a
        bifurcation: see `stability_limit`.
    bifurcations : tuple of Bifurcation
        Points at which another branch crosses the path.

    Examples
    --------
    >>> path = bf.trace_equilibrium(model, until=1.0)
    >>> path[-1].displacement(beam.end).round(4)
    array([-0.0003, -0.0305])
    """

    limit_points: tuple[PathState, ...] = ()
    bifurcations: tuple[Bifurcation, ...] = ()

    def __repr__(self) -> str:
        text = f"{_listed('limit point', self.limit_points)}, {_listed('bifurcation', self.bifurcations)}"
        lost = None if self.stability is None else self.stability_limit
        if lost is not None:
            kind = " by a bifurcation" if isinstance(lost, Bifurcation) else ""
            text += f"; stability is lost first at load factor {lost.at:.6g}{kind}"
        return f"{super().__repr__()[:-1]}; {text}; ended because {self.statistics.ended})"

    @property
    def stability_limit(self) -> PathState | None:
        """The point at which the path first loses its stability, None if it does not.

        It is one of the limit points or bifurcations, or the first unstable row where a load jumps or flutter begins.

        >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e6, 0.0))])
        >>> round(bf.trace_equilibrium(column, until=1.0).stability_limit.load_factor, 3)
        0.539
        """
        lost = np.flatnonzero(self.stable[:-1] & ~self.stable[1:])
        if not len(lost):
            return None
        before, after = (self[int(row)] for row in (lost[0], lost[0] + 1))
        still = np.linalg.norm(after.p - before.p) <= _STILL * np.linalg.norm(before.p)

        def distance(one: PathState, other: PathState) -> float:
            if still:  # heated between walls, say
                return abs(one.load_factor - other.load_factor)
            return float(np.linalg.norm(one.p - other.p))

        ways = {
            distance(before, point): point
            for point in (*self.limit_points, *self.bifurcations)
            if distance(before, point) + distance(point, after) <= _DETOUR * distance(before, after)
        }
        return ways[min(ways)] if ways else after

    def error(self, quantity: Any = None, row: int = -1) -> Any:
        """Return an estimate of the discretisation error of a result, see `Solution.error`.

        A limit point or bifurcation of the path as `quantity` gives that of its load factor [-]: its change on the
        enriched space, where the critical point is located between the same rows. Raises also ConvergenceError if it
        is not found there.

        >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e6, 0.0))])
        >>> path = bf.trace_equilibrium(column, until=1.0)
        >>> abs(path.error(path.bifurcations[0])) < 1e-3
        True
        """
        from beamfem.solve.paths.path_error import critical_error

        if not isinstance(quantity, PathState):
            return super().error(quantity, row)
        if not any(quantity is point for point in (*self.limit_points, *self.bifurcations)):
            raise InputError("a state whose error is estimated is one of the limit points or bifurcations of the path")
        return critical_error(self, quantity)

    @overload
    def __getitem__(self, row: SupportsIndex) -> PathState: ...
    @overload
    def __getitem__(self, row: slice) -> Solution: ...
    def __getitem__(self, row: SupportsIndex | slice) -> PathState | Solution:
        """Return the state of a row, or a Solution of the rows of a slice, without limit points and bifurcations."""
        return super().__getitem__(row)  # type: ignore[return-value]

    def _state(self, row: int) -> PathState:
        from beamfem.results.full_turns import start_rotations

        stability = None if self.stability is None else bool(self.stability[row])
        parts = (self.p[row], self.v[row], self.a[row], float(self.at[row]), self.model)
        return PathState(*parts, stability=stability, turned=start_rotations(self)[row])


def _listed(name: str, points: Sequence[PathState]) -> str:
    """Return critical points by number and load factor, the first few of many."""
    if not points:
        return f"0 {name}s"
    factors = ", ".join(f"{point.at:.6g}" for point in points[:_SHOWN])
    more = ", ..." if len(points) > _SHOWN else ""
    return f"{len(points)} {name}{'s' * (len(points) > 1)} (load factor {factors}{more})"
