"""Check that a model fits into memory, before it is meshed."""

from collections.abc import Sequence

from beamfem.element.coordinates import labels
from beamfem.errors import InputError
from beamfem.installed_memory import USABLE_FRACTION, in_gib, installed_memory
from beamfem.model.beam import Beam

_COORDINATE = 300  # bytes per coordinate; 310 to 370 were measured in statics
_LITTLE = 2**24  # bytes that every computer has


def require_room(beams: Sequence[Beam]) -> None:
    """Raise InputError if the elements of a model need more memory [bytes] than this computer has."""
    needed = _COORDINATE * sum(map(_coordinates, beams))
    if needed <= _LITTLE:
        return
    memory = installed_memory()
    if memory is None or needed <= USABLE_FRACTION * memory:
        return
    most, elements = max(beams, key=_coordinates), sum(beam.element_count for beam in beams)
    raise InputError(
        f"the {elements:.4g} elements of this model need {in_gib(needed)} at the least, and this "
        f"computer has {in_gib(memory)}; the most are in {most!r}, take fewer"
    )


def _coordinates(beam: Beam) -> int:
    element = beam.element
    names = labels(element.coordinates.code, element.field.vectors)
    return beam.element_count * (len(element.field.nodes) - 1) * len(names)
