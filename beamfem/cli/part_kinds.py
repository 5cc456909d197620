"""The kinds of parts in model files, and how the keys of each type are read."""

import re
from collections.abc import Callable, Sequence
from inspect import isclass
from typing import Any, NamedTuple

import numpy as np
from skfem import MeshLine1

from beamfem import section
from beamfem.cli.schema import Keyed, Kinds, Names, in_braces, keys_of, named, part, reader, shown
from beamfem.curves import Curve, Parametric, elliptic_arc, spline_through_hermite
from beamfem.damping import KelvinVoigt, Rayleigh
from beamfem.element.element import Element
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.model.beam import Beam, Point, graded
from beamfem.model.model import Model
from beamfem.model.parts_by_role import parts_in
from beamfem.model.time_functions import Interpolated, kinks_of, sine, smooth_ramp
from beamfem.parts.floating_body import FloatingBody
from beamfem.parts.hinge import Hinge
from beamfem.parts.rigid import Rigid
from beamfem.parts.rigid_body import RigidBody
from beamfem.public_names import public, public_dataclasses
from beamfem.section.protocol import CrossSection
from beamfem.validation import nearest


def _along(make: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that makes a section or a vector of numbers, some of which may vary with the arc length [m]."""

    def made(**numbers: Any) -> Any:
        if not any(map(callable, numbers.values())):
            return make(**numbers)

        def at(arc_length: float) -> Any:
            return make(**{key: value(arc_length) if callable(value) else value for key, value in numbers.items()})

        at.kinks = tuple(sorted({kink for value in numbers.values() for kink in kinks_of(value)}))  # type: ignore[attr-defined]
        at(0.0)
        return at

    varying = dict.fromkeys((float, float | None), float | Callable)
    return Keyed(made, {key: (varying.get(hint, hint), default) for key, (hint, default) in keys_of(make).items()})


def _by_kind(*made: Callable[..., Any]) -> dict[str, Callable[..., Any]]:
    """Return parts by their names in lower case with hyphens, without Point before and Load or Mechanics after them."""
    names = [make.__name__.removeprefix("Point").removesuffix("Load").removesuffix("Mechanics") for make in made]
    kinds = [re.sub(r"(?<=[a-z])(?=[A-Z])", "-", name.replace("_", "-")).lower() for name in names]
    return dict(zip(kinds, made, strict=True))


CURVES: Kinds = {
    **_by_kind(*(make for make in public_dataclasses("curves") if make is not Parametric), elliptic_arc),
    "hermite": spline_through_hermite,
}
SECTIONS: Kinds = {
    **{kind: _along(make) for kind, make in _by_kind(section.Circle, section.Rectangle, section.Tube).items()},
    "moments": _along(section.Section),
    "stiffness": _along(section.Section.from_stiffness),
    **_by_kind(section.Polygon, section.Profile, section.Layered, section.Fibres),
}
MATERIALS: Kinds = {"material": Material}
LAWS: Kinds = _by_kind(*(make for make in public_dataclasses("section") if hasattr(make, "stress")))
DAMPING: Kinds = {"rayleigh": Rayleigh, "ratios": Rayleigh.from_ratios, "kelvin-voigt": KelvinVoigt}
FUNCTIONS: Kinds = {"table": Interpolated, "sine": sine, "smooth-ramp": smooth_ramp}
ELEMENTS: Kinds = {preset.__name__: preset for preset in public("element.element") if not isclass(preset)}
_ACTING = ("supports", "joints", "connectors", "masses", "loads")
ACTING: dict[str, Kinds] = {name: _by_kind(*parts_in(name)) for name in _ACTING}
FORCES: Kinds = _by_kind(*public("element.forces"))


def _curve(value: Any, names: Names) -> Any:
    if isinstance(value, str) and value in CURVES:
        raise InputError(f"must be a table: {in_braces(value, CURVES[value])}")
    return part(CURVES, value, names)


def _number(value: Any, names: Names) -> Any:
    if isinstance(value, bool | list) or (isinstance(value, str) and value not in names.parts["functions"]):
        hint = f"; {nearest(value, names.parts['functions'])}" if isinstance(value, str) else ""
        raise InputError(f"must be a number, or a function by name or as a table, got {shown(value)}{hint}")
    return value if isinstance(value, int | float) else _function(value, names)


def _vector(value: Any, names: Names) -> Any:
    if not isinstance(value, list) or not any(isinstance(item, str | dict) for item in value):
        return value
    numbers = {f"_{key}": _number(item, names) for key, item in enumerate(value)}
    return _along(lambda **parts: tuple(parts.values()))(**numbers)


def _point_or_hinge(value: Any, names: Names) -> Any:
    """Return a point, or the hinge of two points."""
    if not isinstance(value, list):
        return names.point(value)
    if len(value) != 2:
        raise InputError(f"must be a point, or the two points of a hinge, got {shown(value)}")
    return Hinge(*map(names.point, value))


class Reduced(NamedTuple):
    """A floating body, with the beams that it consists of and its interfaces on them."""

    body: FloatingBody
    beams: list[Beam]
    interfaces: list[Point]


def _reduced(beams: list[Beam], interfaces: list[Point], modes: int, joints: Sequence[list[Point]] = ()) -> Reduced:
    """Return the floating body of beams, with rigid joints of pairs of points."""
    from beamfem.solve.linear.craig_bampton import reduce  # takes a while to import

    model = Model(beams, joints=[Rigid(*pair) for pair in joints])
    return Reduced(reduce(model, interfaces, modes).floating_body(), beams, interfaces)


_function = named("functions", FUNCTIONS)
TYPES: dict[Any, Any] = {
    Point: reader(lambda value, names: names.point(value)),
    Point | tuple[float, float]: reader(lambda at, names: tuple(at) if type(at) is list else names.point(at)),
    Point | Hinge: reader(_point_or_hinge),
    Beam: reader(lambda value, names: names.beam(value)),
    MeshLine1: reader(lambda ends, names: part({"graded": graded}, ends, names) if isinstance(ends, dict) else ends),
    Material: reader(named("materials", MATERIALS)),
    Rayleigh: reader(lambda value, names: part(DAMPING, value, names)),
    **dict.fromkeys((CrossSection, section.ShapedSection), reader(named("sections", SECTIONS))),
    section.FibreLaw: reader(lambda value, names: part(LAWS, value, names)),
    Element: reader(named("elements", ELEMENTS)),
    Curve: reader(_curve),
    **dict.fromkeys(FORCES.values(), reader(named("forces", FORCES))),
    "function": reader(_function),
    "number": reader(_number),
    "vector": reader(_vector),
}
NAMED = {"materials": MATERIALS, "functions": FUNCTIONS, "sections": SECTIONS, "elements": ELEMENTS}
NAMED |= {"beams": {"beam": Beam}, "bodies": {"rigid-body": RigidBody, "floating-body": _reduced}}  # read in this order


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
