"""Checks of user-defined loads, supports and joints when a model is made."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.along_beam import AlongBeam, check_along
from beamfem.model.beam import require_beam, require_point_of
from beamfem.model.imposed_strains import require_followed
from beamfem.model.joints import Joint
from beamfem.model.load import BodyLoad, ImposedStrain, LineLoad, Load, PointLoad
from beamfem.model.returned import forces_of, free_strain_of, heat_of
from beamfem.model.support import DIRECTIONS, LineSupport, PointSupport, Support
from beamfem.validation import (
    called,
    finite,
    flag,
    function_of_one,
    items,
    one_of,
    positive,
    require_known,
    shown,
    squared,
    vector,
)

_UNIT = 1e-9  # largest deviation of the length of a unit vector from 1


def require_part(part: Load | Support | Joint) -> None:
    """Raise InputError for invalid members of a user-defined part; parts of the package are not checked."""
    if type(part).__module__.startswith("beamfem."):
        return
    if isinstance(part, Load):
        _require_load(part)
    elif isinstance(part, PointSupport):
        _require_point_support(part)
    elif isinstance(part, LineSupport):
        _require_line_support(part)
    elif isinstance(part, Joint):
        kind = type(part).__name__
        require_point_of(part, "a")
        require_point_of(part, "b")
        flag(f"keeps_angle of {kind}", part.keeps_angle)


def _require_load(load: Load) -> None:
    kind = type(load).__name__
    if isinstance(getattr(type(load), "amplitude", None), property):
        raise InputError(f"amplitude of {kind} must be a field or a method of the time, not a property")
    if load.amplitude is not None:
        function_of_one(f"amplitude of {kind}", load.amplitude, "time")
    flag(f"scale of {kind}", load.scale)
    if isinstance(load, BodyLoad):
        squared(vector)(f"vector of {kind}", getattr(load, "vector", None))
    elif isinstance(load, PointLoad):
        require_point_of(load)
        flag(f"follower of {kind}", load.follower)
        _require_value(load)
    elif isinstance(load, AlongBeam):
        require_beam(kind, getattr(load, "beam", None))
        check_along(load)
        _require_along(load, np.array([0.0, 0.5, 1.0]) * load.beam.curve.length)


def _require_value(load: PointLoad) -> None:
    what = f"value of {type(load).__name__}"
    value = called(what, lambda: load.value)
    if callable(value):
        raise InputError(f"{what} must be a field or a property, not a method")
    numbers = [squared(finite)(what, number) for number in items(what, value)]
    if len(numbers) != 3:
        raise InputError(f"{what} must be three numbers, fx, fy and moment, got {shown(value)}")


def _require_along(load: Load, arc_length: np.ndarray) -> None:
    kind = type(load).__name__
    if isinstance(load, LineLoad):
        one_of(f"axes of {kind}", load.axes, ("plane", "section", "axis"))
        forces = forces_of(load, arc_length)
        if flag(f"uniform of {kind}", load.uniform) and np.any(forces != forces[:1]):
            raise InputError(f"uniform of {kind} is True, but its forces change on the beam: {shown(forces.tolist())}")
    elif isinstance(load, ImposedStrain):
        if len(load.units) != len(load.along):
            raise InputError(f"units of {kind} must name a unit for each name of along, {load.along}, got {load.units}")
        free_strain_of(load, arc_length)
        heat_of(load, arc_length)
        require_followed(load)


def _require_point_support(support: PointSupport) -> None:
    kind = type(support).__name__
    require_point_of(support)
    prescribed = _by_direction(f"prescribed of {kind}", support.prescribed, (*DIRECTIONS, "normal"))
    springs = _by_direction(f"springs of {kind}", support.springs, DIRECTIONS)
    if not prescribed and not springs:
        raise InputError(f"{kind} does nothing: let prescribed() or springs() of it return something by direction")
    for direction, value in prescribed.items():
        what = f"{direction} prescribed by {kind}"
        if direction == "normal" and (callable(value) or finite(what, value) != 0.0):
            raise InputError(f"{what} must be 0.0, got {shown(value)}: only ux, uy and rotation can be moved")
        if callable(value):
            function_of_one(what, value, "time")
        else:
            squared(finite)(what, value)
    for direction, stiffness in springs.items():
        squared(positive)(f"stiffness of {kind} in {direction}", stiffness)
    _require_direction(support, "normal" in prescribed)


def _require_direction(support: PointSupport, needed: bool) -> None:
    what = f"direction of {type(support).__name__}"
    direction = called(what, lambda: support.direction)
    if direction is None and needed:
        raise InputError(f'{what} must be a unit vector, since "normal" is prescribed along it, got None')
    if direction is not None:
        if not needed:
            raise InputError(f'{what} is given, but prescribed() returns no "normal" along it')
        size = np.hypot(*vector(what, direction))
        if abs(size - 1.0) > _UNIT:
            raise InputError(f"{what} must be a unit vector, got {shown(direction)} of length {size:g}")


def _by_direction(what: str, function: Callable[[], Any], known: tuple[str, ...]) -> Mapping[str, Any]:
    values = called(what, function)
    if not isinstance(values, Mapping):
        raise InputError(f'{what} must return a dict by direction, such as {{"ux": 0.0}}, got {shown(values)}')
    for direction in values:
        require_known(f"{what} has the unknown direction {shown(direction)}", direction, known)
    return values


def _require_line_support(support: LineSupport) -> None:
    kind = type(support).__name__
    require_beam(kind, getattr(support, "beam", None))
    stiffness = squared(vector)(f"stiffness of {kind}", getattr(support, "stiffness", None))
    if min(stiffness) < 0.0 or max(stiffness) == 0.0:
        raise InputError(f"the stiffness of a {kind} must not be negative, and somewhere positive, got {stiffness}")
