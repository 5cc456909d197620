"""Rows of numbers that compiled code takes several at a time: a type of `WIDTH` lanes, and pointers to rows of them.

A loop over single numbers leaves it to the compiler to make vectors of it, which asks at run time whether rows overlap
and takes the last few numbers one by one: more work than a short row itself. `x[i]` of a pointer of kind "v" are the
numbers i to i + WIDTH - 1 at once, so that a pass steps with range(0, count, WIDTH) and works on lanes beyond its count
as well. Rows have room for them; what is in them is of no meaning and may be no number.
"""

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.cgutils import get_or_insert_function
from numba.core.datamodel import PrimitiveModel
from numba.core.typing import signature
from numba.extending import intrinsic, lower_builtin, register_model, type_callable

WIDTH = 8  # a cache line of doubles, one or two registers of today's processors
_VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)


class Lanes(types.Type):
    """Numbers that are worked on at once."""

    def __init__(self) -> None:
        super().__init__(name=f"Lanes({WIDTH})")


class RowPointer(types.Type):
    """A pointer to numbers that reads and writes `WIDTH` of them at once, from any of them on."""

    def __init__(self) -> None:
        super().__init__(name=f"RowPointer({WIDTH})")


LANES = Lanes()
ROWS = RowPointer()
_OPERATORS = {
    "fadd": (operator.add, operator.iadd),
    "fsub": (operator.sub, operator.isub),
    "fmul": (operator.mul, operator.imul),
    "fdiv": (operator.truediv,),
}
_INTRINSICS: dict[Callable[..., Any], str] = {math.sqrt: "llvm.sqrt", np.floor: "llvm.floor"}


@register_model(Lanes)
class _LanesModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: types.Type) -> None:
        super().__init__(manager, kind, _VECTOR)


@register_model(RowPointer)
class _RowPointerModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: types.Type) -> None:
        super().__init__(manager, kind, ir.DoubleType().as_pointer())


def _same(builder: Any, value: ir.Value) -> ir.Value:
    """Return a vector that holds one number everywhere."""
    undefined = ir.Constant(ir.VectorType(value.type, WIDTH), ir.Undefined)
    first = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), None)
    return builder.shuffle_vector(builder.insert_element(undefined, value, first.type.element(0)), undefined, first)


def _as_lanes(context: Any, builder: Any, kind: types.Type, value: ir.Value) -> ir.Value:
    return value if kind == LANES else _same(builder, context.cast(builder, value, kind, types.float64))


def _vector_at(builder: Any, pointer: ir.Value, place: ir.Value) -> ir.Value:
    return builder.bitcast(builder.gep(pointer, [place], inbounds=True), _VECTOR.as_pointer())


def _define_operator(operation: Callable[..., Any], instruction: str) -> None:
    @type_callable(operation)
    def find_type(context):
        def find(a, b):
            if LANES in (a, b) and all(each == LANES or each in types.real_domain for each in (a, b)):
                return LANES

        return find

    def generate(context, builder, outer, given):
        return getattr(builder, instruction)(
            *(_as_lanes(context, builder, kind, value) for kind, value in zip(outer.args, given, strict=True))
        )

    for pair in ((LANES, LANES), (LANES, types.Float), (types.Float, LANES)):
        lower_builtin(operation, *pair)(generate)


def _define_function(function: Callable[..., Any], name: str) -> None:
    @type_callable(function)
    def find_type(context):
        def find(value):
            if value == LANES:
                return LANES

        return find

    @lower_builtin(function, LANES)
    def generate(context, builder, outer, given):
        own = get_or_insert_function(builder.module, ir.FunctionType(_VECTOR, [_VECTOR]), f"{name}.v{WIDTH}f64")
        return builder.call(own, given)


for _instruction, _operations in _OPERATORS.items():
    for _operation in _operations:
        _define_operator(_operation, _instruction)
for _function, _name in _INTRINSICS.items():
    _define_function(_function, _name)


@type_callable(operator.neg)
def _type_negative(context):
    def find(value):
        if value == LANES:
            return LANES

    return find


@lower_builtin(operator.neg, LANES)
def _negative(context, builder, outer, given):
    return builder.fneg(given[0])


@type_callable(operator.getitem)
def _type_read(context):
    def find(pointer, place):
        if pointer == ROWS and isinstance(place, types.Integer):
            return signature(LANES, pointer, types.intp)

    return find


@lower_builtin(operator.getitem, RowPointer, types.intp)
def _read(context, builder, outer, given):
    return builder.load(_vector_at(builder, *given), align=8)


@type_callable(operator.setitem)
def _type_write(context):
    def find(pointer, place, value):
        if pointer == ROWS and isinstance(place, types.Integer) and (value == LANES or value in types.real_domain):
            return signature(types.none, pointer, types.intp, value)

    return find


@lower_builtin(operator.setitem, RowPointer, types.intp, LANES)
@lower_builtin(operator.setitem, RowPointer, types.intp, types.Float)
def _write(context, builder, outer, given):
    value = _as_lanes(context, builder, outer.args[2], given[2])
    builder.store(value, _vector_at(builder, *given[:2]), align=8)


@intrinsic
def as_rows(context, pointer):
    """Return the pointer to rows at a pointer to numbers."""

    def generate(context, builder, outer, given):
        return given[0]

    return signature(ROWS, pointer), generate


@intrinsic
def zeros(context):
    """Return lanes that are all zero."""

    def generate(context, builder, outer, given):
        return ir.Constant(_VECTOR, None)

    return signature(LANES), generate


@intrinsic
def merged(context, value, other, count):
    """Return the first `count` lanes of a value, and those of the other one beyond."""

    def generate(context, builder, outer, given):
        places = ir.Constant(ir.VectorType(ir.IntType(64), WIDTH), list(range(WIDTH)))
        inside = builder.icmp_signed("<", places, _same(builder, given[2]))
        return builder.select(inside, given[0], given[1])

    return signature(LANES, value, other, types.intp), generate


@intrinsic
def gathered(context, values, places):
    """Return the numbers at the first `WIDTH` places."""

    def generate(context, builder, outer, given):
        lanes = ir.Constant(_VECTOR, ir.Undefined)
        for lane in range(WIDTH):
            place = builder.load(builder.gep(given[1], [ir.IntType(64)(lane)], inbounds=True))
            value = builder.load(builder.gep(given[0], [place], inbounds=True))
            lanes = builder.insert_element(lanes, value, ir.IntType(32)(lane))
        return lanes

    return signature(LANES, values, places), generate
