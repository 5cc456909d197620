"""A model file solved at every combination of values of its varied keys."""

from dataclasses import dataclass
from typing import Any

from beamfem.cli.modelfile.errors import ModelFileError
from beamfem.cli.modelfile.found import Found
from beamfem.cli.modelfile.outputs import Output
from beamfem.cli.modelfile.read import Job, job_of
from beamfem.cli.modelfile.table import Table
from beamfem.cli.modelfile.varied import Varied, with_values
from beamfem.sweeps.result import Sweep
from beamfem.sweeps.sweep import sweep

_NUMBERED = {
    "load_factors": "load factor",
    "frequencies": "frequency [{Hz}]",
    "growth": "growth [{rate}]",
    "limit_points": "limit point",
    "bifurcations": "bifurcation",
}


@dataclass(frozen=True)
class PointOfFile:
    """The analysis of a file with other values in place of those in the file."""

    root: Table
    varied: tuple[Varied, ...]

    def job(self, values: dict[str, Any]) -> Job:
        """Return the model and analysis with these values by name. Raises ModelFileError."""
        try:
            return job_of(with_values(self.root, {parameter.path: values[parameter.name] for parameter in self.varied}))
        except ModelFileError as error:
            where = ", ".join(f"{name} = {value}" for name, value in values.items())
            raise ModelFileError(f"{error.message} (with {where})", error.file, error.line, error.key) from error

    def __call__(self, **values: Any) -> dict[str, Any]:
        job = self.job(values).imperfect()
        return numbers(job, job.solve())


def solve_sweep(job: Job) -> Sweep:
    """Return the results of a file with a sweep, one row per point. Raises ModelFileError before the first solve."""
    point = PointOfFile(job.root, job.varied)
    first = {parameter.name: parameter.values[0] for parameter in job.varied}
    for parameter in job.varied:
        for value in parameter.values:
            _require_single_rows(point.job(first | {parameter.name: value}))
    parameters: Any = {parameter.name: parameter.values for parameter in job.varied}
    return sweep(point, **parameters)


def numbers(job: Job, found: Found) -> dict[str, Any]:
    """Return the outputs of a file by name, and the results of its analysis, numbered from 1."""
    unit = job.model.unit
    named = {
        f"{title.format(Hz=unit('Hz'), rate=unit('1/s'))} {number}": value
        for key, title in _NUMBERED.items()
        for number, value in enumerate(found.values.get(key, ()), 1)
    }
    for output in job.outputs:
        (row,) = output.rows(found.solution)
        named |= {f"{output.name} {quantity}": row[quantity] for quantity in output.quantities}
    return named


def _require_single_rows(job: Job) -> None:
    """Raise ModelFileError for an output with more than one number per quantity and point of the sweep."""
    for number, output in enumerate(job.outputs, 1):
        where = f"outputs[{number}]"
        if output.beam is not None or output.connector is not None:
            raise ModelFileError(
                _refused(output, "point or of the model, not along a beam or of a connector"), job.file, None, where
            )
        if output.at != "last" and (output.at == "all" or len(output.at) != 1):
            raise ModelFileError(_refused(output, 'single state: at = "last" or one number'), job.file, None, where)
        if output.name in [other.name for other in job.outputs[: number - 1]]:
            raise ModelFileError(f"two outputs are called {output.name!r}; a sweep needs names", job.file, None, where)


def _refused(output: Output, what: str) -> str:
    return f"in a sweep {output.name!r} must be of a {what}"
