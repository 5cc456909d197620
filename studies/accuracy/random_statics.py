"""Random static models: quality of the error estimates, and cost of meshes refined to an accuracy.

Beams and frames, straight and curved, tapered and layered, under forces, followers, pressure, moments, distributed
loads and actuation, each the same for the same seed. True errors are those against 48 elements of order 8 a beam (256
of its own for cubic kinds). Models whose reference has no equilibrium, and errors below ten times its own, which half
as many elements tell, are left out.
"""

import sys
import time
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

import beamfem as bf
from beamfem.equations.system import system_of

ACCURACIES = (1e-2, 1e-4, 1e-6, 1e-8)
UNIFORM = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)  # elements a beam, of every order
FINE = 48
_REFERENCES = (FINE // 2, FINE), (128, 256)  # elements a beam of Lagrange and of cubic fields
CUBIC = {"ANCF": bf.ANCF(bf.Structural()), "shear-rigid": bf.ShearRigid()}
STEEL, BRASS = bf.Material(2e11, 0.3, 7850.0), bf.Material(1e11, 0.34, 8500.0)
ALONG = np.linspace(0.0, 1.0, 33)[1:]
Random = np.random.Generator


@dataclass(frozen=True)
class Built:
    """A model and its beams."""

    beams: tuple[bf.Beam, ...]
    model: bf.Model

    def positions(self, solution: bf.Solution) -> np.ndarray:
        """Return the positions (n, 2) [m] of points along all beams in the last row."""
        return np.array([solution.position(beam.at(x))[-1] for beam in self.beams for x in ALONG.tolist()])


def build(seed: int, elements: Any = "auto", element: Any = None) -> Built:
    """Return the model of a seed with some elements."""
    rng = np.random.default_rng(seed)
    height, taper = 10.0 ** rng.uniform(-3.0, -1.3), rng.uniform(-0.5, 0.5) * (rng.random() < 0.3)
    layered = rng.random() < 0.15
    mesh = {"elements": elements} | ({} if element is None else {"element": element})
    beams, joints = [], []
    for curve in _curves(rng):

        def section(s: float, length: float = curve.length) -> Any:
            h = height * (1.0 + taper * s / length)
            return (
                bf.Layered((bf.Layer(STEEL, 0.6 * h), bf.Layer(BRASS, 0.4 * h)), 0.02)
                if layered
                else bf.Rectangle(0.02, h)
            )

        beams.append(
            bf.Beam(curve, section=section if taper else section(0.0), material=None if layered else STEEL, **mesh)
        )
    if len(beams) > 1:
        joints = [(bf.Rigid if rng.random() < 0.7 else bf.Hinge)(beams[0].end, beams[1].start)]
    clamped = [bf.Clamp(beams[0].start)]
    if isinstance(joints and joints[0], bf.Hinge) or rng.random() < 0.3:
        clamped.append((bf.Pin if rng.random() < 0.7 else bf.Clamp)(beams[-1].end))
    stiffness = STEEL.youngs_modulus * 0.02 * height**3 / 12.0
    loads = [
        _load(rng, beams[rng.integers(len(beams))], stiffness, len(clamped) > 1) for _ in range(rng.integers(1, 3))
    ]
    return Built(tuple(beams), bf.Model(beams, clamped, loads, joints))


def _curves(rng: Random) -> list[bf.Curve]:
    kind = rng.choice(["line", "arc", "wave", "spline", "polyline", "frame"])
    rise, turn = rng.uniform(-0.3, 0.3), rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 4.0)
    if kind == "arc":
        return [bf.Arc((0.0, 0.0), 1.0 / abs(turn), 0.0, turn)]
    if kind == "wave":
        waves = rng.uniform(0.5, 3.0)
        return [bf.Parametric(lambda u: (u, rise * np.sin(waves * np.pi * u)), 0.0, 1.0)]
    corners = [(0.0, 0.0), *((x, float(rng.uniform(-0.5, 0.5))) for x in (0.4, 0.7)), (1.0, rise)]
    if kind == "spline":
        return [bf.BSpline(3, (0.0,) * 4 + (1.0,) * 4, corners)]
    if kind == "polyline":
        return [bf.Polyline(corners[:3])]
    if kind == "frame":
        return [bf.Line(corners[0], corners[1]), bf.Line(corners[1], corners[3])]
    return [bf.Line((0.0, 0.0), (1.0, rise))]


