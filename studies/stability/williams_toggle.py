"""Williams' toggle: two shallow clamped members that snap through under a load on their crown.

Williams, An approach to the non-linear behaviour of the members of a rigid jointed plane framework with finite
deflections, Q. J. Mech. Appl. Math. 17, 1964. Half span 12.943 in, rise 0.386 in, EA = 1.885e6 lb, EI = 9274 lb in^2.
References: collocation of the Reissner beam with nu = 0.3 and k_s = 5/6, no elements.
"""

import time
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure

LIMITS = ((33.8491411685, 0.231963322934, 631.491699114), (31.2444502955, 0.39174738873, 630.387539125))  # lb, in, lb
CURVE = (  # w [in], P [lb], thrust [lb]
    (0.05, 15.180174658, 199.846554117),
    (0.1, 25.1965851474, 365.175607259),
    (0.2, 33.4816833462, 589.72752748),
    (0.3, 32.8182483129, 672.835320908),
    (0.4, 31.2651203993, 621.304434695),
    (0.5, 36.0440798889, 446.506386108),
    (0.6, 53.2188109787, 159.109941476),
    (0.7, 87.9957585627, -233.970160729),
)
OUT = Path("out/williams_toggle")


def toggle(deflection: float | None, elements: int, order: int) -> bf.Model:
    """Return the toggle under a force of 1 lb on its crown, or with a prescribed deflection [in] of it."""
    section, material = bf.Section(area=0.1885, second_moment=9.274e-4), bf.Material(1e7, 0.3, 2.5e-4)
    lines = (bf.Line((0, 0), (12.943, 0.386)), bf.Line((12.943, 0.386), (25.886, 0)))
    left, right = (bf.Beam(line, elements, bf.CRBF(order), section, material) for line in lines)
    supports: list[bf.Clamp | bf.Prescribed] = [bf.Clamp(left.start), bf.Clamp(right.end)]
    loads = [bf.PointForce(left.end, (0.0, -1.0))] if deflection is None else []
    if deflection is not None:
        supports.append(bf.Prescribed(left.end, uy=-deflection))
    return bf.Model([left, right], supports, loads, [bf.Rigid(left.end, right.start)], units="lbf, in")


def thrust(found: bf.Path | bf.PathState | bf.Solution) -> np.ndarray:
    """Return the horizontal thrust [lb] on the left clamp."""
    return np.asarray(found.reaction(found.model.beams[0].start)[..., 0])


def main(elements: int = 6, order: int = 4) -> tuple[bf.Path, list[bf.Solution]]:
    """Return the path under a force up to 90 lb, and the states at prescribed deflections of the crown.

    Parameters
    ----------
    elements : int
        Number of elements of each member.
    order : int
        Order of the elements.
    """
    controlled = [bf.solve_static(toggle(w, elements, order)) for w, _, _ in CURVE]
    return bf.trace_equilibrium(toggle(None, elements, order), until=90.0), controlled


def draw(path: bf.Path, folder: Path = OUT) -> None:
    """Draw load and thrust against the deflection of the crown, and the shapes."""
    w = -path.displacement(path.model.beams[0].end)[:, 1]
    known = np.array(CURVE).T
    for name, label, values, reference in (
        ("path", "load [lb]", path.load_factor, known[1]),
        ("thrust", "horizontal thrust [lb]", thrust(path), known[2]),
    ):
        figure, axes = new_figure()
        axes.plot(w, values, "o-", color=COLOURS[0], markersize=3, label="path")
        axes.plot(known[0], reference, "s", color="black", fillstyle="none", label="collocation")
        axes.set_xlabel("deflection of the crown [in]")
        axes.set_ylabel(label)
        axes.legend(frameon=False)
        save_figure(figure, folder / f"{name}.svg")
    path.plot(folder / "shapes.svg")


if __name__ == "__main__":
    begun = time.perf_counter()
    path, controlled = main()
    for found, (load, w, force) in zip(path.limit_points, LIMITS, strict=True):
        here = -found.displacement(path.model.beams[0].end)[1]
        print(
            f"limit {found.load_factor:.8f} lb (reference {load:.8f}), w {here:.9f} in ({w:.9f}), "
            f"thrust {thrust(found):.6f} lb ({force:.6f})"
        )
    for solution, (w, load, force) in zip(controlled, CURVE, strict=True):
        here = -solution.reaction(solution.model.beams[0].end)[-1, 1]
        print(
            f"w {w:.2f} in: P {here:.8f} lb, error {here / load - 1:8.1e}; "
            f"thrust {thrust(solution)[-1]:.6f} lb, error {thrust(solution)[-1] / force - 1:8.1e}"
        )
    draw(path)
    print(f"{time.perf_counter() - begun:.1f} s; figures in {OUT}")
