"""A page with a slider over the steps of a solution: one file, drawn by the browser, works offline."""

import base64
import itertools
import json
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import whole
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import join
from beamfem.model.beam import Beam
from beamfem.model.load_base import factor
from beamfem.results.axis_fields import QUANTITIES, section_forces
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import of_each
from beamfem.results.beam_stress import stress_at
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading
from beamfem.units import units_of
from beamfem.validation import count, optional, require_known, text
from beamfem.view.deformed_shapes import Shapes, limits
from beamfem.view.frames import axis_of_rows, axis_points, moment_of, spread_rows
from beamfem.view.load_drawing import PlacedLoads, PlacedRow
from beamfem.view.notebook_paths import file_to_write
from beamfem.view.summary import model_rows, solution_rows
from beamfem.view.support_symbols import joints_of, supports_of

_FORCES = ("moment", "normal", "shear")
# names of fields and of the parts of `BeamStress`
_STRESSES = {"stress": "von_mises", "upper": "upper", "lower": "lower", "utilisation": "utilisation"}
FURTHER = ("upper", "lower", "utilisation")  # only on pages with room for them
_STEPS = 254.0  # steps between the limits; level 0 is what is not known


def names_of(solution: Solution) -> tuple[str, ...]:
    """Return the names of the fields of a page: stresses where a section has some."""
    known = set()
    model = solution.model
    for numbers in model.numbered.joinable:
        mesh = join([model.meshes[number] for number in numbers])
        starts = AxisPoints.on_each(mesh, np.zeros(1))
        stress = stress_at(solution, starts, slice(len(solution) - 1, len(solution)))
        known |= {name for name, part in _STRESSES.items() if np.isfinite(stress[part]).any()}
    stresses = tuple(name for name in _STRESSES if name in known)
    moved = ("rotation", "displacement") if solution.static else ("rotation", "displacement", "speed")
    return (*_FORCES, *stresses, *moved)


def fields_of(shapes: Shapes, names: Sequence[str]) -> list[dict[str, Any]]:
    """Return fields by name in levels from 1 to 255 between their limits, 0 where they are not known."""
    solution, rows = shapes.solution, shapes.rows
    by_beam = of_each(shapes.groups, lambda points: _along(points, solution, rows, names), 2)
    result = []
    for number, name in enumerate(names):
        quantity, parts = QUANTITIES[name], [values[number] for values in by_beam]
        low, high = limits(parts)
        values = np.concatenate(parts, axis=1)
        known = np.isfinite(values)
        levels = np.where(known, 1.0 + np.round((np.where(known, values, low) - low) / (high - low) * _STEPS), 0.0)
        whole = "" if quantity.over_height is None else ", largest over the height"  # a page has one colour a section
        scale, unit = units_of(solution.model.units).readable(max(abs(low), abs(high)), quantity.unit)
        limits_shown = {"label": f"{quantity.label}{whole} [{unit}]", "low": scale * low, "high": scale * high}
        result.append({"name": name, **limits_shown, "values": as_text(levels.astype("u1"))})
    return result


