"""Names of beams in messages and tables: the given name, or else the number in the model."""

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from beamfem.errors import InputError

if TYPE_CHECKING:
    from beamfem.model.beam import Beam


def require_different_names(beams: Sequence["Beam"]) -> None:
    """Raise InputError for a name of two beams, or for the number of a beam without a name as the name of another."""
    beam_names = [beam.name for beam in beams if beam.name is not None]
    if not beam_names:
        return
    counts = Counter(beam_names)
    for name, number in counts.items():
        if number > 1:
            raise InputError(f"{number} beams of a Model have the name {name!r}; give each one of its own, or none")
    for number, beam in enumerate(beams):
        if beam.name is None and str(number) in counts:
            raise InputError(f"a beam has the name {str(number)!r}, the number of one without a name; name both")


def names(beams: Sequence["Beam"]) -> list[str]:
    """Return the name of every beam, or its number if it has none."""
    return [str(number) if beam.name is None else beam.name for number, beam in enumerate(beams)]


def beam_in_words(beams: Sequence["Beam"], number: int) -> str:
    """Return "beam 'arm'" for a beam with a name, "beam 3" for one without."""
    name = beams[number].name
    return f"beam {number if name is None else repr(name)}"
