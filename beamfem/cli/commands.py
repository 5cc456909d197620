"""`beamfem run`, which solves a model file; `info`, `export` and `plot` for its results; `doctor`, for problems."""

import platform
import re
import sys
import time
import warnings
from functools import partial
from importlib.metadata import distributions, requires
from pathlib import Path
from timeit import repeat
from typing import Annotated, Any

import numpy as np
import typer

import beamfem as bf
from beamfem.cli.report import DRAWN, FAILED, AsJson, Colour, Quiet, draw, reported, require_target, summary, writable
from beamfem.errors import ConvergenceError, InputError, MissingPackageError
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


_TIP = 0.71385896416  # tip deflection over the length of the geometrically exact beam, P L^2 / (E I) = 5, L / h = 100
_NO_EXTRAS = {"", "all", "test", "bench", "docs"}


def doctor(as_json: AsJson = False) -> None:
    """Check the installation: versions, compiled kernels, a first solve, pictures of bodies and missing extras."""
    with reported(as_json) as show:
        from beamfem.kernels.cache import cache_folder, kept
        from beamfem.view.rendering import ADVICE, can_render

        folder, needed = cache_folder(), "\n".join(requires("beamfem") or ())
        required = re.findall(r"^([\w.-]+)(?:.*extra\s*==\s*['\"](\w+))?", needed, re.MULTILINE)
        missing: dict[str, list[str]] = {extra: [] for extra in sorted({of for _, of in required} - _NO_EXTRAS)}
        for name, extra in required:
            if extra in missing and _version(name) is None:
                missing[extra].append(name)
        try:
            rendering = "" if can_render() else f"VTK cannot render here; {ADVICE}"
        except MissingPackageError as error:
            rendering = str(error)
        versions: dict[str, str | None] = {"python": platform.python_version(), "system": platform.platform()}
        versions |= {name: _version(name) for name in ("beamfem", *(name for name, extra in required if not extra))}
        kernels, writes, solve = kept(), folder is not None and writable(folder), _first_solve()
        where = folder or "nowhere: set BEAMFEM_CACHE_DIR to a folder that can be written to"
        wrong = f"WRONG: tip deflection {solve['deflection']:.8f} instead of {_TIP:.8f}"
        first, again = solve["seconds"]
        lines = ["versions", *(f"  {name:14s} {version}" for name, version in versions.items())]
        lines += [f"\n{kernels} kernels in {where}{'' if writes else ', which cannot be written to'}"]
        lines += [f"first solve {first:.2f} s, again {1e3 * again:.1f} ms: {'right' if solve['right'] else wrong}"]
        lines += [f"pictures of bodies: {rendering or 'work'}\n\nextras"]
        for extra, packages in missing.items():
            need = f'missing {", ".join(packages)}: pip install "beamfem[{extra}]"'
            lines.append(f"  {extra:14s} {need if packages else 'installed'}")
        found = {"versions": versions, "cache": {"folder": folder, "writable": writes, "compiled_kernels": kernels}}
        show({**found, "first_solve": solve, "rendering": rendering, "missing": missing}, "\n".join(lines))
        if not solve["right"]:
            raise typer.Exit(FAILED)


def _first_solve() -> dict[str, Any]:
    """Solve a cantilever twice: seconds of each solve, and whether the result is right."""
    section, material = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), section, material)
    force = 5.0 * material.youngs_modulus * section.second_moment
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))])

    def deflection() -> float:
        return float(bf.solve_static(model).displacement(beam.end)[-1, 1])

    seconds = repeat(deflection, number=1, repeat=2)
    tip = deflection()
    return {"seconds": seconds, "deflection": tip, "right": abs(tip - _TIP) < 1e-6}


def _version(name: str) -> str | None:
    return next((found.version for found in distributions(name=name)), None)
