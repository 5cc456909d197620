"""Memory in compiled code: pointers."""

from collections.abc import Callable
from typing import Any

from llvmlite import ir

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.value_types import FLAG, REALS, WHOLE, WHOLES, Kind, Value


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


@operation
def given(build: Build, pointer: Value) -> Value:
    """Return whether a pointer, to an array or a record, leads anywhere."""
    address = build.builder.ptrtoint(pointer.llvm, WHOLE.llvm)
    return Value(FLAG, build.builder.icmp_signed("!=", address, WHOLE.llvm(0)))


reals = _pointer(REALS)
wholes = _pointer(WHOLES)
