"""Plain memory in compiled code: pointers made of addresses, and calls of compiled functions by their address.

A function that calls another one by address is compiled on its own: neither waits for the other, and none is compiled
twice. Addresses stand in tables of whole numbers that Python owns.
"""

from collections.abc import Callable
from ctypes import addressof, c_char
from functools import cache
from inspect import Parameter, Signature
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.typing import signature
from numba.extending import intrinsic

from beamfem.kernels.lanes import ROWS

REALS = types.CPointer(types.float64)
WHOLES = types.CPointer(types.int64)
SLOTS = types.CPointer(types.int32)
# One letter an argument: pointers to numbers, to rows of lanes, whole numbers and 32-bit whole numbers; a whole number,
# a number.
KINDS = {"r": REALS, "v": ROWS, "n": WHOLES, "s": SLOTS, "i": types.int64, "d": types.float64}


@intrinsic
def at(context, pointer, count):
    """Return the pointer `count` entries further on."""

    def generate(context, builder, outer, given):
        return builder.gep(given[0], [given[1]], inbounds=True)

    return signature(pointer, pointer, types.intp), generate


@intrinsic
def small_code(context):
    """Keep the code of the function that says so small: no loop of it is unrolled, or compiled once for each case."""

    def generate(context, builder, outer, given):
        builder.function.attributes.add("optsize")
        return context.get_dummy_value()

    return signature(types.none), generate


def _pointer(kind: types.Type) -> Callable[..., Any]:
    def pointer(context, address):
        def generate(context, builder, outer, given):
            return builder.inttoptr(given[0], context.get_value_type(kind))

        return signature(kind, types.int64), generate

    return intrinsic(pointer)


reals = _pointer(REALS)
wholes = _pointer(WHOLES)
slots = _pointer(SLOTS)


@cache
def caller(kinds: str, returns: types.Type = types.void, of_c: bool = False) -> Callable[..., Any]:
    """Return call(address, *arguments) for compiled functions of these kinds of arguments.

    The address is a `Routine.entry`, called as Numba's functions call one another; of_c: that of any function, which
    is called as C does.
    """
    wanted = tuple(KINDS["r" if kind == "v" else kind] for kind in kinds)  # drivers have pointers to single numbers

    def call(context, address, *arguments):
        def generate(context, builder, outer, given):
            values = [context.cast(builder, *each) for each in zip(given[1:], outer.args[1:], wanted, strict=True)]
            if of_c:
                kept = [context.get_value_type(kind) for kind in wanted]
                own = ir.FunctionType(context.get_value_type(returns), kept)
                value = builder.call(builder.inttoptr(given[0], own.as_pointer()), values)
            else:
                own = context.call_conv.get_function_type(returns, wanted)
                target = builder.inttoptr(given[0], own.as_pointer())
                value = context.call_conv.call_function(builder, target, returns, wanted, values)[1]
            return context.get_dummy_value() if returns is types.void else value

        return signature(returns, address, *wanted), generate

    names = ("context", "address", *(f"argument_{number}" for number in range(len(wanted))))
    vars(call)["__signature__"] = Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in names])
    return intrinsic(call)


def address_of(values: np.ndarray) -> int:
    """Return the address of the first number of an array."""
    if values.size and values.flags.writeable and values.flags.c_contiguous:
        return addressof(c_char.from_buffer(values.data))
    return int(values.__array_interface__["data"][0])  # which takes NumPy twice as long
