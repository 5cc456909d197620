"""Conversion of results to types of JSON."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np

from beamfem.results.solution import Solution


def plain(value: Any) -> Any:
    """Return a value as mappings, lists, texts, numbers and None; numbers that are not finite become None.

    A solution becomes its summary, anything unknown its text.
    """
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, np.generic | np.ndarray):
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Enum):
        return value.name.lower().replace("_", " ")
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, Solution):
        return summary(value)
    if isinstance(value, Mapping):
        return {_key(key): plain(item) for key, item in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return [plain(item) for item in value]
    return str(value)


def summary(solution: Solution) -> dict[str, Any]:
    """Return the number of states of a solution, its first and last time or load factor, and its statistics."""
    axis = "load_factor" if solution.static else "time"
    return {
        "kind": "static" if solution.static else "motion",
        "coordinates": solution.model.size,
        "states": len(solution),
        axis: [float(solution.at[0]), float(solution.at[-1])],
        "statistics": plain(solution.statistics),
    }


def _key(key: Any) -> str:
    return ", ".join(str(part) for part in key) if isinstance(key, tuple) else str(key)
