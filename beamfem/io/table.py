"""Quantities along beams over the steps, and shapes of modes, as labelled arrays."""

from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.extras import needed_for
from beamfem.io.vtk_boundary import ROLES, points_of_forces
from beamfem.model.beam import Beam, names
from beamfem.model.model import Model
from beamfem.results.axis_fields import QUANTITIES, section_forces
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import LikeBeams, equal_beams
from beamfem.results.beam_stress import stress_at
from beamfem.results.solution import Solution
from beamfem.validation import flag

if TYPE_CHECKING:
    from beamfem.solve.modes.modes import Modes
    from beamfem.solve.stability.buckling import Buckling


_PIECES = 4  # of an element between neighbouring points
_ALONG = ("rotation", "normal", "shear", "moment", "axial_strain", "shear_angle")
_STRESSES = {
    "lower": "normal stress at the lower face",
    "upper": "normal stress at the upper face",
    "shear": "largest shear stress over the height",
    "von_mises": "largest von Mises stress over the height",
}
Variable = tuple[tuple[str, ...], np.ndarray, dict[str, str]]
Variables = dict[str, Variable]


def arrays(solution: Solution, beam: Beam | None, errors: bool = False) -> tuple[Variables, Variables]:
    """Return data and coordinates by name: dimensions, values, and attributes with `units` and `long_name`.

    The first dimension is `time` or `load_factor`. Data along the beam, or all beams in succession (time, station): x,
    y, ux, uy [m], vx, vy [m/s] of a motion, rotation [rad], normal, shear [N], moment [N m], axial_strain [-] (Green
    strain xx of the axis), shear_angle [rad]; stress_lower, stress_upper, stress_shear, stress_von_mises [Pa] where
    sections have them, see `BeamStress`; of the model (time,): kinetic, strain, potential energy [J]. Coordinates: time
    [s] or load_factor, number of the beam (with the `names` of all as an attribute, where there are any), arc_length
    [m], x0, y0 [m] of the reference (station,). errors: whether there is error_share [-] of the elements along beams.
    Adjacent elements each have a station at their common end, where section forces may jump.
    """
    over, about = _over(solution), partial(named, solution.model)
    names = _ALONG + ("error_share",) * flag("errors", errors)
    groups, energy = groups_of(solution.model, beam, len(solution)), solution.energy()
    data = side_by_side(groups, lambda group: _along(solution, group.points, names))
    data = {name: each for name, each in data.items() if not name.startswith("stress_") or np.isfinite(each[1]).any()}
    for name in ("kinetic", "strain", "potential"):
        data[f"{name}_energy"] = (over,), getattr(energy, name), about(f"{name} energy of the model", "J")
    at = about(over.replace("_", " "), "1" if solution.static else "s")
    return data, {over: ((over,), solution.at, at), **stations(solution.model, groups)}


def _along(solution: Solution, points: AxisPoints, names: tuple[str, ...]) -> Variables:
    """Return what `arrays` has along beams, at points of them."""
    along, about, rows = (_over(solution), "station"), partial(named, solution.model), slice(None)
    r = points.positions(solution.p)[0]
    vectors = {"": ("position", "m", r), "u": ("displacement", "m", r - points.reference)}
    if not solution.static:
        vectors["v"] = "velocity", "m/s", points.velocities(solution.p, solution.v)
    data: Variables = {}
    for axis, letter in enumerate("xy"):
        for short, (name, unit, values) in vectors.items():
            data[short + letter] = along, values[..., axis], about(f"{name} {letter}", unit)
    forces, stresses = section_forces(points, solution, rows), stress_at(solution, points, rows)
    for name in names:
        quantity = QUANTITIES[name]
        own = forces[name] if name in forces else quantity.values(points, solution, rows)
        data[name] = along, own, about(quantity.label, quantity.unit)
    return data | {f"stress_{name}": (along, stresses[name], about(label, "Pa")) for name, label in _STRESSES.items()}


