"""SI units of the fields of parts, as their classes state them."""

from dataclasses import fields
from typing import Any

from beamfem.model.along_beam import AlongBeam

UNIT = "unit"  # key in the metadata of a field


def field_units(part: Any) -> dict[str, str]:
    """Return the units of the fields of a part, by name: `field(metadata={"unit": ...})`, or `units` beside `along`."""
    stated = {own.name: own.metadata[UNIT] for own in fields(part) if UNIT in own.metadata}
    return stated | dict(zip(part.along, part.units, strict=False) if isinstance(part, AlongBeam) else ())
