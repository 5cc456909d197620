"""Translation of expressions into LLVM values."""

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from llvmlite import ir

from beamfem.kernels.compiler.arithmetic import FUNCTIONS, combined, compared, negative
from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import Inlined, Operation
from beamfem.kernels.compiler.value_types import FLAG, NOTHING, NUMBER, WHOLE, Value

# what an operand of a comparison must not contain where Python might not evaluate it
_MAY_FAIL = (ast.Call, ast.Subscript, ast.FloorDiv, ast.Mod)


@dataclass(frozen=True)
class Scope:
    """The meaning of names in a function.

    outside: objects by name that are not variables, see `source.outside`; inline(function, values): writes the
    instructions of another function here and returns its results; variables: see `Build.variable`; assigned: names of
    the variables that have a value here on every path through the function.
    """

    build: Build
    outside: dict[str, Any]
    inline: Callable[[Inlined, Sequence[Value]], list[Value]]
    variables: dict[str, Value] = field(default_factory=dict)
    assigned: set[str] = field(default_factory=set)


def object_of(scope: Scope, node: ast.expr) -> Any:
    """Return the Python object that a constant, or a name from outside the function, stands for."""
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name) if name in scope.outside:
            return scope.outside[name]
        case ast.Attribute(value=value, attr=name):
            return getattr(object_of(scope, value), name)
    raise TypeError(f"{ast.unparse(node)} is not known to compiled code")


def one_value(scope: Scope, node: ast.expr) -> Value:
    """Return the value of an expression that has exactly one. Raises TypeError otherwise."""
    value = values(scope, node)
    if isinstance(value, Value):
        return value
    raise TypeError(f"{ast.unparse(node)} is not one value")


