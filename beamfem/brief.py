"""Texts of results in a line or two, whatever arrays they hold: for a prompt, a notebook, a debugger."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from beamfem.validation import shown

_FEW = 4  # numbers that are shown themselves


def brief(item: Any) -> str:
    """Return a dataclass with its fields: arrays by their shape and range, long sequences by their length."""
    parts = (f"{field.name}={_shown(getattr(item, field.name))}" for field in fields(item) if field.repr)
    return f"{type(item).__name__}({', '.join(parts)})"


def _shown(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > _FEW:
        known = value[np.isfinite(value)] if value.dtype.kind == "f" else value
        span = f" from {known.min():.6g} to {known.max():.6g}" if known.size and value.dtype.kind in "fiu" else ""
        return f"<array {value.shape}{span}>"
    if isinstance(value, np.ndarray):
        return np.array2string(value, precision=6, separator=", ").replace("\n", "")
    if isinstance(value, tuple | list):
        one = "," if len(value) == 1 else ""
        return f"<{len(value)} items>" if len(value) > _FEW else f"({', '.join(map(_shown, value))}{one})"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key!r}: {_shown(own)}' for key, own in value.items())}}}"
    return shown(value).replace("\n", " ")
