"""The kinds of parts in model files, and how the keys of each type are read."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import Any, Literal, get_type_hints

import numpy as np

from beamfem.cli.schema import Kinds, Names, at_key, in_braces, named, part, reader, shown
from beamfem.curves import Arc, BSpline, Chain, Curve, Line, Polyline, elliptic_arc, spline_through_hermite
from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.element import Element
from beamfem.element.fields import Cubic, Field, Lagrange
from beamfem.element.forces import ContinuumMechanics, ElasticLine, SplitContinuum, Structural
from beamfem.element.presets import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, ShearRigid
from beamfem.errors import InputError
from beamfem.io.cad import read_dxf
from beamfem.io.frame import Frame, build_frame
from beamfem.io.mesh import LineMesh, read_mesh
from beamfem.material import Material
from beamfem.model.beam import Beam, Point
from beamfem.model.grading import graded
from beamfem.model.listed_parts import parts_in
from beamfem.model.time_functions import Interpolated, kinks_of
from beamfem.section import Circle, Layered, Rectangle, Section, Tube
from beamfem.section.protocol import CrossSection
from beamfem.validation import count, finite, items, positive, require_known


@dataclass(frozen=True)
class Sine:
    """size sin(2 pi frequency t + phase) + mean; frequency [Hz], phase [rad]. Raises InputError."""

    frequency: float
    size: float = 1.0
    phase: float = 0.0
    mean: float = 0.0

    def __post_init__(self) -> None:
        positive("frequency", self.frequency)
        for name in ("size", "phase", "mean"):
            finite(name, getattr(self, name))

    def __call__(self, time: float) -> float:
        return float(self.mean + self.size * np.sin(2.0 * np.pi * self.frequency * time + self.phase))


@dataclass(frozen=True)
class SmoothRamp:
    """From 0 at the time `start` to `size` after a `duration`, with continuous rate and acceleration.

    size (10 s^3 - 15 s^4 + 6 s^5), s = (t - start) / duration within [0, 1]. Raises InputError.
    """

    duration: float
    size: float = 1.0
    start: float = 0.0

    def __post_init__(self) -> None:
        positive("duration", self.duration)
        for name in ("size", "start"):
            finite(name, getattr(self, name))

    def __call__(self, time: float) -> float:
        s = min(max((time - self.start) / self.duration, 0.0), 1.0)
        return self.size * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


@dataclass(frozen=True)
class AlongBeam:
    """A section, or the vector of a load, some of whose numbers are functions of the arc length [m]."""

    make: Callable[..., Any]
    numbers: dict[str, Any]

    def __post_init__(self) -> None:
        self(0.0)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Arc lengths [m] of the kinks of all functions."""
        return tuple(sorted({kink for value in self.numbers.values() for kink in kinks_of(value)}))

    def __call__(self, arc_length: float) -> Any:
        return self.make(**{key: item(arc_length) if callable(item) else item for key, item in self.numbers.items()})


