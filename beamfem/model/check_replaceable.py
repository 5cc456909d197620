"""Check that user-defined parts can be recreated from their fields: on other beams, or from a file."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from beamfem.errors import InputError


def require_remade(what: str, part: Any) -> None:
    """Raise InputError, beginning with `what`, if a dataclass recreated from its fields differs from the original."""
    try:
        again = replace(part)
    except Exception as error:
        raise InputError(f"{what}: it cannot be recreated from its fields: {error}") from error
    for field in fields(part):
        if not _same(getattr(part, field.name), getattr(again, field.name)):
            raise InputError(
                f"{what}: its field {field.name} changes when the object is recreated from its fields; store the given "
                "values there, and derive the rest in properties or methods"
            )


def _same(one: Any, other: Any) -> bool:
    if one is other:
        return True
    if isinstance(one, tuple | list) and isinstance(other, tuple | list):
        return len(one) == len(other) and all(map(_same, one, other))
    return bool(np.all(one == other))
