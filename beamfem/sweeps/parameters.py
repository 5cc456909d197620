"""Parameters of a study: which are varied, every combination of them, and what to call their values."""

import inspect
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import partial
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.installed_memory import USABLE_FRACTION, in_gib, installed_memory
from beamfem.validation import nearest

_POINT = 1000  # bytes of a point; 1100 were measured with one parameter


def split(parameters: Mapping[str, Any]) -> tuple[dict[str, tuple[Any, ...]], dict[str, Any]]:
    """Return what is varied (lists, tuples, ranges and arrays of one dimension) and what is not.

    A vector that is meant as one value stands in a list: `start=[(0, 0)]`. Raises InputError for an empty list.
    """
    varied: dict[str, tuple[Any, ...]] = {}
    fixed: dict[str, Any] = {}
    counts = [len(value) for value in parameters.values() if _varies(value)]
    points, memory = math.prod(counts), installed_memory()
    if memory is not None and points * _POINT > USABLE_FRACTION * memory:
        product = " x ".join(map(str, counts))
        raise InputError(
            f"{product} = {points:.3g} points need {in_gib(points * _POINT)} at the least, and this computer has "
            f"{in_gib(memory)}; take fewer values, or several sweeps"
        )
    for name, value in parameters.items():
        if _varies(value):
            varied[name] = tuple(value.tolist() if isinstance(value, np.ndarray) else value)
            if not varied[name]:
                raise InputError(f"{name} must have at least one value, got an empty {type(value).__name__}")
        else:
            fixed[name] = value
    return varied, fixed


def _varies(value: Any) -> bool:
    return isinstance(value, list | tuple | range) or (isinstance(value, np.ndarray) and value.ndim == 1)


def combinations(varied: Mapping[str, Sequence[Any]], fixed: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return every combination of the varied values with the fixed ones; the last list runs fastest."""
    return [dict(zip(varied, values, strict=True)) | dict(fixed) for values in itertools.product(*varied.values())]


def check_call(function: Callable[..., Any], point: Mapping[str, Any], options: Sequence[str]) -> None:
    """Raise InputError if `function` cannot be called with these parameters; options: those of the study itself."""
    if not callable(function):
        raise InputError(f"the first argument must be a function, got {function!r}")
    try:
        signature = inspect.signature(function)
    except ValueError:  # some compiled functions have none
        return
    try:
        signature.bind(**point)
    except TypeError as error:
        name = getattr(function, "__name__", repr(function))
        sentence = f"{name}{signature} cannot be called with {', '.join(point) or 'nothing'}: {error}"
        unknown = [key for key in point if key not in signature.parameters]
        hint = f"; {nearest(unknown[0], [*signature.parameters, *options])}" if unknown else ""
        raise InputError(f"{sentence}{hint}") from None


def name_of(function: Callable[..., Any]) -> str:
    """Return what a bare number of a function is called in tables: as the function, or "value" if that has no name."""
    while isinstance(function, partial):
        function = function.func
    name = getattr(function, "__name__", "")
    return name if name.isidentifier() else "value"


def labels(values: Sequence[Any]) -> tuple[str, ...]:
    """Return a text for each value: its name where it has one; equal names get the members in which they differ."""
    texts = [_label(value) for value in values]
    for text, same in _repeated(texts):
        for i, detail in zip(same, _differences([values[i] for i in same]), strict=True):
            texts[i] = f"{text} ({detail})" if detail else text
    for text, same in _repeated(texts):
        for number, i in enumerate(same, 1):
            texts[i] = f"{text} #{number}"
    return tuple(texts)


def _repeated(texts: Sequence[str]) -> list[tuple[str, list[int]]]:
    """Return each text that is there more than once, with its places."""
    places: dict[str, list[int]] = {}
    for i, text in enumerate(texts):
        places.setdefault(text, []).append(i)
    return [(text, indices) for text, indices in places.items() if len(indices) > 1]


def assignments(point: Mapping[str, Any]) -> str:
    """Return `name=value` of every parameter."""
    return ", ".join(f"{name}={_label(value)}" for name, value in point.items())


def _label(value: Any) -> str:
    if isinstance(name := getattr(value, "name", None), str):
        return name
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    if isinstance(name := getattr(value, "__name__", None), str):
        return name
    return type(value).__name__ if is_dataclass(value) else str(value)


def _differences(values: Sequence[Any]) -> list[str]:
    """Return for objects of one dataclass the members in which they differ, else nothing."""
    kind = type(values[0])
    if not is_dataclass(kind) or any(type(value) is not kind for value in values):
        return [""] * len(values)
    details: list[list[str]] = [[] for _ in values]
    for member in fields(kind):
        texts = labels([getattr(value, member.name) for value in values])
        plain = [text.split(" #")[0] for text in texts]
        if len(set(plain)) == 1:
            continue
        for detail, text, value in zip(details, plain, values, strict=True):
            named = isinstance(getattr(value, member.name), bool | int | float)
            detail.append(f"{member.name}={text}" if named else text)
    return [", ".join(detail) for detail in details]
