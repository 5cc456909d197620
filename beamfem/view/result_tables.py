"""States, beams, energies, section forces and stresses as small tables for notebooks."""

from dataclasses import is_dataclass
from typing import Any

import numpy as np

from beamfem.model.beam import Beam
from beamfem.results.beam_stress import PARTS, BeamStress
from beamfem.results.energies import Energy
from beamfem.results.extremes import Force
from beamfem.results.section_forces import SectionForces, extreme_force
from beamfem.results.solution import State
from beamfem.tables import as_html
from beamfem.validation import shown
from beamfem.view.summary import largest_displacement, model_rows

_LONG = 160  # characters of what a beam is made of
_NOTHING = 1e-9  # of the largest value: round-off of a zero


def state_table(state: State) -> str:
    """Return a state and its model as an HTML table."""
    from beamfem.results.solution import Solution
    from beamfem.results.status import Statistics

    turned = None if state.turned is None else state.turned[None]
    parts = (np.array([state.at]), state.p[None], state.v[None], state.a[None], Statistics(0, 0, 0, "one state"))
    alone = Solution(state.model, True, *parts, turned=turned)
    speed = float(np.abs(state.v).max()) if state.v.size else 0.0
    rows = [
        ("load factor or time", f"{state.at:.6g}"),
        largest_displacement(alone, with_row=False),
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
    rows = []
    for name in ("kinetic", "strain", "potential", "total"):
        values = getattr(energy, name)
        if len(values):
            rows.append((name, *map(float, (values[0], values[-1], values.min(), values.max()))))
    return f"<b>Energy</b>{as_html(head, rows)}"


def section_forces_table(forces: SectionForces) -> str:
    """Return the extremes of section forces as an HTML table, each with its place and row."""
    unit = forces.units.of
    rows = []
    named: tuple[tuple[Force, str], ...] = (("normal", "N"), ("shear", "N"), ("moment", "N m"))
    for name, si in named:
        for which, measure in (("smallest", np.negative), ("largest", np.asarray)):
            value, at, row = extreme_force(forces, name, measure)
            value = 0.0 if abs(value) <= _NOTHING * np.abs(getattr(forces, name)).max() else value
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
