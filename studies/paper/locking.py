"""Locking by Poisson's ratio, by shear and at nodes without shear, and its remedies; paper, sections 3.3 to 5.

Poisson: transverse strain that cannot vary over the height makes continuum forces bend too stiffly; a pure end moment
measures by how much. Shear: the bilinear field with full integration. Nodes without shear (sections 1.5 and 3.5): the
cubic bubble that carries stretch and shear between them vanishes there and is 1.2 times too stiff in the mean square.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import simpson

import beamfem as bf
from beamfem.results import postprocess
from beamfem.results.axis_points import axis_at
from beamfem.view.html_page import Entry, Part, Table
from beamfem.view.plots import COLOURS, new_figure, save_figure
from studies.paper.terminal import show

MODULUS, SHEAR_FACTOR = 2e11, 5.0 / 6.0
FORCES = {
    "continuum, 3D": bf.ContinuumMechanics(),
    "continuum, plane stress": bf.ContinuumMechanics(True),
    "split": bf.SplitContinuum(),
    "structural": bf.Structural(),
    "elastic line": bf.ElasticLine(),
}
RATIOS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49)
SLENDERNESS = (2, 5, 10, 20, 50, 100, 200, 500, 1000)
SMALL = 1e-4  # slope [rad] or stretch of the linear problems


@dataclass(frozen=True, eq=False)
class Locking:
    """Factors of bending stiffness by forces over Poisson's ratios; deflections over their exact values by element over
    L/h; factors of shear and stretch stiffness by shear-rigid element and integration over the numbers of elements."""

    ratios: tuple[float, ...]
    bending: dict[str, list[float]]
    slenderness: tuple[int, ...]
    deflection: dict[str, list[float]]
    meshes: tuple[int, ...]
    shear: dict[tuple[str, str], list[float]]
    stretch: dict[tuple[str, str], list[float]]


def expected_factor(forces: str, ratio: float) -> float:
    """Return the factor of E I in closed form."""
    if forces == "continuum, 3D":
        return (1.0 - ratio) / ((1.0 + ratio) * (1.0 - 2.0 * ratio))
    return 1.0 / (1.0 - ratio**2) if forces == "continuum, plane stress" else 1.0


def beam(element: bf.Element, elements: int, slenderness: float, ratio: float = 0.3) -> bf.Beam:
    """Return a beam along x, 1 m long."""
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness, SHEAR_FACTOR)
    return bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, bf.Material(MODULUS, ratio, 7800.0))


def bending_factor(forces: str, ratio: float) -> float:
    """Return E I over the bending stiffness that a pure moment measures, at L/h = 100 and a turn of 1e-4."""
    kind = FORCES[forces]
    # r_xx, which the elastic line needs, is there in the cubic field
    bar = beam(bf.ANCFCRBF(kind) if forces == "elastic line" else bf.CRBF(4, kind), 4, 100, ratio)
    moment = SMALL * MODULUS * bar.section.second_moment
    solution = bf.solve_static(bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointMoment(bar.end, moment)]))
    return SMALL / float(solution.rotation(bar.end)[-1])


def tip_force(bar: bf.Beam) -> tuple[float, float, float]:
    """Return a small tip force [N] and the deflections that bending and shear shall give [m], Timoshenko."""
    rigidity = bar.section.rigidity(bar.material)
    unit = 1.0 / (3.0 * rigidity.bending) + 1.0 / rigidity.shear
    force = SMALL / unit
    return force, force / (3.0 * rigidity.bending), force / rigidity.shear


def deflection(element: bf.Element, elements: int, slenderness: float) -> float:
    """Return the tip deflection over that of Timoshenko's beam."""
    bar = beam(element, elements, slenderness)
    force, bending, shear = tip_force(bar)
    solution = bf.solve_static(bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointForce(bar.end, (0.0, force))]))
    return float(solution.displacement(bar.end)[-1, 1]) / (bending + shear)


