"""Cost of one model of a study with few elements, from `Beam(...)` to the displacement of the tip.

Beside a model that is made anew, with other measures, stiffness and length each time: the same model with another load,
made by `with_loads`, and a ready model that is solved again.
"""

from collections.abc import Callable
from itertools import count
from pathlib import Path

import beamfem as bf
from beamfem.tables import as_text, write_csv
from studies.benchmarks.peer_cases import STRUCTURAL
from studies.benchmarks.peer_clock import in_turns

OUT = Path("out/bench")
ELEMENTS = {"bilinear": STRUCTURAL, "order 2": bf.CRBF(2), "order 4": bf.CRBF(4), "ANCF": bf.ANCF()}
HEADER = ("element", "elements", "fresh, ms", "median", "other load, ms", "median", "solved again, ms", "median")


def model(element: bf.Element, elements: int, load: float, size: float = 1.0) -> bf.Model:
    """Return a cantilever; load [N], size: factor of all its measures [-]."""
    section = bf.Rectangle(width=0.01 * size, height=0.01 * size)
    steel = bf.Material(youngs_modulus=2e11 * size, poisson_ratio=0.3, density=7800.0)
    beam = bf.Beam(bf.Line((0.0, 0.0), (size, 0.0)), elements, element, section, steel)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, load))])


def tip(made: bf.Model) -> float:
    """Return how far the tip moves up [m]."""
    return float(bf.solve_static(made).displacement(made.beams[0].end)[-1, 1])


def tasks(element: bf.Element, elements: int) -> tuple[Callable[[], float], ...]:
    """Return the three tasks of a row."""
    number, ready = count(), model(element, elements, 20.0)
    end = ready.beams[0].end
    return (
        lambda: tip(model(element, elements, 20.0, 1.0 + 1e-9 * next(number))),
        lambda: tip(ready.with_loads([bf.PointForce(end, (0.0, 20.0 + 1e-6 * next(number)))])),
        lambda: tip(ready),
    )


def main(sizes: tuple[int, ...] = (4, 12), rounds: int = 50, folder: Path = OUT) -> list[tuple[object, ...]]:
    """Measure all sizes, print the table and write it as CSV.

    Parameters
    ----------
    sizes : tuple of int
        Numbers of elements.
    rounds : int
        Number of times each model is made and solved.
    folder : Path
        Folder of the table.
    """
    rows: list[tuple[object, ...]] = []
    for name, element in ELEMENTS.items():
        for elements in sizes:
            timings = in_turns(tasks(element, elements), rounds)
            rows.append((name, elements, *(time for own in timings for time in (own.least, own.median))))
    print(as_text(HEADER, rows, "fresh small models, CPU time"))
    write_csv(folder / "fresh.csv", HEADER, rows)
    return rows


if __name__ == "__main__":
    main()
