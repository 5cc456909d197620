"""Quantities along beams over the steps, as labelled arrays."""

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.extras import needed_for
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.model.named import names
from beamfem.results.along import QUANTITIES, AxisPoints

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_PIECES = 4  # of an element between neighbouring points
Variable = tuple[tuple[str, ...], np.ndarray, dict[str, str]]


def arrays(solution: "Solution", beam: Beam) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Return data and coordinates by name: dimensions, values, and attributes with `units` and `long_name`.

    The first dimension is `time` or `load_factor`. Data along the beam (time, station): x, y, ux, uy [m], vx, vy [m/s]
    of a motion, rotation [rad], normal, shear [N], moment [N m], axial_strain [-], shear_angle [rad]; of the model
    (time,): kinetic, strain, potential energy [J]. Coordinates: time [s] or load_factor, number of the beam (with the
    `names` of all as an attribute, where there are any), arc_length [m], x0, y0 [m] of the reference (station,).
    Adjacent elements each have a station at their common end, where section forces may jump.
    """
    mesh, about = solution.model.meshes[solution.model.number_of(beam)], partial(_about, solution.model)
    points = AxisPoints(mesh, _PIECES)
    rows = np.arange(len(solution))
    at = ("load_factor", "load factor", "1") if solution.static else ("time", "time", "s")
    over = (at[0],)
    along = (*over, "station")
    r = points.positions(solution.p)[0]
    moved = r - points.reference
    data: dict[str, Variable] = {}
    for axis, name in enumerate("xy"):
        data[name] = along, r[..., axis], about(f"position {name}", "m")
        data[f"u{name}"] = along, moved[..., axis], about(f"displacement {name}", "m")
        if not solution.static:
            rate = points.velocities(solution.p, solution.v)[..., axis]
            data[f"v{name}"] = along, rate, about(f"velocity {name}", "m/s")
    for name in ("rotation", "normal", "shear", "moment", "axial_strain", "shear_angle"):
        quantity = QUANTITIES[name]
        values = quantity.values(points, solution, rows)
        data[name] = along, values, about(quantity.label, quantity.unit)
    energy = solution.energy()
    for name in ("kinetic", "strain", "potential"):
        data[f"{name}_energy"] = over, getattr(energy, name), about(f"{name} energy of the model", "J")
    called = names(solution.model.beams)
    named = {"names": ", ".join(called)} if any(one.name for one in solution.model.beams) else {}
    number = np.full(len(points.element), solution.model.number_of(beam))
    coordinates: dict[str, Variable] = {
        at[0]: (over, solution.at, about(at[1], at[2])),
        "beam": (("station",), number, about("number of the beam", "1") | named),
        "arc_length": (("station",), points.arc_length, about("arc length in the reference", "m")),
        "x0": (("station",), points.reference[:, 0], about("reference x", "m")),
        "y0": (("station",), points.reference[:, 1], about("reference y", "m")),
    }
    return data, coordinates


def to_xarray(solution: "Solution", beam: Beam | None = None) -> Any:
    """Return an xarray.Dataset of the `arrays` of a beam, or of all beams in succession; statistics are its attributes.

    Raises InputError for a beam of another model; MissingPackageError without xarray.
    """
    with needed_for("to_xarray"):
        import xarray
    data, coordinates = _of_beams(solution, beam)
    return xarray.Dataset(data, coordinates, asdict(solution.statistics))


def to_pandas(solution: "Solution", beam: Beam | None = None) -> Any:
    """Return a pandas.DataFrame of quantities along a beam, or along all, with a row for each time and station.

    Its index is time [s] or load_factor, number of the beam and arc_length [m]; columns: see `arrays`.
    Raises InputError for a beam of another model; MissingPackageError without pandas.
    """
    with needed_for("to_pandas"):
        import pandas
    data, coordinates = _of_beams(solution, beam)
    over, stations = ("load_factor" if solution.static else "time"), len(coordinates["beam"][1])
    columns = {over: np.repeat(solution.at, stations)}
    columns |= {name: np.tile(coordinates[name][1], len(solution)) for name in ("beam", "arc_length", "x0", "y0")}
    columns |= {name: values.ravel() for name, (_, values, _) in data.items() if values.ndim == 2}
    return pandas.DataFrame(columns).set_index([over, "beam", "arc_length"])


def _of_beams(solution: "Solution", beam: Beam | None) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Return the `arrays` of a beam, or of all beams joined along their stations."""
    parts = [arrays(solution, own) for own in (solution.model.beams if beam is None else (beam,))]
    data, coordinates = (_side_by_side([part[kind] for part in parts]) for kind in (0, 1))
    return data, coordinates


def _side_by_side(parts: list[dict[str, Variable]]) -> dict[str, Variable]:
    joined = dict(parts[0])
    for name, (dimensions, _, about) in parts[0].items():
        if "station" in dimensions and len(parts) > 1:
            joined[name] = dimensions, np.concatenate([part[name][1] for part in parts], axis=-1), about
    return joined


def _about(model: Model, name: str, unit: str) -> dict[str, str]:
    return {"long_name": name, "units": "1" if unit in ("-", "1") else model.unit(unit)}
