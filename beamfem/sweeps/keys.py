"""Keys by which results are found again: equal function and equal parameters give equal keys, in any process."""

import hashlib
import inspect
import json
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial
from pathlib import PurePath
from types import BuiltinFunctionType, FunctionType
from typing import Any

import numpy as np

from beamfem.errors import InputError

_MOVED = {
    "beamfem.assembly.rigid_velocity": "beamfem.analysis.initial",
    "beamfem.solve.motion.integrators": "beamfem.analysis.integrators",
    "beamfem.solve.motion.dynamics": "beamfem.analysis.dynamics",
    "beamfem.solve.newton.iteration": "beamfem.analysis.iteration",
    "beamfem.solve.modes.modes": "beamfem.analysis.modes",
    "beamfem.solve.paths.trace": "beamfem.analysis.trace",
    "beamfem.solve.stability.buckling": "beamfem.analysis.buckling",
    "beamfem.solve.statics.statics": "beamfem.analysis.statics",
    "beamfem.results.path": "beamfem.path",
    "beamfem.results.solution": "beamfem.solution",
    "beamfem.results.status": "beamfem.status",
}


def point_key(function_form: Any, point: Mapping[str, Any]) -> str:
    """Return the key of a call (64 hexadecimal digits). Raises InputError for what cannot be keyed."""
    forms = {name: canonical(value, name) for name, value in sorted(point.items())}
    return _digest(json.dumps([function_form, forms]))


def function_form(function: Callable[..., Any]) -> Any:
    """Return what a function is known by: module, qualified name and what it closes over; its content is `Sources`.

    Raises InputError for lambdas, methods and functions without a source file: another one may look the same.
    """
    return canonical(function, "the function")


def canonical(value: Any, where: str) -> Any:
    """Return lists and texts that are equal for equal values only; floats by every digit, dataclasses by members."""
    if value is None or isinstance(value, bool | np.bool_):
        return str(value)
    if isinstance(value, Enum):
        return ["enum", _name(type(value)), value.name]
    if isinstance(value, str):
        return ["text", value]
    if isinstance(value, PurePath):
        return ["path", str(value)]
    if isinstance(value, int | np.integer):
        return ["int", str(int(value))]
    if isinstance(value, float | np.floating):
        return ["float", float(value).hex()]
    if isinstance(value, complex | np.complexfloating):
        return ["complex", float(value.real).hex(), float(value.imag).hex()]
    if isinstance(value, np.ndarray):
        return _array(value, where)
    if isinstance(value, tuple | list | range):
        return ["sequence", *(canonical(item, f"{where}[{i}]") for i, item in enumerate(value))]
    if isinstance(value, Mapping) and all(isinstance(name, str) for name in value):
        return ["mapping", *([name, canonical(value[name], f"{where}[{name!r}]")] for name in sorted(value))]
    if isinstance(value, partial):
        parts = {"of": value.func, "with": value.args, "and": value.keywords}
        return ["partial", canonical(parts, where)]
    if is_dataclass(value) and not isinstance(value, type):
        members = {member.name: getattr(value, member.name) for member in fields(value)}
        return ["object", _name(type(value)), *([n, canonical(item, f"{where}.{n}")] for n, item in members.items())]
    if isinstance(value, type | BuiltinFunctionType | np.ufunc):
        return ["builtin", getattr(value, "__module__", ""), value.__name__]
    if isinstance(value, FunctionType):
        return _function(value, where)
    raise InputError(
        f"{where} is a {type(value).__name__}, which cannot be stored under a key that is the same in the next run; "
        "numbers, text, tuples, arrays, dataclasses and functions made with def can"
    )


def _function(function: FunctionType, where: str) -> Any:
    name = _name(function)
    if function.__name__ == "<lambda>":
        raise InputError(f"{where} is a lambda, which has no name to be found again by; define it with def")
    try:
        inspect.getsource(function)
    except (OSError, TypeError):
        raise InputError(
            f"the source of {name} cannot be read, so that a change would go unnoticed; put it in a file"
        ) from None
    closed = [cell.cell_contents for cell in function.__closure__ or ()]
    return ["function", name, canonical(closed, f"what {name} closes over")]


def _array(value: np.ndarray, where: str) -> Any:
    if value.dtype.hasobject:
        raise InputError(f"{where} is an array of objects, which cannot be stored under a stable key; use a tuple")
    little = value.astype(value.dtype.newbyteorder("<"), order="C", copy=False)
    return ["array", little.dtype.str, list(value.shape), hashlib.sha256(little.tobytes()).hexdigest()]


def _name(item: FunctionType | type) -> str:
    """Return module and qualified name; of what has moved the name under which results may be stored."""
    return f"{_MOVED.get(item.__module__, item.__module__)}.{item.__qualname__}"


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
