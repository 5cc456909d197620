"""How time and memory grow with one chain of 1000 to 1,000,000 elements; each size in a process of its own.

The cantilever under P L^2 / E I = 5 for statics, the pendulum of the paper for motion. Reported: CPU time of a ready
model an element and iteration with one thread, iterations, error of the tip, largest memory of the process, and bytes a
coordinate of it beyond that of a small model. Memory counts model, solver and what is kept of the motion: its first and
last state.
"""

import multiprocessing
import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

import beamfem as bf
from beamfem.tables import as_text, write_csv
from studies.benchmarks.peer_cases import STRUCTURAL, cantilever, pendulum, static_error

OUT = Path("out/bench")
SIZES = (1000, 10_000, 100_000, 1_000_000)
STEPS = 20
ELEMENTS = {"bilinear": STRUCTURAL, "order 2": bf.CRBF(2)}
HEADER = (
    "analysis",
    "element",
    "elements",
    "steps",
    "iterations",
    "ns an element and iteration",
    "to that of the smallest",
    "s in all",
    "error of the tip [m]",
    "peak memory [MB]",
    "bytes a coordinate",
    "remark",
)


def measure(analysis: str, name: str, elements: int) -> tuple[object, ...]:
    """Return what a row holds behind the number of elements, without the ratio to the smallest."""
    with threadpool_limits(1):
        _solve(analysis, _model(analysis, name, 4))
        before = _peak()
        model = _model(analysis, name, elements)
        seconds, remark = [], ""
        for _ in range(max(2, min(5, 100_000 // elements))):
            begun = time.process_time()
            try:
                solution = _solve(analysis, model)
            except bf.ConvergenceError as error:
                solution, remark = error.solution, str(error).partition(",")[0]
            seconds.append(time.process_time() - begun)
            if remark:
                break
    steps, iterations = solution.statistics.steps, solution.statistics.iterations
    error = static_error(solution.position(model.beams[0].end)[-1]) if analysis == "statics" else np.nan
    each = min(seconds) / max(iterations, 1) / elements * 1e9
    # a small model is lost in the memory of the libraries
    grown = (_peak() - before) / model.size if elements >= 100_000 else np.nan
    return steps, iterations, each, min(seconds), error, _peak() / 1e6, grown, remark


def _model(analysis: str, name: str, elements: int) -> bf.Model:
    return (cantilever if analysis == "statics" else pendulum)(ELEMENTS[name], elements)


def _solve(analysis: str, model: bf.Model) -> bf.Solution:
    if analysis == "statics":
        return bf.solve_static(model)
    return bf.simulate(model, STEPS * 1e-3, 1e-3, bf.GeneralizedAlpha(1.0), save_every=STEPS)


def _peak() -> float:
    """Largest memory of this process so far [bytes]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1.0 if sys.platform == "darwin" else 1024.0)


def main(sizes: tuple[int, ...] = SIZES, folder: Path = OUT) -> list[tuple[object, ...]]:
    """Measure all sizes, print the table and write it as CSV.

    Parameters
    ----------
    sizes : tuple of int
        Numbers of elements.
    folder : Path
        Folder of the table.
    """
    rows: list[tuple[object, ...]] = []
    fresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=fresh, max_tasks_per_child=1) as pool:
        for analysis in ("statics", "motion"):
            for name in ELEMENTS:
                first = np.nan
                for elements in sizes:
                    found = pool.submit(measure, analysis, name, elements).result()
                    steps, iterations, each, *rest = found
                    first = each if np.isnan(first) else first
                    rows.append((analysis, name, elements, steps, iterations, each, each / first, *rest))
                    print(
                        f"{analysis}, {name}, {elements} elements: {each:.0f} ns an element and iteration", flush=True
                    )
    print(as_text(HEADER, rows, "growth of one chain"))
    write_csv(folder / "growth.csv", HEADER, rows)
    return rows


if __name__ == "__main__":
    main()