def locked(elements: int, slenderness: float) -> float:
    """Return `deflection` of the bilinear element with full integration in closed form.

    A curvature k that is constant over a length l makes a shear that varies by k l: E I + k_s G A l^2 / 12 resists.
    """
    bar = beam(bf.BilinearCRBF(bf.Structural()), elements, slenderness)
    _, bending, shear = tip_force(bar)
    rigidity = bar.section.rigidity(bar.material)
    stiffer = 1.0 + rigidity.shear / (12.0 * rigidity.bending * elements**2)
    return (bending * _piecewise(elements) / stiffer + shear) / (bending + shear)


def _piecewise(elements: int) -> float:
    """Share of P L^3 / (3 E I) that a curvature has which is constant in each element."""
    return 1.0 - 1.0 / (4.0 * elements**2)


def shear_factor(element: bf.Element, elements: int) -> float:
    """Return how many times too stiff in shear a shear-rigid element is, on a thick beam, L/h = 2."""
    bar = beam(element, elements, 2)
    _, bending, shear = tip_force(bar)
    found = deflection(element, elements, 2) * (bending + shear)
    return shear / (found - bending * _piecewise(elements))


def stretch_factor(element: bf.Element, elements: int) -> float:
    """Return how many times too stiff in stretch it is."""
    bar = beam(element, elements, 2)
    force = SMALL * bar.section.rigidity(bar.material).axial
    solution = bf.solve_static(bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointForce(bar.end, (force, 0.0))]))
    return SMALL / float(solution.displacement(bar.end)[-1, 0])


