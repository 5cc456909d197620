"""Deep circular arches of 215 degrees under a dead load on the crown: limit points and sidesway.

DaDeppo and Schmidt, Instability of clamped-hinged circular arches subjected to a point load, J. Appl. Mech. 42, 1975:
P R^2 / EI = 8.97 clamped-hinged. References: elastica by collocation and shooting, no elements. L / h = 5000 here.
The hinged arch sways at 3.2763 before its symmetric limit point at 9.4631; the clamped-hinged one has no symmetry.
"""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, new_figure, save_figure

HALF = np.deg2rad(107.5)
LIMITS = {"clamped-hinged": 8.97308996972, "hinged-hinged": 9.463108888550, "clamped-clamped": 9.26073844}
SIDESWAY = 3.2762821409
ENDS = {"clamped": bf.Clamp, "hinged": bf.Pin}
OUT = Path("out/deep_arches")


@dataclass(frozen=True)
class Run:
    """The path from load factor 0, and the branches that leave its first bifurcation to both sides, if any."""

    path: bf.Path
    branches: tuple[bf.Path, ...]


def arch(ends: str, elements: int, order: int, slenderness: float) -> bf.Model:
    """Return an arch with R = EI = 1; ends: such as "clamped-hinged", left end first."""
    thickness = 2.0 * HALF / slenderness
    stiffness = 12.0 / thickness**2
    section = bf.Section.from_stiffness(stiffness, stiffness * 5 / 6 / 2.6, 1.0, 1.0, 1.0)
    curve = bf.Arc((0, 0), 1.0, 0.5 * np.pi + HALF, 0.5 * np.pi - HALF)
    beam = bf.Beam(curve, elements, bf.CRBF(order), section)
    first, last = (ENDS[name] for name in ends.split("-"))
    return bf.Model([beam], [first(beam.start), last(beam.end)], [bf.PointForce(beam.at(0.5), (0.0, -1.0))])


def crown(found: bf.Path | bf.PathState) -> np.ndarray:
    """Return u to the right and w down of the crown, in units of R."""
    return found.displacement(found.model.beams[0].at(0.5)) * (1.0, -1.0)


def main(elements: int = 24, order: int = 4, slenderness: float = 5000.0, depth: float = 1.6) -> dict[str, Run]:
    """Return the paths for each pair of ends.

    Parameters
    ----------
    elements : int
        Number of elements.
    order : int
        Order of the elements.
    slenderness : float, [-]
        Slenderness L / h of the arches.
    depth : float, [-]
        Displacement of the crown, over R, at which the paths end.
    """
    runs = {}
    for ends in LIMITS:
        model = arch(ends, elements, order, slenderness)
        path = bf.trace_equilibrium(model, until=lambda state: crown(state)[1] > depth)
        branches = [
            bf.trace_equilibrium(model, until=lambda state: crown(state)[1] > 0.9, start=crossing, direction=side)
            for crossing in path.bifurcations[:1]
            for side in (1, -1)
        ]
        runs[ends] = Run(path, tuple(branches))
    return runs


def draw(runs: dict[str, Run], folder: Path = OUT) -> None:
    """Draw load against the deflection of the crown, and shapes of each arch."""
    figure, axes = new_figure()
    for i, (ends, run) in enumerate(runs.items()):
        axes.plot(crown(run.path)[:, 1], run.path.load_factor, "-", color=COLOURS[i], label=ends)
        for found in (*run.path.limit_points, *run.path.bifurcations):
            marker = "x" if isinstance(found, bf.Bifurcation) else "o"
            axes.plot(crown(found)[1], found.load_factor, marker, color=COLOURS[i])
        for branch in run.branches[:1]:
            axes.plot(crown(branch)[:, 1], branch.load_factor, "--", color=COLOURS[i], label=f"{ends}, swaying")
            branch.plot(folder / f"shapes-{ends}-sway.svg", shapes=6)
        run.path.plot(folder / f"shapes-{ends}.svg", shapes=6)
    axes.set_xlabel("deflection of the crown / R")
    axes.set_ylabel("P R$^2$ / EI")
    axes.legend(frameon=False)
    save_figure(figure, folder / "paths.svg")


if __name__ == "__main__":
    begun = time.perf_counter()
    runs = main()
    for ends, run in runs.items():
        first = run.path.limit_points[0]
        error = first.load_factor / LIMITS[ends] - 1
        print(f"{ends:16s} limit {first.load_factor:.8f} ({LIMITS[ends]:.8f}, {error:8.1e}) at u, w {crown(first)} R")
        for found in run.path.bifurcations:
            error = found.load_factor / SIDESWAY - 1
            print(
                f"{'':16s} sidesway {found.load_factor:.8f} ({SIDESWAY:.8f}, {error:8.1e}) at w {crown(found)[1]:.7f} R"
            )
        for branch in run.branches:
            print(f"{'':16s} branch ends at load {branch.load_factor[-1]:.5f}, u, w {crown(branch)[-1]} R")
    draw(runs)
    print(f"{time.perf_counter() - begun:.1f} s; figures in {OUT}")
