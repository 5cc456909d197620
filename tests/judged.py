"""Where a static model must end, by its traced path if that agrees with itself, and what solve_static makes of it."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from recipes import Built, Recipe, View

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.errors import CuspWarning

SAME = 1e-6  # of the model: positions, and of a load factor
FIRST_STEP = 3e-3  # load factor of the second point of the path that checks the first one
NEAR = 0.05  # of the model: another mesh
POINTS = 40, 120, 400
# these lock, or share no r_x at joints: another mesh is another answer
COARSE = (
    "bilinear ANCF",
    "bilinear ANCF split",
    "bilinear CRBF",
    "bilinear CRBF reduced",
    "ANCF",
    "ANCF-CRBF",
    "ANCF line",
    "ANCF-CRBF line",
)


@dataclass(frozen=True, eq=False)
class Reference:
    """Where the path ends: positions (n, 2) at load factor 1, or the load factor of its first limit point before.

    crossed: load factors of the bifurcations on the way; iterations: what tracing took.
    """

    end: np.ndarray | None
    limit: float | None
    crossed: tuple[float, ...]
    iterations: int


@dataclass(frozen=True)
class NoReference:
    """Why the path of a model cannot be trusted."""

    reason: str


@dataclass(frozen=True)
class Outcome:
    """What solve_static did: "right", "elsewhere" or "gave up", in how many iterations, and how it put it."""

    verdict: str
    iterations: int
    said: str

    @property
    def right(self) -> bool:
        return self.verdict == "right"


def followed(built: Built, step: float | None = None) -> Reference | NoReference:
    """Return the end of the path that leaves load factor 0, traced once."""
    for points in POINTS:  # a path that has turned back may go on for long
        try:
            with warnings.catch_warnings():
                # there may be cusps beyond a limit point; one before would not be where solve_static ends
                warnings.simplefilter("ignore", CuspWarning)
                path = bf.trace_equilibrium(built.model, 1.0, step=step, points=points)
        except bf.ConvergenceError as error:
            path = error.solution
            if path is None or not _limits(path):
                return NoReference(f"the path was lost: {error}")
        if _limits(path) or path.load_factor[-1] == 1.0:
            return _reference(built, path)
    return NoReference(f"the path did not come to its end in {points} points")


def _reference(built: Built, path: bf.Path) -> Reference | NoReference:
    limits = _limits(path)
    last = limits[0] if limits else 1.0
    crossed = tuple(point.load_factor for point in path.bifurcations if point.load_factor < last)
    if limits:
        return Reference(None, limits[0], crossed, path.iterations)
    if not crossed and _unstable(path[0]) != _unstable(path[-1]):
        return NoReference("the path lost or won stability where it has no critical point")
    return Reference(built.positions(path.p[-1]), None, crossed, path.iterations)


def _unstable(state: bf.PathState) -> int:
    """Return the number of negative pivots of a symmetric tangent, 0 of one that is not."""
    system = system_of(state.model, static=True)
    rest = np.zeros(len(state.p))
    _, tangent = linearise(system, state.p, rest, rest, state.at, STATICS)
    return tangent.factorised(system.rotated).negative_pivots if system.symmetric else 0


def reference(recipe: Recipe, meshes: bool = True) -> Reference | NoReference:
    """Return the end of the path, where it is the same in other steps and, unless the kind locks, on a finer mesh."""
    built = recipe.build()
    try:
        first = followed(built)
    except bf.InputError as refused:
        if "the body would overlap itself" not in str(refused):
            raise
        return NoReference(str(refused))  # the section of a steep wave reaches over its centre of curvature
    if isinstance(first, NoReference):
        return first
    again = followed(built, FIRST_STEP)
    if isinstance(again, NoReference):
        return NoReference(f"in other steps {again.reason}")
    if _apart(first, again, recipe.reach) > 0.1 * SAME:
        return NoReference("other steps along the path lead elsewhere")
    if meshes and not any(bar.kind in COARSE for bar in recipe.bars):
        finer = followed(recipe.build(View(finer=2)))
        if isinstance(finer, NoReference):
            return NoReference(f"on a finer mesh {finer.reason}")
        if _apart(first, finer, recipe.reach) > NEAR:
            return NoReference("the path of a finer mesh leads elsewhere")
    return first


def outcome(built: Built, expected: Reference, steps: int) -> Outcome:
    """Return what solve_static makes of a model whose path is known."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a path may lead through unstable states
            solution = bf.solve_static(built.model, steps)
    except bf.ConvergenceError as error:
        spent = error.solution.iterations if error.solution is not None else 0
        limit = getattr(error, "load_factor", None)
        if limit is not None:
            right = expected.limit is not None and abs(limit - expected.limit) <= 1e-4 * abs(expected.limit)
            return Outcome("right" if right else "elsewhere", spent, str(error))
        return Outcome("gave up", spent, str(error))
    said = solution.statistics.ended
    if expected.end is None:
        return Outcome("elsewhere", solution.iterations, f"over the limit point at {expected.limit:.6g}: {said}")
    away = float(np.abs(built.positions(solution.p[-1]) - expected.end).max()) / built.recipe.reach
    verdict = "right" if away <= SAME else "elsewhere"
    return Outcome(verdict, solution.iterations, f"{away:.1e} away: {said}")


def _limits(path: bf.Path) -> list[float]:
    return [point.load_factor for point in path.limit_points if point.load_factor < 1.0]


def _apart(a: Reference, b: Reference, reach: float) -> float:
    """Return how far two ends of a path are from one another, as a share of the model or of the load factor."""
    if a.limit is not None and b.limit is not None:
        return abs(a.limit - b.limit) / abs(a.limit)
    if a.end is None or b.end is None:
        return np.inf
    return float(np.abs(a.end - b.end).max()) / reach


def judged(recipe: Recipe, steps: Sequence[int] = (1, 10, 100)) -> tuple[Reference | NoReference, list[Outcome]]:
    """Return where a model must end and what solve_static makes of it, starting with so many steps."""
    expected = reference(recipe)
    if isinstance(expected, NoReference):
        return expected, []
    return expected, [outcome(recipe.build(), expected, count) for count in steps]
