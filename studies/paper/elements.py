"""Comparison of all elements: a cantilever under P L^2 / (E I) = 5, L/h = 10 and 100.

All have as many nodes (24 intervals). Each is judged against its own limit: structural forces against Reissner's beam
and the elastic line against the extensible elastica, both by shooting; continuum forces against a graded mesh of
order 8 with the same coordinates. Paper: sections 3, 4 and 5 compare three of them.
"""

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.convergence.refinement_curve import extrapolate, fit_order, order_of_three
from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.fields import Cubic, Lagrange
from beamfem.view.html_page import Entry, Part, Table
from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.paper.elastica import tip_displacement
from studies.paper.terminal import show

FIELDS = (Cubic(), *(Lagrange(order) for order in (1, 2, 3, 4, 8)))
COORDINATES = (Gradients(), Rotation(), ShearFree(True), ShearFree(False))
FORCES = (bf.Structural(), bf.ContinuumMechanics(), bf.ContinuumMechanics(True), bf.SplitContinuum(), bf.ElasticLine())
SLENDERNESS = (10, 100)
MODULUS, RATIO, SHEAR_FACTOR, LOAD = 2e11, 0.3, 5.0 / 6.0, 5.0
INTERVALS = 24  # between nodes, in the table
MESHES = {1: (24, 48, 96, 192), 2: (6, 12, 24, 48), 3: (4, 8, 16), 4: (2, 3, 4, 6, 8), 8: (1, 2, 3, 4)}
# of an elastic line over whose r_xx round-off grows fastest: beyond, Newton's residual never gets small enough
LINE_MESHES = (12, 24, 48)
# boundary layers as deep as the section lie at both ends
_LAYERS = [0.0, 0.00125, 0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.15, 0.25, 0.35, 0.5]
GRADED = (*_LAYERS, *(1.0 - x for x in _LAYERS[-2::-1]))
REISSNER, ELASTICA, FINE, OWN = "Reissner", "elastica", "order 8", "extrapolated"


@dataclass(frozen=True)
class Found:
    """One element at one slenderness: coordinates, error (of L), order (nan where none), iterations, steps, time."""

    element: bf.Element
    slenderness: int
    coordinates: int
    error: float
    limit: str
    order: float
    iterations: int
    steps: int
    milliseconds: float


def combinations() -> Iterator[bf.Element]:
    """Every combination that is not refused; of cubic ones with gradients or rotations without the reduced ones."""
    for field, coordinates, forces, integration in product(FIELDS, COORDINATES, FORCES, ("full", "reduced", "lobatto")):
        plain_cubic = field.name == "cubic" and not isinstance(coordinates, ShearFree)
        if integration == "reduced" and plain_cubic:
            continue  # as the full ones to a thousandth of the error
        try:
            yield bf.Element(field, coordinates, forces, integration)
        except bf.InputError:
            continue


def model(element: bf.Element, elements: int | tuple[float, ...], slenderness: float) -> bf.Model:
    """Return the cantilever, 1 m long."""
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness, SHEAR_FACTOR)
    mesh = elements if isinstance(elements, int) else list(elements)
    material = bf.Material(MODULUS, RATIO, 7800.0)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), mesh, element, section, material)
    force = LOAD * MODULUS * section.second_moment
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))])


def tip(solution: bf.Solution) -> np.ndarray:
    """Return the tip displacement (2,) [m] at the full load."""
    return solution.displacement(solution.model.beams[0].end)[-1]


