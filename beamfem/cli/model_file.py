"""Model files: a model, an analysis and what to print, in TOML."""

import re
import sys
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import chain
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, ValidationInfo

from beamfem.cli.analyses import ANALYSES, CRITICAL, Analysis, Found, Output
from beamfem.cli.part_kinds import ACTING, NAMED, TYPES, Reduced, in_keys
from beamfem.cli.report import print_table, summary
from beamfem.cli.schema import Keyed, KeyFault, Kinds, Names, build, fault_at, part, reader, require_table, shown
from beamfem.equations.system import System
from beamfem.errors import ConvergenceError, InputError
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.parts.floating_body import FloatingBody
from beamfem.parts.rigid_body import RigidBody
from beamfem.results.axis_fields import UNITS
from beamfem.results.path import Path as EquilibriumPath
from beamfem.results.solution_checks import findings
from beamfem.results.status import counted

_HDF5 = b"\x89HDF"
_LARGEST = 5_000_000  # bytes
# start of a message of tomllib, and the usual cause
_CAUSES = {
    "Cannot overwrite": "the key is there twice, or the header of its table has another number of brackets above",
    "Cannot declare": "the table is there twice; only those in double brackets, such as [[loads]], may be repeated",
    "Invalid value": 'texts are written in quotation marks: "arm.start", numbers like 0.5, arrays like [0, 1], truth '
    "values true or false",
    "Expected newline": "only a comment may follow a value on its line, and numbers are written like 5.0 or 2e-3",
    "Invalid initial character": "a table in braces must be on one line, without a comma at its end",
    "Illegal character '\\n'": "a quotation mark is missing at the end of a text",
    "Expected ']' at the end of a table": "names other than A-Z, a-z, 0-9, - and _ are written in quotation marks",
    "Expected '='": "keys and their values are written: key = value",
    "Unescaped": "paths may be written with /",
}


class ModelFileError(InputError):
    """An error in a model file; the message begins with `file:line: key:`."""

    def __init__(self, message: str, file: Path, line: int | None = None, key: str | None = None) -> None:
        place = f"{file}:{line}" if line else str(file)
        super().__init__(f"{place}: {key}: {message}" if key else f"{place}: {message}")
        self.message, self.file, self.line, self.key = message, file, line, key


@dataclass(frozen=True)
class Source:
    """The text of a model file and its values."""

    file: Path
    text: str
    values: dict[str, Any]

    def error(self, message: str, *path: str | int) -> ModelFileError:
        """Return the error of a key; items of arrays are counted from 1."""
        key = "".join(f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in path)
        return ModelFileError(message, self.file, _line(self.text, path), key.removeprefix(".") or None)


def read_source(path: Path) -> Source:
    """Return the text and values of a model file. Raises ModelFileError."""
    line, content = None, b""
    if path.exists() and not path.is_file():
        raise ModelFileError(f"this is a {'folder' if path.is_dir() else 'device'}, not a model file", path)
    try:
        if path.stat().st_size <= _LARGEST:
            content = path.read_bytes()
            text = content.decode("utf-8-sig").replace("\r\n", "\n")
            return Source(path, text, tomllib.loads(text))
        message = f"this file has more than {_LARGEST // 10**6} MB, too many for a model file"
    except FileNotFoundError:
        message = "there is no such file"
    except UnicodeDecodeError:
        results = "a results file, which beamfem info, plot and export read"
        message = f"this is {results if content.startswith(_HDF5) else 'not a text in UTF-8'}; model files are TOML"
    except tomllib.TOMLDecodeError as error:
        cause = next((f"; {cause}" for start, cause in _CAUSES.items() if str(error).startswith(start)), "")
        place = re.search(r"\(at line (\d+)", str(error))
        line = int(place[1]) if place else max(len(text.rstrip().splitlines()), 1)
        message = f"not valid TOML: {error}{cause}"
    except ValueError as error:  # whole numbers of thousands of digits
        message = f"a number cannot be read: {error}"
    except RecursionError:
        message = "arrays or tables are nested too deeply"
    raise ModelFileError(message, path, line)


