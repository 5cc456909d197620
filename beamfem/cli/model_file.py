"""Model files: a model, an analysis and what to print, in TOML."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

from beamfem.assembly.system import System
from beamfem.cli.analyses import ANALYSES, Analysis, Found
from beamfem.cli.outputs import Output
from beamfem.cli.part_kinds import ACTING, NAMED, TYPES, BeamTable, in_keys
from beamfem.cli.schema import KeyFault, Kinds, Names, build, named_first, part, require_table, shown
from beamfem.cli.toml_source import ModelFileError, Source, read_source
from beamfem.errors import FileError, InputError
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.validation import nearest

_TEXTS, _TABLES = ("title", "units"), ("beams", "analysis", "outputs")


@dataclass(frozen=True)
class Job:
    """Contents of a model file: the model, the analysis, and the outputs to print."""

    source: Source
    title: str
    model: Model
    analysis: Analysis
    outputs: Sequence[Output]

    def solve(self) -> Found:
        """Run the analysis and return what it finds. Raises ModelFileError, ConvergenceError."""
        with _within(self.source, "analysis"):
            return self.analysis.run(self.model, [at for output in self.outputs for at in output.asked])


def read_model_file(path: str | PathLike[str]) -> Job:
    """Return the contents of a model file (TOML). Raises ModelFileError with file, line and key."""
    source = read_source(Path(path))
    known = [*_TEXTS, *NAMED, *_TABLES, *(name for name, kinds in ACTING.items() if kinds)]
    for key in source.values:
        if key not in known:
            raise source.error(f"unknown key; {nearest(key, known)}", key)
    names = Names(TYPES)
    for section, kinds in NAMED.items():
        names.parts[section] = {}
        for name, table in _named_tables(source, section).items():
            with _within(source, section, name):
                names.parts[section][name] = part(kinds, table, names)
    for name, table in _named_tables(source, "beams").items():
        with _within(source, "beams", name):
            names.beams[name] = build(BeamTable, table, names).beam(name)
    if not names.beams:
        raise source.error("a model needs at least one beam, a table headed [beams.NAME]")
    acting = {
        section: _tables(source, section, partial(_each_place, kinds, names)) for section, kinds in ACTING.items()
    }
    model = _model(source, list(names.beams.values()), acting)
    if "units" in source.values:
        with _within(source, "units"):
            model = replace(model, units=_text(source, "units"))
    with _within(source, "analysis"):
        analysis = part(ANALYSES, source.values.get("analysis", {}), names, default="static")
    outputs = _tables(source, "outputs", lambda table: build(Output, table, names))
    for number, output in enumerate(outputs):
        with _within(source, "outputs", number):
            output.require(model, analysis)
    return Job(source, _text(source, "title", source.file.stem), model, analysis, outputs)


def _each_place(kinds: Kinds, names: Names, table: Any) -> list[Any]:
    """Return the part of a table, or one for each of its `points` or `beams`. Raises KeyFault."""
    require_table(table)
    for plural, single in (("points", "point"), ("beams", "beam")):
        if isinstance(places := table.get(plural), list):
            rest = {key: value for key, value in table.items() if key != plural}
            try:
                return [part(kinds, {**rest, single: (place := each)}, names) for each in places]
            except KeyFault as fault:
                path = (plural, places.index(place), *fault.path[1:]) if fault.path[:1] == (single,) else fault.path
                raise KeyFault(fault.message, *path) from None
    return [part(kinds, table, names)]


def _model(source: Source, beams: list[Beam], acting: dict[str, list[list[Any]]]) -> Model:
    """Return the model, or raise the error of the first part that it refuses."""
    items = {section: [item for found in parts for item in found] for section, parts in acting.items()}
    try:
        model = Model(
            beams, items["supports"], items["loads"], items["joints"], items["connectors"], masses=items["masses"]
        )
        _require_compatible(model)
    except InputError:
        for section, parts in acting.items():
            before: list[Any] = []
            for number, found in enumerate(parts):
                with _within(source, section, number):
                    before += found
                    alone = before if section == "supports" else found
                    given: Any = {section: alone}
                    _require_compatible(Model(beams, **given))
        raise
    return model


def _require_compatible(model: Model) -> None:
    """Raise InputError for a support that constrains what another one constrains already."""
    system = System(Model(model.beams, model.supports, joints=model.joints), static=True)
    _ = system.prescribed, system.inclined


@contextmanager
def _within(source: Source, *path: str | int) -> Iterator[None]:
    """Raise what is wrong with the value at a path as a ModelFileError with its place."""
    try:
        yield
    except ModelFileError:
        raise
    except (KeyFault, InputError, FileError) as error:
        if not isinstance(error, KeyFault):
            value: Any = source.values
            for key in path:
                value = value[key] if isinstance(key, int) else value.get(key, {})
            named = named_first(str(error), value) if isinstance(value, dict) else []
            path = path if named or path != ("analysis",) else ()  # the model rather than a key of the analysis
            error = KeyFault.of(error, *named)
        raise source.error(in_keys(error.message), *path, *error.path) from error


def _tables(source: Source, section: str, read: Callable[[Any], Any]) -> list[Any]:
    """Return what is read from each of the tables [[section]]. Raises ModelFileError."""
    tables = source.values.get(section, [])
    if not isinstance(tables, list):
        raise source.error(f"must be an array of tables, each headed [[{section}]], got {shown(tables)}", section)
    found = []
    for number, table in enumerate(tables):
        with _within(source, section, number):
            found.append(read(table))
    return found


def _named_tables(source: Source, section: str) -> dict[str, Any]:
    """Return the tables [section.NAME] by name. Raises ModelFileError."""
    tables = source.values.get(section, {})
    if not isinstance(tables, dict):
        raise source.error(f"must be tables with a name, each headed [{section}.NAME], got {shown(tables)}", section)
    return tables


def _text(source: Source, key: str, default: str = "") -> str:
    value = source.values.get(key, default)
    if not isinstance(value, str):
        raise source.error(f"must be a text, got {shown(value)}", key)
    return value
