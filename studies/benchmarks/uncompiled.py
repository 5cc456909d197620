"""Kernels run as the Python they are written in, on memory whose floating-point numbers may be replaced by others.

Rows are taken one lane at a time then.
"""

import importlib
import math
import pkgutil
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import ModuleType, SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

import beamfem.kernels
from beamfem.kernels import nodes, pointers
from beamfem.kernels import simd as lanes
from beamfem.kernels import simd as pairs
from beamfem.kernels.compiler.callables import Inlined, Operation
from beamfem.kernels.compiler.value_types import WIDTH
from beamfem.kernels.compiling import Routine
from beamfem.kernels.records import Record
from beamfem.physics.compiled_elements import MEASURE_PASSES, NODE_PASSES


class Pointer:
    """A place in an array."""

    __slots__ = ("first", "values")

    def __init__(self, values: Any, first: int) -> None:
        self.values, self.first = values, first

    def __getitem__(self, index: int) -> Any:
        return self.values[self.first + index]

    def __setitem__(self, index: int, value: Any) -> None:
        self.values[self.first + index] = value


class Pair(NamedTuple):
    """Two numbers that are subtracted from and multiplied by those of another pair."""

    first: Any
    second: Any

    def __sub__(self, other: "Pair") -> "Pair":
        return Pair(self.first - other.first, self.second - other.second)

    def __mul__(self, other: "Pair") -> "Pair":  # type: ignore[override]
        return Pair(self.first * other.first, self.second * other.second)


class Pairs(Pointer):
    """A place in an array whose entries are read as pairs; an entry that was set to a pair is one."""

    __slots__ = ()

    def __getitem__(self, index: int) -> Pair:
        value = super().__getitem__(index)
        return value if isinstance(value, Pair) else Pair(value, super().__getitem__(index + 1))


class Memory:
    """Arrays by their addresses; those of floating-point numbers as lists, each number passed through `made`."""

    def __init__(self, arrays: Iterable[np.ndarray], made: Callable[[float], Any]) -> None:
        self.made = made
        held = sorted({each.ctypes.data: each for each in arrays if each.size}.items())
        self._bases = [base for base, _ in held]
        self._sizes = [each.itemsize for _, each in held]
        self._values = [
            [made(x) for x in each.ravel().tolist()] if each.dtype.kind == "f" else each.ravel() for _, each in held
        ]

    def at(self, address: int) -> Pointer:
        number = max(bisect_right(self._bases, int(address)) - 1, 0)
        return Pointer(self._values[number], (int(address) - self._bases[number]) // self._sizes[number])


class Fields:
    """A record whose arrays are places in a memory, and whose functions are run as Python."""

    def __init__(self, record: Record, memory: Memory) -> None:
        vars(self).update(record=record, memory=memory)

    def __getattr__(self, name: str) -> Any:
        field, value = self.record.fields[name], getattr(self.record, name)
        if isinstance(value, np.ndarray):
            entry = field.kind.entry
            if entry is not None and entry.fields is not None:  # records side by side
                return [SimpleNamespace(**dict(zip(entry.fields, row, strict=True))) for row in value.tolist()]
            return self.memory.at(value.ctypes.data)
        if isinstance(value, list | tuple):
            return [Fields(each, self.memory) for each in value]
        if isinstance(value, Record):
            return Fields(value, self.memory)
        if isinstance(value, Routine):
            return value.function
        return self.memory.made(value) if isinstance(value, float) else value

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self.record, name, value)


def arrays_of(record: Record) -> Iterator[np.ndarray]:
    """Yield the arrays of a record and of those that it refers to."""
    for value in record.kept.values():
        for each in value if isinstance(value, list | tuple) else [value]:
            if isinstance(each, Record):
                yield from arrays_of(each)
            elif isinstance(each, np.ndarray):
                yield each


@contextmanager
def uncompiled() -> Iterator[None]:
    """Let functions of all kernel modules call each other as Python, on the records of `Fields`."""
    replaced: list[tuple[ModuleType, str, Any]] = []

    def at(pointer: Pointer, count: int) -> Pointer:
        return Pointer(pointer.values, pointer.first + int(count))

    def push(window: Pointer, count: int, value: Any) -> None:
        step = 2 if isinstance(window, Pairs) else 1
        window.values[:] = [*window.values[step:], *step * [value]]

    plain = {
        "at": at,
        "given": lambda pointer: pointer is not None,
        "as_rows": lambda pointer: pointer,
        "zeros": lambda: 0,
        "gathered": lambda values, places: values[places[0]],
        "small_code": lambda: None,
        "merged": lambda value, other, count: value,
        "room": lambda count: Pointer([0.0] * count, 0),
        "push": push,
        "as_pairs": lambda pointer: Pairs(pointer.values, pointer.first),
        "paired": Pair,
        "first_of": lambda pair: pair.first,
        "second_of": lambda pair: pair.second,
    }
    constants = {"WIDTH": 1, "WRITES_PARTS": False}
    numbers = SimpleNamespace(floor=lambda x: math.floor(float(x)))
    try:
        for module in [*_modules()]:  # all before the first is changed, from which others import
            for name, value in list(vars(module).items()):
                if name in constants:
                    replaced.append((module, name, value))
                    setattr(module, name, constants[name])
                elif isinstance(value, Operation) and module not in (lanes, pairs, pointers) and name in plain:
                    replaced.append((module, name, value))
                    setattr(module, name, plain[name])
                elif isinstance(value, Inlined):
                    replaced.append((module, name, value))
                    setattr(module, name, value.function)
        replaced.append((nodes, "np", np))
        nodes.np = numbers
        for derived in _derived():
            derived |= {"at": at, **constants}
        yield
    finally:
        for module, name, value in replaced:
            setattr(module, name, value)
        for derived in _derived():
            derived |= {"at": pointers.at, "WIDTH": WIDTH}


def _derived() -> Iterator[dict[str, Any]]:
    """Yield what derived passes of strain measures and nodes find outside."""
    for passes in (*MEASURE_PASSES, *NODE_PASSES):
        for each in passes.values():
            yield each.function.__globals__


def _modules() -> Iterator[ModuleType]:
    for found in pkgutil.walk_packages(beamfem.kernels.__path__, "beamfem.kernels."):
        yield importlib.import_module(found.name)
