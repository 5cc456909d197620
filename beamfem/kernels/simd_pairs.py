"""Two numbers at once in compiled code, such as those of two recursions that wait for their last value each."""

from llvmlite import ir

from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import operation
from beamfem.kernels.compiler.value_types import NUMBER, PAIR, PAIRS, Value

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
