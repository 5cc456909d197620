"""`beamfem info`, `export` and `plot`: commands for a results file."""

from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beamfem.cli.report import AsJson, Quiet, print_json, reported, require_target, summary, wrote
from beamfem.cli.run import Colour

if TYPE_CHECKING:
    from beamfem.model.beam import Point
    from beamfem.model.model import Model
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
    from beamfem.io.own_parts import NotImportedError
    from beamfem.io.results import load

    try:
        return load(results)
    except InputError as error:
        missing = error.__cause__
        if isinstance(missing, NotImportedError):
            what = f"the file holds a {missing.kind} of the module {missing.module}, and commands run no code of yours"
            raise InputError(f"{results} cannot be loaded: {what}; load it in Python with bf.load after the import") from error
        raise


def _described(path: Path, solution: "Solution") -> dict[str, Any]:
    """Return the contents of a results file as names, texts and numbers."""
    import h5py

    from beamfem.io.hdf5 import read_label

    with h5py.File(path, "r") as file:
        version = read_label(file, "beamfem_version")
    model, statistics = solution.model, solution.statistics
    parts = ("supports", "joints", "connectors", "loads")
    return {
        "file": str(path),
        "written_by": f"beamfem {version}",
        **summary(solution),
        "outcome": statistics.outcome,
        "effort": statistics.effort,
        "units": model.units,
        "model": {
            "beams": _beam_lines(model),
            **{name: [_part_line(item, model) for item in getattr(model, name)] for name in parts},
        },
    }


def _beam_lines(model: "Model") -> list[str]:
    """Return a line for each beam: its name, its axis, its elements, its section and its material."""
    from beamfem.io.in_words import material_in_words, section_in_words
    from beamfem.model.named import names

    lines = []
    for name, beam, mesh in zip(names(model.beams), model.beams, model.meshes, strict=True):
        axis = f"{type(beam.curve).__name__}, {beam.curve.length:.6g} {model.unit('m')} long"
        parts = [axis, f"{mesh.elements} x {beam.element.name} ({beam.element.forces.name})"]
        parts.append(section_in_words(beam.section, model.unit))
        if beam.material is not None:
            parts.append(material_in_words(beam.material, model.unit))
        lines.append(f"{name}: {', '.join(parts)}")
    return lines


def _part_line(item: Any, model: "Model") -> str:
    """Return a support, joint, connector or load in a line, with its places and what differs from its defaults."""
    from beamfem.model.joints import Joint

    joined = ("a", "b") if isinstance(item, Joint) else ()
    words = [f"{' and '.join(_place(getattr(item, name), model) for name in joined)}, {_at(item.a, model)}"] * bool(joined)
    for field in fields(item):
        value = getattr(item, field.name)
        default = value is None or (not hasattr(value, "shape") and value == field.default)
        if field.name not in joined and not default:
            words.append(_value(item, field.name, value, model))
    return f"{type(item).__name__}: {', '.join(words)}"


def _value(item: Any, name: str, value: Any, model: "Model") -> str:
    """Return a field of a part: its name, its value and its unit."""
    from beamfem.model.beam import Beam, Point
    from beamfem.model.field_units import field_units
    from beamfem.model.named import names
    from beamfem.model.sampled import Sampled, SampledAlong

    points = value if isinstance(value, tuple) else (value,)
    if points and all(isinstance(point, Point) for point in points):
        places = " and ".join(f"{_place(point, model)}, {_at(point, model)}" for point in points)
        return places if name == "point" else f"{name} {places}"
    if isinstance(value, Beam):
        return f"along {names(model.beams)[model.number_of(value)]}"
    if isinstance(value, Sampled | SampledAlong):
        return f"{name} a function, saved at {len(value.at)} values"
    if isinstance(value, bool):
        return name if value else f"{name} false"
    unit = field_units(item).get(name)
    return f"{name} {_number(value)}" + (f" {model.unit(unit)}" if unit else "")


def _place(point: "Point", model: "Model") -> str:
    """Return a point as model files name it."""
    from beamfem.model.named import names

    name = names(model.beams)[model.number_of(point.beam)]
    return f"{name}.{ {0.0: 'start', 1.0: 'end'}.get(point.fraction, f'at({point.fraction:g})')}"


def _at(point: "Point", model: "Model") -> str:
    x, y = point.reference
    return f"at ({x:g}, {y:g}) {model.unit('m')}"


def _number(value: Any) -> str:
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"({', '.join(map(_number, value))})"
    points = getattr(value, "points", None)  # of a table over time, which is saved as it is
    return f"a table of {len(points)} points" if points is not None else f"{value:.6g}" if isinstance(value, float) else str(value)


def _print(found: dict[str, Any]) -> None:
    """Print what a results file holds."""
    from beamfem.units import units_of

    statistics, second = found["statistics"], units_of(found["units"]).of("s")
    for name in ("file", "written_by", "kind", "units", "coordinates", "states", "load_factor", "time"):
        if name in found:
            value = found[name]
            text = f"{value[0]:g} to {value[1]:g}" if isinstance(value, list) else value
            print(f"{name.replace('_', ' '):12s} {text}{f' {second}' if name == 'time' else ''}")
    print(f"{'solve':12s} {found['outcome']}")
    if statistics["iterations"]:
        print(f"{'effort':12s} {found['effort']}")
    if statistics["digits"] is not None:
        print(f"{'accuracy':12s} {statistics['digits']:.0f} digits of the forces are reliable")
    for warning in statistics["warnings"]:
        print(f"{'warning':12s} {warning}")
    for part, items in found["model"].items():
        print("\n  ".join([f"\n{part}" + ("" if items else ": none"), *items]))
