"""Translation of the subset of Python that kernels are written in to LLVM instructions.

Kernels are functions of integers, floating-point numbers and pointers. A variable has one kind of value, that of its
first assignment; a floating-point variable can be assigned integers, and outside of loops and branches a name can be
assigned a value of another kind. The statements are `for` over `range` with a constant step, `while`, `if`, `break`,
`continue`, `return`, calls, and assignments, also of tuples, to names and entries of pointers. A function that is
called is an `Operation`, an `Inlined` function, one of `arithmetic.FUNCTIONS`, or a field of a record that has its
address. Fields of records (see `records`) have the kinds that they declare. Names from outside the function stand
for numbers, modules or such functions. Anything else raises TypeError with the line.

Integers have 64 bits, and are converted in operations with floating-point numbers. What differs from Python:

- An index counts from the address of its pointer; a negative one means memory before it (`at` may have moved it there).
  A negative constant in brackets is refused. Nothing is checked, except with BEAMFEM_CHECK=1, see `checks`.
- A chained comparison computes all its operands. Those that Python may leave out cannot have calls, entries or
  integer division; use `and`. `min`, `max` and `in` compute all of theirs, in Python as well.
- `2**3` of integers is refused, since the power is a floating-point number here. (-8.0)**0.5 is NaN, 0.0**-1 infinite.
- `int` of NaN, of an infinity or of a number beyond 64 bits has no defined value, nor has an integer that overflows.
- Integer division by zero ends the process, as in C; floating-point division by zero gives an infinity or NaN.

BEAMFEM_CHECK=1 makes errors of the indices, of `int` and of integer division by zero; constants are refused always.
"""

import ast
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from llvmlite import ir

from beamfem.kernels.compiler.arithmetic import combined
from beamfem.kernels.compiler.build import Build
from beamfem.kernels.compiler.callables import Inlined
from beamfem.kernels.compiler.expressions import Scope, index_of, object_of, one_value, truth, values
from beamfem.kernels.compiler.source import definition, outside
from beamfem.kernels.compiler.value_types import WHOLE, Signature, Value


def translate(
    function: Callable[..., Any], signature: Signature, flags: Sequence[str], fixed: Mapping[str, int], name: str
) -> ir.Module:
    """Return a module with one function in C calling convention.

    flags: see `Build`; fixed: integers by name that replace arguments.
    """
    module, (kinds, result) = ir.Module(name), signature
    outer = ir.VoidType() if result is None else result.llvm
    llvm_function = ir.Function(module, ir.FunctionType(outer, [kind.llvm for kind in kinds]), name)
    llvm_function.attributes.add("nounwind")
    builder = ir.IRBuilder(llvm_function.append_basic_block("entry"))
    arguments = [Value(kind, argument) for kind, argument in zip(kinds, llvm_function.args, strict=True)]
    for index, argument in enumerate(definition(function).args.args):
        if argument.arg in fixed:
            arguments[index] = Value(WHOLE, WHOLE.llvm(fixed[argument.arg]))
    results = _Body(Build(builder, tuple(flags)), function, arguments).run()
    if result is None:
        builder.ret_void()
    elif len(results) == 1:
        builder.ret(Build(builder).converted(results[0], result))
    else:
        raise TypeError(f"{function.__qualname__} returns {len(results)} values, not one {result.name}")
    return module