def groups_of(model: Model, beam: Beam | None, rows: int) -> list[LikeBeams]:
    """Return the stations of one beam, or of all in groups of like beams."""
    if beam is None:
        return equal_beams(model, [AxisPoints.spaced(mesh, _PIECES) for mesh in model.meshes], rows)
    number = model.number_of(beam)
    return [LikeBeams([number], [AxisPoints.spaced(model.meshes[number], _PIECES)])]


def stations(model: Model, groups: list[LikeBeams]) -> Variables:
    """Return the coordinates of the stations of beams by name, see `arrays`."""
    about = partial(named, model)
    called = {"names": ", ".join(names(model.beams))} if any(beam.name for beam in model.beams) else {}

    def of_group(group: LikeBeams) -> Variables:
        number, points = np.repeat(group.numbers, group.counts), group.points
        coordinates = {
            "beam": (number, about("number of the beam", "1") | called),
            "arc_length": (points.arc_length, about("arc length in the reference", "m")),
            "x0": (points.reference[:, 0], about("reference x", "m")),
            "y0": (points.reference[:, 1], about("reference y", "m")),
        }
        return {name: (("station",), *variable) for name, variable in coordinates.items()}

    return side_by_side(groups, of_group)


def side_by_side(groups: list[LikeBeams], of_group: Callable[[LikeBeams], Variables]) -> Variables:
    """Return variables of groups of beams joined along their stations, in the order of the beams."""
    parts = [of_group(group) for group in groups]
    if len(parts) == 1:
        return parts[0]
    order = np.argsort(np.concatenate([np.repeat(group.numbers, group.counts) for group in groups]), kind="stable")
    return {
        name: (over, np.concatenate([part[name][1] for part in parts], axis=-1)[..., order], about)
        for name, (over, _, about) in parts[0].items()
    }


def to_xarray(solution: Solution, beam: Beam | None = None, errors: bool = False) -> Any:
    """Return an xarray.Dataset of the `arrays` of a beam, or of all beams in succession, see `Solution.to_xarray`."""
    data, coordinates = arrays(solution, beam, errors)
    # files hold texts and numbers
    words = {"status": solution.status.name, "warnings": "\n".join(solution.statistics.warnings)}
    return as_dataset(data, coordinates, asdict(solution.statistics) | words, single=beam is not None)


def as_dataset(data: Variables, coordinates: Variables, attributes: dict[str, Any], single: bool) -> Any:
    """Return an xarray.Dataset over stations, or, of a single beam, over its arc length, where none is twice."""
    with needed_for("to_xarray"):
        import xarray
    dataset = xarray.Dataset(data, coordinates, attributes)
    if not single:
        return dataset
    dataset["arc_length"] = "station", told_apart(dataset["arc_length"].to_numpy()), dataset["arc_length"].attrs
    dataset["beam"] = (), dataset["beam"].to_numpy()[0], dataset["beam"].attrs
    return dataset.swap_dims(station="arc_length")


def to_pandas(solution: Solution, beam: Beam | None = None, forces: bool = False, errors: bool = False) -> Any:
    """Return a pandas.DataFrame of the `arrays`, with a row for each time and station, see `Solution.to_pandas`."""
    with needed_for("to_pandas"):
        import pandas
    if forces:
        return pandas.DataFrame(_forces(solution)).set_index([_over(solution), "point"]).sort_index()
    data, coordinates = arrays(solution, beam, errors)
    over, stations = _over(solution), len(coordinates["beam"][1])
    places = {name: coordinates[name][1] for name in ("beam", "arc_length", "x0", "y0")}
    places["arc_length"] = told_apart(places["arc_length"])
    columns = {over: np.repeat(told_apart(solution.at), stations)}
    columns |= {name: np.tile(values, len(solution)) for name, values in places.items()}
    columns |= {name: values.ravel() for name, (_, values, _) in data.items() if values.ndim == 2}
    return pandas.DataFrame(columns).set_index([over, "beam", "arc_length"])


def _over(solution: Solution) -> str:
    """Return the name of what a solution is a function of."""
    return "load_factor" if solution.static else "time"


