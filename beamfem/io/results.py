"""Solutions in HDF5 files: the model described in JSON, the states in rows."""

import json
from dataclasses import asdict, replace
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.errors import BeamfemError, InputError
from beamfem.io.critical import load_factors, load_path, save_critical
from beamfem.io.description import describe, rebuild
from beamfem.path import Path as EquilibriumPath
from beamfem.solution import Solution, Statistics
from beamfem.status import Status

_FORMAT = "beamfem solution"
_FORMAT_VERSION = 1
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_BLOCK_BYTES = 2**20
_STATES = ("at", "p", "v", "a")
_OPTIONAL = ("stability", "turned", "loaded")


def save(solution: Solution, path: str | PathLike[str]) -> None:
    """Write model and states into one HDF5 file; folders in the path are made.

    Raises InputError for a model with parts that cannot be saved, BeamfemError without h5py.
    """
    h5py = _h5py()
    # a model that cannot be described must not cost the file that may already be there
    at = np.append(solution.at, load_factors(solution)) if isinstance(solution, EquilibriumPath) else solution.at
    description = json.dumps(describe(solution.model, at))
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    block = max(min(_BLOCK_BYTES // (8 * solution.p.shape[1]), len(solution)), 1)
    with h5py.File(target, "w") as file:
        file.attrs["format"] = _FORMAT
        file.attrs["format_version"] = _FORMAT_VERSION
        file.attrs["beamfem_version"] = version("beamfem")
        file.attrs["static"] = solution.static
        file.attrs["statistics"] = json.dumps(asdict(solution.statistics) | {"status": solution.status.name})
        file.attrs["all_rows"] = len(solution)
        file.attrs["rows"] = 0
        file.create_dataset("model", data=description)
        for name in _OPTIONAL:
            values = getattr(solution, name)
            if values is not None and values.size:
                file.create_dataset(name, data=values)
        for name in _STATES:
            row = getattr(solution, name).shape[1:]
            file.create_dataset(name, (0, *row), np.float64, maxshape=(None, *row), chunks=(block, *row))
        file.flush()
        for first in range(0, len(solution), block):
            _append(file, solution, slice(first, min(first + block, len(solution))))
        if isinstance(solution, EquilibriumPath):
            save_critical(file, solution)


def load(path: str | PathLike[str]) -> Solution:
    """Return the solution in a file; functions of time come back as `Sampled`, their values at the saved rows.

    Of a file whose writer was killed the rows that were written. Raises FileNotFoundError, InputError for a file that
    is damaged, of a newer format or not of beamfem, BeamfemError without h5py.
    """
    h5py = _h5py()
    source = Path(path)
    if not source.exists():
        raise FileNotFoundError(f"there is no file {source}")
    with source.open("rb") as stream:
        if stream.read(len(_SIGNATURE)) != _SIGNATURE:
            raise InputError(f"{source} is not a file that beamfem saved: it is no HDF5 file")
    try:
        with h5py.File(source, "r") as file:
            return _read(file)
    except InputError as error:
        raise InputError(f"{source} cannot be loaded: {error}") from error
    except (OSError, KeyError, IndexError, TypeError, ValueError, RuntimeError, AssertionError) as error:
        message = f"{source} cannot be loaded: it is truncated, damaged or still being written ({error})"
        raise InputError(message) from error


def _h5py() -> Any:
    try:
        import h5py
    except ImportError:
        raise BeamfemError("saving and loading solutions needs h5py: pip install beamfem[store]") from None
    return h5py


def _append(file: Any, solution: Solution, rows: slice) -> None:
    for name in _STATES:
        file[name].resize(rows.stop, axis=0)
        file[name][rows] = getattr(solution, name)[rows]
    # rows count only when their numbers have left for the file
    file.flush()
    file.attrs.modify("rows", rows.stop)
    file.flush()


def _read(file: Any) -> Solution:
    if file.attrs.get("format") != _FORMAT:
        raise InputError("it is an HDF5 file, but not one that beamfem saved")
    if file.attrs["format_version"] > _FORMAT_VERSION:
        raise InputError(
            f"beamfem {file.attrs['beamfem_version']} wrote it in format {file.attrs['format_version']}, this version "
            f"reads formats up to {_FORMAT_VERSION}; a newer beamfem can load it"
        )
    rows, all_rows = int(file.attrs["rows"]), int(file.attrs["all_rows"])
    if rows == 0:
        raise InputError("its writing was cut off before the first rows")
    model = rebuild(json.loads(file["model"].asstr()[()]))
    at, p, v, a = (np.asarray(file[name][:rows]) for name in _STATES)
    if at.shape != (rows,) or any(values.shape != (rows, model.size) for values in (p, v, a)):
        raise InputError(f"its arrays do not fit its model of {model.size} coordinates and its {rows} rows")
    statistics = _statistics(json.loads(file.attrs["statistics"]))
    if rows < all_rows:
        ended = f"{statistics.ended}; the file holds {rows} of {all_rows} rows because its writing was cut off"
        statistics = replace(statistics, ended=ended, status=Status.STOPPED)
    known = {name: np.asarray(file[name][:rows]) for name in _OPTIONAL if name in file}
    return load_path(file, Solution(model, bool(file.attrs["static"]), at, p, v, a, statistics, **known))


def _statistics(saved: dict[str, Any]) -> Statistics:
    """Return the statistics of a file; older ones know no status and no warnings."""
    status = Status[saved.pop("status", Status.COMPLETED.name)]
    if np.isnan(saved.get("digits", np.nan)):
        saved.pop("digits", None)  # not known: that of the default, which equals itself
    return Statistics(**saved | {"status": status, "warnings": tuple(saved.get("warnings", ()))})
