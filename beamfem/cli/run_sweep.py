"""`beamfem run` of a model file with a sweep."""

import time
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from beamfem.cli.report import FAILED, print_json

if TYPE_CHECKING:
    from beamfem.cli.modelfile.read import Job
    from beamfem.sweeps.result import Sweep


def run_sweep(
    job: "Job", out: Path | None, vtk: Path | None, plot: Path | None, colour: str | None, as_json: bool, quiet: bool
) -> None:
    """Solve every point, print the table and write it; exit with 1 if a point failed. Raises InputError."""
    from beamfem.assembly.compiled import tell_of_compilation
    from beamfem.cli.modelfile.sweep import solve_sweep
    from beamfem.cli.targets import require_target
    from beamfem.errors import InputError

    if vtk is not None or colour is not None:
        raise InputError(f"{'--vtk' if vtk else '--colour'} is for one solution, and {job.file} has a sweep")
    for name in ("curves", "files"):
        if getattr(job, name):
            raise InputError(
                f"{job.file} has [[{name}]], which are of one solution, and a sweep; leave one of them out"
            )
    require_target("table", out)
    require_target("curve", plot)
    if plot is not None and not any(all(map(_is_number, parameter.values)) for parameter in job.varied):
        raise InputError(f"--plot draws over a key whose values are numbers, and {job.file} varies none")
    if not quiet:
        tell_of_compilation()
    start = time.perf_counter()
    try:
        sweep = solve_sweep(job)
    except KeyboardInterrupt as error:
        partial = getattr(error, "sweep", None)
        if partial is not None and out is not None:
            partial.to_csv(out)
            error.add_note(f"The points computed before are in {out}.")
        raise
    seconds = time.perf_counter() - start
    if out is not None:
        sweep.to_csv(out)
    if plot is not None:
        sweep.plot(path=plot)
    written = [str(path) for path in (out, plot) if path is not None]
    if as_json:
        print_json(_result(job, sweep, seconds, written))
    elif not quiet:
        print(job.title)
        print(f"{job.kind}: {seconds:.2f} s; numbers are in {job.model.units}")
        print(sweep.report())
        for path in written:
            print(f"wrote {path}")
    if sweep.failures:
        raise typer.Exit(FAILED)


def _result(job: "Job", found: "Sweep", seconds: float, written: list[str]) -> dict[str, object]:
    return {
        "title": job.title,
        "file": str(job.file),
        "analysis": job.kind,
        "seconds": seconds,
        "points": found.table(),
        "failures": [str(failure) for failure in found.failures],
        "written": written,
    }


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
