"""What came of a random case: right by independent balances, a named error, or something that must not happen."""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from absurd_models import Case
from complex_steps import elastic, external, nodal_force, sprung, to_coordinates
from fuzz_steps import faults_of_steps
from independent_balance import balance, floor_of
from scipy.linalg import LinAlgError

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.results.postprocess import nodal_vectors
from beamfem.results.solution import Statistics
from beamfem.solve.modes.pencil import Pencil

MOST_WARNINGS = 5
UNEXPLAINED = (
    *("wrong", "not judged", "hang", "died"),
    *("unnamed exception", "unnamed warning", "flood of warnings"),
)
_STRAIN = 1e-3
_DIFFERENCE = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))
_MODE = 1e-6  # of the largest force of a mode
_NOISE = 30.0
_SAMPLES = 4
_FEW = 4.0  # times the largest of so many samples
_CRITICAL = 1e-3  # of the stiffness at the start that a critical mode may have left


@dataclass(frozen=True)
class Outcome:
    """Seed, analysis and what came of it: "right", the class of a named error, or what must not happen with why."""

    seed: int
    analysis: str
    verdict: str
    said: str = ""

    @property
    def unexplained(self) -> bool:
        return self.verdict in UNEXPLAINED


def judge(case: Case) -> Outcome:
    """Run a case and judge what comes of it."""

    def outcome(verdict: str, said: str = "") -> Outcome:
        return Outcome(case.seed, case.analysis, verdict, said)

    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        try:
            result, verdict = case.run(), "right"
        except bf.BeamfemError as error:
            result, verdict = getattr(error, "solution", None), type(error).__name__
        except Exception as error:
            return outcome("unnamed exception", f"{type(error).__name__}: {error}")
    foreign = [
        f"{item.category.__name__}: {item.message} at {item.filename}:{item.lineno}"
        for item in warned
        if item.category is not UserWarning and item.category.__module__ != "beamfem.errors"
    ]
    if foreign:
        return outcome("unnamed warning", foreign[0])
    if len(warned) > MOST_WARNINGS:
        return outcome("flood of warnings", f"{len(warned)}, such as {warned[0].message}")
    with np.errstate(all="ignore"):
        wrong = next(_faults(case, result, verdict), None)
    return outcome("wrong", f"{verdict}: {wrong}") if wrong else outcome(verdict)


def _faults(case: Case, result: object, verdict: str) -> Iterator[str]:
    """Say what is wrong of a result, as far as it is looked at."""
    if isinstance(result, bf.Modes):
        yield from _of_modes(result)
    elif isinstance(result, bf.Buckling):
        yield from _of_buckling(result)
    elif isinstance(result, bf.Solution):
        yield from _of_states(result, verdict)
        if case.analysis == "motion" and verdict == "right":
            yield from faults_of_steps(result, case.options)