def shear_elements(elements: int) -> dict[str, tuple[bf.Element, int]]:
    """Elements with about as many coordinates and how many of each."""
    return {
        "bilinear, full": (bf.BilinearCRBF(bf.Structural()), elements),
        "bilinear, 1 point": (bf.CRBF(1), elements),
        "order 2, full": (bf.CRBF(2, integration="full"), elements // 2),
        "order 2, 2 points": (bf.CRBF(2), elements // 2),
        "order 3, full": (bf.CRBF(3, integration="full"), elements // 3),
        "cubic ANCF/CRBF, full": (bf.ANCFCRBF(bf.Structural(), "full"), elements),
    }


def main(
    ratios: tuple[float, ...] = RATIOS,
    slenderness: tuple[int, ...] = SLENDERNESS,
    elements: int = 12,
    meshes: tuple[int, ...] = (1, 2, 8, 32),
) -> Locking:
    """Measure the effect of Poisson's ratio, locking in shear, and nodes without shear.

    Parameters
    ----------
    ratios : tuple of float, [-]
        Poisson's ratios.
    slenderness : tuple of int, [-]
        Slenderness L / h at which locking in shear is measured.
    elements : int
        Number of bilinear elements for it; elements of order n are n times fewer.
    meshes : tuple of int
        Numbers of elements without shear at their nodes.
    """
    rigid = {
        (bf.ShearRigid(stretchable).name, integration): bf.ShearRigid(stretchable, integration=integration)
        for stretchable in (True, False)
        for integration in ("full", "reduced", "lobatto")
    }
    return Locking(
        ratios,
        {forces: [bending_factor(forces, ratio) for ratio in ratios] for forces in FORCES},
        slenderness,
        {
            name: [deflection(element, count, ratio) for ratio in slenderness]
            for name, (element, count) in shear_elements(elements).items()
        },
        meshes,
        {key: [shear_factor(element, count) for count in meshes] for key, element in rigid.items()},
        {key: [stretch_factor(element, count) for count in meshes] for key, element in rigid.items()},
    )


@dataclass(frozen=True, eq=False)
class Stresses:
    """Second Piola-Kirchhoff stress xx [Pa] (points,) along the arc length [m], on the axis and on the upper face, and
    that of Timoshenko's beam; at_nodes: the largest component xx, yy, xy on the axis there; mean: of the axis; nodes:
    their arc lengths [m]."""

    arc_length: np.ndarray
    axis: np.ndarray
    face: np.ndarray
    exact_axis: float
    exact_face: np.ndarray
    at_nodes: float
    mean: float
    nodes: np.ndarray


def stresses(elements: int = 4, integration: str = "reduced", points: int = 41) -> Stresses:
    """Pull and bend a shear-rigid beam of 3 coordinates a node with continuum forces, nu = 0; L/h = 10."""
    element = bf.ShearRigid(False, bf.ContinuumMechanics(), integration)
    bar = beam(element, elements, 10, ratio=0.0)
    area, height = bar.section.area, 0.1
    axial, across = 1e-5 * MODULUS * area, 1e-5 * MODULUS * area / 100
    solution = bf.solve_static(bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointForce(bar.end, (axial, across))]))
    mesh = solution.model.meshes[0]
    number, xi = np.repeat(np.arange(elements), points), np.tile(np.linspace(0.0, 1.0, points), elements)
    now = axis_at(mesh, solution.p[-1:], number, xi)
    reference = postprocess.reference_axis(mesh, number, xi)
    found = []
    for y in (0.0, height / 2):
        strain = postprocess.green_strain(now, reference, np.array([y]))
        components = element.forces.stress(strain.xx, strain.yy, strain.xy, bar.material)
        found.append(np.array([part[0, :, 0] for part in components]))
    arc = mesh.arc_length(number, xi)
    at_nodes = np.isin(xi, (0.0, 1.0))
    return Stresses(
        arc,
        found[0][0],
        found[1][0],
        axial / area,
        axial / area - across * (1.0 - arc) * (height / 2) / bar.section.second_moment,
        float(np.abs(found[0][:, at_nodes]).max()),
        float(simpson(found[0][0].reshape(elements, points), x=np.linspace(0.0, 1.0, points), axis=1).mean()),
        mesh.vertices,
    )


def _draw_bending(result: Locking, path: Path) -> None:
    canvas, axes = new_figure(5.2, 3.7)
    fine = np.linspace(0.0, max(result.ratios), 100)
    for i, (forces, factors) in enumerate(result.bending.items()):
        axes.plot(fine, [expected_factor(forces, ratio) for ratio in fine], color=COLOURS[i], linewidth=1.2)
        axes.plot(result.ratios, factors, "os^vD"[i], color=COLOURS[i], markersize=8 - i, label=forces)
    axes.set_yscale("log")
    axes.set_yticks((1, 1.5, 2, 3, 5, 10, 20), ("1", "1.5", "2", "3", "5", "10", "20"))
    axes.minorticks_off()
    axes.set_xlabel("Poisson's ratio")
    axes.set_ylabel("bending stiffness / E I")
    axes.legend(frameon=False, title="marks measured, lines closed form")
    _save(canvas, path)


def _draw_shear(result: Locking, elements: int, path: Path) -> None:
    canvas, axes = new_figure(5.2, 3.7)
    fine = np.geomspace(min(result.slenderness), max(result.slenderness), 100)
    axes.semilogx(fine, [locked(elements, x) for x in fine], color="0.4", linewidth=1.2, label="closed form")
    for i, (name, values) in enumerate(result.deflection.items()):
        alone = "full" in name and "bilinear" in name
        axes.plot(result.slenderness, values, "os^vD*"[i] + ("" if alone else "-"), color=COLOURS[i], label=name)
    axes.set_xlabel("L / h")
    axes.set_ylabel("tip deflection / Timoshenko's")
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(0.0, 0.4))
    _save(canvas, path)


def _draw_stresses(found: Stresses, path: Path) -> None:
    canvas, axes = new_figure(5.2, 3.7)
    for i, (name, values, exact) in enumerate(
        (("y = 0", found.axis, np.full_like(found.axis, found.exact_axis)), ("y = h/2", found.face, found.exact_face))
    ):
        axes.plot(found.arc_length, values / 1e6, color=COLOURS[i], label=f"{name}, element")
        axes.plot(found.arc_length, exact / 1e6, "--", color=COLOURS[i], linewidth=1.2, label=f"{name}, beam theory")
    axes.plot(found.nodes, np.zeros_like(found.nodes), "o", color="black", label="nodes")
    axes.set_xlabel("arc length [m]")
    axes.set_ylabel("stress xx [MPa]")
    axes.set_ylim(-2.2, 3.2)  # room for the legend
    axes.legend(frameon=False, ncols=2, fontsize=8)
    _save(canvas, path)


def _save(canvas: object, path: Path) -> None:
    save_figure(canvas, path)
    save_figure(canvas, path.with_suffix(".png"))


