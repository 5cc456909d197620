"""Models whose loads and prescribed motions change from those at one load factor to those at another."""

from copy import copy
from dataclasses import dataclass

from beamfem.model.load_base import Load, factor
from beamfem.model.model import Model
from beamfem.model.support_base import DIRECTIONS, PointSupport, Value
from beamfem.model.supports import Prescribed, Roller, Spring
from beamfem.validation import function_value


@dataclass(frozen=True)
class _Line:
    """A function that is linear in the load factor, with its values at 0 and 1."""

    first: float
    last: float

    def __call__(self, load_factor: float) -> float:
        return (1.0 - load_factor) * self.first + load_factor * self.last


def changing(model: Model, before: float | None, after: float) -> Model:
    """Return the model with loads and prescribed values linear in the load factor, those at `after` reached at 1.

    At 0 they are those at the load factor `before`, or zero for None.
    """
    loads = [_changing_load(load, before, after) for load in model.loads]
    moved = {id(support): _moved(support, before, after) for support in model.point_supports if _moves(support)}
    supports = [part for support in model.supports for part in moved.get(id(support), (support,))]
    return model.with_(supports=supports, loads=loads)


def _moves(support: PointSupport) -> bool:
    """Return whether a support prescribes nonzero values."""
    return any(callable(value) or value != 0.0 for value in support.prescribed().values())


def _moved(support: PointSupport, before: float | None, after: float) -> tuple[PointSupport, ...]:
    """Return equivalent supports with prescribed values linear in the load factor."""
    values = {
        name: _Line(0.0 if before is None else _prescribed(value, before), _prescribed(value, after))
        for name, value in support.prescribed().items()
        if name != "normal"
    }
    supports: tuple[PointSupport, ...] = (Prescribed(support.point, **values),)
    if support.direction is not None:
        supports = (*supports, Roller(support.point, tuple(support.direction)))
    if springs := support.springs():
        kx, ky, rotational = (springs.get(name, 0.0) for name in DIRECTIONS)
        supports = (*supports, Spring(support.point, (kx, ky), rotational))
    return supports


def _prescribed(value: Value, load_factor: float) -> float:
    return function_value("motion prescribed", value, load_factor) if callable(value) else value * load_factor


def _changing_load(load: Load, before: float | None, after: float) -> Load:
    """Return a load whose factor is linear in the load factor."""
    result: Load = copy(load)
    line = _Line(0.0 if before is None else factor(load, before, True), factor(load, after, True))
    # whether or not it is a field of its class
    object.__setattr__(result, "amplitude", line)
    return result
