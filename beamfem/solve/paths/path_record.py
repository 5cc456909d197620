"""Results of a path so far, kept even if the solve ends with an exception."""

import numpy as np

from beamfem.assembly.system import system_of
from beamfem.model.model import Model
from beamfem.precision.roundoff import FEW_DIGITS, remainder
from beamfem.results.full_turns import first_turns
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.results.status import Statistics, Status
from beamfem.solve.continuation.continuation import Continuation, PathPoint
from beamfem.solve.continuation.steps import Step

_SAME_POINT = 1e-5  # lengths of the model, radians: bifurcations are located to about 1e-8


class PathRecord:
    """Results so far; rows: points y (n + 1,), whether they are stable, and counted rotations (m,) [rad].

    One call adds a row, so that rows are complete after an interruption.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        # for unsymmetric tangents the signs of pivots do not determine stability
        self.symmetric = system_of(model, static=True).symmetric
        self.rows: list[tuple[np.ndarray, bool, np.ndarray]] = []
        self.limit_points: list[PathState] = []
        self.bifurcations: list[Bifurcation] = []
        self.iterations = 0
        self.cuts = 0
        self.ended = "the path was not followed to its end"
        self.status = Status.STOPPED

    def add(self, y: np.ndarray, stable: bool, turned: np.ndarray | None = None) -> None:
        """Add a point y (n + 1,); turned (m,) [rad]: see `PathState`, by default continued from the last point."""
        self.rows.append((y, stable, self._turned(y) if turned is None else turned))

    def end(self, why: str) -> None:
        """Record that the path is complete, and why it ends there."""
        self.ended, self.status = why, Status.COMPLETED

    @property
    def last(self) -> PathState:
        y, stable, _ = self.rows[-1]
        return self.state(y, stable if self.symmetric else None)

    def add_critical(self, line: Continuation, step: Step, last: PathPoint) -> None:
        """Add the limit points and bifurcations of a step up to its last point."""
        segment = step.segment
        fraction = line.dot(last.y - segment.before.y, segment.chord) / line.dot(segment.chord, segment.chord)
        for x in step.limits:
            if x <= fraction:
                self.limit_points.append(self.state(segment.critical(x)))
        for crossing in step.crossings:
            if crossing.fraction <= fraction:
                state = vars(self.state(crossing.y))
                self.bifurcations.append(Bifurcation(**state, mode=crossing.mode[:-1], tangent=crossing.tangent))

    def returns_to(self, line: Continuation, start: Bifurcation) -> bool:
        """Return whether one of the bifurcations found is that from which the branch starts."""
        changes = [np.append(found.p - start.p, found.at - start.at) for found in self.bifurcations]
        return any(line.length(change) < _SAME_POINT for change in changes)

    def state(self, y: np.ndarray, stability: bool | None = False) -> PathState:
        """Return the state of y (n + 1,), coordinates and load factor; stability: whether it is stable, if known."""
        zeros = np.zeros(self.model.size)
        turned = self._turned(y)
        return PathState(y[:-1], zeros, zeros, float(y[-1]), self.model, stability=stability, turned=turned)

    def _turned(self, y: np.ndarray) -> np.ndarray:
        """Return the rotations (m,) [rad] of `first_turns` in y (n + 1,), continued from the last point."""
        last = self.rows[-1][2] if self.rows else np.zeros(len(self.model.numbered.uncounted))
        return first_turns(self.model, y[:-1], last)

    def path(self) -> Path:
        rows, stable, turned = map(np.array, zip(*self.rows, strict=True))
        system = system_of(self.model, static=True)
        digits = remainder(system, rows[-1, :-1], float(rows[-1, -1])).digits
        ended = self.ended
        if digits < FEW_DIGITS:
            ended += f"; round-off leaves {digits:.0f} digits of the forces"
        statistics = Statistics(self.iterations, len(rows) - 1, self.cuts, ended, self.status, digits=digits)
        zeros = np.zeros((len(rows), self.model.size))
        states = rows[:, :-1], zeros, zeros.copy()
        return Path(
            self.model,
            True,
            rows[:, -1],
            *states,
            statistics,
            stability=stable if self.symmetric else None,
            turned=turned,
            limit_points=tuple(self.limit_points),
            bifurcations=tuple(self.bifurcations),
        )
