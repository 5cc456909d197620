"""A straight beam rolls up into one circle and into two, under an end moment 2 pi EI / L and twice that.

With structural forces and the elastic line it closes; so it does with continuum forces up to the square of its strain,
where EI is that of their own (1.346 times at nu = 0.3, 1.099 times in plane stress). Paper: section 4 asks how far the
director of neighbouring nodes may turn.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product
from math import atan, pi
from pathlib import Path

import numpy as np
from scipy.optimize import brentq, root

import beamfem as bf
from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.fields import Cubic, Lagrange
from beamfem.element.forces import Forces
from beamfem.view.html_page import Entry, Part, Table
from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.paper.terminal import show

STEEL = bf.Material(2e11, 0.3, 7800.0)
FIELDS = {Cubic(): 48, Lagrange(1): 48, Lagrange(2): 24, Lagrange(4): 8, Lagrange(6): 4}
COORDINATES = (Gradients(), Rotation(), ShearFree(True), ShearFree(False))
FORCES = (bf.Structural(), bf.ElasticLine(), bf.ContinuumMechanics(), bf.ContinuumMechanics(True), bf.SplitContinuum())
STARTS = (1, 8, 32)  # load steps to begin with, of continuum forces
COUNTS = {4: 8, 6: 4}  # elements of each order
SLENDERNESS = (10, 100, 1000, 10000)


@dataclass(frozen=True)
class Rolled:
    """How far the tip is from the clamp over L, how many turns it made, load steps, iterations; nan where it failed."""

    gap: float
    turns: float
    steps: int
    iterations: int
    failed: str = ""


def combinations() -> Iterator[tuple[bf.Element, int]]:
    """Every combination that is not refused, in the integration it is meant for, and how many elements."""
    for field, coordinates, forces in product(FIELDS, COORDINATES, FORCES):
        reduced = field != Cubic() or (isinstance(coordinates, ShearFree) and forces.fills_body)
        try:
            yield bf.Element(field, coordinates, forces, "reduced" if reduced else None), FIELDS[field]
        except bf.InputError:
            continue


def bending_factor(forces: Forces) -> float:
    """Return the bending stiffness of forces over E I."""
    nu = STEEL.poisson_ratio
    if not isinstance(forces, bf.ContinuumMechanics):
        return 1.0
    return 1.0 / (1.0 - nu**2) if forces.plane_stress else (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


def model(element: bf.Element, elements: int, slenderness: float, turns: float) -> bf.Model:
    """Return the beam, 1 m long, with the moment that shall roll it up."""
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    moment = turns * 2 * pi * bending_factor(element.forces) * STEEL.youngs_modulus * section.second_moment
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), elements, element, section, STEEL)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)])


def roll(element: bf.Element, elements: int, slenderness: float, turns: float, starts: Iterable[int] = (1,)) -> Rolled:
    """Return the run with the fewest iterations of those that begin with each number of load steps."""
    best = Rolled(np.nan, np.nan, 0, 0, "not tried")
    for steps in starts:
        try:
            solution = bf.solve_static(model(element, elements, slenderness, turns), steps=steps)
        except bf.ConvergenceError as error:
            if best.failed:
                found = error.solution.load_factor[-1]
                best = Rolled(np.nan, np.nan, 0, 0, f"ends at load factor {found:.3f}")
            continue
        if best.failed or solution.iterations < best.iterations:
            end = solution.model.beams[0].end
            gap = float(np.linalg.norm(solution.position(end)[-1]))
            turned = float(solution.rotation(end)[-1]) / (2 * pi)
            best = Rolled(gap, turned, solution.statistics.steps, solution.iterations)
        if best.steps == 1:
            break
    return best


def bilinear_turns(elements: int, turns: float = 1.0) -> float:
    """Return the turns of bilinear elements with one point and structural forces in closed form.

    Half the angle between neighbouring directors, x, makes a curvature 2 tan(x) / l at the midpoint, where they are
    interpolated as vectors; the moment does work on x: tan x + tan^3 x = pi turns / elements.
    """
    tangent = brentq(lambda t: t + t**3 - pi * turns / elements, 0.0, 10.0, xtol=1e-15)
    return elements * 2 * atan(tangent) / (2 * pi)


def uniform_turns(forces: Forces, coordinates: Gradients | Rotation, slenderness: float, turns: float) -> float:
    """Return the turns of a continuum that is bent uniformly, r0' = g t and d = e n; nan where it cannot be.

    Stationary energy of a = (g^2 - 1)/2, b = -g e k, c = (e k)^2/2 and eyy = (e^2 - 1)/2 over the section; e = 1 where
    rotations hold it. Clamps, which hold e too, are not in it.
    """
    area, second, fourth = slenderness**-2, slenderness**-4 / 12.0, slenderness**-6 / 80.0
    coupled = STEEL.lame_lambda(forces.plane_stress) if isinstance(forces, bf.ContinuumMechanics) else 0.0
    stiff = coupled + 2 * STEEL.shear_modulus if coupled else STEEL.youngs_modulus
    full = turns * 2 * pi * bending_factor(forces) * STEEL.youngs_modulus * second
    free = isinstance(coordinates, Gradients)

    def unbalanced(x: np.ndarray, moment: float) -> list[float]:
        g, k, e = x if free else (*x, 1.0)
        a, b, c, eyy = 0.5 * (g * g - 1), -g * e * k, 0.5 * (e * k) ** 2, 0.5 * (e * e - 1)
        to_a = stiff * (area * a + second * c) + coupled * area * eyy
        to_b = stiff * second * b
        to_c = stiff * (second * a + fourth * c) + coupled * second * eyy
        to_eyy = stiff * area * eyy + coupled * (area * a + second * c)
        along, turning = to_a * g - to_b * e * k, to_c * e * e * k - to_b * g * e
        thick = to_eyy * e - to_b * g * k + to_c * e * k * k
        return [along / (stiff * area), turning / full - moment, *([thick / (stiff * area)] if free else [])]

    found = np.array([1.0, 0.0, 1.0] if free else [1.0, 0.0])
    for moment in np.linspace(0.0, 1.0, 41)[1:]:
        solved = root(unbalanced, found, args=(moment,), tol=1e-13)
        if np.abs(solved.fun).max() > 1e-9:
            return float("nan")
        found = solved.x
    return float(found[1]) / (2 * pi)


@dataclass(frozen=True, eq=False)
class RollUp:
    """Runs by element and turns, at L/h = 100; of one step and order 4 and 6 by (order, L/h); the 12 bilinear ones by
    what they are run with."""

    all: dict[tuple[bf.Element, int], Rolled]
    thin: dict[tuple[int, int], Rolled]
    bilinear: dict[str, Rolled]


def main(
    elements: Iterable[tuple[bf.Element, int]] | None = None,
    slenderness: tuple[int, ...] = SLENDERNESS,
    starts: tuple[int, ...] = STARTS,
) -> RollUp:
    """Roll up elements of every combination, unless some are given, into one and two circles.

    Parameters
    ----------
    elements : iterable of (Element, int), optional
        Elements, each with the number of them, by default all combinations.
    slenderness : tuple of int, [-]
        Slenderness L / h, for elements of order 4 and 6.
    starts : tuple of int
        Numbers of load steps to begin with, tried one after the other.
    """
    structural = bf.Structural()
    kinds = {
        "1 Gauss point, structural": bf.CRBF(1),
        "full, structural": bf.BilinearCRBF(structural),
        "1 Gauss point, continuum, plane stress": bf.CRBF(1, bf.ContinuumMechanics(True)),
        "full, continuum, plane stress": bf.BilinearCRBF(bf.ContinuumMechanics(True)),
    }
    return RollUp(
        {
            (element, turns): roll(element, count, 100, turns, starts if turns == 1 else (1,))
            for element, count in (combinations() if elements is None else elements)
            for turns in (1, 2)
        },
        {(order, ratio): roll(bf.CRBF(order), COUNTS[order], ratio, 1) for order in (4, 6) for ratio in slenderness},
        {name: roll(element, 12, 100, 1) for name, element in kinds.items()},
    )


def _draw(path: Path) -> None:
    """Draw the beam at quarters of the moment, and 12 bilinear elements beside the circle."""
    canvas, axes = new_figure(5.2, 4.0)
    fractions = np.linspace(0.0, 1.0, 97)
    for i, share in enumerate((0.25, 0.5, 0.75, 1.0)):
        axis = _axis(bf.CRBF(4), 8, share, fractions)
        axes.plot(*axis.T, color=COLOURS[0], alpha=0.25 + 0.25 * i, label="8 of order 4" if share == 1.0 else None)
    axis = _axis(bf.CRBF(1), 12, 1.0, np.linspace(0.0, 1.0, 13))
    axes.plot(*axis.T, "o--", color=COLOURS[1], markersize=4, label="12 bilinear, 1 point")
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.legend(frameon=False)
    save_figure(canvas, path)
    save_figure(canvas, path.with_suffix(".png"))


def _axis(element: bf.Element, elements: int, turns: float, fractions: np.ndarray) -> np.ndarray:
    solution = bf.solve_static(model(element, elements, 100, turns))
    beam = solution.model.beams[0]
    return np.array([solution.position(beam.at(fraction))[-1] for fraction in fractions])


def _cells(run: Rolled) -> list[str]:
    if run.failed:
        return [run.failed, "", ""]
    steps = f"{run.iterations} in {run.steps} steps" if run.steps > 1 else f"{run.iterations}"
    return [f"{run.gap:.1e}", f"{run.turns:.8f}", steps]


def _tables(result: RollUp) -> list[Table]:
    rows = []
    for element in dict.fromkeys(element for element, _ in result.all):
        name = element.forces.name.replace("-", " ")
        name += ", plane stress" if getattr(element.forces, "plane_stress", False) else ""
        held = Gradients() if isinstance(element.coordinates, Gradients) else Rotation()
        body = isinstance(element.forces, bf.ContinuumMechanics) or (element.forces.fills_body and held == Rotation())
        row = [element.field.name, element.coordinates.name, name, str(FIELDS[element.field])]
        for turns in (1, 2):
            expected = uniform_turns(element.forces, held, 100, turns) if body else float(turns)
            known = body or not element.forces.fills_body
            row += [f"{expected:.8f}" if known else "", *_cells(result.all[element, turns])]
        rows.append(row)
    header = ["field", "coordinates", "forces", "elements"]
    for turns in ("one", "two"):
        header += [f"{turns}: turns expected", "gap / L", "turns", "iterations"]
    everything = Table(
        "Rolled up, L/h = 100",
        header,
        rows,
        "Reduced integration (k points, 2 of shear-rigid ones); on the cubic field the Lobatto points with structural "
        "forces and the elastic line, full with continuum forces on gradients or rotations. Expected: structural "
        "forces and elastic line as many as the moment says; continuum "
        "forces a little more, the energy of uniform bending (at the clamp gradients bend a little differently). Load "
        f"steps and iterations for one circle: fewest of beginning with {', '.join(map(str, STARTS))} steps.",
    )
    thin = Table(
        "One circle, structural forces, rotations, k points",
        ["order", "elements", "L/h", "gap / L", "turns", "iterations"],
        [[str(order), str(COUNTS[order]), str(ratio), *_cells(run)] for (order, ratio), run in result.thin.items()],
    )
    bilinear = Table(
        "12 bilinear CRBF elements, moment for one circle, L/h = 100",
        ["integration, forces", "gap / L", "turns", "iterations"],
        [[name, *_cells(run)] for name, run in result.bilinear.items()],
        f"With one Gauss point and structural forces they turn {bilinear_turns(12):.6f} of a circle at any thickness: "
        "n atan(t) / pi turns where t + t^3 = pi / n, because the director is interpolated and not its angle. "
        "Full integration locks in shear; continuum forces lock because the director is shorter between the nodes.",
    )
    return [everything, thin, bilinear]


def part(folder: Path) -> Part:
    """Run, draw, and return the part of the page."""
    result = main()
    _draw(folder / "rollup.svg")
    four, six = result.thin[4, 100], result.thin[6, 100]
    sentence = (
        f"8 elements of order 4 close to {four.gap:.1e} L in {four.iterations} iterations, {COUNTS[6]} of order 6 to "
        f"{six.gap:.1e} L in {six.iterations}, in one load step from the straight beam at any thickness. 12 bilinear "
        f"elements with one point turn {result.bilinear['1 Gauss point, structural'].turns:.4f} of the circle."
    )
    entries = [Entry("A quarter, a half, three quarters and all of a circle", folder / "rollup.svg", "", sentence)]
    text = (
        "L = 1 m, E = 2e11 Pa, nu = 0.3, clamped at the start, moment 2 pi E I / L at the end, E I of its own forces."
    )
    return Part("Roll-up", text, entries, _tables(result))


if __name__ == "__main__":
    show(part(Path("out/rollup")))