def _line(text: str, path: tuple[str | int, ...]) -> int | None:
    """Return the line, from 1, where the statement of a key begins, or else the table that should contain it."""
    while path and not _known(text, path):
        path = path[:-1]
    lines = text.splitlines(keepends=True)
    without, having = 0, len(lines)
    while path and having - without > 1:
        middle = (without + having) // 2
        # the first lines are TOML if they end with a statement, which lines of a long array, with a comma, do not
        ends = (end for end in range(middle, having) if end == middle or lines[end - 1].rstrip()[-1:] != ",")
        known = next((known for end in ends if (known := _known("".join(lines[:end]), path)) is not None), True)
        without, having = (without, middle) if known else (middle, having)
    return having if path else None


def _known(text: str, path: tuple[str | int, ...]) -> bool | None:
    """Return whether a text has a key, None if it is no TOML."""
    try:
        value: Any = tomllib.loads(text)
        for key in path:
            value = value[key]
        return True
    except (KeyError, IndexError, TypeError):
        return False
    except tomllib.TOMLDecodeError:
        return None


_TITLES = {  # of results whose name does not say it
    "load_factors": "Critical load factors",
    "linearised": "Linearised about the start",
    "rigid": "Rigid motions",
    "limit_points": "Limit points, load factor",
    "bifurcations": "Bifurcations, load factor",
}


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
        with _located(self.source, "analysis"):
            return self.analysis.run(self.model, [at for output in self.outputs for at in output.asked])

    def result(self, found: Found, seconds: float, written: Sequence[str]) -> dict[str, Any]:
        """Return all that is printed."""
        outputs = []
        for output in self.outputs:
            rows = output.rows(found.solution)
            units = {name: self.model.unit(UNITS[name]) for name in rows[0] if name in UNITS}
            critical = output.critical(found.solution) if isinstance(found.solution, EquilibriumPath) else {}
            outputs.append({"name": output.name, "units": units, "rows": rows, **critical})
        return {
            "title": self.title,
            "file": str(self.source.file),
            "analysis": self.analysis.kind,
            "beams": len(self.model.beams),
            **summary(found.solution),
            "seconds": seconds,
            **found.values,
            "warnings": [in_keys(warning) for warning in found.solution.warnings],
            "outputs": outputs,
            "written": written,
        }

    def print(self, result: dict[str, Any], found: Found) -> None:
        """Print a result as tables, and on stderr what was found wrong with it but not warned of."""
        statistics = found.solution.statistics
        effort = f"{counted(statistics.iterations, 'iteration')}, " if statistics.iterations else ""
        sizes = ", ".join(counted(result[f"{what}s"], what) for what in ("beam", "coordinate", "state"))
        print(f"{self.title}\n{self.analysis.kind}: {sizes}, {effort}{result['seconds']:.2f} s; {statistics.outcome}")
        for name, values in found.values.items():
            unit = f" [{self.model.unit(UNITS[name])}]" if name in UNITS else ""
            rows = [{"": number, name: value} for number, value in enumerate(values, 1)]
            print_table(_TITLES.get(name, name.capitalize()) + unit, rows)
        for output in result["outputs"]:
            print_table(output["name"], output["rows"], output["units"])
            for critical in CRITICAL:
                title = f"{output['name']}, at {critical.replace('_', ' ')}"
                print_table(title, output.get(critical, ()), output["units"])
        for finding in findings(found.solution):
            if finding.kind is None:
                print(f"warning: {in_keys(finding.sentence)}", file=sys.stderr)
        if result["written"]:
            print("\n" + "\n".join(f"wrote {path}" for path in result["written"]))


def read_model_file(path: str | PathLike[str]) -> Job:
    """Return the contents of a model file (TOML). Raises ModelFileError with file, line and key."""
    source, names = read_source(Path(path)), Names(TYPES)
    with _located(source):
        for section in (*ACTING, "outputs"):
            if not isinstance(tables := source.values.get(section, []), list):
                raise KeyFault(f"must be an array of tables, each headed [[{section}]], got {shown(tables)}", section)
        if not source.values.get("beams") and set(source.values) <= set(_FILE.keys):
            raise InputError("a model needs at least one beam, a table headed [beams.NAME]")
        given = build(_FILE, source.values, names)
        with fault_at(table=given.keys() & {"units", "redundant_conditions"}):
            model = _model(list(names.parts["beams"].values()), list(names.parts["bodies"].values()), given, source)
        analysis = given.get("analysis", Analysis("static", {}))
        for number, output in enumerate(outputs := given.get("outputs", [])):
            with fault_at("outputs", number, table=source.values["outputs"][number]):
                output.require(model, analysis)
    return Job(source, given.get("title", source.file.stem), model, analysis, outputs)


