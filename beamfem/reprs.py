"""Texts of results in a line or two, whatever arrays they hold: for a prompt, a notebook, a debugger."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from beamfem.validation import shown

_FEW = 4  # items that are shown themselves
_LONG = 200  # characters of what is in a field
_LONGEST = 700  # characters of everything


def brief(item: Any) -> str:
    """Return a dataclass with its fields: arrays by their shape and range, long sequences by their length.

    Where a class has a method `_unit_of`, the unit of each field that it names follows the value.
    """
    unit_of = getattr(item, "_unit_of", lambda name: "")
    shown_fields = ((field.name, unit_of(field.name)) for field in fields(item) if field.repr)
    parts = (f"{name}={_shown(getattr(item, name))}{unit and f' {unit}'}" for name, unit in shown_fields)
    text = f"{type(item).__name__}({', '.join(parts)})"
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}...)"


def _shown(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > _FEW:
        finite = value[np.isfinite(value)] if value.dtype.kind == "f" else value
        span = f" from {finite.min():.6g} to {finite.max():.6g}" if finite.size and value.dtype.kind in "fiu" else ""
        return f"<array {value.shape}{span}>"
    if isinstance(value, np.ndarray):
        return np.array2string(value, precision=6, separator=", ").replace("\n", "")
    if isinstance(value, tuple | list):
        comma = "," if len(value) == 1 else ""
        text = f"({', '.join(map(_shown, value[:_FEW]))}{comma})"
        return f"<{len(value)} items>" if len(value) > _FEW or len(text) > _LONG else text
    if isinstance(value, Mapping):
        text = f"{{{', '.join(f'{key!r}: {_shown(value[key])}' for key in list(value)[:_FEW])}}}"
        return f"<{len(value)} entries>" if len(value) > _FEW or len(text) > _LONG else text
    return shown(value).replace("\n", " ")
