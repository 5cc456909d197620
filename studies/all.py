"""The main job, `make run`: the paper's examples as figures, ParaView files and a page in `out/`."""

import multiprocessing
import os
import time
import warnings
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from pathlib import Path

import beamfem as bf
from beamfem.kernels.compiling import Routine
from beamfem.view.html_page import Part, write_page
from studies.mechanisms import page as mechanisms
from studies.paper import cantilever_small, curved, elements, locking, pendulum_page, rollup
from studies.stability import page as stability

OUT = Path("out")
PARTS: dict[str, Callable[[Path], Part]] = {  # by folder, as they stand on the page
    **{f"pendulum-{name}": partial(pendulum_page.part, name) for name in pendulum_page.CASES},
    "cantilever": cantilever_small.part,
    "elements": elements.part,
    "locking": locking.part,
    "curved": curved.part,
    "rollup": rollup.part,
    "frames": stability.part,
    "mechanisms": mechanisms.part,
}
LONGEST_FIRST = (
    "elements",
    "rollup",
    "pendulum-printed",
    "pendulum-thin",
    "frames",
    "mechanisms",
    "curved",
    "locking",
    "cantilever",
)
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def compile_kernels(first: int, apart: int) -> None:
    """Compile, or load, some of the kernels: each process others, where it would else be each process all."""
    for kernel in Routine.made[first::apart]:
        _ = kernel.address


def timed(folder: str) -> tuple[Part, float]:
    """Return a part of the page and the seconds that it took."""
    begun = time.perf_counter()
    with warnings.catch_warnings():  # the paper's elements lock, and its pendulum strains: that is what the page shows
        for category in (bf.LockingWarning, bf.LargeStrainWarning, bf.CoarseMeshWarning):
            warnings.simplefilter("ignore", category)
        return PARTS[folder](OUT / folder), time.perf_counter() - begun


def run_all() -> dict[str, Part]:
    """Run every part, side by side on the cores there are, each with one thread: the matrices are small."""
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))  # read by the libraries of a process as it starts
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    parts = {}
    with ProcessPoolExecutor(cores, multiprocessing.get_context("spawn")) as pool:
        list(pool.map(compile_kernels, range(cores), [cores] * cores))
        tasks = {pool.submit(timed, folder): folder for folder in LONGEST_FIRST}
        for task in as_completed(tasks):
            folder = tasks[task]
            parts[folder], seconds = task.result()
            print(f"{folder:16s} {seconds:5.1f} s", flush=True)
    return parts


def main() -> None:
    """Run everything, and print where the results are."""
    begun = time.perf_counter()
    print("compiling kernels on first use (some seconds), then computing ...", flush=True)
    parts = run_all()
    page = write_page(
        OUT / "index.html", "The paper's examples, computed by beamfem", [parts[folder] for folder in PARTS]
    )
    print(f"done in {time.perf_counter() - begun:.0f} s")
    print(f"page           {page}")
    print(f"figures        {OUT}/pendulum-printed/figure*.png, {OUT}/pendulum-thin/figure*.png")
    print(f"               {', '.join(f'{OUT}/{folder}/' for folder in PARTS if 'pendulum' not in folder)}")
    print(f"ParaView files {OUT}/pendulum-*/paraview/*.vtkhdf (ParaView 5.12 or newer), *.pvd (fewer states)")


if __name__ == "__main__":
    main()
