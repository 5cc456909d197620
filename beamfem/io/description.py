"""A model as plain numbers, lists and names for JSON, and back.

User-defined classes are saved by module and name, and found again if the module is imported.
"""

import sys
from collections.abc import Callable
from dataclasses import MISSING, fields, is_dataclass, replace
from typing import Any

import numpy as np

from beamfem.curves import Parametric
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import energy_points, length_points, stations
from beamfem.model.along_beam import AlongBeam, functions_along, jumps_along
from beamfem.model.beam import Beam, Point
from beamfem.model.check_replaceable import require_remade
from beamfem.model.model import Model
from beamfem.model.rotating_frame import RotatingFrame
from beamfem.model.sampled_functions import Sampled, SampledAlong, SampledSection
from beamfem.model.time_functions import Interpolated
from beamfem.parts.floating_body import FloatingBody
from beamfem.public_names import public_dataclasses
from beamfem.section import ElasticFibreSection, RememberingFibreSection, ShapedSection, StiffnessSection
from beamfem.section.outline import RectangleOutline, StripOutline, TubeOutline
from beamfem.section.protocol import CrossSection
from beamfem.validation import function_value, takes


class NotImportedError(InputError):
    """A file holds a part of a class that no loaded module has."""

    def __init__(self, kind: str, module: str) -> None:
        if module == "__main__":
            message = f"the file holds a {kind} of the script that saved it: define it in this one as it was"
        else:
            message = f"the file holds a {kind} of the module {module}: import that module before loading the file"
        super().__init__(message)
        self.kind, self.module = kind, module


def name_of(part: Any) -> str:
    """Return "module:Class" for a user-defined part of a model. Raises InputError if it cannot be found again."""
    kind = type(part)
    what = f"a {kind.__name__} cannot be saved"
    if not is_dataclass(part):
        raise InputError(f"{what}: only dataclasses can, whose fields tell what they hold")
    if find(f"{kind.__module__}:{kind.__qualname__}") is not kind:
        raise InputError(f"{what}: define its class at the top level of a module, so that it is found again")
    hidden = [field.name for field in fields(part) if not field.init]
    if hidden:
        raise InputError(f"{what}: its field {hidden[0]} is not an argument of the class")
    require_remade(what, part)
    return f"{kind.__module__}:{kind.__qualname__}"


def class_of(name: str) -> Any:
    """Return the class of "module:Class" without importing anything. Raises NotImportedError if there is none."""
    found = find(name)
    if not (isinstance(found, type) and is_dataclass(found)):
        module, _, kind = name.partition(":")
        raise NotImportedError(kind, module)
    return found


def made(name: str, members: dict[str, Any]) -> Any:
    """Return a part of the class "module:Class". Raises InputError if the class is missing or has changed."""
    kind = class_of(name)
    try:
        return kind(**members)
    except TypeError as error:
        raise InputError(f"the class {name} is no longer that which the file was saved with: {error}") from error


def find(name: str) -> Any:
    """Return the attribute "module:name" of a loaded module, None if there is none."""
    module, _, attribute = name.partition(":")
    result: Any = sys.modules.get(module)
    for part in attribute.split("."):
        result = getattr(result, part, None)
    return result


_FOLDERS = ("curves", "damping", "element", "material", "section", "parts")
_FURTHER = (  # public ones of other folders, and those whose objects public functions return
    Model,
    Beam,
    Point,
    RotatingFrame,
    Interpolated,
    FloatingBody,
    ShapedSection,
    StiffnessSection,
    ElasticFibreSection,
    RememberingFibreSection,
    RectangleOutline,
    StripOutline,
    TubeOutline,
    SampledAlong,
    SampledSection,
)
_PUBLIC = (kind for folder in _FOLDERS for kind in public_dataclasses(folder))
_CLASSES: dict[str, Any] = {kind.__name__: kind for kind in (*_PUBLIC, *_FURTHER)}
_OF_TIME = "amplitude"  # the field of a user's part that is known to be a function of time
_DRAWN = 4  # intervals of an element at whose ends a section that varies is saved besides


def describe(model: Model, at: np.ndarray) -> dict[str, Any]:
    """Return the description of a model, with its functions sampled at times [s] or load factors (steps,).

    Raises InputError for a part that cannot be saved.
    """
    writer = _Writer(model, [float(value) for value in np.unique(at)])
    both = zip(model.beams, model.meshes, strict=True)
    beams = [writer.members(_with_values(beam, mesh), Beam) for beam, mesh in both]
    described = {"class": Model.__name__}
    loads = [_with_own_values(load, model) for load in model.loads]
    for field in fields(Model):
        described[field.name] = writer.write(loads if field.name == "loads" else getattr(model, field.name))
    return {"beams": beams, "model": described, "at": writer.at, "functions": writer.values}


def rebuild(description: dict[str, Any]) -> Model:
    """Return the model of a description; its functions are `Sampled`. Raises InputError for an unknown class."""
    at = tuple(description["at"])
    functions = [Sampled(at, tuple(values)) for values in description["functions"]]
    beams: list[Beam] = []
    for beam in description["beams"]:
        beams.append(_read(beam, beams, functions))
    model = _read(description["model"], beams, functions)
    assert isinstance(model, Model)
    return model


def _with_values(beam: Beam, mesh: BeamMesh) -> Beam:
    """Return the beam with a varying section as samples: those that were used, and more for drawing."""
    if isinstance(beam.section, CrossSection | SampledSection):
        return beam
    drawn = np.linspace(0.0, 1.0, _DRAWN + 1)
    also = np.repeat(np.arange(mesh.elements), len(drawn)), np.tile(drawn, mesh.elements)
    points = (stations(mesh), energy_points(mesh)[:2], length_points(mesh)[:2], also)
    parts = [mesh.section_arc_length(element, xi) for element, xi in points]
    at = np.unique(np.concatenate([*parts, [0.0, 0.5 * beam.curve.length, beam.curve.length]]))
    at = at[np.append(True, np.diff(at) > 1e-9 * beam.curve.length)]
    values = tuple(beam.section_at(float(arc)) for arc in at)
    return replace(beam, section=SampledSection(tuple(at.tolist()), values, beam.jumps))


