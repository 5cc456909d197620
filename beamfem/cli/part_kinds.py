"""The kinds of parts in model files, and how the keys of each type are read."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from typing import Any, get_type_hints

import numpy as np

from beamfem.cli.schema import Kinds, Names, in_braces, named, part, reader, shown
from beamfem.curves import Arc, BSpline, Chain, Curve, Line, Polyline, elliptic_arc, spline_through_hermite
from beamfem.element.element import Element
from beamfem.element.forces import ContinuumMechanics, ElasticLine, SplitContinuum, Structural
from beamfem.element.presets import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, ShearRigid
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.model.beam import Beam, Point
from beamfem.model.grading import graded
from beamfem.model.time_functions import Interpolated, kinks_of
from beamfem.parts.parts_registry import parts_in
from beamfem.section import Circle, Layered, Rectangle, Section, Tube
from beamfem.section.protocol import CrossSection
from beamfem.validation import nearest, positive


def _sine(frequency: float, size: float = 1.0, phase: float = 0.0, mean: float = 0.0) -> Callable[[float], float]:
    """Return size sin(2 pi frequency t + phase) + mean; frequency [Hz], phase [rad]."""
    positive("frequency", frequency)
    return lambda t: float(mean + size * np.sin(2.0 * np.pi * frequency * t + phase))


def _smooth_ramp(duration: float, size: float = 1.0, start: float = 0.0) -> Callable[[float], float]:
    """Return a function that rises from 0 to size with continuous acceleration.

    size (10 s^3 - 15 s^4 + 6 s^5), s = (t - start) / duration within [0, 1].
    """
    positive("duration", duration)

    def ramp(t: float) -> float:
        s = min(max((t - start) / duration, 0.0), 1.0)
        return size * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)

    return ramp


def _along(make: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that makes a section or a vector of numbers, some of which may vary with the arc length [m]."""

    @wraps(make)
    def made(**numbers: Any) -> Any:
        if not any(map(callable, numbers.values())):
            return make(**numbers)

        def at(arc_length: float) -> Any:
            return make(**{key: value(arc_length) if callable(value) else value for key, value in numbers.items()})

        at.kinks = tuple(sorted({kink for value in numbers.values() for kink in kinks_of(value)}))  # type: ignore[attr-defined]
        at(0.0)
        return at

    hints = get_type_hints(make)
    made.__annotations__ = {
        name: float | Callable if hints.get(name) in (float, float | None) else hints.get(name)
        for name in signature(make).parameters
    }
    return made


def _continuum(plane_stress: bool = False) -> ContinuumMechanics:
    return ContinuumMechanics(plane_stress)


CURVES: Kinds = {
    "line": Line,
    "arc": Arc,
    "elliptic-arc": elliptic_arc,
    "polyline": Polyline,
    "bspline": BSpline,
    "hermite": spline_through_hermite,
    "chain": Chain,
}
SECTIONS: Kinds = {
    "rectangle": _along(Rectangle),
    "circle": _along(Circle),
    "tube": _along(Tube),
    "moments": _along(Section),
    "stiffness": _along(Section.from_stiffness),
    "layered": Layered,
}
MATERIALS: Kinds = {"material": Material}
FUNCTIONS: Kinds = {"table": Interpolated, "sine": _sine, "smooth-ramp": _smooth_ramp}
ELEMENTS: Kinds = {preset.__name__: preset for preset in (ANCF, ANCFCRBF, BilinearANCF, BilinearCRBF, CRBF, ShearRigid)}
FORCES: Kinds = {
    "continuum": _continuum,
    "split-continuum": lambda: SplitContinuum(),
    "elastic-line": lambda: ElasticLine(),
    "structural": lambda: Structural(),
}


def _kinds_of(name: str) -> Kinds:
    """Return the parts of the package that a list of a `Model` takes, by their kinds.

    A kind is the name of the class in lower case with hyphens, without Point before it and Load after it.
    """
    words = {make: re.findall(r"[A-Z][a-z0-9]*", make.__name__) for make in parts_in(name)}
    return {
        "-".join(word for word in found if word not in ("Point", "Load")).lower(): make for make, found in words.items()
    }


ACTING: dict[str, Kinds] = {name: _kinds_of(name) for name in ("supports", "joints", "connectors", "masses", "loads")}


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
    if isinstance(value, bool | list) or (isinstance(value, str) and value not in names.parts["functions"]):
        hint = f"; {nearest(value, names.parts['functions'])}" if isinstance(value, str) else ""
        raise InputError(f"must be a number, or a function by name or as a table, got {shown(value)}{hint}")
    return value if isinstance(value, int | float) else _function(value, names)


def _vector(value: Any, names: Names) -> Any:
    if not isinstance(value, list) or not any(isinstance(item, str | dict) for item in value):
        return value
    return _along(lambda **parts: tuple(parts.values()))(
        **{f"_{key}": _number(item, names) for key, item in enumerate(value)}
    )


_function = named("functions", FUNCTIONS)
_material, _section, _element = named("materials", MATERIALS), named("sections", SECTIONS), named("elements", ELEMENTS)
Elements = reader(_elements)
TYPES: dict[Any, Any] = {
    Point: reader(lambda value, names: names.point(value)),
    Point | tuple[float, float]: reader(
        lambda value, names: tuple(value) if type(value) is list else names.point(value)
    ),
    Sequence[Point]: reader(lambda value, names: names.points(value)),
    Beam: reader(lambda value, names: names.beam(value)),
    Material: reader(_material),
    CrossSection: reader(_section),
    Element: reader(_element),
    Curve: reader(_curve),
    **dict.fromkeys((ContinuumMechanics, SplitContinuum, ElasticLine, Structural), reader(named("forces", FORCES))),
    "function": reader(_function),
    "number": reader(_number),
    "vector": reader(_vector),
}
NAMED: dict[str, Kinds] = {
    "materials": MATERIALS,
    "functions": FUNCTIONS,
    "sections": SECTIONS,
    "elements": ELEMENTS,
}


@dataclass(frozen=True)
class BeamTable:
    """The keys of [beams.NAME]."""

    curve: Curve
    elements: Elements  # type: ignore[valid-type]
    element: Element
    section: CrossSection
    material: Material | None = None

    def beam(self, name: str) -> Beam:
        """Return the beam with a name. Raises InputError."""
        return Beam(**vars(self), name=name)


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
    """Return a message of the library with kinds and keys in place of classes, functions and arguments."""
    keys = re.sub(r"\b([a-z_]+)=(?=[\"\w])", r"\1 = ", _NAME.sub(lambda match: _PYTHON[match[0]], message))
    keys = re.sub(r"np\.radians\(([\d.]+)\)", lambda match: f"{np.radians(float(match[1])):.12g}", keys)
    return keys.replace(" = True", " = true").replace(" = False", " = false")
