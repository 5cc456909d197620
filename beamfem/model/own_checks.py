"""Checks of loads and supports of users' own classes: what their members return, before any solve."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.along_beam import table_along
from beamfem.model.load import BodyLoad, ImposedStrain, LineLoad, Load, PointLoad
from beamfem.model.support import LineSupport, PointSupport, Support
from beamfem.validation import finite, flag, function_of_one, items, one_of, require_known, squared, vector

_DIRECTIONS = ("ux", "uy", "rotation")
_UNIT = 1e-9


def require_own(part: Load | Support) -> None:
    """Raise InputError where a part of a user's own class does not return what the equations need of it."""
    match part:
        case PointLoad():
            _require_value(part)
        case LineLoad():
            _require_forces(part)
        case ImposedStrain():
            table_along(part, "free_strain", _places(part), 4)
        case BodyLoad():
            squared(vector)(f"vector of {type(part).__name__}", part.vector)
        case PointSupport():
            _require_directions(part)
        case LineSupport():
            _require_stiffness(part)


def _places(load: LineLoad | ImposedStrain) -> np.ndarray:
    """Arc lengths (3,) [m] at which what depends on the place is looked at."""
    return np.array([0.0, 0.5, 1.0]) * load.beam.curve.length


def _require_value(load: PointLoad) -> None:
    name = f"value of {type(load).__name__}"
    parts = items(name, load.value)
    if len(parts) != 3:
        raise InputError(f"{name} must be fx, fy [N] and a moment [N m], three numbers, got {len(parts)}")
    for part in parts:
        squared(finite)(name, part)


def _require_forces(load: LineLoad) -> None:
    kind = type(load).__name__
    one_of(f"axes of {kind}", load.axes, ("plane", "section", "axis"))
    found = table_along(load, "forces", _places(load), 2)
    if flag(f"uniform of {kind}", load.uniform) and not (found == found[0]).all():
        raise InputError(f"{kind} says that it is uniform, but its forces differ along the beam")


def _require_directions(support: PointSupport) -> None:
    kind = type(support).__name__
    prescribed, springs = _mapping(support, "prescribed"), _mapping(support, "springs")
    if not prescribed and not springs:
        raise InputError(f"{kind} does nothing: it neither prescribes a direction nor has a spring")
    for name, value in prescribed.items():
        require_known(f"{kind} prescribes an unknown direction", name, (*_DIRECTIONS, "normal"))
        what = f"{name} that {kind} prescribes"
        if callable(value):
            function_of_one(what, value, "time")
        else:
            squared(finite)(what, value)
    if "normal" in prescribed:
        _require_normal(support, kind, prescribed["normal"])
    for name, value in springs.items():
        require_known(f"{kind} has a spring in an unknown direction", name, _DIRECTIONS)
        if not squared(finite)(f"spring of {kind} in {name}", value) > 0.0:
            raise InputError(f"the spring of {kind} in {name} must be stiffer than zero, got {value}")


def _mapping(support: PointSupport, name: str) -> Mapping[str, Any]:
    found = getattr(support, name)()
    if not isinstance(found, Mapping):
        raise InputError(f"{name}() of {type(support).__name__} must return a dict of directions, got {found!r}")
    return found


def _require_normal(support: PointSupport, kind: str, value: Any) -> None:
    if support.direction is None:
        raise InputError(f"{kind} prescribes the displacement along its normal: it needs a direction (2,)")
    along = np.array(vector(f"direction of {kind}", support.direction))
    if abs(np.hypot(*along) - 1.0) > _UNIT:
        raise InputError(f"the direction of {kind} must be a unit vector, got {along.tolist()}")
    if callable(value) or value != 0.0:
        raise InputError(f"{kind} can prescribe no displacement along its normal but 0.0; use ux and uy")


def _require_stiffness(support: LineSupport) -> None:
    name = f"stiffness of {type(support).__name__}"
    if min(squared(vector)(name, support.stiffness)) < 0.0:
        raise InputError(f"{name} must not be negative, got {support.stiffness}")