@cache
def limit(element: bf.Element, slenderness: float) -> tuple[np.ndarray, str] | None:
    """Return the tip displacement (2,) [m] that an element converges to and where it is from; None: no closed form.

    Shear-rigid coordinates under full integration are exactly 1.2 times as stiff in shear, and with a fixed |r_x| in
    stretch. With continuum forces the square of the shear enters the stretch, and again the bubble that carries it has
    another mean square than the square of its mean, unless 2 Gauss points take all.
    """
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness, SHEAR_FACTOR)
    rigidity = section.rigidity(bf.Material(MODULUS, RATIO, 7800.0))
    force = LOAD * rigidity.bending
    tied = isinstance(element.coordinates, ShearFree)
    stretchable = element.coordinates == ShearFree(True)
    factor = 1.2 if tied and element.integration == "full" else 1.0
    axial = rigidity.axial * (1.0 if stretchable else factor)
    if isinstance(element.forces, bf.Structural):
        return np.array(tip_displacement(1.0, (0.0, force), rigidity.bending, axial, factor * rigidity.shear)), REISSNER
    if isinstance(element.forces, bf.ElasticLine):
        return np.array(tip_displacement(1.0, (0.0, force), rigidity.bending, axial)), ELASTICA
    if stretchable or (tied and element.integration != "reduced"):
        return None
    coordinates = Rotation() if tied else element.coordinates
    fine = bf.Element(Lagrange(8), coordinates, element.forces)
    return tip(bf.solve_static(model(fine, GRADED, slenderness))), FINE


def compare(element: bf.Element, slenderness: int, repeats: int = 3) -> Found:
    """Return what is measured of one element; its time is the least of `repeats` solves, at least of one."""
    degree = 1 if element.field.name == "cubic" else element.field.degree
    elements = INTERVALS // degree
    meshes = LINE_MESHES if isinstance(element.forces, bf.ElasticLine) else MESHES[degree]
    solved, times = {}, []
    for count in (*meshes, *[elements] * (repeats - 1)):
        begun = time.process_time()
        solved[count] = bf.solve_static(model(element, count, slenderness))
        if count == elements:
            times.append(1e3 * (time.process_time() - begun))
    sizes, values = 1.0 / np.array(meshes), np.array([tip(solution) for solution in solved.values()])
    known, source = limit(element, slenderness) or (_extrapolated(sizes, values), OWN)
    errors = np.abs(values - known).max(axis=1)
    if source == OWN:
        order = order_of_three(sizes[-3:], values[-3:, 1])  # needs no limit
    else:
        fit = fit_order(sizes, errors) if errors[-1] < 0.01 else None
        order = fit.order if fit else float("nan")
    shown = solved[elements]
    return Found(
        element,
        slenderness,
        shown.model.size,
        float(errors[meshes.index(elements)]),
        source,
        order,
        shown.iterations,
        shown.statistics.steps,
        min(times),
    )


