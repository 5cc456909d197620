"""Parts of a model in words, for the legends of files and for the command line."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any

from beamfem.damping import Damping, KelvinVoigt
from beamfem.material import Material
from beamfem.model.beam import Beam, Point, names
from beamfem.model.joint_base import Joint
from beamfem.model.model import Model
from beamfem.model.part_units import field_units
from beamfem.section import Layered, Section, ShapedSection, StiffnessSection
from beamfem.section.fibres import FibreSection
from beamfem.section.outline import RectangleOutline, TubeOutline

Unit = Callable[[str], str]  # as `Model.unit`


def material_in_words(material: Material | None, unit: Unit) -> str:
    """Return a material with its numbers and units; what is left at its default is left out."""
    if material is None:
        return "of the section"
    parts = [
        f"E = {material.youngs_modulus:g} {unit('Pa')}",
        f"nu = {material.poisson_ratio:g}",
        f"density {material.density:g} {unit('kg/m^3')}",
    ]
    further = {"retardation_time": "s", "thermal_expansion": "1/K", "strength": "Pa"}
    for field in fields(material):
        value = getattr(material, field.name)
        if field.name in further and value != field.default:
            parts.append(f"{field.name.replace('_', ' ')} {value:g} {unit(further[field.name])}")
    return ", ".join(parts)


def damping_in_words(damping: Damping, unit: Unit) -> str:
    """Return a damping with its numbers and units."""
    if isinstance(damping, KelvinVoigt):
        return f"Kelvin-Voigt damping {damping.time:g} {unit('s')}"
    return f"Rayleigh damping {damping.mass:g} {unit('1/s')}, {damping.stiffness:g} {unit('s')}"


def section_in_words(section: Any, unit: Unit) -> str:
    """Return a section with its sizes and units; of the user's own class its text."""
    metre = unit("m")
    match section:
        case ShapedSection(name=str(name)) if name:
            return name
        case ShapedSection(outline=RectangleOutline() as shape):
            return f"rectangle {shape.breadth:g} x {shape.high - shape.low:g} {metre}"
        case ShapedSection(outline=TubeOutline() as shape):
            size = f"diameter {2.0 * shape.outer:g} {metre}"
            wall = shape.outer - shape.inner
            return f"circle, {size}" if shape.inner == 0.0 else f"tube, {size}, wall {wall:g} {metre}"
        case Section():
            height = "" if section.height is None else f", height {section.height:g} {metre}"
            return f"A = {section.area:g} {unit('m^2')}, I = {section.second_moment:g} {unit('m^4')}{height}"
        case Layered():
            layers = ", ".join(f"{layer.thickness:g}" for layer in section.layers)
            return f"layers of {layers} {metre} from below, {section.width:g} {metre} wide"
        case FibreSection():
            law = type(section.law).__name__
            return f"{section_in_words(section.shape, unit)} of {len(section.fibres[0])} fibres, {law}"
        case StiffnessSection():
            forces = f"E A = {section.axial:g} {unit('N')}, k_s G A = {section.shear:g} {unit('N')}"
            return f"{forces}, E I = {section.bending:g} {unit('N m^2')}"
    return "varies along the beam" if callable(section) else str(section)


def beam_in_words(beam: Beam, model: Model) -> str:
    """Return a beam in a line: its name, axis, elements, section and material."""
    axis = f"{type(beam.curve).__name__}, {beam.curve.length:.6g} {model.unit('m')} long"
    elements = f"{model.mesh_of(beam.start).elements} x {beam.element.name} ({beam.element.forces.name})"
    section, material = section_in_words(beam.section, model.unit), material_in_words(beam.material, model.unit)
    damping = "" if beam.damping is None else f", {damping_in_words(beam.damping, model.unit)}"
    return f"{_value_in_words(beam, model)}: {axis}, {elements}, {section}, material {material}{damping}"


def part_in_words(part: Any, model: Model) -> str:
    """Return a support, joint, connector or load in a line, with the fields that are not their defaults."""
    units = field_units(part)
    words = [
        f"{field.name} {_value_in_words(value, model)} {model.unit(units.get(field.name, ''))}"
        for field, value in ((field, getattr(part, field.name)) for field in fields(part))
        if hasattr(value, "shape") or (value is not None and value != field.default)
    ]
    return f"{type(part).__name__}: {', '.join(word.strip() for word in words)}"


def _value_in_words(value: Any, model: Model) -> str:
    """Return a value of a part; points and beams as model files name them."""
    match value:
        case Beam():
            return names(model.beams)[model.number_of(value)]
        case Point():
            ends = {0.0: "start", 1.0: "end"}
            place = ends.get(value.fraction, f"at({value.fraction:g})")
            return f"{_value_in_words(value.beam, model)}.{place}"
        case Joint():
            return part_in_words(value, model)
        case tuple():
            return f"({', '.join(_value_in_words(item, model) for item in value)})"
        case float():
            return f"{value:.6g}"
    return "a function" if callable(value) else str(value)
