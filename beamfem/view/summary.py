"""Models, solutions, states, beams, energies, section forces and stresses as small tables for notebooks."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import is_dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.model.beam import Beam, names
from beamfem.model.model import Model
from beamfem.results.beam_stress import PARTS, BeamStress
from beamfem.results.energies import Energy
from beamfem.results.section_forces import FORCES, SectionForces, extreme_force
from beamfem.results.solution import Solution, State
from beamfem.solve.motion.period_error import lengthened_period
from beamfem.tables import as_html
from beamfem.validation import shown
from beamfem.view.frames import axis_points, moment_of
from beamfem.view.labels import place

if TYPE_CHECKING:
    from beamfem.solve.modes.modes import Modes
    from beamfem.solve.stability.buckling import Buckling

_BEAMS = 12  # listed each
_VALUES = 500_000  # most points in one array
_LONG = 160  # characters of what a beam is made of
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
    rows += [("solved in", statistics.effort), ("ended", statistics.outcome)]
    if solution.energy_drift is not None:
        rows.append(("energy", str(solution.energy_drift)))
    frequency, error = lengthened_period(solution)
    if frequency > 0.0:
        text = f"lengthens the period by {100 * error:.2g} % at {frequency:.4g} {solution.model.unit('Hz')}"
        rows.append(("time step", text))
    if len(solution):
        rows.append(largest_displacement(solution))
    return rows + [("warning", sentence) for sentence in solution.warnings]


def largest_displacement(solution: Solution, with_row: bool = True) -> tuple[str, str]:
    """Return the largest displacement of all rows, its place, and its time or load factor unless there is one row."""
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
    ux, uy = np.where(np.abs(moved) <= _EQUAL * np.abs(moved).max(), 0.0, moved)
    text = f"{largest:.4g} {length}: ({ux:.4g}, {uy:.4g}) {length} at {place(solution.model, at)}"
    return "largest displacement", text + (f", {moment_of(solution, number)}" if with_row else "")


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
        rows.append((number, frequency, 2.0 * np.pi * frequency, growth, what))
    head = ("mode", f"frequency [{unit('Hz')}]", f"[{unit('rad/s')}]", f"growth [{unit('1/s')}]", "")
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
    lines = []
    for label, beam, mesh in list(zip(names(model.beams), model.beams, model.meshes, strict=True))[:_BEAMS]:
        ends = [place(model, at) for at in (mesh.position[0], mesh.position[-1])]
        kind = (beam.element.name, str(mesh.elements), beam.element.forces.name)
        lines.append((label, *ends, f"{beam.curve.length:.4g}", *kind))
    further = len(model.beams) - _BEAMS
    return as_html(head, [*lines, *([("…", f"{further} more", *[""] * 5)] if further > 0 else [])])


def _kinds(items: Sequence[object]) -> str:
    counted = Counter(type(item).__name__ for item in items).items()
    return ", ".join(name if number == 1 else f"{number} {name}" for name, number in counted) or "none"


def state_table(state: State) -> str:
    """Return a state and its model as an HTML table."""
    speed = float(np.abs(state.v).max()) if state.v.size else 0.0
    rows = [
        ("load factor or time", f"{state.at:.6g}"),
        largest_displacement(state.as_row(static=True), with_row=False),
        ("at rest", "no" if speed else "yes"),
        *model_rows(state.model),
    ]
    return f"<b>{type(state).__name__}</b>{as_html((), rows)}"


def beam_table(beam: Beam) -> str:
    """Return what a beam is made of as an HTML table."""
    ends = " to ".join(f"({x:.4g}, {y:.4g})" for x, y in (beam.start.reference, beam.end.reference))
    rows = [
        ("curve", f"{type(beam.curve).__name__}, {ends}"),
        ("length", f"{beam.curve.length:.6g}"),
        ("elements", str(beam.element_count)),
        ("element", f"{beam.element.name}, {beam.element.forces.name}"),
        ("section", _numbers(beam.section) if beam.prismatic else "varies along the beam"),
        ("material", "of the section" if beam.material is None else _numbers(beam.material)),
    ]
    rows += [] if beam.damping is None else [("damping", f"{type(beam.damping).__name__}, {_numbers(beam.damping)}")]
    return f"<b>Beam</b>{as_html((), rows)}"


def energy_table(energy: Energy) -> str:
    """Return energies as an HTML table: at the start, at the end, and between which values they were."""
    unit = energy.unit
    head = ("energy", *(f"{name} [{unit}]" for name in ("first", "last", "smallest", "largest")))
    each = ((name, getattr(energy, name)) for name in ("kinetic", "strain", "potential", "total"))
    rows = [(name, *map(float, (e[0], e[-1], e.min(), e.max()))) for name, e in each if len(e)]
    return f"<b>Energy</b>{as_html(head, rows)}"


def section_forces_table(forces: SectionForces) -> str:
    """Return the extremes of section forces as an HTML table, each with its place and row."""
    unit = forces.units.of
    rows = []
    for name, si in zip(FORCES, ("N", "N", "N m"), strict=True):
        for which, measure in (("smallest", np.negative), ("largest", np.asarray)):
            value, at, row = extreme_force(forces, name, measure)
            value = 0.0 if abs(value) <= _EQUAL * np.abs(getattr(forces, name)).max() else value
            rows.append((f"{which} {name} [{unit(si)}]", value, at, row))
    head = ("", "value", f"at arc length [{unit('m')}]", "row")
    return f"<b>SectionForces</b>{as_html(head, rows)}"


def stress_table(stress: BeamStress) -> str:
    """Return the peaks of stresses as an HTML table, each with its place, row and load factor or time."""
    unit = stress.units.of
    rows: list[tuple[Any, ...]] = []
    for part in PARTS:
        peak = stress.peak(part)
        name = f"{part} [{'-' if part == 'utilisation' else unit('Pa')}]"
        cells = (peak.value, peak.arc_length, peak.row, peak.at) if peak.row >= 0 else ("not known", "", "", "")
        rows.append((name, *cells))
    when = "load factor" if stress.static else f"time [{unit('s')}]"
    head = ("", "extreme", f"at arc length [{unit('m')}]", "row", when)
    return f"<b>Stress, peaks</b>{as_html(head, rows)}"


def _numbers(item: Any) -> str:
    """Return the numbers of a dataclass that are not zero, by name; of others their text, cut."""
    members = vars(item) if is_dataclass(item) else {}
    named = [
        f"{name.replace('_', ' ')} {value:.4g}" for name, value in members.items() if type(value) is float and value
    ]
    text = ", ".join(named) or " ".join(shown(item).split())
    return text if len(text) <= _LONG else f"{text[: _LONG - 2]} …"
