"""Memory in compiled code: pointers made from addresses, and calls of compiled functions by their address.

Functions that call one another by address are compiled separately, and each only once. Addresses are passed in tables
of integers that Python owns.
"""

from collections.abc import Callable
from ctypes import addressof, c_char
from functools import cache
from typing import Any

import numpy as np
from llvmlite import ir

from beamfem.kernels.compiler.bounds_checks import CHECKED, register
from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import RESULTS, operation
from beamfem.kernels.compiler.value_types import KINDS, REALS, SLOTS, WHOLES, Kind, Value

_PLACE = c_char * 0  # an array may be empty


@operation
def at(build: Build, pointer: Value, count: Value) -> Value:
    """Return the pointer advanced by `count` entries."""
    return pointer._replace(llvm=build.builder.gep(pointer.llvm, [count.llvm], inbounds=True))


@operation
def small_code(build: Build) -> None:
    """Optimise the calling function for size: its loops are neither unrolled nor duplicated for special cases."""
    build.builder.function.attributes.add("optsize")


@operation
def room(build: Build, count: Value) -> Value:
    """Return a pointer to `count` numbers on the stack of the function; the count is a compile-time constant."""
    numbers = build.space(ir.ArrayType(REALS.llvm.pointee, count.llvm.constant))
    return build.whole_array(Value(REALS, build.builder.bitcast(numbers, REALS.llvm)), count.llvm.constant)


def _pointer(kind: Kind) -> Callable[..., Any]:
    @operation
    def pointer(build: Build, address: Value) -> Value:
        return Value(kind, build.builder.inttoptr(address.llvm, kind.llvm))

    return pointer


reals = _pointer(REALS)
wholes = _pointer(WHOLES)
slots = _pointer(SLOTS)


@cache
def caller(kinds: str, returns: str = "") -> Callable[..., Any]:
    """Return an operation call(address, *arguments) for functions with these kinds of arguments, in C convention."""
    value_kinds, result = [KINDS[kind] for kind in kinds], RESULTS[returns]
    outer = ir.VoidType() if result is None else result.llvm
    function_type = ir.FunctionType(outer, [kind.llvm for kind in value_kinds]).as_pointer()

    @operation
    def call(build: Build, address: Value, *arguments: Value) -> Value | None:
        for each in arguments:
            build.pass_on(each)
        values = [build.converted(value, kind) for value, kind in zip(arguments, value_kinds, strict=True)]
        returned = build.builder.call(build.builder.inttoptr(address.llvm, function_type), values)
        build.end_if_ended()
        return None if result is None else Value(result, returned)

    return call


def address_of(values: np.ndarray) -> int:
    """Return the address of the first number of an array."""
    if CHECKED:
        register(values)
    if values.flags.writeable and values.flags.c_contiguous:
        return addressof(_PLACE.from_buffer(values.data))
    return int(values.__array_interface__["data"][0])  # works for all arrays, but takes twice as long
