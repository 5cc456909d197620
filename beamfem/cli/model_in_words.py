"""The parts of a model in a line each, for `beamfem info`."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from beamfem.io.in_words import material_in_words, section_in_words
from beamfem.model.beam import Beam, Point
from beamfem.model.field_units import field_units
from beamfem.model.joints import Joint
from beamfem.model.model import Model
from beamfem.model.named import names
from beamfem.model.sampled import Sampled, SampledAlong
from beamfem.results.status import counted


def beam_lines(model: Model) -> list[str]:
    """Return a line for each beam: its name, its axis, its elements, its section and its material."""
    lines = []
    for name, beam, mesh in zip(names(model.beams), model.beams, model.meshes, strict=True):
        axis = f"{type(beam.curve).__name__}, {beam.curve.length:.6g} {model.unit('m')} long"
        parts = [axis, f"{mesh.elements} x {beam.element.name} ({beam.element.forces.name})"]
        parts.append(section_in_words(beam.section, model.unit))
        if beam.material is not None:
            parts.append(material_in_words(beam.material, model.unit))
        lines.append(f"{name}: {', '.join(parts)}")
    return lines


def part_line(item: Any, model: Model) -> str:
    """Return a support, joint, connector or load in a line, with its places and what differs from its defaults."""
    words, told = [], tuple[str, ...]()
    if isinstance(item, Joint):
        (x, y), told = item.a.reference, ("a", "b")
        places = " and ".join(_place(point, model) for point in (item.a, item.b))
        words.append(f"{places}, at ({x:g}, {y:g}) {model.unit('m')}")
    for field in fields(item):
        value = getattr(item, field.name)
        is_default = not isinstance(value, np.ndarray) and (value is None or value == field.default)
        if field.name not in told and not is_default:
            words.append(_field(item, field.name, value, model))
    return f"{type(item).__name__}: {', '.join(words)}"


def _field(item: Any, name: str, value: Any, model: Model) -> str:
    if isinstance(value, Point):
        return _where(value, model) if name == "point" else f"{name} {_where(value, model)}"
    if isinstance(value, tuple) and value and all(isinstance(point, Point) for point in value):
        return f"{name} {' and '.join(_where(point, model) for point in value)}"
    if isinstance(value, Beam):
        return f"along {names(model.beams)[model.number_of(value)]}"
    if isinstance(value, Sampled | SampledAlong):
        return f"{name} a function, saved at {counted(len(value.at), 'value')}"
    if isinstance(value, bool):
        return name if value else f"{name} false"
    unit = field_units(item).get(name)
    return f"{name} {_number(value)}" + (f" {model.unit(unit)}" if unit else "")


def _where(point: Point, model: Model) -> str:
    """Return a point as model files name it, and where it is."""
    x, y = point.reference
    return f"{_place(point, model)}, at ({x:g}, {y:g}) {model.unit('m')}"


def _place(point: Point, model: Model) -> str:
    """Return a point as model files name it."""
    name = names(model.beams)[model.number_of(point.beam)]
    ends = {0.0: "start", 1.0: "end"}
    return f"{name}.{ends.get(point.fraction, f'at({point.fraction:g})')}"


def _number(value: Any) -> str:
    if isinstance(value, int | float | np.number):
        return f"{value:.6g}"
    if isinstance(value, Sequence | np.ndarray) and not isinstance(value, str):
        return f"({', '.join(map(_number, value))})"
    points = getattr(value, "points", None)  # of a table over time, which is saved as it is
    return f"a table of {counted(len(points), 'point')}" if points is not None else str(value)
