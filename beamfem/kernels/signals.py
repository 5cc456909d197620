"""Atomic operations on integers in memory, by which two threads synchronise."""

from llvmlite import binding, ir

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.kinds import FLAG, WHOLE, Value

_PAUSE = "llvm.x86.sse2.pause"


@operation
def acquired(build: Build, pointer: Value, index: Value) -> Value:
    """Load an entry with acquire ordering: all writes that preceded its `release` by another thread are now visible."""
    return Value(WHOLE, build.builder.load_atomic(build.place(pointer, index), "acquire", 8))


@operation
def release(build: Build, pointer: Value, index: Value, value: Value) -> None:
    """Store an entry with release ordering, for a thread that loads it with `acquired`."""
    build.builder.store_atomic(build.converted(value, WHOLE), build.place(pointer, index), "release", 8)


@operation
def replaced(build: Build, pointer: Value, index: Value, old: Value, new: Value) -> Value:
    """Compare and swap: set an entry to `new` if it is `old`; return whether it was. Of two threads, one succeeds."""
    address = build.place(pointer, index)
    result = build.builder.cmpxchg(address, old.llvm, new.llvm, "acq_rel", "acquire")
    return Value(FLAG, build.builder.extract_value(result, 1))


@operation
def pause(build: Build) -> None:
    """Pause in a spin loop, which leaves the core to its other hardware thread for a moment."""
    if binding.get_process_triple().startswith("x86_64"):
        functions = build.builder.module.globals
        callee = functions.get(_PAUSE) or ir.Function(build.builder.module, ir.FunctionType(ir.VoidType(), []), _PAUSE)
        build.builder.call(callee, [])
