"""Buckling: load factors at which the tangent of a loaded structure becomes singular."""

from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np

from beamfem.analysis.balance import left_over
from beamfem.analysis.critical import critical_load, load_of_limit_point
from beamfem.analysis.equations import load_slope
from beamfem.analysis.free_motion import require_support
from beamfem.analysis.initial import resting_state
from beamfem.analysis.lost_stiffness import Start
from beamfem.analysis.newton import Newton, solve_equilibrium
from beamfem.analysis.primary_path import PathEndsError, PrimaryPath
from beamfem.analysis.shapes import largest_translation, upright
from beamfem.errors import ConvergenceError, InputError
from beamfem.model.model import Model
from beamfem.model.system import system_of
from beamfem.solution import Solution, State, Statistics
from beamfem.validation import count as whole_number
from beamfem.validation import positive

_LARGEST_CHANGE = 0.5  # of the model: linearised load factors that would move it further mean nothing


@dataclass(frozen=True, eq=False)
class Buckling:
    """Critical load factors, ascending.

    load_factors (count,): where the tangent is singular on the loading path; linearised (count,): where it would be if
    it went on as it starts, K0 phi = -(lambda - lambda0) dK/dlambda phi; modes (count, n): critical shapes over all
    coordinates, their largest displacement of a node 1; states (count, n): the equilibria at `load_factors`.
    """

    model: Model
    load_factors: np.ndarray
    linearised: np.ndarray
    modes: np.ndarray
    states: np.ndarray

    def __repr__(self) -> str:
        return f"Buckling(load factors {', '.join(f'{value:.8g}' for value in self.load_factors)})"

    def __len__(self) -> int:
        return len(self.load_factors)

    def solution(self, mode: int = 0, amplitude: float | None = None) -> Solution:
        """Return the critical state and the same with a mode added, as a Solution to draw or export.

        mode: its row; amplitude [m] of the largest displacement, by default a tenth of the longest beam.
        """
        if mode not in range(len(self)):
            raise InputError(f"mode must be between 0 and {len(self) - 1}, got {mode!r}")
        if amplitude is None:
            amplitude = 0.1 * max(beam.curve.length for beam in self.model.beams)
        p = self.states[mode] + np.outer([0.0, positive("amplitude", amplitude)], self.modes[mode])
        at = np.full(2, self.load_factors[mode])
        statistics = Statistics(0, 1, 0, "a critical state and its mode")
        return Solution(self.model, True, at, p, np.zeros_like(p), np.zeros_like(p), statistics)

    def plot(self, path: str | PathLike[str] | None = None, **options: Any) -> Any:
        """Draw the modes, each with its load factor; return the figure. See `view.mode_shapes.plot_buckling`."""
        from beamfem.view.mode_shapes import plot_buckling

        return plot_buckling(self, path, **options)


def solve_buckling(model: Model, count: int = 1, about: State | Solution | None = None) -> Buckling:
    """Return the `count` lowest load factors, above that of the start, at which the tangent is singular.

    about: the stable equilibrium to start from, by default that at load factor 0. The path from there is followed with
    its true equilibria and none is left out (negative pivots of the tangent are counted).
    Raises InputError where no load factor is critical, loads do nothing or follow the beam; FreeMotionError;
    ConvergenceError, with the equilibria found, where the path ends in a limit point before.
    """
    whole_number("count", count)
    system = system_of(model, static=True)
    require_support(system)
    unknown = len(system.free_dofs)
    if count > unknown:
        raise InputError(f"count is {count}, but this model has only {unknown} unknown coordinates")
    p, load_factor = resting_state(system, about)
    if left_over(system, p, load_factor) > 0.0:
        begun = solve_equilibrium(system, p, load_factor, Newton())
        if not begun.ended.good:
            raise ConvergenceError(f"no equilibrium at load factor {load_factor:g} to start from: {begun.ended.value}")
        p = begun.state
    if not np.any(load_slope(system, p, load_factor)[system.free_dofs]):
        raise InputError("no load grows with the load factor, so none can buckle the model; add one with scale=True")
    path = PrimaryPath(system, p, load_factor)
    start = Start.at(system, path.found[0])
    linearised = load_factor + 1.0 / start.rates(count)
    moved = float(np.max(np.abs(path.found[0].slope) / system.scale))
    linearised = linearised[(linearised - load_factor) * moved <= _LARGEST_CHANGE]
    if len(linearised) < count:
        found = f"only {len(linearised)} of {count} load factors" if len(linearised) else "no positive load factor"
        raise InputError(
            f"{found} can be critical: the loads stiffen the model, or would first have to move it by more than half "
            "of its length"
        )
    loads: list[float] = []
    shapes: list[np.ndarray] = []
    states: list[np.ndarray] = []
    for number, guess in enumerate(linearised):
        try:
            load = critical_load(path, start, number, guess, count)
        except PathEndsError:
            raise ConvergenceError(_no_further(path, start, loads), path.solution(model)) from None
        state = path.between(load)
        shape = start.critical_shape(state, load, number)
        loads.append(load)
        states.append(state)
        shapes.append(shape / largest_translation(model, state, shape))
    return Buckling(model, np.array(loads), linearised, upright(np.array(shapes)), np.array(states))


def _no_further(path: PrimaryPath, start: Start, loads: list[float]) -> str:
    """Say where and why the path ends."""
    limit = load_of_limit_point(path, start)
    where = f"a limit point at load factor {limit:.6g}" if limit else f"load factor {path.found[-1].load_factor:.6g}"
    before = f"after {', '.join(f'{load:.6g}' for load in loads)}" if loads else "before any load factor"
    return (
        f"the loading path ends in {where} {before} was found critical; "
        "no equilibrium near by carries more. trace_equilibrium follows the path around it"
    )