def _of_states(solution: bf.Solution, verdict: str) -> Iterator[str]:
    for name in ("at", "p", "v", "a"):
        if not np.isfinite(getattr(solution, name)).all():
            yield f"{name} is not finite"
            return
    rows = sorted({0, len(solution) // 2, len(solution) - 1})
    if verdict != "right" and len(solution) == 1:
        return  # no equilibrium at all was found
    for row in rows:
        found = balance(solution, row)
        if not found.holds:
            yield f"row {row} of {len(solution)} at {solution.at[row]:g}: {found}"
    for state in (*getattr(solution, "limit_points", ()), *getattr(solution, "bifurcations", ())):
        found = balance(_alone(state))
        if not found.holds:
            yield f"critical point at {state.at:g}: {found}"


def _alone(state: bf.State) -> bf.Solution:
    rest = np.zeros((1, len(state.p)))
    return bf.Solution(
        state.model, True, np.array([state.at]), state.p[None], rest, rest, Statistics(0, 0, 0, "one state")
    )


def _of_modes(modes: bf.Modes) -> Iterator[str]:
    frequencies, growth = modes.frequencies, modes.growth
    if not (np.isfinite(frequencies).all() and np.isfinite(growth).all() and np.isfinite(modes.modes).all()):
        yield "a mode is not finite"
        return
    if np.any(frequencies < 0.0):
        yield "a frequency is negative"
    start = _alone(modes.state)
    found = balance(start)
    if not found.holds:
        yield f"the state to vibrate about: {found}"
    for number, shape in enumerate(modes.modes):
        square = (growth[number] + 2j * np.pi * frequencies[number]) ** 2
        stiff, noise = _stiffness(start, shape)
        inertia = _inertia(start, shape)
        rest = stiff + square * inertia
        left = np.abs(_free(start, rest))
        allowed = _MODE * float(np.abs(_free(start, stiff)).max() + np.abs(_free(start, square * inertia)).max())
        if np.any(left > allowed + _NOISE * noise) and not _shape_is_near(start, shape, square, rest):
            yield f"mode {number} of {frequencies[number]:g} Hz: {left.max():.2e} left, allowed {allowed:.2e}"


def _shape_is_near(at: bf.Solution, shape: np.ndarray, square: complex, left: np.ndarray) -> bool:
    """Tell whether (K + |omega^2| M)^-1 of what a mode (n,) leaves (n,) is small against it, or as rounding has it.

    The last digits of a slender beam's mode stretch it, with forces that hide those that bend it; those of the state
    stress it.
    """
    system = system_of(at.model, True)
    free, scale = system.free_dofs, system.scale[system.free_dofs]
    pencil, rng = Pencil(system, at.p[0], float(at.at[0])), np.random.default_rng(2)
    try:
        factors = pencil.exact(-abs(square)).factorised(system.rotated)

        def away(forces: np.ndarray) -> float:
            return float(max(np.abs(factors.solve(part[free]) / scale).max() for part in (forces.real, forces.imag)))

        reach = np.where(system.positions, system.extent, np.maximum(np.abs(at.p[0]), 1.0))
        now, rounded = _stiffness(at, shape)[0], 0.0
        for _ in range(_SAMPLES):
            last = np.finfo(float).eps * reach * rng.choice([-0.5, 0.5], len(shape))
            rounded = max(rounded, away(_stiffness(replace(at, p=at.p + last), shape)[0] - now))
        return away(left) <= _MODE * float((np.abs(shape[free]) / scale).max()) + _FEW * rounded
    except (LinAlgError, ValueError):
        return False


def _of_buckling(found: bf.Buckling) -> Iterator[str]:
    for number, (factor, state, mode) in enumerate(zip(found.load_factors, found.states, found.modes, strict=True)):
        critical = _alone(bf.State(state, 0.0 * state, 0.0 * state, float(factor), found.model))
        held = balance(critical)
        if not held.holds:
            yield f"critical state {number} at {factor:g}: {held}"
        system = system_of(found.model, True)
        first = _alone(bf.State(system.reference, 0.0 * state, 0.0 * state, 0.0, found.model))
        (now, noise), (before, _) = _stiffness(critical, mode), _stiffness(first, mode)
        allowed = max(_CRITICAL, 10.0 * found.uncertainty[number]) * abs(float(mode @ before.real))
        left = abs(float(mode @ _spread(critical, _free(critical, now))))
        if left > allowed + _NOISE * float(np.abs(mode) @ _spread(critical, noise / system.scale[system.free_dofs])):
            yield f"critical mode {number} at {factor:g} is resisted: {left:.2e}, allowed {allowed:.2e}"


def _free(at: bf.Solution, values: np.ndarray) -> np.ndarray:
    """Unknown rows of complex forces (n,), times what their coordinate is measured by."""
    system = system_of(at.model, True)
    parts = system.along_free(values.real) + 1j * system.along_free(values.imag)
    return parts * system.scale[system.free_dofs]


def _spread(at: bf.Solution, values: np.ndarray) -> np.ndarray:
    system = system_of(at.model, True)
    result = np.zeros(at.model.size)
    result[system.free_dofs] = np.real(values) / system.scale[system.free_dofs]
    return result


def residual(at: bf.Solution) -> np.ndarray:
    """Elastic forces less all others (n,) of the only row, by complex steps."""
    model, p = at.model, at.p[0]
    result = elastic(model, p, float(at.at[0]), True) - sprung(model, p - system_of(model, True).reference)
    for mesh in model.meshes:
        e = nodal_vectors(mesh, p[None])[0]
        for forces in external(mesh, model, at, 0, float(at.at[0]), True):
            result -= to_coordinates(mesh, p, nodal_force(mesh, forces, e), model.size)
    return result


def _stiffness(at: bf.Solution, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """K phi (n,) by differences of the residual, and what round-off leaves of its unknown rows, in [N m]."""
    system = system_of(at.model, True)
    result, width = np.zeros(len(shape), dtype=complex), np.inf
    for unit, part in ((1.0, np.real(shape)), (1j, np.imag(shape))):
        size = float(np.max(np.abs(part) / system.strain_scale))
        if size == 0.0:
            continue
        h = _STRAIN / size
        width = min(width, h)
        for place, weight in _DIFFERENCE:
            moved = replace(at, p=at.p + place * h * part)
            result = result + unit * weight / h * residual(moved)
    rest = np.zeros(len(shape))
    tangent = linearise(system, at.p[0], rest, rest, float(at.at[0]), STATICS)[1].sparse(system.rotated)
    cut_off = np.zeros(len(shape))  # the difference is of fourth order, of each part of a row that may cancel
    cut_off[system.free_dofs] = _STRAIN**4 * (abs(tangent) @ np.abs(shape[system.free_dofs]))
    noise = (floor_of(at) / width + cut_off) * system.scale
    return result, noise[system.free_dofs] + float(np.max(noise[system.free_dofs], initial=0.0))


def _inertia(at: bf.Solution, shape: np.ndarray) -> np.ndarray:
    """M phi (n,) from inertia forces of an acceleration."""
    result = np.zeros(len(shape), dtype=complex)
    rest = residual(at)
    for unit, part in ((1.0, np.real(shape)), (1j, np.imag(shape))):
        if part.any():
            result = result + unit * (residual(replace(at, a=part[None])) - rest)
    return result
