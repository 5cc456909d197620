"""`beamfem info`, `export` and `plot`: commands for a results file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamfem.cli.loading import OwnCode, loaded
from beamfem.cli.pictures import Colour, draw
from beamfem.cli.report import AsJson, Quiet, print_json, reported
from beamfem.units import units_of

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

Results = Annotated[Path, typer.Argument(help="A results file (.h5).", show_default=False)]


def info(results: Results, code: OwnCode = None, as_json: AsJson = False, quiet: Quiet = False) -> None:
    """Show the contents of a results file: model, states, statistics; with --quiet, check that it can be read."""
    with reported(as_json, quiet):
        contents = _described(results, loaded(results, code))
        if as_json:
            print_json(contents)
        elif not quiet:
            _print(contents)


def export(
    results: Results,
    target: Annotated[Path, typer.Argument(help="A file for ParaView (.pvd, .vtkhdf).", show_default=False)],
    reference: Annotated[
        bool, typer.Option("--reference", help="Leave the points at the reference, to warp them by the displacement.")
    ] = False,
    field: Annotated[
        list[str] | None, typer.Option(help="A field to write, repeated for each; all by default.", show_default=False)
    ] = None,
    every: Annotated[int, typer.Option(help="Write every n-th state.", min=1)] = 1,
    single: Annotated[bool, typer.Option("--single", help="Write numbers of four bytes.")] = False,
    code: OwnCode = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write the states of a results file for ParaView."""
    with reported(as_json, quiet):
        from beamfem.cli.targets import require_target

        require_target("vtk", target)
        solution = loaded(results, code)
        selected = solution if every == 1 else solution[::every]
        selected.to_vtk(target, geometry="reference" if reference else "deformed", fields=field or None, single=single)
        _wrote(target, as_json, quiet)


def plot(
    results: Results,
    target: Annotated[
        Path,
        typer.Argument(
            help="A picture (.png, .svg, .pdf), a page with a slider (.html) or a film (.gif, .mp4).",
            show_default=False,
        ),
    ],
    colour: Colour = None,
    code: OwnCode = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Draw the deformed shapes of a results file."""
    with reported(as_json, quiet):
        from beamfem.cli.targets import require_target

        require_target("plot", target)
        draw(loaded(results, code), target, colour)
        _wrote(target, as_json, quiet)


def _wrote(path: Path, as_json: bool, quiet: bool) -> None:
    if as_json:
        print_json({"written": [path]})
    elif not quiet:
        print(f"wrote {path}")


def _described(path: Path, solution: "Solution") -> dict[str, Any]:
    import h5py

    from beamfem.cli.model_in_words import beam_lines, part_line
    from beamfem.cli.plain import summary
    from beamfem.io.hdf5 import read_label

    with h5py.File(path, "r") as file:
        version = read_label(file, "beamfem_version")
    model, statistics = solution.model, solution.statistics
    return {
        "file": str(path),
        "written_by": f"beamfem {version}",
        **summary(solution),
        "outcome": statistics.outcome,
        "effort": statistics.effort,
        "units": model.units,
        "model": {
            "beams": beam_lines(model),
            "supports": [part_line(item, model) for item in model.supports],
            "joints": [part_line(item, model) for item in model.joints],
            "connectors": [part_line(item, model) for item in model.connectors],
            "loads": [part_line(item, model) for item in model.loads],
        },
    }


def _print(found: dict[str, Any]) -> None:
    """Print what a results file holds, as a person would say it."""
    statistics = found["statistics"]
    second = f" {units_of(found['units']).of('s')}"
    for name in ("file", "written_by", "kind", "units", "coordinates", "states", "load_factor", "time"):
        if name in found:
            value = found[name]
            text = f"{value[0]:g} to {value[1]:g}{second * (name == 'time')}" if isinstance(value, list) else value
            print(f"{name.replace('_', ' '):12s} {text}")
    print(f"{'solve':12s} {found['outcome']}")
    if statistics["iterations"]:
        print(f"{'effort':12s} {found['effort']}")
    if statistics["digits"] is not None:
        print(f"{'accuracy':12s} {statistics['digits']:.0f} digits of the forces are reliable")
    for warning in statistics["warnings"]:
        print(f"{'warning':12s} {warning}")
    for part, items in found["model"].items():
        print(f"\n{part}" + ("" if items else ": none"))
        for item in items:
            print(f"  {item}")
