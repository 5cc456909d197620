"""Stress-free curved beams: a thin ring against Castigliano, a tapered ring, rings on splines and polygons.

Reference for the quarter ring: Reissner's curved beam by shooting; for a spline and a polygon of it order 8 on a fine
mesh. Paper, section 2: a stress-free curved beam measures its strains against its own reference.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.convergence.refinement_curve import fit_order
from beamfem.element.coordinates import Gradients
from beamfem.element.fields import Lagrange
from beamfem.view.html_page import Entry, Part, Table
from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.paper.elastica import tip_displacement
from studies.paper.terminal import show

STEEL = bf.Material(2e11, 0.3, 7800.0)
SMALL = 1e-5  # H R^2 / (E I) of the linear problem
LOAD, THIN = 2.0, 50  # P R^2 / (E I) and R/h of the quarter ring
Shape = Callable[[], bf.Element]
ELEMENTS: dict[str, tuple[Shape, int]] = {  # and the degree of r0, for equal numbers of nodes
    "bilinear CRBF, full": (lambda: bf.BilinearCRBF(bf.Structural()), 1),
    "bilinear CRBF, 1 point": (lambda: bf.CRBF(1), 1),
    "CRBF, order 2": (lambda: bf.CRBF(2), 2),
    "CRBF, order 3": (lambda: bf.CRBF(3), 3),
    "CRBF, order 4": (lambda: bf.CRBF(4), 4),
    "CRBF, order 8": (lambda: bf.CRBF(8), 8),
    "ANCF/CRBF, structural": (lambda: bf.ANCFCRBF(bf.Structural()), 1),
    "ANCF/CRBF, elastic line": (lambda: bf.ANCFCRBF(bf.ElasticLine()), 1),
    "shear-rigid, stretchable": (lambda: bf.ShearRigid(), 1),
    "shear-rigid": (lambda: bf.ShearRigid(False), 1),
    "ANCF, structural": (lambda: bf.ANCF(bf.Structural()), 1),
    "order 4, gradients, structural": (lambda: _gradients(4), 4),
}
CONVERGING = (
    "bilinear CRBF, full",
    "bilinear CRBF, 1 point",
    "CRBF, order 2",
    "CRBF, order 3",
    "CRBF, order 4",
    "ANCF/CRBF, structural",
    "ANCF, structural",
)


def _gradients(order: int) -> bf.Element:
    return bf.Element(Lagrange(order), Gradients(), bf.Structural())


def displaced(
    curve: bf.Curve, element: bf.Element, elements: int, section: bf.Rectangle, *forces: tuple[float, float]
) -> list[np.ndarray]:
    """Return the tip displacement (2,) [m] of a beam along a curve, clamped at its start, under each of some forces."""
    beam = bf.Beam(curve, elements, element, section, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, forces[0])])
    models = [model.with_loads([bf.PointForce(beam.end, force)]) for force in forces]
    return [bf.solve_static(each).displacement(beam.end)[-1] for each in models]


def castigliano(element: bf.Element, elements: int, thinness: float) -> np.ndarray:
    """Return the tip displacement (2,) of a half ring that is pulled in over Castigliano's.

    M = H R sin, N = -H sin, Q = H cos of the angle: u_x = H pi/2 (R^3/(E I) + R/(E A) + R/(k_s G A)) and
    u_y = 2 H R^3/(E I).
    The mean of a small pull and a small push is free of what is quadratic in the load.
    """
    section = bf.Rectangle(1.0 / thinness, 1.0 / thinness)
    rigidity = section.rigidity(STEEL)
    force = SMALL * rigidity.bending
    flexibility = 1.0 / rigidity.bending + 1.0 / rigidity.axial
    if not isinstance(element.forces, bf.ElasticLine):
        flexibility += 1.0 / rigidity.shear
    exact = force * np.array([0.5 * np.pi * flexibility, -2.0 / rigidity.bending])
    ring = bf.Arc((0.0, 0.0), 1.0, 0.0, np.pi)
    pushed, pulled = displaced(ring, element, elements, section, (force, 0.0), (-force, 0.0))
    return 0.5 * (pushed - pulled) / exact


def tapered(element: bf.Element, elements: int) -> bf.Solution:
    """Pull the tapered half ring open."""
    beam = bf.Beam(
        bf.Arc(center=(0, 0), radius=1.0, start_angle=0.0, end_angle=np.pi),
        elements,
        element,
        lambda s: bf.Rectangle(width=0.05, height=0.06 - 0.01 * s),
        bf.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1200.0),
    )
    model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (-20.0, 0.0))])
    return bf.solve_static(model)


def tip(solution: bf.Solution) -> np.ndarray:
    """Return where the end of the beam is (2,) [m]."""
    return solution.position(solution.model.beams[0].end)[-1]


QUARTER = bf.Arc((0.0, 1.0), 1.0, -0.5 * np.pi, 0.0)  # from the origin along x, bending up
SPANS, SIDES = 4, 8


def curves() -> dict[str, tuple[bf.Curve, int]]:
    """The quarter ring, a cubic spline through 5 of its points and tangents, and the polygon through 9; and of how many
    pieces they are."""
    at = np.linspace(0.0, QUARTER.length, SPANS + 1)
    spline = bf.spline_through_hermite(at, QUARTER.position(at), QUARTER.tangent(at))
    corners = QUARTER.position(np.linspace(0.0, QUARTER.length, SIDES + 1))
    return {
        "arc": (QUARTER, 1),
        "cubic B-spline, 4 spans": (spline, SPANS),
        "polygon, 8 sides": (bf.Polyline([tuple(point) for point in corners]), SIDES),
    }


def quarter_section() -> tuple[bf.Rectangle, tuple[float, float]]:
    """Return the section of the quarter ring and the force at its end [N], across the clamp."""
    section = bf.Rectangle(1.0 / THIN, 1.0 / THIN)
    return section, (0.0, LOAD * STEEL.youngs_modulus * section.second_moment)


@cache
def quarter_limit(name: str) -> np.ndarray:
    """Return the tip displacement (2,) [m] of the quarter ring: of the arc by shooting, else by order 8."""
    section, force = quarter_section()
    if name == "arc":
        g = section.rigidity(STEEL)
        return np.array(tip_displacement(QUARTER.length, force, g.bending, g.axial, g.shear, curvature=1.0))
    return displaced(curves()[name][0], bf.CRBF(8), 16, section, force)[0]


@dataclass(frozen=True, eq=False)
class Convergence:
    """Errors [m] of the tip of a quarter ring over the numbers of elements, and the fitted order (nan where none)."""

    meshes: tuple[int, ...]
    errors: np.ndarray
    order: float


def converge(name: str, element: bf.Element, degree: int) -> Convergence:
    """Return how an element converges on a curve; elements end where pieces of it do."""
    curve, pieces = curves()[name]
    section, force = quarter_section()
    first = {1: 8, 2: 4, 3: 4, 4: 2, 8: 1}[degree]
    meshes = tuple(max(first, pieces) * factor for factor in ((1, 2, 4, 8) if degree < 4 else (1, 2, 4)))
    found = np.array([displaced(curve, element, count, section, force)[0] for count in meshes])
    errors = np.abs(found - quarter_limit(name)).max(axis=1)
    fit = fit_order(1.0 / np.array(meshes), errors)
    return Convergence(meshes, errors, fit.order if fit else float("nan"))


@dataclass(frozen=True, eq=False)
class Curved:
    """Castigliano: relative errors (2,) by element and R/h; tapered: solution by element; quarter: convergence by curve
    and element."""

    castigliano: dict[tuple[str, int], np.ndarray]
    tapered: dict[str, bf.Solution]
    quarter: dict[tuple[str, str], Convergence]


def tapered_elements() -> dict[str, tuple[bf.Element, int]]:
    """Kinds of elements for the tapered ring, about 36 node intervals each, and their number."""
    full = {name: (shape(), 36 // degree) for name, (shape, degree) in ELEMENTS.items() if degree != 8}
    continuum = {
        "CRBF, order 4, continuum, 3D": (bf.CRBF(4, bf.ContinuumMechanics()), 9),
        "CRBF, order 4, continuum, plane stress": (bf.CRBF(4, bf.ContinuumMechanics(True)), 9),
        "CRBF, order 4, split": (bf.CRBF(4, bf.SplitContinuum()), 9),
        "ANCF, continuum, plane stress": (bf.ANCF(bf.ContinuumMechanics(True)), 36),
        "ANCF/CRBF, continuum, plane stress": (bf.ANCFCRBF(bf.ContinuumMechanics(True)), 36),
    }
    return full | continuum


def main(intervals: int = 24, thinness: tuple[int, ...] = (10, 100, 1000)) -> Curved:
    """Run all three: the thin ring, the tapered ring, and rings on splines and polygons.

    Parameters
    ----------
    intervals : int
        Intervals between nodes of the half ring, for any order.
    thinness : tuple of int, [-]
        Ratios R / h of the thin ring.
    """
    return Curved(
        {
            (name, ratio): castigliano(shape(), intervals // degree, ratio) - 1.0
            for name, (shape, degree) in ELEMENTS.items()
            for ratio in thinness
        },
        {name: tapered(*element) for name, element in tapered_elements().items()},
        {
            (curve, name): converge(curve, shape(), degree)
            for curve in curves()
            for name, (shape, degree) in ELEMENTS.items()
            if name in CONVERGING
        },
    )


def _draw(result: Curved, path: Path) -> None:
    canvas, axes = new_figure(5.6, 4.0)
    styles = dict(zip(curves(), ("-", "--", ":"), strict=True))
    for (curve, name), found in result.quarter.items():
        i = CONVERGING.index(name)
        shown = found.errors > 1e-14
        x, y = np.array(found.meshes)[shown], found.errors[shown]
        axes.loglog(x, y, "os^vDP*"[i] + styles[curve], color=COLOURS[i], label=name if curve == "arc" else None)
    for curve, style in styles.items():
        axes.plot([], [], style, color="0.3", label=curve)
    ticks = (2, 4, 8, 16, 32, 64)
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel("elements")
    axes.set_ylabel("error of the tip / R")
    axes.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(1.0, 0.0))
    save_figure(canvas, path)
    save_figure(canvas, path.with_suffix(".png"))


def _tables(result: Curved) -> list[Table]:
    ratios = list(dict.fromkeys(ratio for _, ratio in result.castigliano))
    header = ["element"]
    for ratio in ratios:
        header += [f"u_x, R/h = {ratio}", "u_y"]
    ring = Table(
        "Half ring pulled in by its end, relative error against Castigliano; 24 node intervals",
        header,
        [
            [name, *(f"{error:+.1e}" for ratio in ratios for error in result.castigliano[name, ratio])]
            for name in dict.fromkeys(name for name, _ in result.castigliano)
        ],
        "Structural forces but for the elastic line, whose formula has no shear. Order k with k points does not know "
        "how thin the ring is. Gradients come where rotations come, because their thickness strain is taken at the "
        "nodes of r_y; between these r_y is shorter wherever the beam bends. With continuum forces the thickness "
        "strain is that of the whole body and locks (curvature thickness locking).",
    )
    pulled = Table(
        "Tapered half ring pulled open, 36 node intervals",
        ["element", "tip x [m]", "tip y [m]", "iterations", "load steps"],
        [
            [name, *(f"{x:.8f}" for x in tip(solution)), str(solution.iterations), str(solution.statistics.steps)]
            for name, solution in result.tapered.items()
        ],
        "R = 1 m, 0.05 m wide, 0.06 - 0.01 s deep, E = 1e9 Pa, nu = 0.3, 20 N. Continuum forces bend 1.346 or 1.099 "
        "times as stiffly; split continuum and structural forces agree up to strains squared.",
    )
    rows = [
        [curve, name, " ".join(map(str, found.meshes)), *_four(found.errors), _order(found)]
        for (curve, name), found in result.quarter.items()
    ]
    arc = quarter_limit("arc")
    away = {name: np.abs(quarter_limit(name) - arc).max() for name in curves()}
    quarter = Table(
        f"Quarter ring with a force at its end, P R^2 / (E I) = {LOAD:g}, R/h = {THIN}: error of the tip [m]",
        ["curve", "element", "elements", "first", "second", "third", "fourth", "order"],
        rows,
        f"Structural forces. Against Reissner's curved beam by shooting (arc: tip {arc[0]:.12f}, {arc[1]:.12f} m), and "
        "against 16 elements of order 8 on the same spline or polygon. The spline's own limit is "
        f"{away['cubic B-spline, 4 spans']:.1e} m away from the arc's, the polygon's {away['polygon, 8 sides']:.1e} m; "
        "on each of them an element of order k converges with 2 k where elements end at its knots and corners.",
    )
    return [ring, pulled, quarter]


def _four(errors: np.ndarray) -> list[str]:
    return [f"{error:.1e}" for error in errors] + [""] * (4 - len(errors))


def _order(found: Convergence) -> str:
    return "" if np.isnan(found.order) else f"{found.order:.2f}"


def part(folder: Path) -> Part:
    """Run, draw, and return the part of the page."""
    result = main()
    _draw(result, folder / "quarter.svg")
    shown = result.tapered["CRBF, order 3"]
    for suffix in (".svg", ".png"):
        shown.plot(folder / f"tapered{suffix}")
    x, y = tip(shown)
    entries = [
        Entry(
            "Convergence on a quarter ring",
            folder / "quarter.svg",
            "",
            "Orders 1 to 4 converge with 2, 4, 6 and 8 on the arc, on a cubic spline through 5 of its points and on a "
            "polygon through 9; ANCF/CRBF with 2.",
        ),
        Entry(
            "Tapered half ring, pulled open",
            folder / "tapered.svg",
            "",
            f"12 elements of order 3 put the tip at ({x:.8f}, {y:.8f}) m, in {shown.iterations} iterations.",
        ),
    ]
    return Part(
        "Curved beams", "Every curve is stress-free as it stands; clamped at its start.", entries, _tables(result)
    )


if __name__ == "__main__":
    show(part(Path("out/curved")))
