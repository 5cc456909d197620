"""Models with geometric imperfections: a multiple of a mode, free of stress."""

from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from beamfem.curves import Chain, Curve, spline_through_hermite
from beamfem.element.coordinates import across
from beamfem.equations.system import system_of
from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.along_beam import functions_along
from beamfem.model.beam import Beam, Point
from beamfem.model.check_replaceable import require_remade
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.reprs import brief
from beamfem.results.axis_points import AxisPoints, axis_at
from beamfem.section.protocol import CrossSection
from beamfem.validation import finite, number_below, of_package, shown, squared

_PIECES = 4  # minimum number of cubic segments per element of the imperfect axis; one for a linear field


@dataclass(frozen=True)
class _Crooked:
    """An imperfect beam that replaces a perfect one: old and new arc lengths (k,) [m] of the same points."""

    beam: Beam
    old: np.ndarray
    new: np.ndarray

    def fraction(self, fraction: float) -> float:
        at = np.interp(fraction * self.old[-1], self.old, self.new) / self.new[-1]
        return fraction if fraction in (0.0, 1.0) else float(at)


@dataclass(frozen=True)
class Moved:
    """A function of the arc length of the perfect beam, evaluated at the arc length of the imperfect one."""

    function: Callable[[float], Any]
    old: tuple[float, ...]
    new: tuple[float, ...]

    __repr__ = brief

    def __call__(self, arc_length: float) -> Any:
        """Return the value at an arc length [m]."""
        return self.function(float(np.interp(arc_length, self.new, self.old)))

    @property
    def kinks(self) -> tuple[float, ...]:
        """Arc lengths [m] of the kinks that the function declares. Raises AttributeError if it declares none."""
        kinks: tuple[float, ...] = self.function.kinks  # type: ignore[attr-defined]
        return tuple(float(np.interp(kink, self.old, self.new)) for kink in kinks)


def with_imperfection(model: Model, modes: Any, size: float, mode: int = 0) -> Model:
    """Return the model with the axes of its beams displaced by a mode, `size` [m] at most, stress-free in that shape.

    modes: result of `solve_buckling` or `solve_modes`, or a change (n,) of all coordinates; mode: index of the one to
    use. Axes become cubic splines; elements, sections, supports, joints, loads, connectors and masses stay attached to
    the same points (other data of a connector, such as a free length, are unchanged). Elements defined by knot spans
    become elements defined by arc length.
    Raises InputError if the modes belong to a model of another size, if the mode moves no axis, or if the points of a
    connector are not fields of a dataclass.
    """
    (p, shape), size = _shape(model, modes, mode), squared(finite)("size", size)
    moved = [_rates(mesh, p, shape) for mesh in model.meshes]
    largest = max(float(np.linalg.norm(position, axis=-1).max()) for position, _ in moved)
    if largest == 0.0:
        raise InputError("this mode displaces no point of an axis, so it gives no imperfection")
    crooked = {
        id(mesh.beam): _crooked(mesh, *(size / largest * rate for rate in rates))
        for mesh, rates in zip(model.meshes, moved, strict=True)
    }
    beams = [crooked[id(beam)].beam for beam in model.beams]
    for beam, same in zip(getattr(model, "original", ()), model.beams, strict=False):
        crooked[id(beam)] = crooked[id(same)]
    names = ("supports", "loads", "joints", "connectors", "masses")
    parts = {name: [_placed(item, crooked) for item in getattr(model, name)] for name in names}
    for connector in (*parts["connectors"], *parts["masses"]):
        if any(id(point.beam) in crooked for point in connector.points):
            raise InputError(
                f"the points of {type(connector).__name__} cannot be moved to the imperfect model: make it a dataclass "
                "with points, or tuples of points, as its fields"
            )
    return Model(beams, **parts, units=model.units, frame=model.frame, redundant_conditions=model.redundant_conditions)


