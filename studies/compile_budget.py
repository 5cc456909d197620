"""What the compiler costs: kernels and their specialisations of a first static problem and a first motion, and imports.

Each figure is of a new process, the kernels of one with an empty cache folder. The compiler starts on what a kernel
calls while it works on the kernel, so that each kernel has CPU seconds of its own and in all.
Run as a script with the argument `child` it does the work and prints JSON.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from beamfem.tabulate import as_text, write_csv

OUT = Path("out/bench")
HEADER = ("kernel", "specialisations", "s, itself", "s, with what it calls")
_IMPORTS = "import time; a = time.process_time(); import numpy, skfem, numba; "
_IMPORTS += "b = time.process_time(); import beamfem; c = time.process_time(); print(b - a, c - b)"


def first_solves() -> dict[str, Any]:
    """Solve a first static problem and a first motion; return seconds of each and of each kernel that was compiled."""
    from numba.core import event

    class Listener(event.Listener):
        """Keeps a stack of what is being compiled, so that each second belongs to one kernel."""

        def __init__(self) -> None:
            self.running: list[list[Any]] = []
            self.found: list[tuple[str, float, float]] = []

        def on_start(self, event: Any) -> None:
            self.running.append([event.data["dispatcher"].py_func, time.process_time(), 0.0])

        def on_end(self, event: Any) -> None:
            function, begun, inside = self.running.pop()
            spent = time.process_time() - begun
            if self.running:
                self.running[-1][2] += spent
            self.found.append((f"{function.__module__}.{function.__name__}", spent - inside, spent))

    import beamfem as bf

    listener, seconds = Listener(), {}
    with event.install_listener("numba:compile", listener):
        section, material = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
        beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 8, bf.CRBF(2), section, material)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 100.0))])
        for name, solve in (("static", bf.solve_static), ("motion", lambda model: bf.simulate(model, 0.01, 1e-3))):
            begun = time.process_time()
            solve(model)
            seconds[name] = time.process_time() - begun
    return {"seconds": seconds, "kernels": listener.found}


def rows_of(found: list[tuple[str, float, float]]) -> list[tuple[str, int, float, float]]:
    """Return a line for each kernel, the dearest first."""
    names = dict.fromkeys(name for name, _, _ in found)
    rows = []
    for name in names:
        own = [(alone, spent) for other, alone, spent in found if other == name]
        alone, spent = (sum(column) for column in zip(*own, strict=True))
        rows.append((name.removeprefix("beamfem.kernels."), len(own), alone, spent))
    return sorted(rows, key=lambda row: -row[2])


def import_times(rounds: int = 5) -> tuple[float, float]:
    """Return seconds to import NumPy, scikit-fem and numba, and beamfem after them; least of some processes."""
    both = [[float(x) for x in _run("-c", _IMPORTS).split()] for _ in range(rounds)]
    return min(first for first, _ in both), min(second for _, second in both)


def _run(*arguments: str, **environment: str) -> str:
    command, inherited = [sys.executable, *arguments], os.environ | environment
    return subprocess.run(command, env=inherited, capture_output=True, text=True, check=True).stdout


def main(folder: Path = OUT) -> list[tuple[str, int, float, float]]:
    """Measure, print the table and write it as CSV."""
    with tempfile.TemporaryDirectory() as cache:
        cold = json.loads(_run(__file__, "child", NUMBA_CACHE_DIR=cache))
        warm = json.loads(_run(__file__, "child", NUMBA_CACHE_DIR=cache))
    rows = rows_of(cold["kernels"])
    print(as_text(HEADER, rows, "compiled for a first static problem and a first motion"))
    print(f"{sum(row[1] for row in rows)} specialisations of {len(rows)} kernels, {sum(row[2] for row in rows):.1f} s")
    for name, spent in cold["seconds"].items():
        print(f"first {name}: {spent:.1f} s with an empty cache, {warm['seconds'][name]:.2f} s in the next process")
    others, own = import_times()
    print(f"import of NumPy, scikit-fem and numba {others:.2f} s, of beamfem over them {own:.2f} s")
    write_csv(folder / "compile_budget.csv", HEADER, rows)
    return rows


if __name__ == "__main__":
    if sys.argv[1:] == ["child"]:
        print(json.dumps(first_solves()))
    else:
        main()
