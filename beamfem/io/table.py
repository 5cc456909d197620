"""What varies along a beam over the steps, as labelled arrays."""

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.results.along import QUANTITIES, AxisPoints

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_PIECES = 4  # of an element between neighbouring points
Variable = tuple[tuple[str, ...], np.ndarray, dict[str, str]]


def arrays(solution: "Solution", beam: Beam) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Return data and coordinates by name: dimensions, values, and attributes with `units` and `long_name`.

    Data along the beam (row, station): x, y, ux, uy [m], vx, vy [m/s] of a motion, rotation [rad], normal, shear [N],
    moment [N m], axial_strain [-], shear_angle [rad]; of the model (row,): kinetic, strain, potential energy [J].
    Coordinates: time [s] or load_factor (row,), arc_length [m], x0, y0 [m] of the reference (station,). Elements that
    meet both have a station at their common end, where section forces may jump.
    """
    mesh, about = solution.model.meshes[solution.model.number_of(beam)], partial(_about, solution.model)
    points = AxisPoints(mesh, _PIECES)
    rows = np.arange(len(solution))
    along = ("row", "station")
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
        data[f"{name}_energy"] = ("row",), getattr(energy, name), about(f"{name} energy of the model", "J")
    at = ("load_factor", "load factor", "1") if solution.static else ("time", "time", "s")
    coordinates: dict[str, Variable] = {
        at[0]: (("row",), solution.at, about(at[1], at[2])),
        "arc_length": (("station",), points.arc_length, about("arc length in the reference", "m")),
        "x0": (("station",), points.reference[:, 0], about("reference x", "m")),
        "y0": (("station",), points.reference[:, 1], about("reference y", "m")),
    }
    return data, coordinates


def to_xarray(solution: "Solution", beam: Beam | None = None) -> Any:
    """Return an xarray.Dataset of `arrays` of a beam, by default the only one; statistics are its attributes.

    Raises InputError where there are several beams and none is named; MissingPackageError without xarray.
    """
    with needed_for("to_xarray"):
        import xarray
    beams = solution.model.beams
    if beam is None:
        if len(beams) > 1:
            raise InputError(f"the model has {len(beams)} beams; name one: to_xarray(beam)")
        beam = beams[0]
    data, coordinates = arrays(solution, beam)
    return xarray.Dataset(data, coordinates, asdict(solution.statistics))


def _about(model: Model, name: str, unit: str) -> dict[str, str]:
    return {"long_name": name, "units": "1" if unit in ("-", "1") else model.unit(unit)}