def index_of(scope: Scope, node: ast.expr) -> Value:
    """Return the index in brackets. Raises TypeError if it would count from the end in Python."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and isinstance(node.operand, ast.Constant):
        raise TypeError(f"[{ast.unparse(node)}]: compiled code does not count from the end of an array")
    return one_value(scope, node)


def truth(scope: Scope, node: ast.expr) -> ir.Value:
    """Return a condition as an LLVM Boolean."""
    return scope.build.truth(one_value(scope, node))


def values(scope: Scope, node: ast.expr) -> Value | list[Value]:
    """Return the value of an expression, or the list of values of a tuple or a call."""
    build = scope.build
    match node:
        case ast.Tuple(elts=parts):
            return [one_value(scope, each) for each in parts]
        case ast.Name(id=name) if name in scope.variables:
            if name not in scope.assigned:
                raise TypeError(f"{name} may have no value here")
            return build.get(scope.variables[name])
        case ast.Attribute(value=record, attr=name) if _is_field(scope, node):
            return build.get_field(one_value(scope, record), name)
        case ast.Constant() | ast.Name() | ast.Attribute():
            return _constant(object_of(scope, node))
        case ast.Subscript(value=pointer, slice=index):
            return build.read(one_value(scope, pointer), index_of(scope, index))
        case ast.BinOp(left=a, op=operation, right=b):
            return combined(build, operation, one_value(scope, a), one_value(scope, b))
        case ast.UnaryOp(op=ast.USub(), operand=value):
            return negative(build, one_value(scope, value))
        case ast.UnaryOp(op=ast.Not(), operand=value):
            return Value(FLAG, build.builder.not_(truth(scope, value)))
        case ast.BoolOp(op=operation, values=[first, *others]):
            return _joined(scope, isinstance(operation, ast.And), first, others)
        case ast.Compare(left=a, ops=operations, comparators=others):
            return _compared(scope, a, operations, others)
        case ast.IfExp(test=test, body=body, orelse=other):
            return _either(build, truth(scope, test), lambda: one_value(scope, body), lambda: one_value(scope, other))
        case ast.Call(func=function, args=arguments, keywords=[]):
            called = one_value(scope, function) if _is_field(scope, function) else object_of(scope, function)
            return _called(scope, called, [one_value(scope, each) for each in arguments])
    raise TypeError(f"{ast.unparse(node)} is not known to compiled code")


def _is_field(scope: Scope, node: ast.expr) -> bool:
    """Return whether an expression is an attribute, but not one of a name from outside the function."""
    owner = node
    while isinstance(owner, ast.Attribute):
        owner = owner.value
    return owner is not node and not (isinstance(owner, ast.Name) and owner.id in scope.outside)


def _constant(found: Any) -> Value:
    if found is None:
        return Value(NOTHING, ir.Constant(NOTHING.llvm, None))
    for kind, python_type in ((FLAG, bool), (WHOLE, int), (NUMBER, float)):
        if isinstance(found, python_type):
            return Value(kind, ir.Constant(kind.llvm, found))
    raise TypeError(f"{found!r} is no number")


def _called(scope: Scope, function: Any, arguments: list[Value]) -> Value | list[Value]:
    if isinstance(function, Value):
        if function.kind.signature is None:
            raise TypeError(f"a {function.kind.name} cannot be called")
        return scope.build.call_at(function.llvm, function.kind.signature(), arguments) or []
    if isinstance(function, Operation):
        return function.emit(scope.build, *arguments) or []
    if isinstance(function, Inlined):
        results = scope.inline(function, arguments)
        return results[0] if len(results) == 1 else results
    if function in FUNCTIONS:
        return FUNCTIONS[function](scope.build, *arguments)
    raise TypeError(f"{function!r} cannot be called in compiled code")


def _either(build: Build, condition: ir.Value, first: Callable[[], Value], second: Callable[[], Value]) -> Value:
    """Return one of two values by a branch, so that only this one is computed."""
    builder, branches = build.builder, list[tuple[Value, ir.Block]]()
    then, otherwise, after = (builder.append_basic_block(name) for name in ("then", "else", "after"))
    builder.cbranch(condition, then, otherwise)
    for block, computed in ((then, first), (otherwise, second)):
        builder.position_at_end(block)
        branches.append((computed(), builder.block))
    kind = max((value.kind for value, _ in branches), key=lambda kind: kind.rank)
    builder.position_at_end(after)
    phi = builder.phi(kind.llvm)
    for value, block in branches:
        builder.position_at_end(block)
        phi.add_incoming(build.converted(value, kind), block)
        builder.branch(after)
    builder.position_at_end(after)
    return Value(kind, phi)


def _joined(scope: Scope, all_hold: bool, first: ast.expr, others: list[ast.expr]) -> Value:
    """Return the conjunction or disjunction of conditions, evaluated only as far as needed."""
    condition = one_value(scope, first)
    if condition.kind is not FLAG:
        raise TypeError(f"and, or join conditions, and {ast.unparse(first)} is a {condition.kind.name}")
    if not others:
        return condition

    def rest() -> Value:
        return _joined(scope, all_hold, others[0], others[1:])

    both = (rest, lambda: condition) if all_hold else (lambda: condition, rest)
    return _either(scope.build, condition.llvm, *both)


def _compared(scope: Scope, a: ast.expr, operations: list[ast.cmpop], others: list[ast.expr]) -> Value:
    build, first, result = scope.build, one_value(scope, a), None
    for other in others[1:]:
        if any(isinstance(each, _MAY_FAIL) for each in ast.walk(other)):
            raise TypeError(f"{ast.unparse(other)} is computed in any case here, and not always in Python; write `and`")
    for operation, other in zip(operations, others, strict=True):
        if isinstance(operation, ast.In) and isinstance(other, ast.Tuple) and len(operations) == 1:
            equal = [compared(build, ast.Eq(), first, one_value(scope, each)).llvm for each in other.elts]
            holds = equal[0]
            for each in equal[1:]:
                holds = build.builder.or_(holds, each)
            return Value(FLAG, holds)
        second = one_value(scope, other)
        holds = compared(build, operation, first, second).llvm
        result, first = holds if result is None else build.builder.and_(result, holds), second
    return Value(FLAG, result)
