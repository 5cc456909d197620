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

_TITLES = {
    "load_factors": "Critical load factors",
    "kinds": "Kinds",
    "linearised": "Linearised about the start",
    "frequencies": "Frequencies [Hz]",
    "growth": "Growth [1/s]",
    "rigid": "Rigid motions",
    "limit_points": "Limit points, load factor",
    "bifurcations": "Bifurcations, load factor",
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
        from beamfem.cli.targets import require_target
        from beamfem.errors import ConvergenceError

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
        begun = time.perf_counter()
        try:
            job = job.imperfect()
            found = job.solve()
        except (ConvergenceError, KeyboardInterrupt) as error:
            found_before = getattr(error, "solution", None)
            if found_before is not None and out is not None:
                found_before.save(out)
                last = float(found_before.at[-1])
                at = f"load factor {last:g}" if found_before.static else f"{last:g} s"
                error.add_note(f"The states found before, up to {at}, are saved in {out}.")
            raise
        seconds = time.perf_counter() - begun
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
            _print(result)


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
    from beamfem.cli.plain import summary
    from beamfem.results.path import Path as EquilibriumPath

    outputs = []
    for output in job.outputs:
        entry: dict[str, Any] = {"name": output.name, "rows": output.rows(found.solution)}
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
        "warnings": list(found.solution.warnings),
        "outputs": outputs,
        "written": written,
    }


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")


def _print(result: dict[str, Any]) -> None:
    print(result["title"])
    statistics = result["statistics"]
    effort = f"{_counted(statistics['iterations'], 'iteration')}, " if statistics["iterations"] else ""
    sizes = ", ".join(_counted(result[f"{what}s"], what) for what in ("beam", "coordinate", "state"))
    print(f"{result['analysis']}: {sizes}, {effort}{result['seconds']:.2f} s; {statistics['ended']}")
    for name, title in _TITLES.items():
        if result.get(name):
            print_table(title, [{"": number, name: value} for number, value in enumerate(result[name], 1)])
    for output in result["outputs"]:
        print_table(output["name"], output["rows"])
        for critical in ("limit_points", "bifurcations"):
            if output.get(critical):
                print_table(f"{output['name']}, at {critical.replace('_', ' ')}", output[critical])
    for warning in result["warnings"]:
        print(f"warning: {warning}", file=sys.stderr)
    if result["written"]:
        print()
    for path in result["written"]:
        print(f"wrote {path}")