@contextmanager
def _located(source: Source, section: str = "") -> Iterator[None]:
    """Raise what is wrong inside as a ModelFileError with its place; section: that of the keys that messages name."""
    try:
        with fault_at(table=source.values.get(section, ())):
            yield
    except ConvergenceError as error:
        error.args, error.remedy = (in_keys(str(error)),), in_keys(error.remedy)
        raise
    except KeyFault as fault:
        path = (section, *fault.path) if section and fault.path else fault.path
        raise source.error(in_keys(str(fault)), *path) from fault


def _model(beams: list[Beam], bodies: list[RigidBody | FloatingBody], given: dict[str, Any], source: Source) -> Model:
    """Return the model, or raise the error of the first part that it refuses."""

    def made(masses: Sequence[Any] = (), **parts: Any) -> Model:
        model = Model(beams, masses=[*masses, *bodies], **parts)
        system = System(Model(model.beams, model.supports, joints=model.joints, masses=bodies), static=True)
        _ = system.prescribed, system.inclined  # raise InputError for what two supports constrain
        return model

    acting = {section: given[section] for section in ACTING if section in given}
    try:
        whole = {key: given[key] for key in ("units", "redundant_conditions") if key in given}
        return made(**whole, **{section: list(chain.from_iterable(parts)) for section, parts in acting.items()})
    except InputError:
        for section, parts in acting.items():
            for number in range(len(parts)):
                with fault_at(section, number, table=source.values[section][number]):
                    made(**{section: list(chain.from_iterable(parts[: number + 1]))})
        raise


def _each_place(kinds: Kinds, table: Any, names: Names) -> list[Any]:
    """Return the part of a table, or one for each of its `points` or `beams`. Raises KeyFault."""
    require_table(table)
    for plural, single in (("points", "point"), ("beams", "beam")):
        if isinstance(places := table.get(plural), list):
            rest = {key: value for key, value in table.items() if key != plural}
            try:
                return [part(kinds, {**rest, single: (place := each)}, names) for each in places]
            except KeyFault as fault:
                path = (plural, places.index(place), *fault.path[1:]) if fault.path[:1] == (single,) else fault.path
                raise KeyFault(str(fault), *path) from None
    return [part(kinds, table, names)]


def _body_of_beams(reduced: Reduced, names: Names) -> FloatingBody:
    """Return a floating body, whose interfaces and beams no longer are those of the model."""
    beams = names.parts["beams"]
    for name in [name for name, beam in beams.items() if any(beam is own for own in reduced.beams)]:
        pairs = zip(reduced.interfaces, reduced.body.points, strict=True)
        names.parts["interfaces"][name] = {own.fraction: at for own, at in pairs if own.beam is beams[name]}
        del beams[name]
    return reduced.body


def _named(section: str) -> Any:
    """Return the type of the tables [section.NAME], whose parts are known by their names from there on."""

    def register(tables: dict[str, Any], info: ValidationInfo) -> None:
        names: Any = info.context
        for name, table in tables.items():
            with fault_at(name):
                beam = section == "beams"
                default = "rigid-body" if section == "bodies" else None
                made = build(Beam, table, names, name=name) if beam else part(NAMED[section], table, names, default)
                if isinstance(made, Reduced):
                    made = _body_of_beams(made, names)
                names.parts[section][name] = made

    return Annotated[dict[str, Any], AfterValidator(register)]


_FILE = Keyed(
    dict,
    {
        "title": (str, ""),
        "units": (str, ""),
        "redundant_conditions": (str, ""),
        **{section: (_named(section), None) for section in NAMED},
        "analysis": (reader(partial(part, ANALYSES, default="static")), None),
        "outputs": (list[reader(partial(build, Output))], None),  # type: ignore[misc]
        **{section: (list[reader(partial(_each_place, kinds))], None) for section, kinds in ACTING.items()},  # type: ignore[misc]
    },
)