def _shape(model: Model, modes: Any, mode: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the state p (n,) that a mode (n,) perturbs, and the mode."""
    values, p = getattr(modes, "modes", modes), system_of(model, static=True).reference
    if values is not modes:
        if not len(values):
            raise InputError(f"there is no mode to use as an imperfection: {getattr(modes, 'ended', 'none was found')}")
        number = number_below("mode", mode, len(values))
        values, p = values[number], modes.states[number] if hasattr(modes, "states") else modes.state.p
    try:
        shape = np.asarray(values, dtype=complex)
    except (TypeError, ValueError):
        shape = np.empty(0)
    if shape.shape != (model.size,) or p.shape != shape.shape or not np.isfinite(shape).all():
        raise InputError(
            f"an imperfection needs modes of this model with {model.size} coordinates, such as those returned by "
            f"solve_buckling, got {shown(modes)}"
        )
    return p, shape.real


def _points(mesh: BeamMesh) -> AxisPoints:
    """Return the ends of the cubic segments."""
    degree = mesh.beam.element.field.degree
    return AxisPoints.spaced(mesh, 1 if degree == 1 else max(_PIECES, 2 * degree))


def _rates(mesh: BeamMesh, p: np.ndarray, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return displacements and their arc length derivatives (ne * (pieces + 1), 2) for a mode (n,) about p (n,).

    A linear field has no unique slope at its nodes: the axis is taken to turn with the section there.
    """
    points = _points(mesh)
    rates = axis_at(mesh, p[None], points.element, points.xi, shape[None])
    slope = -across(rates.d[0]) if mesh.beam.element.field.degree == 1 else rates.r_s[0]
    return rates.r[0], slope


def _crooked(mesh: BeamMesh, moved: np.ndarray, slope: np.ndarray) -> _Crooked:
    beam, curve, points = mesh.beam, mesh.beam.curve, _points(mesh)
    inside, at = mesh.arc_length_inside(points.element, points.xi, curve.corners), points.arc_length
    position, rate = curve.position(at.copy()) + moved, curve.tangent(inside.copy()) + slope
    # element ends are one point with the mean of the slopes on both sides, except at corners
    first = np.arange(points.pieces + 1, len(at), points.pieces + 1)
    corner = np.isclose(at[first][:, None], np.array(curve.corners), rtol=0.0, atol=1e-9 * curve.length).any(axis=1)
    smooth = first[~corner]
    rate[smooth - 1] = rate[smooth] = 0.5 * (rate[smooth - 1] + rate[smooth])
    stops = [0, *first[corner].tolist(), len(at)]
    pieces, old, new = list[Curve](), [np.zeros(1)], [np.zeros(1)]
    for begin, end in pairwise(stops):
        indices = np.setdiff1d(np.arange(begin, end), smooth)
        spline = spline_through_hermite(at[indices], position[indices], rate[indices])
        old.append(at[indices][1:])
        new.append(new[-1][-1] + spline.arc_length(at[indices])[1:])
        pieces.append(spline)
    before, after = np.concatenate(old), np.concatenate(new)
    line = pieces[0] if len(pieces) == 1 else Chain(tuple(pieces))
    ends = np.interp(mesh.vertices, before, after) / after[-1]
    ends[0], ends[-1] = 0.0, 1.0
    section = beam.section if isinstance(beam.section, CrossSection) else _along(beam.section, before, after)
    return _Crooked(replace(beam, curve=line, elements=tuple(ends.tolist()), section=section), before, after)


def _along(function: Any, old: np.ndarray, new: np.ndarray) -> Moved:
    return Moved(function, tuple(old.tolist()), tuple(new.tolist()))


def _placed(item: Any, crooked: dict[int, _Crooked]) -> Any:
    """Return a part, or what it refers to, at the same points of the imperfect beams; loads with their functions.

    Raises InputError for a part that cannot be made anew from its fields.
    """
    if isinstance(item, Beam):
        return crooked[id(item)].beam
    if isinstance(item, Point):
        moved = crooked[id(item.beam)]
        return Point(moved.beam, moved.fraction(item.fraction))
    if isinstance(item, tuple | list):
        parts = [_placed(part, crooked) for part in item]
        return type(item)(*parts) if hasattr(item, "_fields") else type(item)(parts)
    if not is_dataclass(item) or isinstance(item, type):
        return item
    if not of_package(type(item)):
        require_remade(f"a {type(item).__name__} cannot be placed on imperfect beams", item)
    changes = {field.name: _placed(getattr(item, field.name), crooked) for field in fields(item) if field.init}
    if isinstance(item, Load):
        for name, function in functions_along(item).items():
            moved = crooked[id(item.place)]
            changes[name] = _along(function, moved.old, moved.new)
    return replace(item, **changes)
