"""Cost of compilation: kernels of first problems of different kinds, and imports.

Each figure is of a new process, the kernels of one with an empty cache folder; problems are solved one after the other,
so that each is charged with what none before it needed. Run as a script with the argument `child` it does the work and
prints JSON.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from beamfem.tables import as_text, write_csv

OUT = Path("out/bench")
HEADER = ("kernel", "s")
_IMPORTS = "import time; a = time.process_time(); import numpy, skfem, llvmlite.binding; "
_IMPORTS += "b = time.process_time(); import beamfem; c = time.process_time(); print(b - a, c - b)"


def first_solves() -> dict[str, Any]:
    """Solve first problems one after the other; return seconds of each and of each kernel that was compiled."""
    import beamfem as bf
    from beamfem.equations.compilation_notice import compiled_here

    section, material = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)

    def cantilever(element: bf.Element) -> bf.Model:
        beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 8, element, section, material)
        return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 100.0))])

    tasks = {
        "static": lambda: bf.solve_static(cantilever(bf.CRBF(2))),
        "motion": lambda: bf.simulate(cantilever(bf.CRBF(2)), 0.01, 1e-3),
        "static of another order": lambda: bf.solve_static(cantilever(bf.CRBF(4))),
        "static of another strain measure": lambda: bf.solve_static(cantilever(bf.ANCFCRBF())),
        "static of another kind of nodes": lambda: bf.solve_static(cantilever(bf.ANCF())),
    }
    seconds = {}
    for name, task in tasks.items():
        begun = time.process_time()
        task()
        seconds[name] = time.process_time() - begun
    found = [(routine.name.removeprefix("beamfem.kernels."), routine.seconds) for routine in compiled_here()]
    return {"seconds": seconds, "kernels": sorted(found, key=lambda row: -row[1])}


def import_times(rounds: int = 5) -> tuple[float, float]:
    """Return seconds to import NumPy, scikit-fem and llvmlite, and beamfem after them; least of some processes."""
    both = [[float(x) for x in _run("-c", _IMPORTS).split()] for _ in range(rounds)]
    return min(first for first, _ in both), min(second for _, second in both)


def _run(*arguments: str, **environment: str) -> str:
    command, inherited = [sys.executable, *arguments], os.environ | environment
    return subprocess.run(command, env=inherited, capture_output=True, text=True, check=True).stdout


def main(folder: Path = OUT) -> list[tuple[str, float]]:
    """Measure compilation and imports, print the table and write it as CSV.

    Parameters
    ----------
    folder : Path
        Folder of the table.
    """
    with tempfile.TemporaryDirectory() as cache:
        cold = json.loads(_run(__file__, "child", BEAMFEM_CACHE_DIR=cache))
        warm = json.loads(_run(__file__, "child", BEAMFEM_CACHE_DIR=cache))
    rows = [tuple(row) for row in cold["kernels"]]
    print(as_text(HEADER, rows, "compiled for first problems of different kinds"))
    print(f"{len(rows)} kernels, {sum(row[1] for row in rows):.1f} s")
    for name, spent in cold["seconds"].items():
        print(f"first {name}: {spent:.1f} s with an empty cache, {warm['seconds'][name]:.2f} s in the next process")
    others, own = import_times()
    print(f"import of NumPy, scikit-fem and llvmlite {others:.2f} s, of beamfem over them {own:.2f} s")
    write_csv(folder / "compile_budget.csv", HEADER, rows)
    return rows


if __name__ == "__main__":
    if sys.argv[1:] == ["child"]:
        print(json.dumps(first_solves()))
    else:
        main()
