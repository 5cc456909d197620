"""Rows of numbers that compiled code takes several at a time: lanes, and pointers to rows of them.

A loop over single numbers leaves it to the compiler to make vectors of it, which asks at run time whether rows overlap
and takes the last few numbers one by one: more work than a short row itself. `x[i]` of a pointer of kind "v" are the
numbers i to i + WIDTH - 1 at once, so that a pass steps with range(0, count, WIDTH) and works on lanes beyond its count
as well. Rows have room for them; what is in them is of no meaning and may be no number.
"""

from llvmlite import ir

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.kinds import LANES, NUMBER, ROWS, WHOLE, WIDTH, Value

__all__ = ["WIDTH", "as_rows", "gathered", "larger", "largest", "merged", "zeros"]

_BITS = ir.VectorType(WHOLE.llvm, WIDTH)


@operation
def as_rows(build: Build, pointer: Value) -> Value:
    """Return the pointer to rows at a pointer to numbers."""
    return Value(ROWS, build.converted(pointer, ROWS))


@operation
def zeros(build: Build) -> Value:
    """Return lanes that are all zero."""
    return Value(LANES, ir.Constant(LANES.llvm, None))


@operation
def larger(build: Build, a: Value, b: Value) -> Value:
    """Return the size of the larger of two, lane by lane; what is no number is larger than all."""
    # sizes are ordered as their bits are, and the bits of what is no number come after those of infinity
    sizes = [build.call(f"llvm.fabs.v{WIDTH}f64", Value(LANES, build.converted(each, LANES))).llvm for each in (a, b)]
    bits = [build.builder.bitcast(size, _BITS) for size in sizes]
    return Value(LANES, build.builder.select(build.builder.icmp_signed(">", *bits), *sizes))


@operation
def largest(build: Build, value: Value) -> Value:
    """Return the largest of lanes that are not negative, or what is no number."""
    name = f"llvm.vector.reduce.smax.v{WIDTH}i64"
    functions, kind = build.builder.module.globals, ir.FunctionType(WHOLE.llvm, [_BITS])
    reduce = functions.get(name) or ir.Function(build.builder.module, kind, name)
    found = build.builder.call(reduce, [build.builder.bitcast(value.llvm, _BITS)])
    return Value(NUMBER, build.builder.bitcast(found, NUMBER.llvm))


@operation
def merged(build: Build, value: Value, other: Value, count: Value) -> Value:
    """Return the first `count` lanes of a value, and those of the other one beyond."""
    places = ir.Constant(ir.VectorType(ir.IntType(64), WIDTH), list(range(WIDTH)))
    inside = build.builder.icmp_signed("<", places, build.same(count.llvm))
    return Value(LANES, build.builder.select(inside, build.converted(value, LANES), build.converted(other, LANES)))


@operation
def gathered(build: Build, values: Value, places: Value) -> Value:
    """Return the numbers at the first `WIDTH` places."""
    builder, lanes = build.builder, ir.Constant(LANES.llvm, ir.Undefined)
    for lane in range(WIDTH):
        place = builder.load(builder.gep(places.llvm, [ir.IntType(64)(lane)], inbounds=True))
        number = builder.load(builder.gep(values.llvm, [place], inbounds=True))
        lanes = builder.insert_element(lanes, number, ir.IntType(32)(lane))
    return Value(LANES, lanes)