def _load(rng: Random, beam: bf.Beam, stiffness: float, held: bool) -> Any:
    length = beam.curve.length
    size = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-1.0, 1.0 if held else 0.7)
    at, angle = beam.at(float(rng.choice([0.3, 0.5, 1.0]))), rng.uniform(0.0, 2.0 * np.pi)
    force = size * stiffness / length**2
    vector = (force * np.cos(angle), force * np.sin(angle))
    kinds: dict[str, Callable[[], Any]] = {
        "force": lambda: bf.PointForce(at, vector),
        "follower": lambda: bf.PointForce(at, vector, follower=True),
        "moment": lambda: bf.PointMoment(at, force * length),
        "pressure": lambda: bf.Pressure(beam, force / length),
        "spread": lambda: bf.DistributedLoad(beam, lambda s: (0.0, 2.0 * force / length * np.sin(4.0 * s / length))),
        "actuation": lambda: bf.Actuation(beam, curvature=lambda s: size / length * np.cos(3.0 * s / length)),
    }
    return kinds[str(rng.choice(list(kinds)))]()


def effectivities(seed: int) -> list[tuple[str, float, float]]:
    """Return quantity, relative true error and effectivity of results of a random mesh; nothing without a reference."""
    rng = np.random.default_rng(10**6 + seed)
    kind = rng.choice([*CUBIC, *range(1, 9)])
    element = CUBIC.get(kind) or bf.CRBF(int(kind))
    most = 16 if kind in CUBIC else 64 // int(kind)
    few = build(seed, max(round(most ** rng.random()), 1), element)
    best = element if kind in CUBIC else bf.CRBF(8)
    models = [few, *(build(seed, elements, best) for elements in _REFERENCES[kind in CUBIC])]
    solutions = [bf.solve_static(each.model) for each in models]
    found: list[tuple[str, list[Any], Any]] = []
    for name, quantity in {
        "displacement": lambda s, b: s.displacement(b.beams[-1].at(0.5))[-1],
        "reaction": lambda s, b: s.reaction(b.beams[0].start)[-1],
        "largest moment": lambda s, b: max(abs(s.section_forces(beam).peak("moment").value) for beam in b.beams),
        "peak stress": lambda s, b: max(s.stresses(beam).peak("von_mises").value for beam in b.beams),
    }.items():
        estimate = solutions[0].error(lambda s, quantity=quantity: quantity(s, few))
        found.append((name, [quantity(s[-1:], b) for s, b in zip(solutions, models, strict=True)], estimate))
    shapes = [bf.solve_modes(each.model, 3) for each in models]
    found += [
        ("frequency", [each.frequencies[i] for each in shapes], shapes[0].error(i))
        for i in range(min(3, len(shapes[0])))
    ]
    result = []
    for name, (value, near, limit), estimate in found:
        size, error, doubt = (np.linalg.norm(each) for each in (limit, limit - value, limit - near))
        if error > max(1e-8 * size, 10.0 * doubt):
            result.append((name, float(error / size), float(np.linalg.norm(estimate) / error)))
    return result


