"""What two threads tell each other through whole numbers in memory."""

from llvmlite import binding, ir

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.kinds import FLAG, WHOLE, Value

_PAUSE = "llvm.x86.sse2.pause"


@operation
def acquired(build: Build, pointer: Value, index: Value) -> Value:
    """Return an entry; what the thread that released it has written before is seen from here on."""
    return Value(WHOLE, build.builder.load_atomic(build.place(pointer, index), "acquire", 8))


@operation
def release(build: Build, pointer: Value, index: Value, value: Value) -> None:
    """Set an entry, for a thread that acquires it."""
    build.builder.store_atomic(build.converted(value, WHOLE), build.place(pointer, index), "release", 8)


@operation
def replaced(build: Build, pointer: Value, index: Value, old: Value, new: Value) -> Value:
    """Set an entry if it has a value; return whether it had. Of two threads one finds that it had."""
    place = build.place(pointer, index)
    found = build.builder.cmpxchg(place, old.llvm, new.llvm, "acq_rel", "acquire")
    return Value(FLAG, build.builder.extract_value(found, 1))


@operation
def pause(build: Build) -> None:
    """Leave the core to its other thread for a moment."""
    if binding.get_process_triple().startswith("x86_64"):
        functions = build.builder.module.globals
        own = functions.get(_PAUSE) or ir.Function(build.builder.module, ir.FunctionType(ir.VoidType(), []), _PAUSE)
        build.builder.call(own, [])
