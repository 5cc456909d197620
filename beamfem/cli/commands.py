"""`beamfem run`, which solves a model file, and `info`, `export` and `plot` for the file of its results."""

import sys
import time
import warnings
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from beamfem.cli.report import DRAWN, AsJson, Colour, Quiet, draw, reported, require_target, summary
from beamfem.errors import ConvergenceError, InputError
from beamfem.progress import ends_as_a_whole

Results = Annotated[Path, typer.Argument(help="A results file (.h5).")]
_LINES = ("file", "written_by", "kind", "units", "coordinates", "states", "load_factor", "time", "outcome", "effort")


def run(
    model: Annotated[Path, typer.Argument(help="A model file (.toml), see docs/model_files.md.")],
    out: Annotated[Path | None, typer.Option(help="Save model and states (.h5).")] = None,
    vtk: Annotated[Path | None, typer.Option(help="Write files for ParaView (.pvd).")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw (.png, .svg, .pdf), or write a page (.html) or a film (.gif, .mp4).")
    ] = None,
    colour: Colour = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Solve a model file, print its outputs and write the files given as options."""
    with reported(as_json, quiet) as show, warnings.catch_warnings():
        from beamfem.cli.model_file import read_model_file
        from beamfem.cli.part_kinds import in_keys
        from beamfem.equations.compilation_notice import announce_compilation
        from beamfem.io.description import describe

        # without lines of Python
        warnings.showwarning = lambda message, *_: print(f"warning: {in_keys(str(message))}", file=sys.stderr)
        job = read_model_file(model)
        for target, suffixes in ((out, (".h5", ".hdf5")), (vtk, (".pvd", ".vtkhdf")), (plot, DRAWN)):
            if target is not None:
                require_target(target, suffixes)
        if out is not None:
            describe(job.model, np.zeros(1))  # refuses parts that cannot be saved
        if not quiet:
            announce_compilation()
        start = time.perf_counter()
        try:
            with ends_as_a_whole():
                found = job.solve()
        except (ConvergenceError, KeyboardInterrupt) as error:
            if out is not None and (before := getattr(error, "solution", None)) is not None:
                before.save(out)
                last = float(before.at[-1])
                at = f"load factor {last:g}" if before.static else f"{last:g} {job.model.unit('s')}"
                error.add_note(f"The states found before, up to {at}, are saved in {out}.")
            raise
        seconds = time.perf_counter() - start
        solution = found.solution
        drawn = partial(draw, solution, colour=colour)
        for path, write in ((out, solution.save), (vtk, solution.to_vtk), (plot, drawn)):
            if path is not None:
                write(path)
        written = [str(path) for path in (out, vtk, plot) if path is not None]
        result = job.result(found, seconds, written)
        show(result, partial(job.print, result, found))


def info(results: Results, as_json: AsJson = False, quiet: Quiet = False) -> None:
    """Show the contents of a results file: model, states, statistics; with --quiet, check that it can be read."""
    with reported(as_json, quiet) as show:
        from beamfem.io.hdf5 import read_label, required_h5py
        from beamfem.io.parts_in_words import beam_in_words, part_in_words

        solution = _loaded(results)
        with required_h5py("loading").File(results, "r") as file:
            version = read_label(file, "beamfem_version")
        model, statistics = solution.model, solution.statistics
        parts = ("supports", "joints", "connectors", "masses", "loads")
        words = {name: [part_in_words(item, model) for item in getattr(model, name)] for name in parts}
        words = {"beams": [beam_in_words(beam, model) for beam in model.beams], **words}
        found = {
            "file": str(results),
            "written_by": f"beamfem {version}",
            **summary(solution),
            "outcome": statistics.outcome,
            "effort": statistics.effort,
            "units": model.units,
            "model": words,
        }
        lines = []
        for name in _LINES:
            if value := found.get(name):
                text = f"{value[0]:g} to {value[1]:g}" if isinstance(value, list) else value
                lines.append(f"{name.replace('_', ' '):12s} {text}")
        if np.isfinite(statistics.digits):
            lines.append(f"{'accuracy':12s} {statistics.digits:.0f} digits of the forces are reliable")
        lines += [f"{'warning':12s} {warning}" for warning in statistics.warnings]
        for part, items in words.items():
            lines += [f"\n{part}" + ("" if items else ": none"), *(f"  {item}" for item in items)]
        show(found, "\n".join(lines))


def export(
    results: Results,
    target: Annotated[Path, typer.Argument(help="A file for ParaView (.pvd, .vtkhdf).")],
    reference: Annotated[
        bool, typer.Option("--reference", help="Leave the points at the reference, to warp them by the displacement.")
    ] = False,
    field: Annotated[
        list[str] | None, typer.Option(help="A field to write, repeated for each; all by default.")
    ] = None,
    every: Annotated[int, typer.Option(help="Write every n-th state.", min=1)] = 1,
    single: Annotated[bool, typer.Option("--single", help="Write numbers of four bytes.")] = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write the states of a results file for ParaView."""
    with reported(as_json, quiet) as show:
        require_target(target, (".pvd", ".vtkhdf"))
        geometry = "reference" if reference else "deformed"
        _loaded(results)[::every].to_vtk(target, geometry=geometry, fields=field or None, single=single)
        show({"written": [target]}, f"wrote {target}")


def plot(
    results: Results,
    target: Annotated[
        Path, typer.Argument(help="A picture (.png, .svg, .pdf), a page with a slider (.html) or a film (.gif, .mp4).")
    ],
    colour: Colour = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Draw the deformed shapes of a results file."""
    with reported(as_json, quiet) as show:
        require_target(target, DRAWN)
        draw(_loaded(results), target, colour)
        show({"written": [target]}, f"wrote {target}")


def _loaded(results: Path) -> Any:
    """Return the solution of a results file. Raises InputError."""
    from beamfem.io.description import NotImportedError
    from beamfem.io.results_hdf5 import load

    try:
        return load(results)
    except InputError as error:
        if isinstance(missing := error.__cause__, NotImportedError):
            held = f"the file holds a {missing.kind} of the module {missing.module}, and commands run no code of yours"
            raise InputError(f"{results}: {held}; import the module in Python and use bf.load") from error
        raise
