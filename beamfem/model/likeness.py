"""Models that are alike but for the size of their loads, and what they share: studies make many of them."""

from collections.abc import Hashable
from dataclasses import is_dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from beamfem.alike import lasting
from beamfem.element.element import lasts
from beamfem.model.beam import Beam, Point
from beamfem.model.made_of import is_plain

if TYPE_CHECKING:
    from beamfem.model.model import Model

_MOST_BEAMS, _MOST_ELEMENTS = 16, 300  # of larger models, a solve takes longer than what they would share


def shared_by_likes(model: "Model") -> dict[Any, Any]:
    """Return a dictionary that all models have in common which are alike but for the size of their loads.

    A model with parts of the user's own, which may change from one model to the next, has a dictionary to itself.
    """
    try:
        likeness = _likeness(model)
        return {} if likeness is None else _known(likeness)
    except TypeError:  # a part has functions, or no hash
        return {}


@lru_cache(maxsize=16)
def _known(likeness: Hashable) -> dict[Any, Any]:
    return {"made_of": ()}  # parts of the package do not change


def _likeness(model: "Model") -> Hashable | None:
    """Return what models that are alike have in common, by value; None for one that may be like no other."""
    beams, elements = model.beams, 0
    if model.connectors or len(beams) > _MOST_BEAMS:
        return None
    described: list[Hashable] = []
    for beam in beams:
        of_package = type(beam) is Beam and lasts(beam.element) and lasting(beam.curve, beam.section, beam.material)
        if isinstance(beam.elements, str) or not of_package or beam.law is not None:
            return None
        elements += beam.element_count + len(beam.curve.corners)
        described.append((beam.curve, beam.elements, beam.element, beam.section, beam.material))
    parts: tuple[Any, ...] = (*model.supports, *model.loads, *model.joints)
    # each of the parts may divide an element
    if elements + len(parts) > _MOST_ELEMENTS or not all(map(is_plain, map(type, parts))):
        return None
    numbers = {id(beam): number for number, beam in enumerate(beams)}
    described += [_by_value(load.besides_size, numbers) for load in model.loads]
    return (*described, *(_by_value(part, numbers) for part in (*model.supports, *model.joints)))


def _by_value(item: Any, numbers: dict[int, int]) -> Hashable:
    """Return a part by value, with beams by their number in the model. Raises TypeError if it has functions."""
    if isinstance(item, Beam):
        return numbers[id(item)]
    if isinstance(item, Point):
        return numbers[id(item.beam)], item.fraction
    if isinstance(item, tuple):
        return tuple(_by_value(part, numbers) for part in item)
    if is_dataclass(item):
        return type(item), *(_by_value(getattr(item, name), numbers) for name in item.__dataclass_fields__)
    if callable(item):  # may return something else by the time the next model is made
        raise TypeError
    return item