class _Body:
    """The body of a function, whose instructions are written at the position of a builder."""

    def __init__(self, build: Build, function: Callable[..., Any], arguments: Sequence[Value]) -> None:
        self._build, self._builder, self._function = build, build.builder, function
        self._scope = Scope(build, outside(function), self._inline)
        self._end = self._builder.append_basic_block("end")
        self._depth = 0  # number of loops and branches around a statement
        self._loops: list[tuple[ir.Block, ir.Block]] = []  # targets of `continue` and `break`
        self._results: list[Value] | None = None  # variables, from the first return
        self._breaks: list[set[str] | None] = []  # names assigned at every `break` of a loop, None without any
        self._definition = definition(function)
        for argument, value in zip(self._definition.args.args, arguments, strict=True):
            self._assign(ast.Name(argument.arg), value)

    def run(self) -> list[Value]:
        """Write all instructions; return the results of the function."""
        self._suite(self._definition.body)
        if self._results and not self._builder.block.is_terminated:
            raise TypeError(f"{self._function.__qualname__} returns a value, but not where it ends")
        self._branch(self._end)
        self._builder.position_at_end(self._end)
        return [self._build.get(variable) for variable in self._results or ()]

    def _inline(self, inlined: Inlined, arguments: Sequence[Value]) -> list[Value]:
        flags = self._build.flags if inlined.flags is None else inlined.flags
        return _Body(Build(self._builder, flags), inlined.function, arguments).run()

    def _branch(self, block: ir.Block) -> None:
        if not self._builder.block.is_terminated:
            self._builder.branch(block)

    def _suite(self, statements: Sequence[ast.stmt]) -> None:
        for statement in statements:
            if self._builder.block.is_terminated:
                return
            where = f"in compiled code: {self._function.__code__.co_filename}, line {statement.lineno}"
            self._build.where = f"{self._function.__module__}.{self._function.__name__}, line {statement.lineno}"
            try:
                self._statement(statement)
            except TypeError as error:
                if not hasattr(error, "__notes__"):
                    error.add_note(where)
                raise
            except Exception as error:  # an unforeseen statement may fail anywhere
                named = TypeError(f"{ast.unparse(statement).splitlines()[0]}: {error!r}")
                named.add_note(where)
                raise named from error

    def _inner(self, statements: Sequence[ast.stmt]) -> None:
        self._depth += 1
        self._suite(statements)
        self._depth -= 1

    def _statement(self, statement: ast.stmt) -> None:
        scope = self._scope
        match statement:
            case ast.Assign(targets=targets, value=value):
                computed = values(scope, value)
                for target in targets:
                    self._assign(target, computed)
            case ast.AugAssign(target=target, op=operation, value=value):
                self._change(target, operation, value)
            case ast.Expr(value=ast.Constant()) | ast.Pass():
                pass  # a docstring
            case ast.Expr(value=value):
                values(scope, value)
            case ast.If(test=test, body=body, orelse=other):
                self._fork(truth(scope, test), body, other)
            case ast.For(
                target=ast.Name() as target,
                iter=ast.Call(func=ast.Name("range"), args=limits, keywords=[]),
                body=body,
                orelse=[],
            ) if len(limits) in (1, 2, 3):
                self._count(target, limits, body)
            case ast.While(test=test, body=body, orelse=[]):
                endless = isinstance(test, ast.Constant) and test.value is True
                self._loop(lambda: truth(scope, test), body, endless=endless)
            case ast.Break():
                at_breaks = self._breaks[-1]
                self._breaks[-1] = self._scope.assigned & (self._scope.assigned if at_breaks is None else at_breaks)
                self._builder.branch(self._loops[-1][1])
            case ast.Continue():
                self._builder.branch(self._loops[-1][0])
            case ast.Return(value=value):
                computed = [] if value is None else values(scope, value)
                self._return([computed] if isinstance(computed, Value) else computed)
            case _:
                raise TypeError(f"{ast.unparse(statement).splitlines()[0]} is not known to compiled code")

    def _assign(self, target: ast.expr, value: Value | list[Value]) -> None:
        match target, value:
            case ast.Tuple(elts=targets), list():
                if len(targets) != len(value):
                    raise TypeError(f"{len(value)} values for {len(targets)} names")
                for part, item in zip(targets, value, strict=True):
                    self._assign(part, item)
            case ast.Name(id=name), Value():
                self._set(name, value)
            case ast.Subscript(value=pointer, slice=index), Value():
                self._build.write(one_value(self._scope, pointer), index_of(self._scope, index), value)
            case ast.Attribute(value=record, attr=name), Value():
                self._build.set_field(one_value(self._scope, record), name, value)
            case _:
                raise TypeError(f"{ast.unparse(target)} cannot be assigned this in compiled code")

    def _set(self, name: str, value: Value) -> None:
        variables = self._scope.variables
        self._scope.assigned.add(name)
        if name in variables:
            kind = variables[name].kind
            if kind is value.kind or kind.rank > value.kind.rank > 0:
                self._build.set(variables[name], value)
                return
            if self._depth > 0:
                raise TypeError(f"{name} is a {kind.name} and cannot become a {value.kind.name} in a loop or branch")
        variables[name] = self._build.variable(value, name)
        self._build.set(variables[name], value)

    def _change(self, target: ast.expr, operation: ast.operator, by: ast.expr) -> None:
        if isinstance(target, ast.Subscript):
            pointer, index = one_value(self._scope, target.value), index_of(self._scope, target.slice)
            before = self._build.read(pointer, index)
            after = combined(self._build, operation, before, one_value(self._scope, by))
            self._build.write(pointer, index, after)
        else:
            before = one_value(self._scope, target)
            self._assign(target, combined(self._build, operation, before, one_value(self._scope, by)))

    def _return(self, found: list[Value]) -> None:
        if self._results is None:
            self._results = [self._build.variable(each) for each in found]
        if len(self._results) != len(found):
            raise TypeError("a function returns as many values everywhere")
        for variable, value in zip(self._results, found, strict=True):
            self._build.set(variable, value)
        self._builder.branch(self._end)

    def _fork(self, condition: ir.Value, body: Sequence[ast.stmt], other: Sequence[ast.stmt]) -> None:
        then, otherwise, after = (self._builder.append_basic_block(name) for name in ("then", "else", "after"))
        self._builder.cbranch(condition, then, otherwise)
        assigned = self._scope.assigned
        before, ways = set(assigned), []
        for block, statements in ((then, body), (otherwise, other)):
            self._builder.position_at_end(block)
            self._inner(statements)
            if not self._builder.block.is_terminated:
                ways.append(set(assigned))
            self._branch(after)
            assigned.clear()
            assigned |= before
        self._builder.position_at_end(after)
        if ways:
            assigned |= set.intersection(*ways)
        else:
            self._builder.unreachable()

    def _loop(
        self,
        condition: Callable[[], ir.Value],
        body: Sequence[ast.stmt],
        begin: Callable[[], None] = lambda: None,
        advance: Callable[[], None] = lambda: None,
        endless: bool = False,
    ) -> None:
        ask, inside, onwards, after = (
            self._builder.append_basic_block(name) for name in ("ask", "inside", "onwards", "after")
        )
        self._builder.branch(ask)
        self._builder.position_at_end(ask)
        self._builder.cbranch(condition(), inside, after)
        self._builder.position_at_end(inside)
        self._loops.append((onwards, after))
        self._breaks.append(None)
        assigned = self._scope.assigned
        before = set(assigned)
        self._depth += 1
        begin()
        self._inner(body)
        self._depth -= 1
        self._loops.pop()
        left = self._breaks.pop()
        self._branch(onwards)
        self._builder.position_at_end(onwards)
        advance()
        self._builder.branch(ask)
        self._builder.position_at_end(after)
        assigned.clear()
        assigned |= (left or set()) if endless else before
        if endless and left is None:
            self._builder.unreachable()

    def _count(self, target: ast.Name, limits: list[ast.expr], body: Sequence[ast.stmt]) -> None:
        bounds = [one_value(self._scope, each) for each in limits]
        if any(each.kind is not WHOLE for each in bounds):
            raise TypeError("a range counts whole numbers")
        start, stop = bounds[:2] if len(bounds) > 1 else (Value(WHOLE, WHOLE.llvm(0)), bounds[0])
        step = self._step(limits[2]) if len(bounds) > 2 else 1
        counter = self._build.space(WHOLE.llvm)
        self._builder.store(start.llvm, counter)

        def condition() -> ir.Value:
            return self._builder.icmp_signed("<" if step > 0 else ">", self._builder.load(counter), stop.llvm)

        def begin() -> None:
            self._set(target.id, Value(WHOLE, self._builder.load(counter)))

        def advance() -> None:
            current = self._builder.load(counter)
            self._builder.store(self._builder.add(current, WHOLE.llvm(step), flags=("nsw",)), counter)

        self._loop(condition, body, begin, advance)

    def _step(self, node: ast.expr) -> int:
        """Return the step of a range, a compile-time constant."""
        match node:
            case ast.UnaryOp(op=ast.USub(), operand=value):
                return -self._step(value)
            case ast.Name(id=name) if name in self._scope.variables:
                step = None
            case _:
                step = object_of(self._scope, node)
        if type(step) is not int or step == 0:
            raise TypeError("the step of a range is a number that is known when it is compiled")
        return step
