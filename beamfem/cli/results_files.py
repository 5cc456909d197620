"""`beamfem info`, `export` and `plot`: commands for a results file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, reported, require_target, summary, wrote
from beamfem.cli.run_command import Colour

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

Results = Annotated[Path, typer.Argument(help="A results file (.h5).", show_default=False)]


def info(results: Results, as_json: AsJson = False, quiet: Quiet = False) -> None:
    """Show the contents of a results file: model, states, statistics; with --quiet, check that it can be read."""
    with reported(as_json, quiet):
        contents = _described(results, _loaded(results))
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
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Write the states of a results file for ParaView."""
    with reported(as_json, quiet):
        require_target(target, (".pvd", ".vtkhdf"))
        solution = _loaded(results)
        selected = solution if every == 1 else solution[::every]
        selected.to_vtk(target, geometry="reference" if reference else "deformed", fields=field or None, single=single)
        wrote([target], as_json, quiet)


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
        from beamfem.cli.outputs import DRAWN, draw

        require_target(target, DRAWN)
        draw(_loaded(results), target, **({} if colour is None else {"colour": colour}))
        wrote([target], as_json, quiet)


def _loaded(results: Path) -> "Solution":
    """Return the solution of a results file. Raises InputError."""
    from beamfem.errors import InputError
    from beamfem.io.results_hdf5 import load
    from beamfem.io.user_classes import NotImportedError

    try:
        return load(results)
    except InputError as error:
        if isinstance(missing := error.__cause__, NotImportedError):
            held = f"the file holds a {missing.kind} of the module {missing.module}, and commands run no code of yours"
            raise InputError(f"{results}: {held}; import the module in Python and use bf.load") from error
        raise


def _described(path: Path, solution: "Solution") -> dict[str, Any]:
    """Return the contents of a results file as names, texts and numbers."""
    import h5py

    from beamfem.io.descriptions import beam_in_words, part_in_words
    from beamfem.io.hdf5 import read_label

    with h5py.File(path, "r") as file:
        version = read_label(file, "beamfem_version")
    model, statistics = solution.model, solution.statistics
    parts = {name: getattr(model, name) for name in ("supports", "joints", "connectors", "masses", "loads")}
    words = {name: [part_in_words(item, model) for item in items] for name, items in parts.items()}
    return {
        "file": str(path),
        "written_by": f"beamfem {version}",
        **summary(solution),
        "outcome": statistics.outcome,
        "effort": statistics.effort,
        "units": model.units,
        "model": {"beams": [beam_in_words(beam, model) for beam in model.beams], **words},
    }


def _print(found: dict[str, Any]) -> None:
    """Print the contents of a results file."""
    statistics = found["statistics"]
    for name in (
        "file",
        "written_by",
        "kind",
        "units",
        "coordinates",
        "states",
        "load_factor",
        "time",
        "outcome",
        "effort",
    ):
        if found.get(name):
            value = found[name]
            text = f"{value[0]:g} to {value[1]:g}" if isinstance(value, list) else value
            print(f"{name.replace('_', ' '):12s} {text}")
    if statistics["digits"] is not None:
        print(f"{'accuracy':12s} {statistics['digits']:.0f} digits of the forces are reliable")
    for warning in statistics["warnings"]:
        print(f"{'warning':12s} {warning}")
    for part, items in found["model"].items():
        print("\n  ".join([f"\n{part}" + ("" if items else ": none"), *items]))
