"""`beamfem run`: solve a model file."""

import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, print_table, reported, require_target, summary

if TYPE_CHECKING:
    from beamfem.cli.analyses import Found
    from beamfem.cli.model_file import Job

Colour = Annotated[
    str | None,
    typer.Option(
        "--colour", "--color", help="Colour of the body: moment, stress, utilisation, speed ...", show_default=False
    ),
]
# titles of results, with the unit of the numbers in SI
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
    out: Annotated[Path | None, typer.Option(help="Save model and states (.h5).", show_default=False)] = None,
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
    """Solve a model file, print its outputs and write the files given as options."""
    with reported(as_json, quiet):
        from beamfem.assembly.compilation_notice import announce_compilation
        from beamfem.cli.model_file import read_model_file
        from beamfem.cli.outputs import DRAWN, draw, require_saved

        with _warned():
            job = read_model_file(model)
            for target, suffixes in ((out, (".h5", ".hdf5")), (vtk, (".pvd", ".vtkhdf")), (plot, DRAWN)):
                require_target(target, suffixes)
            if out is not None:
                require_saved(job.model)
            if not quiet:
                announce_compilation()
            start = time.perf_counter()
            with _kept(job, out):
                found = job.solve()
            seconds = time.perf_counter() - start
            if out is not None:
                found.solution.save(out)
            if vtk is not None:
                found.solution.to_vtk(vtk)
            if plot is not None:
                draw(found.solution, plot, **({} if colour is None else {"colour": colour}))
            written = [str(path) for path in (out, vtk, plot) if path is not None]
            result = _result(job, found, seconds, written)
        if as_json:
            print_json(result)
        elif not quiet:
            _print(result, job, found)


@contextmanager
def _warned() -> Iterator[None]:
    """Print warnings of the library without lines of Python."""
    from beamfem import errors
    from beamfem.cli.part_kinds import in_keys

    with warnings.catch_warnings():
        others = warnings.showwarning

        def show(message: Any, category: Any, *place: Any) -> None:
            if category.__module__ == errors.__name__ or category is UserWarning:
                print(f"warning: {in_keys(str(message))}", file=sys.stderr)
            else:
                others(message, category, *place)

        warnings.showwarning = show  # type: ignore[assignment]
        yield


@contextmanager
def _kept(job: "Job", out: Path | None) -> Iterator[None]:
    """Save the states found before a solve failed; word its error in the keys of model files."""
    from beamfem.cli.part_kinds import in_keys
    from beamfem.errors import ConvergenceError

    try:
        yield
    except (ConvergenceError, KeyboardInterrupt) as error:
        if isinstance(error, ConvergenceError):
            error.args, error.remedy = (in_keys(str(error)),), in_keys(error.remedy)
        before = getattr(error, "solution", None)
        if before is not None and out is not None:
            before.save(out)
            last = float(before.at[-1])
            at = f"load factor {last:g}" if before.static else f"{last:g} {job.model.unit('s')}"
            error.add_note(f"The states found before, up to {at}, are saved in {out}.")
        raise


def _result(job: "Job", found: "Found", seconds: float, written: list[str]) -> dict[str, Any]:
    """Return all that is printed."""
    from beamfem.cli.outputs import UNITS
    from beamfem.cli.part_kinds import in_keys
    from beamfem.results.path import Path as EquilibriumPath

    outputs = []
    for output in job.outputs:
        rows = output.rows(found.solution)
        units = {name: job.model.unit(UNITS[name]) for name in rows[0] if name in UNITS}
        critical = output.critical(found.solution) if isinstance(found.solution, EquilibriumPath) else {}
        outputs.append({"name": output.name, "units": units, "rows": rows, **critical})
    return {
        "title": job.title,
        "file": str(job.source.file),
        "analysis": job.analysis.kind,
        "beams": len(job.model.beams),
        **summary(found.solution),
        "seconds": seconds,
        **found.values,
        "warnings": [in_keys(warning) for warning in found.solution.warnings],
        "outputs": outputs,
        "written": written,
    }


def _print(result: dict[str, Any], job: "Job", found: "Found") -> None:
    from beamfem.cli.part_kinds import in_keys
    from beamfem.results.solution_checks import findings
    from beamfem.results.status import counted

    print(result["title"])
    statistics = found.solution.statistics
    effort = f"{counted(statistics.iterations, 'iteration')}, " if statistics.iterations else ""
    sizes = ", ".join(counted(result[f"{what}s"], what) for what in ("beam", "coordinate", "state"))
    print(f"{result['analysis']}: {sizes}, {effort}{result['seconds']:.2f} s; {statistics.outcome}")
    for name, (title, unit) in _TITLES.items():
        if result.get(name):
            head = f"{title} [{job.model.unit(unit)}]" if unit else title
            print_table(head, [{"": number, name: value} for number, value in enumerate(result[name], 1)])
    for output in result["outputs"]:
        print_table(output["name"], output["rows"], output["units"])
        for critical in ("limit_points", "bifurcations"):
            title = f"{output['name']}, at {critical.replace('_', ' ')}"
            print_table(title, output.get(critical, ()), output["units"])
    for finding in findings(found.solution):
        if finding.kind is None:  # the others were printed as they were found
            print(f"warning: {in_keys(finding.sentence)}", file=sys.stderr)
    if result["written"]:
        print("\n" + "\n".join(f"wrote {path}" for path in result["written"]))