def _forces(solution: Solution) -> dict[str, np.ndarray]:
    """Return the columns of the forces of supports, connectors and joints, row by row for each point."""
    groups = points_of_forces(solution.model)
    place = [group.points.positions(solution.p)[0][:, 0] for group in groups]
    values = [group.values(solution) for group in groups]
    acting = [np.column_stack([each["force"][:, 0, :2], each["moment"][:, 0]]) for each in values]
    numbers = np.concatenate([np.empty((0, 5)), *map(np.column_stack, zip(place, acting, strict=True))])
    columns = {_over(solution): np.tile(told_apart(solution.at), len(groups))}
    columns["point"] = np.repeat(np.arange(len(groups)), len(solution))
    columns["role"] = np.repeat(np.array([ROLES[group.role] for group in groups]), len(solution))
    columns["kind"] = np.repeat(np.array([group.kind for group in groups]), len(solution))
    return columns | dict(zip(("x", "y", "fx", "fy", "moment"), numbers.T, strict=True))


def told_apart(values: np.ndarray) -> np.ndarray:
    """Return values (n,) of which the first of two equal neighbours is one unit of the last digit smaller."""
    before = np.append(values[:-1] == values[1:], False)
    return np.where(before, np.nextafter(values, -np.inf), values)


def named(model: Model, name: str, unit: str) -> dict[str, str]:
    """Return the attributes of a variable: its name in words, and its unit in that of the model."""
    return {"long_name": name, "units": "1" if unit in ("-", "1") else model.unit(unit)}


def modes_to_xarray(modes: "Modes", beam: Beam | None = None) -> Any:
    """Return an xarray.Dataset over the modes: frequency [Hz], growth [1/s], rigid motion, shapes ux, uy along beams.

    Shapes are scaled as `modes.modes`; of complex ones the real part. Stations as in `solution.to_xarray`.
    """
    about = partial(named, modes.model)
    rigid = np.array([*modes.rigid, *[""] * (len(modes) - len(modes.rigid))], dtype=object)
    data: Variables = {
        "frequency": (("mode",), modes.frequencies, about("frequency", "Hz")),
        "growth": (("mode",), modes.growth, about("growth", "1/s")),
        "rigid": (("mode",), rigid, {"long_name": "what a rigid mode moves"}),
    }
    states = np.broadcast_to(modes.state.p, modes.modes.shape)
    return _with_shapes(modes.model, states, np.real(modes.modes), beam, data)


def buckling_to_xarray(buckling: "Buckling", beam: Beam | None = None) -> Any:
    """Return an xarray.Dataset over the critical points: load_factor, kind, uncertainty, shapes ux, uy.

    Shapes are scaled as `buckling.modes`. Stations as in `solution.to_xarray`.
    """
    about = partial(named, buckling.model)
    data: Variables = {
        "load_factor": (("mode",), buckling.load_factors, about("load factor", "1")),
        "kind": (("mode",), np.array(buckling.kinds, dtype=object), {"long_name": "kind of critical point"}),
        "uncertainty": (("mode",), buckling.uncertainty, about("relative error of the load factor", "1")),
    }
    dataset = _with_shapes(buckling.model, buckling.states, buckling.modes, beam, data)
    return dataset.assign_attrs(ended=buckling.ended, status=buckling.status.name)


def _with_shapes(model: Model, p: np.ndarray, shapes: np.ndarray, beam: Beam | None, data: Variables) -> Any:
    """Return the data with ux, uy of shapes (modes, n) about states p (modes, n) along one beam or all."""
    groups = groups_of(model, beam, len(shapes))

    def of_group(group: LikeBeams) -> Variables:
        rates = group.points.velocities(p, shapes)
        return {
            f"u{axis}": (("mode", "station"), rates[..., i], {"long_name": f"shape {axis}"})
            for i, axis in enumerate("xy")
        }

    number: Variables = {"mode": (("mode",), np.arange(len(shapes)), {"long_name": "number of the mode"})}
    return as_dataset(
        data | side_by_side(groups, of_group), number | stations(model, groups), {}, single=beam is not None
    )
