"""LLVM instructions for the operators and functions of Python."""

import ast
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir

from beamfem.kernels.compiler.bounds_checks import CHECKED
from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.value_types import FLAG, LANES, NUMBER, WHOLE, WIDTH, Kind, Value

_OF_WHOLES = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
_OF_NUMBERS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
_COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}

_BEYOND = 2.0**63
_OF_ONE = ir.FunctionType(NUMBER.llvm, [NUMBER.llvm])


def _common(a: Value, b: Value, least: Kind) -> Kind:
    if min(a.kind.rank, b.kind.rank) < 0:
        raise TypeError(f"a {a.kind.name} and a {b.kind.name} cannot be added, multiplied or compared")
    return max(a.kind, b.kind, least, key=lambda kind: kind.rank)


def combined(build: Build, operation: ast.operator, a: Value, b: Value) -> Value:
    """Return a + b, a - b, a * b, a / b, a // b, a % b or a ** b, with the meaning they have in Python."""
    if isinstance(operation, ast.Pow) and max(a.kind.rank, b.kind.rank) <= WHOLE.rank:
        raise TypeError("a power of whole numbers is a number here and may be whole in Python; write x * x or 2.0**n")
    kind = _common(a, b, NUMBER if isinstance(operation, ast.Div | ast.Pow) else WHOLE)
    both = [Value(kind, build.converted(each, kind)) for each in (a, b)]
    first, second = both[0].llvm, both[1].llvm
    if isinstance(operation, ast.Pow):
        return build.call("llvm.pow.f64", *both)
    if kind is not WHOLE and type(operation) in _OF_NUMBERS:
        instruction = getattr(build.builder, _OF_NUMBERS[type(operation)])
        return Value(kind, instruction(first, second, flags=build.flags))
    if kind is WHOLE and type(operation) in _OF_WHOLES:
        return Value(kind, getattr(build.builder, _OF_WHOLES[type(operation)])(first, second, flags=("nsw",)))
    if kind is WHOLE and isinstance(operation, ast.FloorDiv | ast.Mod):
        return Value(kind, _floored(build, operation, first, second))
    raise TypeError(f"{type(operation).__name__} of a {kind.name} is not known to compiled code")


def _floored(build: Build, operation: ast.operator, a: ir.Value, b: ir.Value) -> ir.Value:
    """Return the quotient of integers rounded down, or its remainder; those of LLVM round towards zero."""
    builder = build.builder
    if isinstance(b, ir.Constant):
        if b.constant == 0:
            raise TypeError("division by zero")
    elif CHECKED:
        build.require(builder.icmp_signed("!=", b, WHOLE.llvm(0)), "integer division by zero")
    left, zero = builder.srem(a, b), WHOLE.llvm(0)
    signs_differ = builder.icmp_signed("<", builder.xor(left, b), zero)
    rounded_up = builder.and_(builder.icmp_signed("!=", left, zero), signs_differ)
    if isinstance(operation, ast.Mod):
        return builder.add(left, builder.select(rounded_up, b, zero))
    return builder.sub(builder.sdiv(a, b), builder.zext(rounded_up, WHOLE.llvm))


def compared(build: Build, operation: ast.cmpop, a: Value, b: Value) -> Value:
    """Return whether a < b, and so on; NaN is unequal to every number, and neither smaller nor larger."""
    kind, sign = _common(a, b, WHOLE), _COMPARISONS[type(operation)]
    first, second = build.converted(a, kind), build.converted(b, kind)
    if kind is WHOLE:
        return Value(FLAG, build.builder.icmp_signed(sign, first, second))
    if kind is LANES:
        raise TypeError("lanes are not compared: each may have another answer")
    ask = build.builder.fcmp_unordered if sign == "!=" else build.builder.fcmp_ordered
    return Value(FLAG, ask(sign, first, second, flags=build.flags))


def negative(build: Build, value: Value) -> Value:
    """Return -value."""
    if value.kind is WHOLE:
        return Value(WHOLE, build.builder.sub(WHOLE.llvm(0), value.llvm, flags=("nsw",)))
    if value.kind in (NUMBER, LANES):
        return Value(value.kind, build.builder.fneg(value.llvm))
    raise TypeError(f"a {value.kind.name} has no sign")


def chosen(build: Build, condition: Value, a: Value, b: Value) -> Value:
    """Return a if a condition holds, else b; both are computed in any case."""
    kind = _common(a, b, WHOLE)
    both = [build.converted(each, kind) for each in (a, b)]
    return Value(kind, build.builder.select(condition.llvm, *both))


def _extreme(operation: ast.cmpop) -> Callable[..., Value]:
    def call(build: Build, first: Value, *others: Value) -> Value:
        for other in others:
            first = chosen(build, compared(build, operation, other, first), other, first)
        return first

    return call


_largest = _extreme(ast.Gt())


def _absolute(build: Build, value: Value) -> Value:
    if value.kind is NUMBER:
        return build.call("llvm.fabs.f64", value)
    return _largest(build, value, negative(build, value))


def _whole(build: Build, value: Value) -> Value:
    if value.kind is NUMBER:
        if isinstance(value.llvm, ir.Constant) and not abs(value.llvm.constant) < _BEYOND:
            raise TypeError(f"{value.llvm.constant} is no whole number of 64 bits")
        if CHECKED:
            size = build.builder.call(build.declared("llvm.fabs.f64", _OF_ONE), [value.llvm])
            build.require(
                build.builder.fcmp_ordered("<", size, NUMBER.llvm(_BEYOND)), "int of NaN or a number too large"
            )
        return Value(WHOLE, build.builder.fptosi(value.llvm, WHOLE.llvm))
    return Value(WHOLE, build.converted(value, WHOLE))


def _of_llvm(name: str) -> Callable[..., Value]:
    def call(build: Build, value: Value) -> Value:
        if value.kind is LANES:
            return build.call(f"llvm.{name}.v{WIDTH}f64", value)
        return build.call(f"llvm.{name}.f64", Value(NUMBER, build.converted(value, NUMBER)))

    return call


# by function of Python
FUNCTIONS: dict[Any, Callable[..., Value]] = {
    min: _extreme(ast.Lt()),
    max: _largest,
    abs: _absolute,
    int: _whole,
    math.sqrt: _of_llvm("sqrt"),
    np.floor: _of_llvm("floor"),
    math.atan2: lambda build, y, x: build.call("atan2", *(Value(NUMBER, build.converted(v, NUMBER)) for v in (y, x))),
}
