"""Lattice under compression: time, memory and iterations at four sizes, and a picture of the deformed lattice.

Squares of 1 m with one diagonal each, rigid nodes, clamped below and pressed down from above, so that members carry up
to about 40 N: less than the 51 N at which they would buckle between hinges. The lattice is our own; no literature.
"""

import resource
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import beamfem as bf
from beamfem.io.line_mesh import read_mesh
from beamfem.results.postprocess import nodal_vectors
from beamfem.view.plots import new_figure, save_figure

MESHES = Path(__file__).parents[2] / "meshes"
SECTION = bf.Rectangle(0.05, 0.05)
MATERIAL = bf.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000.0)
PRESSURE = 50.0  # [N/m]
SIDES = (20, 41, 82, 182)  # squares along each side: 1240, 5125, 20336 and 99736 members


@dataclass(frozen=True)
class Run:
    """A solved lattice with seconds for reading and numbering, and for solving; memory [MB] is the peak so far."""

    solution: bf.Solution
    members: int
    coordinates: int
    build: float
    solve: float
    memory: float


def solve(path: Path, order: int = 1) -> Run:
    """Read a lattice, press its top down and solve."""
    begun = time.perf_counter()
    mesh = read_mesh(path)
    frame = mesh.frame(elements=2, element=bf.CRBF(order), section=SECTION, material=MATERIAL)
    top = frame.points("edge=2")
    loads = [bf.PointForce(point, (0.0, -PRESSURE * _share(i, len(top)))) for i, point in enumerate(top)]
    supports = [bf.Clamp(point) for point in frame.points("edge=1")]
    model = bf.Model(frame.beams, supports, loads, frame.joints)
    coordinates = model.size  # numbers them
    built = time.perf_counter()
    solution = bf.solve_static(model)
    done = time.perf_counter()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return Run(solution, len(frame.beams), coordinates, built - begun, done - built, memory)


def _share(i: int, count: int) -> float:
    """Length [m] of the top that a node carries."""
    return 0.5 if i in (0, count - 1) else 1.0


def draw(solution: bf.Solution, path: Path, times: float = 1.0) -> Path:
    """Draw the deformed members, coloured by their change of length; displacements `times` as large."""
    from matplotlib.collections import LineCollection

    lines, strains = [], []
    for mesh in solution.model.meshes:
        position = nodal_vectors(mesh, solution.p[-1:])[0, :, 0]
        lines.append(mesh.position + times * (position - mesh.position))
        strains.append(np.linalg.norm(position[-1] - position[0]) / mesh.beam.curve.length - 1.0)
    limit = float(np.max(np.abs(strains)))
    canvas, axes = new_figure(5.4, 4.2)
    drawn = LineCollection(lines, array=1e3 * np.array(strains), cmap="coolwarm", linewidths=0.7)
    drawn.set_clim(-1e3 * limit, 1e3 * limit)
    axes.add_collection(drawn)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.figure.colorbar(drawn, label="change of length of a member [1e-3]")
    save_figure(canvas, path)
    return path


def main(sides: tuple[int, ...] = SIDES, order: int = 1) -> list[Run]:
    """Solve lattices of several sizes, and print time, memory and iterations of each.

    Parameters
    ----------
    sides : tuple of int
        Numbers of squares along each side.
    order : int
        Order of the elements.
    """
    sys.path.insert(0, str(MESHES))
    import make_meshes

    runs = []
    print("members  coordinates  build [s]  solve [s]  iterations  peak memory [MB]")
    with TemporaryDirectory() as folder:
        for side in sides:
            path = Path(folder) / f"lattice{side}.vtu"
            make_meshes.lattice(path, side, side)
            run = solve(path, order)
            runs.append(run)
            iterations = run.solution.statistics.iterations
            print(
                f"{run.members:7d}  {run.coordinates:11d}  {run.build:9.2f}  {run.solve:9.2f}  {iterations:10d}  "
                f"{run.memory:16.0f}",
                flush=True,
            )
    return runs


if __name__ == "__main__":
    bf.solve_static(solve(MESHES / "lattice.vtu").solution.model)  # compiles the kernels
    main()
    picture = draw(solve(MESHES / "lattice.vtu").solution, Path("out") / "lattice" / "deformed.png", 10.0)
    print(f"picture {picture}")