def _with_own_values(load: Any, model: Model) -> Any:
    """Return a load along a beam with its functions as samples: those that were used, and more for drawing."""
    saved: dict[str, Any] = {}
    for name in functions_along(load):
        mesh = model.mesh_of(load.beam.start)
        used, jumps = (length_points(mesh)[:2], energy_points(mesh)[:2], stations(mesh)), jumps_along(load)
        points = [mesh.arc_length_inside(*places, jumps) for places in used]
        drawn = np.linspace(0.0, 1.0, _DRAWN * mesh.elements + 1) * load.beam.curve.length
        at = np.unique(np.concatenate([*points, drawn, [0.5 * load.beam.curve.length]]))
        values = tuple(tuple(value) if np.ndim(value) else value for value in load.values_of(name, at).tolist())
        saved[name] = SampledAlong(tuple(at.tolist()), values, load.kinks_along[name])
    return replace(load, **saved) if saved else load


class _Writer:
    """Beams and functions are written once and referred to by number."""

    def __init__(self, model: Model, at: list[float]) -> None:
        # parts of a model with another mesh are at points of its original
        every = (*enumerate(model.beams), *enumerate(getattr(model, "original", ())))
        self.beams = {id(beam): number for number, beam in every}
        self.at = at
        self.functions: dict[int, tuple[int, Callable[[float], float]]] = {}
        self.values: list[list[float]] = []

    def members(self, value: Any, kind: type[Any] | None = None) -> dict[str, Any]:
        names = [field.name for field in fields(kind or value)]
        return {"class": (kind or type(value)).__name__, **{name: self.write(getattr(value, name)) for name in names}}

    def own_members(self, value: Any) -> dict[str, Any]:
        """Describe a user-defined part. Raises InputError for a function with an unknown argument."""
        described: dict[str, Any] = {"class": name_of(value)}
        for field in fields(value):
            member = getattr(value, field.name)
            if field.name != _OF_TIME and self.has_function(member):
                what = f"a {type(value).__name__} cannot be saved: its field {field.name} is a function"
                if isinstance(value, AlongBeam):
                    raise InputError(f"{what}; if it is one of the arc length, name it in `along`")
                raise InputError(f"{what}; make it a method of the class")
            described[field.name] = self.own_field(member)
        return described

    def own_field(self, given: Any) -> Any:
        if isinstance(given, np.ndarray) and given.dtype.kind in "biufU":
            return {"array": given.tolist()}
        if isinstance(given, tuple | list):
            return [self.own_field(item) for item in given]
        return self.write(given)

    def has_function(self, given: Any) -> bool:
        if isinstance(given, tuple | list):
            return any(map(self.has_function, given))
        return callable(given) and not self.known(given)

    @staticmethod
    def known(value: Any) -> bool:
        return _CLASSES.get(type(value).__name__) is type(value)

    def write(self, value: Any) -> Any:
        if isinstance(value, Parametric):
            value = value.spline()
        if isinstance(value, Beam):
            if id(value) not in self.beams:
                raise InputError(f"a part of the model refers to the beam {value!r}, which is not in the model")
            return {"beam": self.beams[id(value)]}
        if self.known(value):
            return self.members(value)
        if isinstance(value, np.ndarray | np.generic):
            return value.tolist()
        if isinstance(value, tuple | list):
            return [self.write(item) for item in value]
        if value is None or isinstance(value, bool | int | float | str):
            return value
        if callable(value) and not (is_dataclass(value) and _of_several(value)):
            return {"function": self.number(value)}
        return self.own_members(value)

    def number(self, function: Callable[[float], float]) -> int:
        if _of_several(function):
            raise InputError("a function of several numbers cannot be saved; make it a dataclass with __call__")
        if id(function) not in self.functions:
            self.functions[id(function)] = len(self.values), function  # kept, so that no other gets its identity
            self.values.append([function_value("saved function", function, at) for at in self.at])
        return self.functions[id(function)][0]


def _of_several(function: Any) -> bool:
    return takes(function, 3) or (takes(function, 2) and not takes(function, 1))


def _read(value: Any, beams: list[Beam], functions: list[Sampled]) -> Any:
    if isinstance(value, list):
        return tuple(_read(item, beams, functions) for item in value)
    if not isinstance(value, dict):
        return value
    if "class" not in value:
        if "array" in value:
            return np.array(value["array"])
        return beams[value["beam"]] if "beam" in value else functions[value["function"]]
    name = value["class"]
    if name not in _CLASSES and ":" not in name:
        raise InputError(f"this version of beamfem knows no {name}; a newer one may")
    members = {key: _read(item, beams, functions) for key, item in value.items() if key != "class"}
    return made(name, members) if ":" in name else _of_package(name, members)


def _of_package(name: str, members: dict[str, Any]) -> Any:
    """Return a part of the package. Raises InputError if its class had other members in the version that saved it."""
    own = fields(_CLASSES[name])
    unknown = set(members).difference(field.name for field in own)
    if unknown:
        raise InputError(f"another version of beamfem saved it: a {name} has no {min(unknown)!r} in this version")
    for field in own:
        if field.name not in members and field.default is MISSING and field.default_factory is MISSING:
            raise InputError(f"another version of beamfem saved it: a {name} had no {field.name!r} in that version")
    return _CLASSES[name](**members)
