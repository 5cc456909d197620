"""Random motions: quality of the estimated error of the mesh, and meshes refined to an accuracy.

Beams and frames of `random_statics` under its loads and gravity, which act at once, come and go or swing; a third of
them fly freely. Each is the same for the same seed. True errors are those against 24 elements of order 8 a beam with
the same steps. Motions whose reference is not settled, by half as many elements, are left out.
"""

import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.motion.motion_error import motion_attempt
from studies.accuracy.random_statics import _of_all, _share, build

ACCURACIES = (1e-2, 1e-4, 1e-6)
FINE = 24
STEPS, EVERY = 400, 16  # of a period of the lowest mode; steps from row to row
ALONG = np.linspace(0.0, 1.0, 17)


@dataclass(frozen=True)
class Motion:
    """A model, its beams, and how long [s] it is to move."""

    beams: tuple[bf.Beam, ...]
    model: bf.Model
    duration: float
    velocity: bf.RigidVelocity | None

    def solve(self, model: bf.Model | None = None, like: bf.Solution | None = None, **asked: Any) -> bf.Solution:
        """Return the motion of the model, or of one with other elements; like: one that has the same rows anyway."""
        step = self.duration / STEPS
        return bf.simulate(model or self.model, self.duration, step, velocity=self.velocity, save_every=EVERY, **asked)

    def positions(self, solution: bf.Solution) -> np.ndarray:
        """Return the positions (points, rows, 2) [m] of points along all beams."""
        return np.array([solution.position(beam.at(x)) for beam in self.beams for x in ALONG.tolist()])


def motion(seed: int, elements: Any = "auto", element: Any = None) -> Motion:
    """Return the motion of a seed with some elements."""
    still, built = build(seed, 4, bf.CRBF(8)), build(seed, elements, element)
    frequency = bf.solve_modes(still.model, 4).elastic[0]
    rng = np.random.default_rng(10**7 + seed)
    period = 1.0 / float(frequency)
    kinds: dict[str, Callable[[float], float] | None] = {
        "at once": None,
        "pulse": lambda t: np.sin(np.pi * t / (0.4 * period)) ** 2 if t < 0.4 * period else 0.0,
        "swinging": lambda t: np.sin(5.0 * t / period),
    }
    loads = [replace(load, amplitude=kinds[str(rng.choice(list(kinds)))]) for load in built.model.loads]
    if rng.random() < 0.5:
        height = rng.uniform(0.02, 0.5) * system_of(still.model, static=True).extent
        loads.append(bf.Gravity((0.0, -8.0 * height / period**2)))
    flies = rng.random() < 0.3
    spin = rng.uniform(-4.0, 4.0) / period
    return Motion(
        built.beams,
        replace(built.model, loads=tuple(loads), supports=() if flies else built.model.supports),
        period * rng.uniform(0.5, 1.5),
        bf.RigidVelocity((0.0, 0.1 / period), spin) if flies else None,
    )


def _exact(seed: int) -> tuple[np.ndarray, float]:
    """Return the positions (points, rows, 2) [m] of the reference, and its own error."""
    fine, half = (motion(seed, elements, bf.CRBF(8)) for elements in (FINE, FINE // 2))
    exact, near = (each.positions(each.solve()) for each in (fine, half))
    return exact, float(np.linalg.norm(exact - near, axis=2).max())


def effectivities(seed: int) -> list[tuple[str, float, float]]:
    """Return relative true error and effectivity of the positions on a random mesh, nothing without a reference."""
    rng = np.random.default_rng(10**6 + seed)
    order = int(rng.integers(1, 9))
    few = motion(seed, max(round((24 // order) ** rng.random()), 1), bf.CRBF(order))
    exact, doubt = _exact(seed)
    size = system_of(few.model, static=False).extent
    solution, estimate, _ = motion_attempt(few.model, few.solve)
    error = float(np.linalg.norm(few.positions(solution) - exact, axis=2).max())
    return [("positions", error / size, estimate * size / error)] if error > max(1e-8 * size, 10.0 * doubt) else []


def refinements(seed: int) -> list[tuple[float, ...]]:
    """Return accuracy, true error over it, unknowns over those of the best uniform mesh found, and seconds."""
    exact, doubt = _exact(seed)
    size = system_of(motion(seed, 1).model, static=False).extent
    uniform = []
    for order in (2, 4, 6, 8):
        for elements in (1, 2, 3, 4, 6, 8, 12, 16, 24):
            each = motion(seed, elements, bf.CRBF(order))
            try:
                error = float(np.linalg.norm(each.positions(each.solve()) - exact, axis=2).max()) / size
            except bf.BeamfemError:
                continue
            uniform.append((each.model.size, error))
            if error < ACCURACIES[-1]:
                break
    result: list[tuple[float, ...]] = []
    for accuracy in ACCURACIES:
        if doubt > 0.1 * accuracy * size:
            continue
        each, begun = motion(seed), time.perf_counter()
        try:
            solution = each.solve(accuracy=accuracy)
        except bf.BeamfemError:
            result.append((accuracy, *(np.nan,) * 3))
            continue
        seconds = time.perf_counter() - begun
        error = float(np.linalg.norm(each.positions(solution) - exact, axis=2).max()) / size
        best = min((each[0] for each in uniform if each[1] <= accuracy), default=np.nan)
        result.append((accuracy, error / accuracy, solution.model.size / best, seconds))
    return result


def print_effectivities(found: list[tuple[str, float, float]]) -> None:
    """Print the distribution of effectivities where the error is below 5 %."""
    ratio = np.array([each[2] for each in found if each[1] < 0.05])
    near, within = (ratio >= 0.5) & (ratio <= 2.0), (ratio >= 0.2) & (ratio <= 5.0)
    print(f"{ratio.size} errors, effectivity 0.5..2 in {_share(near)} %, 0.2..5 in {_share(within)} %, "
          f"below 0.1 in {_share(ratio < 0.1)} %, median {np.median(ratio):.2f}")  # fmt: skip


def print_refinements(found: list[tuple[float, ...]]) -> None:
    """Print a line for each accuracy; refused are those of which no mesh is said to be fine enough."""
    print(f"{'accuracy':<9}{'motions':>8} {'refused':>7} {'met %':>6} {'largest':>8} {'>1/100 %':>9} "
          f"{'unknowns/best':>14} {'<1.5 %':>7} {'seconds':>8}")  # fmt: skip
    for accuracy in ACCURACIES:
        table = np.array([each[1:] for each in found if each[0] == accuracy]).reshape(-1, 3)
        ratio, unknowns, seconds = table[np.isfinite(table[:, 0])].T
        if ratio.size:
            print(f"{accuracy:<9g}{len(table):>8} {len(table) - len(ratio):>7} {_share(ratio <= 1.0):>6} "
                  f"{ratio.max():>8.2f} {_share(ratio > 0.01):>9} {np.nanmedian(unknowns):>14.2f} "
                  f"{_share(unknowns <= 1.5):>7} {np.median(seconds):>8.2f}")  # fmt: skip


def main(first: int = 0, effectivity: int = 30, accuracy: int = 30) -> None:
    """Print both tables for so many motions each from a first seed."""
    warnings.simplefilter("ignore")
    for title, function, number, show in (
        ("Effectivity", effectivities, effectivity, print_effectivities),
        ("Meshes to an accuracy", refinements, accuracy, print_refinements),
    ):
        found, without = _of_all(function, range(first, first + number))
        print(f"{title}, of {number} random motions; without a reference or an estimate: {dict(without)}")
        if found:
            show(found)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
