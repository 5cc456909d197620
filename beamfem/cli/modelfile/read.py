"""Read a model file."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

from beamfem.cli.modelfile import actions, parts
from beamfem.cli.modelfile.actions import Structure
from beamfem.cli.modelfile.analyses import Analysis, Found, analysis
from beamfem.cli.modelfile.code import Code, run_code
from beamfem.cli.modelfile.curves import OutputCurve, curves
from beamfem.cli.modelfile.errors import ModelFileError
from beamfem.cli.modelfile.files import OutputFile, files
from beamfem.cli.modelfile.imperfection import Imperfection, imperfection
from beamfem.cli.modelfile.lines import key_lines
from beamfem.cli.modelfile.outputs import Output, outputs
from beamfem.cli.modelfile.phrases import told_in_keys
from beamfem.cli.modelfile.places import moved
from beamfem.cli.modelfile.table import Source, Table
from beamfem.cli.modelfile.toml_faults import in_words, line_of
from beamfem.cli.modelfile.varied import Varied, varied
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.model.model import Model

_HDF5 = b"\x89HDF"
_KEYS = (
    "title",
    "units",
    "code",
    "materials",
    "sections",
    "elements",
    "functions",
    "beams",
    "frames",
    "supports",
    "joints",
    "connectors",
    "imperfection",
    "loads",
    "analysis",
    "outputs",
    "curves",
    "files",
    "sweep",
)


@dataclass(frozen=True)
class Job:
    """Contents of a model file: the model with its beams by name, the analysis, outputs, files and varied keys."""

    title: str
    structure: Structure
    model: Model
    kind: str
    analysis: Analysis
    outputs: tuple[Output, ...]
    curves: tuple[OutputCurve, ...]
    files: tuple[OutputFile, ...]
    varied: tuple[Varied, ...]
    root: Table
    imperfection: Imperfection | None = None

    @property
    def file(self) -> Path:
        """The model file."""
        return self.root.source.file

    @property
    def beams(self) -> Mapping[str, Beam]:
        """The beams by name; those of a frame are NAME[1], NAME[2], ..."""
        return {name: self.structure.moved.beam(beam) for name, beam in self.structure.beams.items()}

    def imperfect(self) -> "Job":
        """Return the job of the imperfect model, if there is an imperfection. Raises ModelFileError, ConvergenceError.

        Its mode has to be solved for, so this comes after all checks of the file.
        """
        if self.imperfection is None:
            return self
        try:
            with told_in_keys():
                model = self.imperfection.of_model(self.model)
        except InputError as error:
            raise self.root.table("imperfection").refused(error) from error
        return _job(self.root, replace(self.structure, moved=moved(self.model, model)), model, self.title, None)

    def solve(self) -> Found:
        """Run the analysis and return its results. Raises ConvergenceError; ModelFileError for errors found late."""
        try:
            with told_in_keys():
                return self.analysis.run(self.model, [at for output in self.outputs for at in output.asked])
        except ModelFileError:
            raise
        except InputError as error:
            raise ModelFileError(str(error), self.file, None, None) from error


def read_model_file(path: str | PathLike[str]) -> Job:
    """Return the contents of a model file (TOML). Raises ModelFileError with file, line and key.

    Runs the Python file that is named in `code`, if there is one.
    """
    file = Path(path)
    if file.is_char_device() or file.is_fifo():
        raise ModelFileError("this is a device, not a model file", file, None, None)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise ModelFileError("there is no such file", file, None, None) from None
    except IsADirectoryError:
        raise ModelFileError("this is a folder, not a model file", file, None, None) from None
    except UnicodeDecodeError:
        results = file.read_bytes().startswith(_HDF5)
        what = "a results file, which beamfem info, plot and export read" if results else "not a text in UTF-8"
        raise ModelFileError(f"this is {what}; model files are TOML", file, None, None) from None
    try:
        values = tomllib.loads(text)
        lines = key_lines(text)
    except tomllib.TOMLDecodeError as error:
        message = str(error)
        raise ModelFileError(f"not valid TOML: {in_words(message, text)}", file, line_of(message, text), None) from None
    except ValueError as error:  # whole numbers of thousands of digits
        raise ModelFileError(f"a number cannot be read: {error}", file, None, None) from None
    except RecursionError:
        raise ModelFileError("arrays or tables are nested too deeply", file, None, None) from None
    bare = Table(Source(file, lines), (), values)
    return job_of(Table(Source(file, lines, _code(bare)), (), values))


def _code(root: Table) -> Code | None:
    """Run the Python file that a model file names, if any. Raises ModelFileError."""
    if "code" not in root.values:
        return None
    name = root.text("code")
    try:
        return run_code(root.source.file.parent, name)
    except InputError as error:
        raise root.error(str(error), "code") from error


def job_of(root: Table) -> Job:
    """Return the job that the whole table of a file describes. Raises ModelFileError."""
    root.require_known(_KEYS)
    title = root.text("title") if "title" in root.values else root.source.file.stem
    function = parts.functions(root)
    function.check_all()
    structure = actions.structure(root, function)
    moving = analysis(root, structure.places).moving
    return _job(root, structure, actions.model(root, structure, function, moving), title, imperfection(root))


def _job(root: Table, known: Structure, model: Model, title: str, crooked: Imperfection | None) -> Job:
    chosen = analysis(root, known.places)
    kind = root.values.get("analysis", {}).get("kind", "static")
    connectors = dict(zip(root.values.get("connectors", {}), model.connectors, strict=True))
    requested = tuple(outputs(root, known.places, model, chosen, connectors))
    drawn, written = curves(root, known.places, model, chosen), files(root, known.places, model, chosen)
    return Job(title, known, model, kind, chosen, requested, drawn, written, varied(root), root, crooked)
