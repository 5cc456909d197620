"""A page with a slider over the steps of a solution: one file, drawn by the browser, works offline."""

import json
from html import escape
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import path_of, whole
from beamfem.errors import InputError
from beamfem.results.solution import Solution
from beamfem.validation import count, optional, text
from beamfem.view.deformed_shapes import Shapes
from beamfem.view.frames import axis_of_rows, moment_of, spread_rows
from beamfem.view.notebook_paths import WrittenFile
from beamfem.view.page_fields import FURTHER, as_text, fields_of, names_of
from beamfem.view.page_loads import loads_of
from beamfem.view.summary import model_rows, solution_rows
from beamfem.view.support_symbols import joints_of, supports_of

_BYTES = 560_000  # of numbers in a page; as text they grow by a third
_LEVELS = 65534  # into which the box of all shapes is cut


def write_player(solution: Solution, path: str | PathLike[str], title: str | None = None, frames: int = 60) -> Path:
    """Write a self-contained page with a slider over up to `frames` steps and return its path; folders are created.

    The body moves with its supports, optionally coloured by a section force [N, N m], a stress [Pa], utilisation,
    rotation [rad], displacement [m] or speed [m/s]; a curve of the largest displacement and the statistics are shown
    beside it. Below 1 MB: for large models only the axes and fewer steps are drawn. Raises InputError for a suffix
    other than .html.
    """
    target = path_of(path)
    if target.suffix != ".html":
        right = target.with_suffix(".html") if target.name else target / "steps.html"
        raise InputError(f'a page is a .html file, got "{target}"; "{right}" would be right')
    if len(solution) == 0:
        raise InputError("the solution has no rows, so there is nothing to show")
    heading = optional(text)("title", title) or (target.stem.replace("_", " ").replace("-", " ") or "Solution")
    statistics = [*solution_rows(solution), *model_rows(solution.model)]
    table = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in statistics)
    template = files("beamfem.view").joinpath("player.html").read_text(encoding="utf-8")
    # "</" would end the script in which the numbers stand
    data = json.dumps(_data(solution, count("frames", frames)), separators=(",", ":")).replace("</", "<\\/")
    page = template.replace("@TITLE@", escape(heading)).replace("@TABLE@", table).replace("@DATA@", data)
    with whole(target) as partial:
        partial.write_text(page, encoding="utf-8")
    return WrittenFile(target)


def _data(solution: Solution, frames: int) -> dict[str, Any]:
    shapes, body, names = _sized(solution, frames)
    sides = shapes.body if body else [axis[:, :, None] for axis in shapes.axis]
    low, high = shapes.box
    size = float(np.max(high - low)) or 1.0
    # (rows, points, sides, 2)
    numbers = np.round((np.concatenate(sides, axis=1) - low) / size * _LEVELS - 0.5 * _LEVELS).astype("<i2")
    moved = [
        np.linalg.norm(axis - points.reference, axis=-1)
        for axis, points in zip(shapes.axis, shapes.points, strict=True)
    ]
    rows = [int(row) for row in shapes.rows]
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
        "at": [float(f"{solution.at[row]:.7g}") for row in rows],
        "axis": f"{name} [{unit}]",
        "length": solution.model.unit("m"),
        "moved": [float(f"{value:.5g}") for value in np.concatenate(moved, axis=1).max(axis=1)],
        "points": as_text(numbers),
        "reference": as_text(
            np.round(
                (np.concatenate([points.reference for points in shapes.points]) - low) / size * _LEVELS - 0.5 * _LEVELS
            ).astype("<i2")
        ),
        "loads": loads_of(shapes),
        "outlines": outlines,
        "places": places,
        "fields": fields_of(shapes, names),
    }


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
        stamps.add_all(joints_of(shapes.solution, int(row)))
        by_row.append(stamps)
    outlines = [
        {
            "line": np.round(by_row[0].outlines[key], 3).tolist(),
            "colour": _css(colour),
            "fill": {"none": None, "white": "#fff"}.get(fill, fill),
        }
        for key, colour, _, fill in by_row[0].places
    ]
    places = [[[_rounded(place) for place in group] for group in stamps.places.values()] for stamps in by_row]
    return outlines, places[:1] if all(row_places == places[0] for row_places in places) else places


def _rounded(place: np.ndarray) -> list[float]:
    return [float(f"{value:.6g}") for value in place]


def _css(colour: str) -> str:
    """Return a colour of matplotlib, a name or a grey between 0 and 1, as CSS."""
    return colour if colour.startswith("#") else f"rgb({','.join([str(round(255 * float(colour)))] * 3)})"
