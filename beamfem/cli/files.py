"""`beamfem info`, `export` and `plot`: commands for a results file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamfem.cli.pictures import Colour, draw
from beamfem.cli.report import AsJson, Quiet, print_json, reported

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

Results = Annotated[Path, typer.Argument(help="A results file (.h5).", show_default=False)]


def info(results: Results, as_json: AsJson = False) -> None:
    """Show the contents of a results file: model, states, statistics."""
    with reported(as_json):
        from beamfem.io.results import load

        found = _described(results, load(results))
        if as_json:
            print_json(found)
            return
        model = found["model"]
        for name in ("file", "written_by", "kind", "states", "load_factor", "time", "coordinates"):
            if name in found:
                value = found[name]
                text = f"{value[0]:g} to {value[1]:g}" if isinstance(value, list) else value
                print(f"{name.replace('_', ' '):12s} {text}")
        for name, value in found["statistics"].items():
            print(f"{name:12s} {value}")
        print(f"{'units':12s} {found['units']}")
        for part, items in model.items():
            print(f"\n{part}" + ("" if items else ": none"))
            for item in items:
                print(f"  {item}")


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
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write the states of a results file for ParaView."""
    with reported(as_json, quiet):
        from beamfem.cli.targets import require_target
        from beamfem.io.results import load

        require_target("vtk", target)
        solution = load(results)
        shown = solution if every == 1 else solution[::every]
        shown.to_vtk(target, geometry="reference" if reference else "deformed", fields=field or None, single=single)
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
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Draw the deformed shapes of a results file."""
    with reported(as_json, quiet):
        from beamfem.cli.targets import require_target
        from beamfem.io.results import load

        require_target("plot", target)
        draw(load(results), target, colour)
        _wrote(target, as_json, quiet)


def _wrote(path: Path, as_json: bool, quiet: bool) -> None:
    if as_json:
        print_json({"written": [path]})
    elif not quiet:
        print(f"wrote {path}")


def _described(path: Path, solution: "Solution") -> dict[str, Any]:
    import h5py

    from beamfem.cli.plain import summary
    from beamfem.io.hdf5 import read_label

    with h5py.File(path, "r") as file:
        version = read_label(file, "beamfem_version")
    model = solution.model
    beams = [
        f"{number}: {type(beam.curve).__name__}, length {beam.curve.length:.6g}, "
        f"{model.meshes[number].elements} x {beam.element.name} ({beam.element.forces.name}), "
        f"{beam.section}, {beam.material}"
        for number, beam in enumerate(model.beams)
    ]
    return {
        "file": str(path),
        "written_by": f"beamfem {version}",
        **summary(solution),
        "units": model.units,
        "model": {
            "beams": beams,
            "supports": [_acting(item, solution) for item in model.supports],
            "joints": [_acting(item, solution) for item in model.joints],
            "loads": [_acting(item, solution) for item in model.loads],
        },
    }


def _acting(item: Any, solution: "Solution") -> str:
    """Return a support, joint or load as one line, with its places by beam number and fraction."""
    from dataclasses import fields

    from beamfem.model.beam import Beam, Point
    from beamfem.model.sampled import Sampled

    words = []
    for field in fields(item):
        value = getattr(item, field.name)
        if value == field.default:
            continue
        if isinstance(value, Point):
            x, y = value.reference
            value = f"beam {solution.model.number_of(value.beam)} at {value.fraction:g} ({x:g}, {y:g})"
        elif isinstance(value, Beam):
            value = f"{solution.model.number_of(value)}"
        elif isinstance(value, Sampled):
            value = f"function saved at {len(value.at)} values"
        words.append(f"{field.name} {value}")
    return f"{type(item).__name__}: {', '.join(words)}"