def _tapered(make: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that makes a section, whose numbers may be functions of the arc length [m]."""

    @wraps(make)
    def made(**numbers: Any) -> Any:
        return AlongBeam(make, numbers) if any(map(callable, numbers.values())) else make(**numbers)

    hints = get_type_hints(make)
    made.__annotations__ = {
        name: float | Callable if hints[name] in (float, float | None) else hints[name]
        for name in signature(make).parameters
    }
    return made


def _continuum(plane_stress: bool = False) -> ContinuumMechanics:
    return ContinuumMechanics(plane_stress)


def _dxf(file: Path, layer: str | None = None, number: int | None = None) -> Curve:
    """Return a curve of a DXF file, of one layer or of all; number: which one, from 1, if there are several."""
    curves = read_dxf(file, layer)
    if number is None and len(curves) > 1:
        raise InputError(f"{file.name} has {len(curves)} curves there; number, from 1 to {len(curves)}, chooses one")
    if (chosen := 1 if number is None else count("number", number)) > len(curves):
        raise InputError(f"number is {number}, but {file.name} has {len(curves)} curves there")
    return curves[chosen - 1]


CURVES: Kinds = {
    "line": Line,
    "arc": Arc,
    "elliptic-arc": elliptic_arc,
    "polyline": Polyline,
    "bspline": BSpline,
    "hermite": spline_through_hermite,
    "chain": Chain,
    "dxf": _dxf,
}
SECTIONS: Kinds = {
    "rectangle": _tapered(Rectangle),
    "circle": _tapered(Circle),
    "tube": _tapered(Tube),
    "moments": _tapered(Section),
    "stiffness": _tapered(Section.from_stiffness),
    "layered": Layered,
}
FUNCTIONS: Kinds = {"table": Interpolated, "sine": Sine, "smooth-ramp": SmoothRamp}
PRESETS: Kinds = {preset.__name__: preset for preset in (ANCF, ANCFCRBF, BilinearANCF, BilinearCRBF, CRBF, ShearRigid)}
ELEMENTS: Kinds = {**PRESETS, "Element": Element}
FORCES: Kinds = {
    "continuum": _continuum,
    "split-continuum": lambda: SplitContinuum(),
    "elastic-line": lambda: ElasticLine(),
    "structural": lambda: Structural(),
}
FIELDS: Kinds = {"cubic": lambda: Cubic(), "lagrange": Lagrange}
COORDINATES: Kinds = {"gradients": Gradients, "rotation": Rotation, "shear-free": ShearFree}


def _kinds_of(name: str) -> Kinds:
    """Return the parts of the package that a list of a `Model` takes, by their kinds.

    A kind is the name of the class in lower case with hyphens, without Point before it and Load after it.
    """
    words = {make: re.findall(r"[A-Z][a-z0-9]*", make.__name__) for make in parts_in(name)}
    return {
        "-".join(word for word in found if word not in ("Point", "Load")).lower(): make for make, found in words.items()
    }


ACTING: dict[str, Kinds] = {name: _kinds_of(name) for name in ("supports", "joints", "connectors", "loads")}


def _curve(value: Any, names: Names) -> Any:
    if isinstance(value, str) and value in CURVES:
        raise InputError(f"must be a table: {in_braces(value, CURVES[value])}")
    return part(CURVES, value, names)


def _elements(value: Any, names: Names) -> Any:
    """Return `elements` of a beam: a number, fractions, "knots" or a graded mesh."""
    if isinstance(value, bool):
        raise InputError(f"must be a number, an array or a text, got {shown(value)}")
    return part({"graded": graded}, value, names) if isinstance(value, dict) else value


def _number(value: Any, names: Names) -> Any:
    if isinstance(value, bool | list):
        raise InputError(f"must be a number, or a function by name or as a table, got {shown(value)}")
    return value if isinstance(value, int | float) else _function(value, names)


def _vector(value: Any, names: Names) -> Any:
    if not isinstance(value, list) or not any(isinstance(item, str | dict) for item in value):
        return value
    components = dict(enumerate(_number(item, names) for item in value))
    return AlongBeam(lambda **parts: tuple(parts.values()), {f"_{key}": item for key, item in components.items()})


def _file(value: Any, names: Names) -> Path:
    if not isinstance(value, str):
        raise InputError(f"must be a text, got {shown(value)}")
    return names.folder / value


_function = named("functions", FUNCTIONS)
_material, _section, _element = named("materials", Material), named("sections", SECTIONS), named("elements", ELEMENTS)
Elements = reader(_elements)
TYPES: dict[Any, Any] = {
    Point: reader(lambda value, names: names.point(value)),
    Sequence[Point]: reader(lambda value, names: names.several("points", value if isinstance(value, list) else [value])),
    Beam: reader(lambda value, names: names.beam(value)),
    Material: reader(_material),
    CrossSection: reader(_section),
    Element: reader(_element),
    Curve: reader(_curve),
    Field: reader(named("fields", FIELDS)),
    Path: reader(_file),
    **dict.fromkeys(
        (ContinuumMechanics, SplitContinuum, ElasticLine, Structural), reader(named("forces", FORCES))
    ),
    **dict.fromkeys((Gradients, Rotation, ShearFree), reader(named("coordinates", COORDINATES))),
    "function": reader(_function),
    "number": reader(_number),
    "vector": reader(_vector),
}
NAMED: dict[str, Kinds | Callable[..., Any]] = {
    "materials": Material,
    "functions": FUNCTIONS,
    "sections": SECTIONS,
    "elements": ELEMENTS,
}


def _by_set(read: Callable[[Any, Names], Any]) -> Any:
    """Return the type of a property of a frame: one for all members, or a table of them by member set."""

    def read_sets(value: Any, names: Names) -> Any:
        if not isinstance(value, dict) or {"kind", "youngs_modulus"} & set(value):
            return read(value, names)
        return {name: at_key(name, read, item, names) for name, item in value.items()}

    return reader(read_sets)


@dataclass(frozen=True)
class BeamTable:
    """The keys of [beams.NAME]."""

    curve: Curve
    elements: Elements
    element: Element
    section: CrossSection
    material: Material | None = None

    def beam(self, name: str) -> Beam:
        """Return the beam with a name. Raises InputError."""
        return Beam(**vars(self), name=name)


@dataclass(frozen=True)
class FrameTable:
    """The keys of [frames.NAME]: beams along the lines of a mesh file."""

    file: Path
    elements: _by_set(lambda value, names: value)  # type: ignore[valid-type]
    element: _by_set(_element)  # type: ignore[valid-type]
    section: _by_set(_section)  # type: ignore[valid-type]
    material: _by_set(_material) = None  # type: ignore[valid-type]
    members: Literal["cells", "chains"] = "cells"
    hinges: Any = ()
    merge: bool = False

    def frame(self, name: str) -> Frame:
        """Return the frame, whose beams are NAME[1], NAME[2], ... Raises InputError."""
        mesh: LineMesh = read_mesh(self.file, merge=self.merge)
        for key in ("elements", "element", "section", "material"):
            value = getattr(self, key)
            for known in value if isinstance(value, dict) else ():
                require_known(f"{key} has no member set {known!r}", known, mesh.member_sets)
        for known in [self.hinges] if isinstance(self.hinges, str) else items("hinges", self.hinges):
            require_known(f"hinges has no point set {known!r}", known, mesh.point_sets)
        return build_frame(mesh, self.elements, self.element, self.section, self.material, self.members, self.hinges, name)


_PYTHON = {
    **{make.__name__: f'"{kind}"' for kinds in ACTING.values() for kind, make in kinds.items()},
    "solve_static": '`kind = "static"`',
    "trace_equilibrium": '`kind = "path"`',
    "solve_buckling": '`kind = "buckling"`',
    "solve_modes": '`kind = "modes"`',
    "simulate": '`kind = "dynamics"`',
}
_NAME = re.compile(rf"\b({'|'.join(_PYTHON)})\b")


def in_keys(message: str) -> str:
    """Return a message of the library with the kinds of model files in place of classes and functions."""
    return _NAME.sub(lambda match: _PYTHON[match[0]], message)