def _extrapolated(sizes: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the tip displacement (2,) [m] for size 0 of values (meshes, 2)."""
    return np.array([extrapolate(sizes[-3:], component[-3:]).limit for component in values.T])


def main(
    elements: Iterable[bf.Element] | None = None, slenderness: tuple[int, ...] = SLENDERNESS, repeats: int = 3
) -> list[Found]:
    """Return what is measured of each element at each slenderness.

    Parameters
    ----------
    elements : iterable of Element, optional
        Elements, by default all combinations.
    slenderness : tuple of int, [-]
        Slenderness L / h.
    repeats : int
        Number of solves of which the fastest is the time.
    """
    chosen = combinations() if elements is None else elements
    return [compare(element, ratio, repeats) for element in chosen for ratio in slenderness]


def forces_name(element: bf.Element) -> str:
    """Say which elastic forces an element has."""
    if isinstance(element.forces, bf.ContinuumMechanics):
        return "continuum, plane stress" if element.forces.plane_stress else "continuum, 3D"
    return element.forces.name.replace("-", " ")


def table(found: list[Found]) -> Table:
    """Return one row for each element."""
    ratios = sorted({one.slenderness for one in found})
    rows = []
    for element in dict.fromkeys(one.element for one in found):
        same = [one for ratio in ratios for one in found if one.element == element and one.slenderness == ratio]
        cells = [element.field.name, element.coordinates.name, forces_name(element), element.integration]
        cells += [str(same[0].coordinates), same[0].limit]
        for one in same:
            steps = f" in {one.steps} steps" if one.steps > 1 else ""
            order = "" if np.isnan(one.order) else f"{one.order:.1f}"
            cells += [f"{one.error:.1e}", order, f"{one.iterations}{steps}", f"{one.milliseconds:.1f}"]
        rows.append(cells)
    header = ["field", "coordinates", "forces", "integration", "size", "limit"]
    for ratio in ratios:
        header += [f"error at L/h = {ratio}", "order", "iterations", "ms"]
    remark = (
        f"All with {INTERVALS + 1} nodes; size: coordinates in all; error: largest of u and v at the tip, over L; "
        "order: of the least-squares line through the finest meshes that lie on one (extrapolated: of the three finest "
        "values), empty where the element still locks or the error does not fall; ms: CPU time, best of 3, warm, the "
        "model made anew. Limits: Reissner's beam and the extensible elastica by shooting (shear-rigid coordinates "
        "under full integration: with 1.2 times the shear stiffness, and with a fixed |r_x| 1.2 times E A); order 8: "
        "22 elements "
        "of order 8 with the same coordinates, graded towards both ends; extrapolated: from its own finest meshes, "
        "because the square of the shear enters the stretch and the limit is a little different from that of "
        "rotations. A fixed |r_x| with the elastic line comes to the elastica up to (N / (E A))^2 only. Order k with k "
        "points falls with 2 k; continuum forces on gradients have boundary layers of the thickness at the ends, which "
        "uniform meshes of high order feel first. Orders other than 2 of cubic and bilinear elements with continuum "
        "forces at L/h = 100 are "
        "not the last word: a director that is linear between two nodes is shorter in the middle, the thickness "
        "stiffness resists that, and this locking falls with the fourth power until the second order shows."
    )
    return Table("Cantilever, P L^2 / (E I) = 5", header, rows, remark)


def _drawn() -> dict[str, tuple[bf.Element, tuple[int, ...]]]:
    structural = bf.Structural()
    return {
        "bilinear CRBF, full": (bf.BilinearCRBF(structural), (6, 12, 24, 48, 96)),
        "bilinear CRBF, 1 point": (bf.CRBF(1), (6, 12, 24, 48, 96)),
        "ANCF/CRBF, full": (bf.ANCFCRBF(structural, "full"), (6, 12, 24, 48, 96)),
        "ANCF/CRBF, lobatto": (bf.ANCFCRBF(structural), (6, 12, 24, 48, 96)),
        "CRBF, order 2": (bf.CRBF(2), (3, 6, 12, 24)),
        "CRBF, order 4": (bf.CRBF(4), (1, 2, 4, 6, 8, 12)),
        "CRBF, order 8": (bf.CRBF(8), (1, 2, 3, 4)),
    }


def draw(folder: Path, slenderness: int = 100) -> Path:
    """Draw the error over the number of coordinates for structural forces; return the picture."""
    canvas, axes = new_figure(5.6, 4.0)
    for i, (label, (element, meshes)) in enumerate(_drawn().items()):
        found = limit(element, slenderness)
        assert found is not None
        solved = [bf.solve_static(model(element, count, slenderness)) for count in meshes]
        errors = [np.abs(tip(solution) - found[0]).max() for solution in solved]
        axes.loglog([s.model.size for s in solved], errors, "os^vDP*"[i] + "-", color=COLOURS[i], label=label)
    ticks = (20, 50, 100, 200, 500)
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel("coordinates")
    axes.set_ylabel("error of the tip / L")
    axes.legend(frameon=False, fontsize=8, loc="lower left")
    path = folder / "error.svg"
    save_figure(canvas, path)
    save_figure(canvas, path.with_suffix(".png"))
    return path


def part(folder: Path) -> Part:
    """Run all, draw, and return the part of the page."""
    found = table(main())
    sentence = (
        "Reissner's beam, L/h = 100. The bilinear element with full integration locks; with one point it converges "
        "with order 2, as the cubic ones do. Order 4 with 4 points falls with order 8, order 8 with order 16: one "
        "element of order 8 (27 coordinates) is right to 2e-7, 96 of ANCF/CRBF (485 coordinates) to 1.3e-5."
    )
    entry = Entry("Error over the number of coordinates", draw(folder), "", sentence)
    text = "A cantilever bends by 0.7 L under a dead tip force, nu = 0.3, k_s = 5/6, E I nominal for all forces."
    return Part("Elements compared", text, [entry], [found])


if __name__ == "__main__":
    show(part(Path("out/elements")))