def _tables(result: Locking) -> list[Table]:
    bending = Table(
        "Bending stiffness over E I, from a pure end moment; L/h = 100",
        ["forces", *(f"nu = {ratio:g}" for ratio in result.ratios)],
        [[forces, *(f"{factor:.9f}" for factor in factors)] for forces, factors in result.bending.items()],
        "Closed form: (1 - nu) / ((1 + nu)(1 - 2 nu)) for the 3D lambda, 1 / (1 - nu^2) in plane stress, else 1.",
    )
    shear = Table(
        "Tip deflection over Timoshenko's, tip force, 12 element lengths",
        ["element", *(f"L/h = {ratio:g}" for ratio in result.slenderness)],
        [[name, *(f"{value:.4f}" for value in values)] for name, values in result.deflection.items()],
        "Structural forces, 12 elements (6 of order 2, 4 of order 3). With full integration the bilinear element bends "
        "with E I + k_s G A l^2 / 12, l its length; one Gauss point or a higher order cures it.",
    )
    header = ["element", "integration"]
    for name in ("shear", "stretch"):
        header += [f"{name}, {count} element{'s' if count > 1 else ''}" for count in result.meshes]
    rigid = Table(
        "Stiffness in shear and stretch over k_s G A and E A; thick beam, L/h = 2",
        header,
        [[*key, *(f"{value:.6f}" for value in (*result.shear[key], *result.stretch[key]))] for key in result.shear],
        "Structural forces. Between nodes without shear a bubble 6 xi (1 - xi) carries it; its mean is 1 and its mean "
        "square 1.2, at the 2 Gauss points it is 1, in the middle 3/2, which at the Lobatto points counts with 4/9. "
        "So full integration is 1.2 times too stiff at every mesh, in shear, and in stretch where |r_x| = 1 is fixed; "
        "with a stretch coordinate stretch is exact. The bending part "
        "of the deflection, P L^3 / (3 E I) (1 - 1 / (4 n^2)) with n elements, is subtracted.",
    )
    return [bending, shear, rigid]


def part(folder: Path) -> Part:
    """Run, draw, and return the part of the page."""
    result, found, full = main(), stresses(), stresses(integration="full")
    _draw_bending(result, folder / "poisson.svg")
    _draw_shear(result, 12, folder / "shear.svg")
    _draw_stresses(found, folder / "stress.svg")
    solid, plane = (
        result.bending[name][result.ratios.index(0.3)] for name in ("continuum, 3D", "continuum, plane stress")
    )
    entries = [
        Entry(
            "Poisson locking",
            folder / "poisson.svg",
            "",
            f"At nu = 0.3 the 3D lambda bends {solid:.9f} times too stiffly, plane stress {plane:.9f}; split "
            "continuum, structural forces and the elastic line bend with E I at every ratio.",
        ),
        Entry(
            "Shear locking",
            folder / "shear.svg",
            "",
            "The bilinear element with full integration hardly moves when the beam is thin: 12 elements at L/h = 1000 "
            f"reach {result.deflection['bilinear, full'][-1]:.1e} of the deflection. One point, or order 2, cures it.",
        ),
        Entry(
            "Stress of the shear-rigid element with 3 coordinates a node",
            folder / "stress.svg",
            "continuum mechanics leads to zero stresses at the nodal points; the centreline of the beam is assumed to "
            "be stress free",
            "on the centreline (y = 0) all components of stress vanish at the nodes, to round-off, because |r_x| = "
            f"|r_y| = 1 and r_x.r_y = 0 are fixed there: {found.at_nodes:.0e} Pa under a pull of "
            f"{found.exact_axis:.0e} Pa. The "
            f"mean over the beam is not zero: {found.mean / found.exact_axis:.5f} of F / A with 2 Gauss points, "
            f"{full.mean / full.exact_axis:.5f} with full integration (1 / 1.2). Away from the centreline the bending "
            f"stress does not vanish at the nodes either: {found.face[0] / 1e6:.2f} MPa at the clamp, y = h/2. The "
            "stress-free centreline belongs to the coordinates at the nodes, not to the beam.",
        ),
    ]
    text = "E = 2e11 Pa, k_s = 5/6, small loads, so that every number stands beside its closed form."
    return Part("Locking", text, entries, _tables(result))


if __name__ == "__main__":
    show(part(Path("out/locking")))
