"""Models and solutions as small tables for notebooks."""

from collections import Counter
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from beamfem.model.beam import names
from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.solve.motion.period_error import lengthened_period
from beamfem.tables import as_html
from beamfem.view.labels import place

if TYPE_CHECKING:
    from beamfem.solve.modes.modes import Modes
    from beamfem.solve.stability.buckling import Buckling

_BEAMS = 12  # listed each
_VALUES = 500_000  # most points in one array
_EQUAL = 1e-9  # what differs by less is the same: points of two beams at their joint, the round-off of a zero


def model_rows(model: Model) -> list[tuple[str, str]]:
    """Return the contents of a model as pairs of name and text."""
    elements, length = sum(mesh.elements for mesh in model.meshes), sum(beam.curve.length for beam in model.beams)
    names = ", ".join(dict.fromkeys(mesh.beam.element.name for mesh in model.meshes))
    rows = [
        ("beams", f"{len(model.beams)}, {length:.4g} {model.unit('m')} long in all"),
        ("elements", f"{elements} ({names})"),
        ("coordinates", str(model.size)),
        ("supports", _kinds(model.supports)),
        ("loads", _kinds(model.loads)),
    ]
    further = (("joints", model.joints), ("connectors", model.connectors), ("masses", model.masses))
    return rows + [(name, _kinds(items)) for name, items in further if items]


def solution_rows(solution: Solution) -> list[tuple[str, str]]:
    """Return how a solution was found, where it ends and how far it moves, as pairs of name and text."""
    statistics = solution.statistics
    name, unit = ("load factor", "") if solution.static else ("time", f" {solution.model.unit('s')}")
    rows = [("rows", str(len(solution)))]
    if len(solution):
        rows.append((name, f"{solution.at[0]:.6g} to {solution.at[-1]:.6g}{unit}"))
    rows += [
        ("solved in", statistics.effort),
        ("ended", statistics.outcome),
    ]
    if solution.energy_drift is not None:
        rows.append(("energy", str(solution.energy_drift)))
    frequency, error = lengthened_period(solution)
    if frequency > 0.0:
        text = f"lengthens the period by {100 * error:.2g} % at {frequency:.4g} {solution.model.unit('Hz')}"
        rows.append(("time step", text))
    if len(solution):
        name, value = largest_displacement(solution)
        rows.append((name, value))
    return rows + [("warning", sentence) for sentence in solution.warnings]


def largest_displacement(solution: Solution, with_row: bool = True) -> tuple[str, str]:
    """Return the largest displacement of all rows, its place, and its time or load factor unless there is one row."""
    from beamfem.view.frames import axis_points, moment_of

    best = (-1.0, np.zeros(2), np.zeros(2), 0)
    for points in axis_points(solution, _VALUES // len(solution)):
        chunk = max(1, _VALUES // len(points.xi))
        for first in range(0, len(solution), chunk):
            moved = points.positions(solution.p[first : first + chunk])[0] - points.reference
            size = np.linalg.norm(moved, axis=-1)
            row, point = np.unravel_index(int(size.argmax()), size.shape)
            if size[row, point] > best[0] * (1.0 + _EQUAL):
                best = float(size[row, point]), moved[row, point], points.reference[point], first + int(row)
    largest, moved, at, number = best
    length = solution.model.unit("m")
    text = f"{largest:.4g} {length}: {_vector(moved)} {length} at {place(solution.model, at)}"
    return "largest displacement", text + (f", {moment_of(solution, number)}" if with_row else "")


def _vector(moved: np.ndarray) -> str:
    """Return a displacement as text, without the round-off of a zero."""
    ux, uy = np.where(np.abs(moved) <= _EQUAL * np.abs(moved).max(), 0.0, moved)
    return f"({ux:.4g}, {uy:.4g})"


def model_table(model: Model) -> str:
    """Return a model as an HTML table."""
    return f"<b>Model</b>{as_html((), model_rows(model))}{_beams(model)}"


def solution_table(solution: Solution) -> str:
    """Return a solution and its model as an HTML table."""
    kind = type(solution).__name__ + (" of statics" if solution.static else " of a motion")
    return f"<b>{kind}</b>{as_html((), solution_rows(solution) + model_rows(solution.model))}"


def modes_table(modes: "Modes") -> str:
    """Return the frequencies of modes as an HTML table."""
    rows, unit = [], modes.model.unit
    for number, (frequency, growth) in enumerate(zip(modes.frequencies.tolist(), modes.growth.tolist(), strict=True)):
        what = f"rigid: {modes.rigid[number]}" if number < len(modes.rigid) else "grows" if growth > 0.0 else ""
        rows.append((number, frequency, growth, what))
    head = ("mode", f"frequency [{unit('Hz')}]", f"growth [{unit('1/s')}]", "")
    return f"<b>Modes</b>{as_html(head, rows)}"


def buckling_table(buckling: "Buckling") -> str:
    """Return critical load factors as an HTML table."""
    parts = (buckling.load_factors.tolist(), buckling.kinds, buckling.uncertainty.tolist())
    rows = [(number, *row) for number, row in enumerate(zip(*parts, strict=True))]
    table = as_html(("mode", "load factor", "kind", "uncertainty"), rows)
    return f"<b>Buckling</b>{table}{escape(f'ended because {buckling.ended}')}"


def _beams(model: Model) -> str:
    unit = model.unit("m")
    head = ("beam", f"from [{unit}]", f"to [{unit}]", f"length [{unit}]", "element", "elements", "forces")
    lines, labels = [], names(model.beams)
    for number, (beam, mesh) in enumerate(zip(model.beams, model.meshes, strict=True)):
        if number == _BEAMS:
            lines.append(("…", f"{len(model.beams) - _BEAMS} more", *[""] * 5))
            break
        ends = [place(model, at) for at in (mesh.position[0], mesh.position[-1])]
        kind = (beam.element.name, str(mesh.elements), beam.element.forces.name)
        lines.append((labels[number], *ends, f"{beam.curve.length:.4g}", *kind))
    return as_html(head, lines)


def _kinds(items: Sequence[object]) -> str:
    return _counted(type(item).__name__ for item in items) or "none"


def _counted(names: Iterable[str]) -> str:
    counted = Counter(names)
    return ", ".join(name if number == 1 else f"{number} {name}" for name, number in counted.items())
