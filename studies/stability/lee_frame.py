"""Lee's frame: two rigidly joined members on hinges that snap through and back.

Lee, Manuel and Rossow, Large deflections and stability of elastic frames, J. Eng. Mech. Div. ASCE 94, 1968.
L = 120 cm, A = 6 cm^2, I = 2 cm^4, E = 7.2e6 N/cm^2, nu = 0.3; dead load P down on the beam, 0.2 L from the corner.
References: collocation of the Reissner beam, no elements.
"""

import time
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure

LIMITS = ((18544.52709, 26.8783276616, 48.7542403782), (-9392.48964, 90.1770006077, 58.2249580457))  # N, u, w [cm]
OUT = Path("out/lee_frame")


def trace(element: bf.Element | None = None, elements: int = 10, youngs_modulus: float = 7.2e6) -> bf.Path:
    """Return the path until the load point is 95 cm down; elements: of each member."""
    section, material = bf.Section(area=6.0, second_moment=2.0), bf.Material(youngs_modulus, 0.3, 2.7e-5)
    element = element or bf.CRBF(4)
    column = bf.Beam(bf.Line((0, 0), (0, 120)), elements, element, section, material)
    beam = bf.Beam(bf.Line((0, 120), (120, 120)), elements, element, section, material)
    model = bf.Model(
        [column, beam],
        supports=[bf.Pin(column.start), bf.Pin(beam.end)],
        joints=[bf.Rigid(column.end, beam.start)],
        loads=[bf.PointForce(beam.at(0.2), (0.0, -1.0))],
        units="N, cm",
    )
    return bf.trace_equilibrium(model, until=lambda state: state.displacement(beam.at(0.2))[1] < -95.0)


def moved(found: bf.Path | bf.PathState) -> np.ndarray:
    """Return u to the right and w down [cm] of the load point."""
    return found.displacement(found.model.beams[1].at(0.2)) * (1.0, -1.0)


def main(orders: tuple[int, ...] = (1, 2, 4), elements: int = 10) -> dict[int, bf.Path]:
    """Return the path for each order of the elements.

    Parameters
    ----------
    orders : tuple of int
        Orders of the elements.
    elements : int
        Number of elements of each member.
    """
    return {order: trace(bf.CRBF(order), elements) for order in orders}


def draw(paths: dict[int, bf.Path], folder: Path = OUT) -> None:
    """Draw load against displacement of the load point, and the shapes of the finest path."""
    figure, axes = new_figure()
    for i, (order, path) in enumerate(paths.items()):
        u, w = moved(path).T
        axes.plot(w, path.load_factor / 1000, "-", color=COLOURS[i], label=f"w, order {order}")
        axes.plot(u, path.load_factor / 1000, "--", color=COLOURS[i], label=f"u, order {order}")
    for load, u, w in LIMITS:
        axes.plot([u, w], [load / 1000] * 2, "o", color="black", markersize=4)
    axes.set_xlabel("displacement of the load point [cm]")
    axes.set_ylim(-15.0, 40.0)
    axes.set_ylabel("load [kN]")
    axes.legend(frameon=False)
    save_figure(figure, folder / "path.svg")
    list(paths.values())[-1].plot(folder / "shapes.svg")


if __name__ == "__main__":
    begun = time.perf_counter()
    paths = main()
    for order, path in paths.items():
        print(f"order {order}: {len(path)} points, {path.iterations} iterations, ended: {path.statistics.ended}")
        for found, (load, u, w) in zip(path.limit_points, LIMITS, strict=True):
            error = found.load_factor / load - 1
            print(f"  limit {found.load_factor:12.4f} N, reference {load:12.4f} N, error {error:8.1e}", end="")
            print(f"; u, w {moved(found).round(5)} cm, reference {u:.5f} {w:.5f}")
    draw(paths)
    print(f"{time.perf_counter() - begun:.1f} s; figures in {OUT}")
