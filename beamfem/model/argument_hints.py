"""Hints for parts passed to the wrong argument of Model, and for points of another model."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from beamfem.curves.curve import GAP
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.model.contribution import Contribution
from beamfem.validation import items, members, shown

Kinds = Mapping[str, tuple[type, ...]]


def listed(name: str, given: Any, kinds: Kinds) -> tuple[Any, ...]:
    """Return the parts of one of the lists of a Model; a part in its place is told to stand in brackets."""
    try:
        return tuple(items(f"{name} of Model", given))
    except InputError as error:
        if isinstance(given, kinds[name]):
            raise InputError(f"{error}; write it in brackets: {name}=[...]") from None
        raise


def refused(name: str, item: object, kinds: Kinds) -> str:
    """Return why a list of a Model cannot hold an item: where it belongs, or what it lacks."""
    said = f"{name} of a Model cannot hold {shown(item)}"
    right = [other for other, own in kinds.items() if other != name and isinstance(item, own)]
    if right:
        return f"{said}; it belongs in {right[0]}"
    lacking = [member for member in members(Contribution) if not hasattr(item, member)]
    if name == "connectors" and 0 < len(lacking) < len(members(Contribution)):
        return f"{said}, which has no {' and no '.join(lacking)}, but a Contribution"
    return f"{said}, but {_named(kinds[name])}"


def resembles_beam(beams: Sequence[Beam], beam: Beam) -> str:
    """Return in words which beam of a model is on the axis of one that is not in it, empty if none is."""
    alike = (number for number, own in enumerate(beams) if type(own.curve) is type(beam.curve))
    same = next((number for number in alike if beams[number].curve == beam.curve), None)
    return "" if same is None else f"use model.beams[{same}], a beam on the same axis"


def touching(one: Beam, other: Beam) -> str:
    """Return in words which ends of two beams are at one place, empty if none are."""
    near = GAP * max(one.curve.length, other.curve.length)
    for own, its in product(("start", "end"), repeat=2):
        if np.hypot(*(getattr(one, own).reference - getattr(other, its).reference)) <= near:
            return f"; the {own} of the first beam and the {its} of the second do"
    return ""


def _named(kinds: Sequence[type]) -> str:
    """Return the names of the package's classes of some kinds, as a list in words."""
    derived: list[Sequence[type]] = [kind.__subclasses__() or [kind] for kind in kinds if kind is not Contribution] or [
        kinds
    ]
    names = [each.__name__ for some in derived for each in some if each.__module__.startswith("beamfem.")]
    return " or ".join(", ".join(dict.fromkeys(names)).rsplit(", ", 1))  # slots make a class twice
