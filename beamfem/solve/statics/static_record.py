"""Results of a static solve, and their conversion into a solution."""

import numpy as np

from beamfem.equations.system import system_of
from beamfem.errors import RoundOffWarning, UnstableWarning, warn
from beamfem.model.model import Model
from beamfem.precision.roundoff import ENOUGH, FEW_DIGITS
from beamfem.results.full_turns import continued_rotations
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics, Status
from beamfem.solve.newton.newton import Termination


class StaticRecord:
    """The rows found so far: load factors, states (n,) and the negative pivots of their tangents.

    One call adds a row, so that rows are complete after an interruption.
    """

    def __init__(self, model: Model, symmetric: bool) -> None:
        self.model = model
        self.symmetric = symmetric
        self.rows: list[tuple[float, np.ndarray, int]] = []
        # number of a row behind a jump of the loads, and the states (n,) on the way to it, by which turns are counted
        self.on_the_way: dict[int, list[np.ndarray]] = {}
        self.iterations = 0
        self.cuts = 0
        self.ended = Termination.CONVERGED
        self.digits = np.nan
        self.left: list[str] = []  # bifurcations at which the path was left, and to which side

    @property
    def reached(self) -> float:
        return self.rows[-1][0]

    @property
    def state(self) -> np.ndarray:
        return self.rows[-1][1]

    @property
    def negative_pivots(self) -> int:
        return self.rows[-1][2]

    @property
    def lost_stability(self) -> bool:
        """Whether the last row is the first unstable one after stable rows."""
        last = [is_unstable(self.symmetric, count) for _, _, count in self.rows[-2:]]
        return last == [False, True]

    def add(
        self, load_factor: float, state: np.ndarray, negative_pivots: int, ended: Termination, digits: float = np.nan
    ) -> None:
        self.ended = ended
        self.digits = digits
        self.rows.append((load_factor, state, negative_pivots))

    def solution(self, complete: bool = False) -> Solution:
        """Return the rows as a solution; complete: the solve reached its end.

        Warns of few accurate digits and, for complete solves, of unstable rows; incomplete ones raise an error anyway.
        """
        load_factors, states = np.array([row[0] for row in self.rows]), np.array([row[1] for row in self.rows])
        states = system_of(self.model, static=True).finished(states, load_factors.tolist())
        counts = [count for _, _, count in self.rows]
        unstable = [is_unstable(self.symmetric, count) for count in counts]
        status = Status.STOPPED if not complete else Status.COMPLETED
        if complete and self.ended is Termination.ROUND_OFF and not self.digits >= ENOUGH:
            status = Status.ROUND_OFF
        ended = "; ".join([*self.left, self.ended.value])
        messages: tuple[str, ...] = ()
        if any(unstable):
            status = Status.UNSTABLE if complete else status
            messages = (_describe(np.array(unstable), load_factors),)
            if unstable[-1] and self.symmetric:
                ended += f"; the equilibrium is unstable, {counts[-1]} eigenvalues of its tangent are negative"
            elif unstable[-1]:
                ended += "; the equilibrium is unstable, the determinant of its tangent is negative"
            if complete:
                warn(messages[0], UnstableWarning)
        if self.digits < FEW_DIGITS:
            few = f"round-off leaves {self.digits:.0f} digits of the forces"
            ended += f"; {few}"
            messages += (few,)
            warn(few, RoundOffWarning)
        statistics = Statistics(self.iterations, len(states) - 1, self.cuts, ended, status, messages, self.digits)
        rates = np.zeros(states.shape)  # unlike zeros_like, it takes no memory until it is written to
        for values in (load_factors, states, rates):
            values.setflags(write=False)
        turned = self._turned(states) if self.on_the_way else None
        return Solution(
            self.model,
            True,
            load_factors,
            states,
            rates,
            rates,
            statistics,
            ~np.array(unstable) if self.symmetric else None,
            turned,
        )

    def _turned(self, states: np.ndarray) -> np.ndarray:
        """Return the rotations (rows, m) [rad] of `start_rotations`, counted over the states on the way as well."""
        parts = [np.array([*self.on_the_way.get(row, []), state]) for row, state in enumerate(states)]
        rotations = continued_rotations(self.model, np.concatenate(parts))
        return np.asarray(rotations[np.cumsum([len(part) for part in parts]) - 1])


def is_unstable(symmetric: bool, negative_pivots: int) -> bool:
    """Return whether the negative pivots of a tangent show that a motion grows.

    Under follower loads an odd count, a negative determinant, does; an even one proves nothing.
    """
    return negative_pivots > 0 if symmetric else negative_pivots % 2 == 1


def _describe(unstable: np.ndarray, load_factors: np.ndarray) -> str:
    rows = np.flatnonzero(unstable)
    first, last = load_factors[rows[0]], load_factors[rows[-1]]
    where = f"at load factor {first:.6g}" if len(rows) == 1 else f"from load factor {first:.6g} to {last:.6g}"
    return (
        f"{len(rows)} of {len(unstable)} rows are unstable equilibria, {where}: the structure would leave them for "
        "another path. solution.stable tells which; trace_equilibrium finds the bifurcations and follows their "
        'branches; unstable="leave" follows the stable branch instead'
    )