def _along(points: AxisPoints, solution: Solution, rows: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Return fields (names, rows, points)."""
    result = section_forces(points, solution, rows)
    if any(name in _STRESSES for name in names):
        stress = stress_at(solution, points, rows)
        result |= {name: stress[part] for name, part in _STRESSES.items()}
    result |= {name: QUANTITIES[name].values(points, solution, rows) for name in names if name not in result}
    return np.stack([result[name] for name in names])


def as_text(numbers: np.ndarray) -> str:
    """Return numbers as text for a page."""
    return base64.b64encode(np.ascontiguousarray(numbers).tobytes()).decode()


_LONGEST, _SHORTEST, _SPREAD = 40.0, 18.0, 26.0  # [pixels]: the largest force, a small one, loads along beams
_MOST = 40_000  # numbers of arrows on a page


def loads_of(shapes: Shapes) -> list[dict[str, Any]]:
    """Return for each row forces [x, y, across, up, tip], moments [x, y, sense] and gravity [across, up].

    x, y [m]; across, up [pixels]: the arrow, with its tip at x, y if `tip` is 1, else its tail. For models with many
    loads or rows, the loads of the last row are used for all.
    """
    solution, rows = shapes.solution, [int(row) for row in shapes.rows]
    system, at = loading(solution)
    arrows = sum(55 if isinstance(load.place, Beam) else 5 for load in solution.model.loads)
    chosen = rows if arrows * len(rows) <= _MOST else rows[-1:] if arrows <= _MOST else []
    loads = [PlacedLoads() for _ in chosen]
    for row, here in zip(chosen, loads, strict=True):
        placed = PlacedRow(solution, row)
        for load in solution.model.loads:
            here.add(placed, load, factor(load, float(at[row]), system.static))
    sizes = [float(np.linalg.norm(vector)) for each in loads for _, vector, _ in each.forces]
    dense = max((float(np.abs(forces.vectors).max()) for each in loads for _, forces in each.lines), default=1.0)
    return [
        {
            "forces": [
                *(_arrow(place, _scaled(vector, max(sizes)), tip) for place, vector, tip in each.forces),
                *(
                    _arrow(place, _SPREAD * vector / dense, True)
                    for places, forces in each.lines
                    for place, vector in zip(places, forces.vectors, strict=True)
                    if vector.any()
                ),
            ],
            "moments": [[*_short(place), float(np.sign(moment))] for place, moment in each.moments],
            "gravity": [*itertools.chain(*(_short(g / np.linalg.norm(g) * _LONGEST) for g in each.gravity[-1:]))],
        }
        for each in loads
    ]


def _scaled(vector: np.ndarray, largest: float) -> np.ndarray:
    """Return an arrow [pixels]: small forces are longer than to scale, so that they are seen."""
    size = float(np.linalg.norm(vector))
    return np.asarray(vector / size * max(_LONGEST * np.sqrt(size / largest), _SHORTEST))


def _arrow(place: np.ndarray, vector: np.ndarray, tip: bool) -> list[float]:
    return [*_short(place), *(round(float(part), 1) for part in vector), int(tip)]


def _short(values: np.ndarray, digits: int = 6) -> list[float]:
    return [float(f"{value:.{digits}g}") for value in values]


_BYTES = 560_000  # of numbers in a page; as text they grow by a third
_LEVELS = 65534  # into which the box of all shapes is cut
_CURVE, _AT_ONCE = 500, 500_000  # points of the axes, and parts of the curve; points in one array


def write_player(
    solution: Solution,
    path: str | PathLike[str] | None = None,
    title: str | None = None,
    frames: int = 60,
    colour: str | None = None,
) -> Path:
    """Write a self-contained page with a slider over up to `frames` steps and return its path: `Solution.to_html`."""
    target = file_to_write(path, "a page", ".html", example="steps.html")
    if len(solution) == 0:
        raise InputError("the solution has no rows, so there is nothing to show")
    stem = "" if path is None else target.stem.replace("_", " ").replace("-", " ")
    heading = optional(text)("title", title) or stem or "Solution"
    statistics = [*solution_rows(solution), *model_rows(solution.model)]
    table = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in statistics)
    template = files("beamfem.view").joinpath("player.html").read_text(encoding="utf-8")
    # "</" would end the script in which the numbers stand
    content = _data(solution, count("frames", frames))
    if colour is not None:
        content["colour"] = "stress" if colour == "von_mises" else colour
        require_known("colour of a page", content["colour"], [field["name"] for field in content["fields"]])
    data = json.dumps(content, separators=(",", ":")).replace("</", "<\\/")
    page = template.replace("@TITLE@", escape(heading)).replace("@TABLE@", table).replace("@DATA@", data)
    with whole(target) as partial:
        partial.write_text(page, encoding="utf-8")
    return target


def _data(solution: Solution, frames: int) -> dict[str, Any]:
    shapes, body, names = _sized(solution, frames)
    sides = shapes.body if body else [axis[:, :, None] for axis in shapes.axis]
    low, high = shapes.box
    size = float(np.max(high - low)) or 1.0

    def levels(places: np.ndarray) -> str:
        return as_text(np.round((places - low) / size * _LEVELS - 0.5 * _LEVELS).astype("<i2"))

    rows = [int(row) for row in shapes.rows]
    moved, chosen = _largest_moves(solution)
    name, unit = axis_of_rows(solution)
    outlines, places = _supports(shapes)
    return {
        "low": low.tolist(),
        "high": high.tolist(),
        "size": size,
        "levels": _LEVELS,
        "sides": 2 if body else 1,
        "beams": [len(points.xi) for points in shapes.points],
        "pieces": [points.pieces for points in shapes.points],
        "labels": [moment_of(solution, row) for row in rows],
        "at": _short(solution.at[rows], 7),
        "axis": f"{name} [{unit}]",
        "length": solution.model.unit("m"),
        "moved": _short(moved[rows]),
        "curve": [_short(solution.at[chosen], 7), _short(moved[chosen])],
        "points": levels(np.concatenate(sides, axis=1)),  # (rows, points, sides, 2)
        "reference": levels(np.concatenate([points.reference for points in shapes.points])),
        "loads": loads_of(shapes),
        "outlines": outlines,
        "places": places,
        "fields": fields_of(shapes, names),
    }


def _largest_moves(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest displacement of each row (rows,) [m], and the rows of a curve that keeps its peaks."""
    moved = np.zeros(len(solution))
    for points in axis_points(solution, _CURVE):
        chunk = max(1, _AT_ONCE // len(points.xi))
        for first in range(0, len(moved), chunk):
            own = points.positions(solution.p[first : first + chunk])[0] - points.reference
            here = moved[first : first + chunk]
            np.maximum(here, np.linalg.norm(own, axis=-1).max(axis=1), out=here)
    groups = np.array_split(np.arange(len(moved)), min(len(moved), _CURVE))
    peaks = [(group[0], group[moved[group].argmin()], group[moved[group].argmax()], group[-1]) for group in groups]
    return moved, np.unique(peaks)


def _sized(solution: Solution, frames: int) -> tuple[Shapes, bool, tuple[str, ...]]:
    """Return the shapes that fit on a page, whether bodies fit too, and the names of the fields."""
    rows, names = spread_rows(solution, frames), names_of(solution)
    elements = sum(mesh.elements for mesh in solution.model.meshes)
    room = _BYTES // (len(rows) * (8 + len(names)))
    if room >= 2 * elements:
        # an element of n pieces has n + 1 points
        return Shapes(solution, rows, total=max(1, room - elements)), True, names
    names = tuple(name for name in names if name not in FURTHER)
    most = max(2, _BYTES // (2 * elements * (4 + len(names))))
    return Shapes(solution, spread_rows(solution, min(frames, most)), total=1), False, names


def _supports(shapes: Shapes) -> tuple[list[Any], list[Any]]:
    """Return outlines [symbols] and for each row the places [m] of each outline; one row if all of them stay fixed."""
    by_row = []
    for row in shapes.rows:
        stamps = supports_of(shapes.solution, int(row), shapes.centre)
        by_row.append(joints_of(shapes.solution, int(row), stamps))
    outlines = [
        {
            "line": np.round(by_row[0].outlines[key], 3).tolist(),
            # matplotlib takes a number for a grey
            "colour": colour if colour.startswith("#") else f"rgb({','.join([str(round(255 * float(colour)))] * 3)})",
            "fill": {"none": None, "white": "#fff"}.get(fill, fill),
        }
        for key, colour, _, fill in by_row[0].places
    ]
    places = [[[_short(place) for place in group] for group in stamps.places.values()] for stamps in by_row]
    return outlines, places[:1] if all(row_places == places[0] for row_places in places) else places
