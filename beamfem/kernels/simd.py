"""Explicit SIMD in compiled code: values of several lanes, and pointers to rows of them."""

from llvmlite import ir

from beamfem.kernels.compiler import machine
from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.value_types import LANES, NUMBER, PAIR, PAIRS, REALS, ROWS, WHOLE, Value
from beamfem.kernels.compiler.value_types import WIDTH as WIDTH  # for kernels

COLUMNS = 4  # most rows that `add_columns` takes
_NAME, _FEATURES = machine.processor()
# whether the processor writes a part of a vector as fast as a whole one; those of AMD take about twenty operations
WRITES_PARTS = "+avx512vl" in _FEATURES.split(",") and not _NAME.startswith("znver")
_BITS = ir.VectorType(WHOLE.llvm, WIDTH)


@operation
def as_rows(build: Build, pointer: Value) -> Value:
    """Return a pointer to numbers as a pointer to lanes."""
    return pointer._replace(kind=ROWS, llvm=build.converted(pointer, ROWS))


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
    reduce = build.declared(name, ir.FunctionType(WHOLE.llvm, [_BITS]))
    bits = build.builder.call(reduce, [build.builder.bitcast(value.llvm, _BITS)])
    return Value(NUMBER, build.builder.bitcast(bits, NUMBER.llvm))


@operation
def where_negative(build: Build, condition: Value, value: Value, other: Value) -> Value:
    """Return `value` where a condition is negative and `other` elsewhere, for numbers or lane by lane."""
    kind = LANES if LANES in (condition.kind, value.kind, other.kind) else NUMBER
    tested, *both = (build.converted(each, kind) for each in (condition, value, other))
    negative = build.builder.fcmp_ordered("<", tested, ir.Constant(kind.llvm, None if kind is LANES else 0.0))
    return Value(kind, build.builder.select(negative, *both))


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
        index = build.read(places, Value(WHOLE, WHOLE.llvm(lane)))
        number = build.read(values._replace(kind=REALS), index).llvm
        lanes = builder.insert_element(lanes, number, ir.IntType(32)(lane))
    return Value(LANES, lanes)


@operation
def power_of_two(build: Build, value: Value) -> Value:
    """Return the largest power of two that is not above the size of a number, and zero for one below 2e-308."""
    exponent = build.builder.and_(build.builder.bitcast(value.llvm, WHOLE.llvm), WHOLE.llvm(0x7FF << 52))
    return Value(NUMBER, build.builder.bitcast(exponent, NUMBER.llvm))


@operation
def add_columns(
    build: Build, columns: Value, count: Value, apart: Value, source: Value, step: Value, target: Value
) -> None:
    """Add lane i of the j-th of some rows to the entry j after `step` i, for all i < count and j < columns.

    source: first row of lanes, the next one `apart` numbers on; columns: at most `COLUMNS`; at least one lane is added.
    """
    builder, inside, rows = build.builder, [ir.Constant(WHOLE.llvm, j) for j in range(COLUMNS)], []
    for j in inside:  # the first row stands for those that are not there
        there = builder.icmp_signed("<", j, columns.llvm)
        place = builder.select(there, builder.mul(apart.llvm, j), inside[0])
        rows.append(build.read(source._replace(kind=ROWS), Value(WHOLE, place)).llvm)
    several = build.same(columns.llvm, COLUMNS)
    mask = builder.icmp_signed("<", ir.Constant(several.type, inside), several)
    # pairs of columns side by side, of the even and of the odd lanes
    even, odd = ([lane + part for lane in range(first, WIDTH, 2) for part in (0, WIDTH)] for first in (0, 1))
    pairs = [[_shuffled(build, rows[j], rows[j + 1], lanes) for j in (0, 2)] for lanes in (even, odd)]
    done = builder.append_basic_block("added")
    for lane in range(WIDTH):
        if lane:
            further = builder.append_basic_block("further")
            builder.cbranch(builder.icmp_signed(">", count.llvm, WHOLE.llvm(lane)), further, done)
            builder.position_at_end(further)
        first = lane // 2 * 2
        left, right = pairs[lane % 2]
        entries = _shuffled(build, left, right, [first, first + 1, WIDTH + first, WIDTH + first + 1])
        place = builder.mul(step.llvm, WHOLE.llvm(lane))
        build.check(target, place, columns.llvm)
        address = builder.gep(target.llvm, [place], inbounds=True)
        before = _load(build, address, mask, COLUMNS)
        _store(build, builder.fadd(before, entries), address, mask, COLUMNS)
    builder.branch(done)
    builder.position_at_end(done)


def _shuffled(build: Build, first: ir.Value, second: ir.Value, lanes: list[int]) -> ir.Value:
    """Return some lanes of two vectors, those of the second one counted on from those of the first one."""
    return build.builder.shuffle_vector(first, second, ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), lanes))


def _load(build: Build, address: ir.Value, mask: ir.Value, lanes: int) -> ir.Value:
    """Return the numbers at an address where a mask is set, and zero elsewhere."""
    vector, short = ir.VectorType(NUMBER.llvm, lanes), ir.IntType(32)
    kind = ir.FunctionType(vector, [vector.as_pointer(), short, mask.type, vector])
    place = build.builder.bitcast(address, vector.as_pointer())
    return build.builder.call(
        build.declared(f"llvm.masked.load.v{lanes}f64.p0v{lanes}f64", kind),
        [place, short(8), mask, ir.Constant(vector, None)],
    )


def _store(build: Build, value: ir.Value, address: ir.Value, mask: ir.Value, lanes: int) -> None:
    """Set the numbers at an address where a mask is set."""
    vector, short = ir.VectorType(NUMBER.llvm, lanes), ir.IntType(32)
    kind = ir.FunctionType(ir.VoidType(), [vector, vector.as_pointer(), short, mask.type])
    place = build.builder.bitcast(address, vector.as_pointer())
    build.builder.call(
        build.declared(f"llvm.masked.store.v{lanes}f64.p0v{lanes}f64", kind), [value, place, short(8), mask]
    )


_SHORT = ir.IntType(32)


@operation
def as_pairs(build: Build, pointer: Value) -> Value:
    """Return a pointer to numbers as a pointer to pairs of a number and the next one."""
    return pointer._replace(kind=PAIRS, llvm=build.converted(pointer, PAIRS))


@operation
def paired(build: Build, first: Value, second: Value) -> Value:
    """Return a pair of two numbers."""
    pair = ir.Constant(PAIR.llvm, ir.Undefined)
    for place, value in enumerate((first, second)):
        pair = build.builder.insert_element(pair, build.converted(value, NUMBER), _SHORT(place))
    return Value(PAIR, pair)


@operation
def first_of(build: Build, pair: Value) -> Value:
    """Return the first number of a pair."""
    return Value(NUMBER, build.builder.extract_element(pair.llvm, _SHORT(0)))


@operation
def second_of(build: Build, pair: Value) -> Value:
    """Return the second number of a pair."""
    return Value(NUMBER, build.builder.extract_element(pair.llvm, _SHORT(1)))
