"""Explicit SIMD in compiled code: values of several lanes, and pointers to rows of them.

If a loop over single numbers is left to the compiler's vectoriser, the code tests at run time whether rows overlap and
processes the last few numbers one by one, which takes longer than a short row itself. For a pointer of kind "v", `x[i]`
is the vector of the numbers i to i + WIDTH - 1, so a pass steps with range(0, count, WIDTH) and also processes lanes
beyond its count. Rows are padded for them; the values in them have no meaning and may be NaN.
"""

from llvmlite import ir

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.kinds import LANES, NUMBER, ROWS, WHOLE, WIDTH, Value

__all__ = ["WIDTH", "as_rows", "gathered", "lanes_within", "larger", "largest", "merged", "put_within", "zeros"]

_SHORT = ir.IntType(32)
_MASK = ir.VectorType(ir.IntType(1), WIDTH)
_BITS = ir.VectorType(WHOLE.llvm, WIDTH)


@operation
def as_rows(build: Build, pointer: Value) -> Value:
    """Return a pointer to numbers as a pointer to lanes."""
    return Value(ROWS, build.converted(pointer, ROWS))


@operation
def zeros(build: Build) -> Value:
    """Return lanes of zeros."""
    return Value(LANES, ir.Constant(LANES.llvm, None))


@operation
def larger(build: Build, a: Value, b: Value) -> Value:
    """Return the larger of two absolute values, lane by lane; NaN counts as larger than any number."""
    # non-negative doubles have the order of their bits taken as integers, and NaN comes after infinity
    sizes = [build.call(f"llvm.fabs.v{WIDTH}f64", Value(LANES, build.converted(each, LANES))).llvm for each in (a, b)]
    bits = [build.builder.bitcast(size, _BITS) for size in sizes]
    return Value(LANES, build.builder.select(build.builder.icmp_signed(">", *bits), *sizes))


@operation
def largest(build: Build, value: Value) -> Value:
    """Return the largest of non-negative lanes, or NaN if one of them is NaN."""
    name = f"llvm.vector.reduce.smax.v{WIDTH}i64"
    functions, kind = build.builder.module.globals, ir.FunctionType(WHOLE.llvm, [_BITS])
    reduce = functions.get(name) or ir.Function(build.builder.module, kind, name)
    bits = build.builder.call(reduce, [build.builder.bitcast(value.llvm, _BITS)])
    return Value(NUMBER, build.builder.bitcast(bits, NUMBER.llvm))


@operation
def merged(build: Build, value: Value, other: Value, count: Value) -> Value:
    """Return the first `count` lanes of `value` followed by the remaining lanes of `other`."""
    lanes = ir.Constant(ir.VectorType(ir.IntType(64), WIDTH), list(range(WIDTH)))
    inside = build.builder.icmp_signed("<", lanes, build.same(count.llvm))
    return Value(LANES, build.builder.select(inside, build.converted(value, LANES), build.converted(other, LANES)))


@operation
def gathered(build: Build, values: Value, places: Value) -> Value:
    """Return the entries of `values` at the first `WIDTH` indices in `places`."""
    builder, lanes = build.builder, ir.Constant(LANES.llvm, ir.Undefined)
    for lane in range(WIDTH):
        index = builder.load(builder.gep(places.llvm, [ir.IntType(64)(lane)], inbounds=True))
        number = builder.load(builder.gep(values.llvm, [index], inbounds=True))
        lanes = builder.insert_element(lanes, number, ir.IntType(32)(lane))
    return Value(LANES, lanes)


@operation
def lanes_within(build: Build, pointer: Value, first: Value, end: Value) -> Value:
    """Return the lanes from `first` to `end`, constants for the compiler, and zero in the others, which are not read."""
    memory, mask = LANES.llvm.as_pointer(), _mask(first, end)
    load = _intrinsic(
        build, f"llvm.masked.load.v{WIDTH}f64.p0v{WIDTH}f64", LANES.llvm, [memory, _SHORT, _MASK, LANES.llvm]
    )
    address = build.builder.bitcast(pointer.llvm, memory)
    return Value(LANES, build.builder.call(load, [address, _SHORT(8), mask, ir.Constant(LANES.llvm, None)]))


@operation
def put_within(build: Build, pointer: Value, first: Value, end: Value, value: Value) -> None:
    """Set the lanes from `first` to `end`, constants for the compiler."""
    memory, mask = LANES.llvm.as_pointer(), _mask(first, end)
    store = _intrinsic(
        build, f"llvm.masked.store.v{WIDTH}f64.p0v{WIDTH}f64", ir.VoidType(), [LANES.llvm, memory, _SHORT, _MASK]
    )
    address = build.builder.bitcast(pointer.llvm, memory)
    build.builder.call(store, [build.converted(value, LANES), address, _SHORT(8), mask])


def _mask(first: Value, end: Value) -> ir.Constant:
    return ir.Constant(_MASK, [int(first.llvm.constant <= lane < end.llvm.constant) for lane in range(WIDTH)])


def _intrinsic(build: Build, name: str, result: ir.Type, arguments: list[ir.Type]) -> ir.Function:
    """Return a function of LLVM."""
    module = build.builder.module
    return module.globals.get(name) or ir.Function(module, ir.FunctionType(result, arguments), name)