def refinements(seed: int) -> list[tuple[float, float, float, float, float]]:
    """Return accuracy, true error over it, and unknowns over those of the best and of bilinear uniform meshes, and
    time.

    The time is that of the solve with an accuracy over that of a solve with the best uniform mesh.
    """
    fine = build(seed, FINE, bf.CRBF(8))
    extent = system_of(fine.model, static=True).extent
    exact = fine.positions(bf.solve_static(fine.model))

    def error_of(built: Built, solution: bf.Solution) -> float:
        return float(np.linalg.norm(built.positions(solution) - exact, axis=1).max()) / extent

    uniform = []
    for order in range(1, 9):
        for elements in UNIFORM:
            built = build(seed, elements, bf.CRBF(order))
            begun = time.perf_counter()
            try:
                solution = bf.solve_static(built.model)
            except bf.BeamfemError:
                continue
            seconds = time.perf_counter() - begun
            uniform.append((built.model.size, error_of(built, solution), order, seconds))
            if uniform[-1][1] < ACCURACIES[-1]:
                break
    result = []
    for accuracy in ACCURACIES:
        built = build(seed)
        begun = time.perf_counter()
        try:
            solution = bf.solve_static(built.model, accuracy=accuracy)
        except bf.BeamfemError:
            result.append((accuracy, *(np.nan,) * 4))
            continue
        seconds = time.perf_counter() - begun
        enough = [each for each in uniform if each[1] <= accuracy]
        best = min(enough, default=(np.nan,) * 4)
        size, error, *_ = max(each for each in uniform if each[2] == 1)
        bilinear = size * max(error / accuracy, 1e-30) ** 0.5  # by its order, 2
        bilinear = min([each[0] for each in enough if each[2] == 1], default=bilinear)
        unknowns = solution.model.size
        result.append(
            (accuracy, error_of(built, solution) / accuracy, unknowns / best[0], unknowns / bilinear, seconds / best[3])
        )
    return result


def _of_all(function: Callable[[int], list[Any]], seeds: Iterable[int]) -> tuple[list[Any], dict[str, int]]:
    """Return the results of all seeds, and how often there was none, by the reason."""
    results, without = [], defaultdict[str, int](int)
    for seed in seeds:
        try:
            results += function(seed)
        except bf.BeamfemError as reason:
            without[type(reason).__name__] += 1
    return results, without


def _share(condition: np.ndarray) -> str:
    return f"{100.0 * np.mean(condition):5.1f}" if condition.size else "    -"


def print_effectivities(found: list[tuple[str, float, float]]) -> None:
    """Print a line for each quantity."""
    print(f"{'quantity':<16}{'errors':>7} {'0.5..2 %':>9} {'0.2..5 %':>9} {'<0.1 %':>7} {'median':>7}")
    for name in dict.fromkeys(each[0] for each in found):
        ratio = np.array([each[2] for each in found if each[0] == name and each[1] < 0.05])
        near, within = (ratio >= 0.5) & (ratio <= 2.0), (ratio >= 0.2) & (ratio <= 5.0)
        print(
            f"{name:<16}{ratio.size:>7} {_share(near):>9} {_share(within):>9} {_share(ratio < 0.1):>7} "
            f"{np.median(ratio):>7.2f}"
        )


def print_refinements(found: list[tuple[float, float, float, float, float]]) -> None:
    """Print a line for each accuracy; refused are those of which no mesh is said to be fine enough."""
    print(
        f"{'accuracy':<9}{'models':>7} {'refused':>7} {'met %':>6} {'largest':>8} {'>1/100 %':>9} "
        f"{'unknowns/best':>14} {'<1.5 %':>7} {'<1/5 of bilinear %':>19} {'time/best':>10} {'<4 %':>6}"
    )
    for accuracy in ACCURACIES:
        table = np.array([each[1:] for each in found if each[0] == accuracy])
        ratio, unknowns, bilinear, seconds = table[np.isfinite(table[:, 0])].T
        print(
            f"{accuracy:<9g}{len(table):>7} {len(table) - len(ratio):>7} {_share(ratio <= 1.0):>6} {ratio.max():>8.2f} "
            f"{_share(ratio > 0.01):>9} {np.nanmedian(unknowns):>14.2f} {_share(unknowns <= 1.5):>7} "
            f"{_share(bilinear <= 0.2):>19} {np.nanmedian(seconds):>10.1f} {_share(seconds <= 4.0):>6}"
        )


def main(first: int = 0, effectivity: int = 100, accuracy: int = 20) -> None:
    """Print both tables for so many models each from a first seed."""
    warnings.simplefilter("ignore")
    for title, function, count, show in (
        ("Effectivity where the error is below 5 %", effectivities, effectivity, print_effectivities),
        ("Meshes to an accuracy", refinements, accuracy, print_refinements),
    ):
        found, without = _of_all(function, range(first, first + count))
        print(f"{title}, of {count} random models; without a reference or an estimate: {dict(without)}")
        if found:
            show(found)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
