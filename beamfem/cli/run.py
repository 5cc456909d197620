"""`beamfem run`: solve a model file."""

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamfem.cli.pictures import Colour, draw
from beamfem.cli.report import AsJson, Quiet, print_json, print_table, reported
from beamfem.cli.run_sweep import run_sweep

if TYPE_CHECKING:
    from beamfem.cli.modelfile.analyses import Found
    from beamfem.cli.modelfile.read import Job
    from beamfem.results.solution import Solution

# and the units of the numbers
_TITLES = {
    "load_factors": ("Critical load factors", ""),
    "kinds": ("Kinds", ""),
    "linearised": ("Linearised about the start", ""),
    "frequencies": ("Frequencies", "Hz"),
    "growth": ("Growth", "1/s"),
    "rigid": ("Rigid motions", ""),
    "limit_points": ("Limit points, load factor", ""),
    "bifurcations": ("Bifurcations, load factor", ""),
}


def run(
    model: Annotated[Path, typer.Argument(help="A model file (.toml), see docs/model_files.md.", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(help="Save model and states (.h5), or the table of a sweep (.csv).", show_default=False),
    ] = None,
    vtk: Annotated[Path | None, typer.Option(help="Write files for ParaView (.pvd).", show_default=False)] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw (.png, .svg, .pdf), or write a page (.html) or a film (.gif, .mp4).", show_default=False
        ),
    ] = None,
    colour: Colour = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Solve a model file, print its outputs and write its files and those given as options."""
    with reported(as_json, quiet):
        from beamfem.assembly.compiled import tell_of_compilation
        from beamfem.cli.modelfile import read_model_file
        from beamfem.cli.modelfile.files import require_saved
        from beamfem.cli.modelfile.phrases import told_in_keys, warned_in_keys
        from beamfem.cli.targets import require_target
        from beamfem.errors import ConvergenceError

        with warned_in_keys():
            job = read_model_file(model)
        if job.varied:
            run_sweep(job, out, vtk, plot, colour, as_json, quiet)
            return
        for option, target in (("out", out), ("vtk", vtk), ("plot", plot)):
            require_target(option, target)
        if out is not None:
            require_saved(job.model)
        if not quiet:
            tell_of_compilation()
        start = time.perf_counter()
        try:
            job = job.imperfect()
            found = job.solve()
        except (ConvergenceError, KeyboardInterrupt) as error:
            found_before = getattr(error, "solution", None)
            if found_before is not None and out is not None:
                found_before.save(out)
                last = float(found_before.at[-1])
                at = f"load factor {last:g}" if found_before.static else f"{last:g} {job.model.unit('s')}"
                error.add_note(f"The states found before, up to {at}, are saved in {out}.")
            raise
        seconds = time.perf_counter() - start
        with told_in_keys():
            written = _write(found.solution, out, vtk, plot, colour)
            for curve in job.curves:
                curve.draw(found.solution)
                written.append(str(curve.file))
            for file in job.files:
                file.write(found)
                written.append(str(file.file))
        result = _result(model, job, found, seconds, written)
        if as_json:
            print_json(result)
        elif not quiet:
            _print(result, found.solution)


def _write(
    solution: "Solution", out: Path | None, vtk: Path | None, plot: Path | None, colour: str | None
) -> list[str]:
    if out is not None:
        solution.save(out)
    if vtk is not None:
        solution.to_vtk(vtk)
    if plot is not None:
        draw(solution, plot, colour)
    return [str(path) for path in (out, vtk, plot) if path is not None]


def _result(file: Path, job: "Job", found: "Found", seconds: float, written: list[str]) -> dict[str, Any]:
    """Return all that is printed."""
    from beamfem.cli.modelfile.outputs import critical
    from beamfem.cli.modelfile.phrases import in_keys
    from beamfem.cli.modelfile.quantities import UNITS
    from beamfem.cli.plain import summary
    from beamfem.results.path import Path as EquilibriumPath

    outputs = []
    for output in job.outputs:
        rows = output.rows(found.solution)
        units = {name: job.model.unit(UNITS[name]) for name in rows[0] if name in UNITS}
        entry: dict[str, Any] = {"name": output.name, "units": units, "rows": rows}
        if isinstance(found.solution, EquilibriumPath):
            entry |= critical(output, found.solution)
        outputs.append(entry)
    return {
        "title": job.title,
        "file": str(file),
        "analysis": job.kind,
        "beams": len(job.beams),
        **summary(found.solution),
        "seconds": seconds,
        **found.values,
        "warnings": [in_keys(warning) for warning in found.solution.warnings],
        "outputs": outputs,
        "written": written,
    }


def _print(result: dict[str, Any], solution: "Solution") -> None:
    from beamfem.cli.modelfile.phrases import in_keys
    from beamfem.results.checks import findings
    from beamfem.results.status import counted

    print(result["title"])
    statistics, unit = solution.statistics, solution.model.unit
    effort = f"{counted(statistics.iterations, 'iteration')}, " if statistics.iterations else ""
    sizes = ", ".join(counted(result[f"{what}s"], what) for what in ("beam", "coordinate", "state"))
    print(f"{result['analysis']}: {sizes}, {effort}{result['seconds']:.2f} s; {statistics.outcome}")
    for name, (title, si) in _TITLES.items():
        if result.get(name):
            print_table(
                f"{title} [{unit(si)}]" if si else title,
                [{"": number, name: value} for number, value in enumerate(result[name], 1)],
            )
    for output in result["outputs"]:
        print_table(output["name"], output["rows"], output["units"])
        for critical in ("limit_points", "bifurcations"):
            if output.get(critical):
                print_table(f"{output['name']}, at {critical.replace('_', ' ')}", output[critical], output["units"])
    for finding in findings(solution):
        if finding.kind is None:  # the others were printed as they were found
            print(f"warning: {in_keys(finding.sentence)}", file=sys.stderr)
    if result["written"]:
        print()
    for path in result["written"]:
        print(f"wrote {path}")
