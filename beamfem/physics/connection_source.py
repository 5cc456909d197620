"""Force and tangent of a part at points as source, derived from its energies and conditions by sympy."""

from typing import Any

import sympy
from sympy.printing.pycode import PythonCodePrinter

from beamfem.physics.connections import Connection, Functions


class Printer(PythonCodePrinter):
    """Print powers as products and square roots, which the compiler can vectorise."""

    def _print_Pow(self, power: Any, **unused: Any) -> str:
        base, exponent = power.as_base_exp()
        halves = 2 * exponent
        if not halves.is_Integer or abs(halves) > 8:
            raise ValueError(f"no rule for {power}")
        whole, factor = abs(int(halves)) // 2, self.parenthesize(base, 60)
        factors = [factor] * whole + ([f"math.sqrt({self._print(base)})"] if halves % 2 else [])
        product = " * ".join(factors)
        if exponent < 0:
            return f"(1.0 / ({product}))" if len(factors) > 1 else f"(1.0 / {product})"
        return f"({product})" if len(factors) > 1 else product

    def _print_Rational(self, number: Any) -> str:
        return repr(float(number))

    def _print_Integer(self, number: Any) -> str:
        return f"{int(number)}.0"

    _print_Half = _print_Rational

    def _print_Function(self, function: Any) -> str:
        if not function.is_number:
            raise ValueError(f"no rule for {function}")
        return repr(float(function))

    _print_cos = _print_sin = _print_exp = _print_Function


def _positive(x: Any) -> Any:
    return sympy.Piecewise((x, x > 0), (0, True))


def connection_source(connection: Connection) -> str:
    """Return the source of two functions of a part at points: its force, and ck df/dq + cv df/dv + ca df/da."""
    size, count, k = connection.coordinates, connection.points * connection.coordinates, connection.multipliers
    moved = connection.prescribed
    q, v, a = (sympy.symbols([f"{letter}{i}" for i in range(count)], real=True) for letter in "qva")
    own, values = (sympy.symbols(f"{name}:{number}", real=True) for name, number in (("own", k), ("value", moved)))
    data = sympy.symbols([*connection.data, *connection.memory], real=True)
    gravity, zero = sympy.symbols("gx gy", real=True), sympy.Integer(0)
    functions = Functions(sympy.sqrt, sympy.cos, sympy.sin, _positive)
    at, rates = ([tuple(x[size * i : size * (i + 1)]) for i in range(connection.points)] for x in (q, v))
    kinetic = connection.kinetic(at, rates, data, functions) if connection.kinetic else zero
    potential = connection.potential(at, data, gravity, functions) if connection.potential else zero
    lost = connection.dissipation(at, rates, data, functions) if connection.dissipation else zero
    given = connection.force(at, rates, (*data, *own), functions) if connection.force else [zero] * count
    conditions = list(connection.conditions(at, data, functions)) if connection.conditions else []
    momentum = sympy.Matrix([kinetic.diff(x) for x in v])
    force = momentum.jacobian(v) * sympy.Matrix(a) + momentum.jacobian(q) * sympy.Matrix(v)
    for i, (x, rate, direct) in enumerate(zip(q, v, given, strict=True)):
        force[i] += (potential - kinetic).diff(x) + lost.diff(rate) + direct
        force[i] += sum((symbol * g.diff(x) for symbol, g in zip(own, conditions, strict=True)), zero)
    for i, value in enumerate(values):
        conditions[i] -= value
    whole = sympy.Matrix([sympy.expand_trig(value) for value in [*force, *conditions, *(-x for x in own[:moved])]])
    weights = sympy.symbols("ck cv ca", real=True)
    tangent = sympy.zeros(len(whole), len(whole))
    for weight, variables in zip(weights, ([*q, *own, *values], v, a), strict=True):
        tangent[:, : len(variables)] += weight * whole.jacobian(variables)
    turned = {f(x): sympy.Symbol(f"{n}{i}") for i, x in enumerate(q) for f, n in ((sympy.cos, "c"), (sympy.sin, "s"))}
    arrays = {"q": q, "v": v, "a": a, "own": [*own, *values], "data": data, "gravity": gravity}
    places = {symbol: f"{name}[{i}]" for name, symbols in arrays.items() for i, symbol in enumerate(symbols)}
    for number in range(connection.points):
        places |= {sympy.Symbol(f"{n}{size * number + 2}"): f"turned[{2 * number + i}]" for i, n in enumerate("cs")}
    name, what = connection.name, f"of `{connection.name.upper()}`"
    force, weighed = list(whole.subs(turned)), list(tangent.subs(turned))
    listed, purpose = "q, v, a, own, turned, data, gravity", f"ck df/dq + cv df/dv + ca df/da {what}, row by row"
    functions_of = (
        _pointwise(f"{name}_force", "rrrrrrrr", f"{listed}, out", f"the force {what}", places, force),
        _pointwise(f"{name}_tangent", "rrrrrrrdddr", f"{listed}, ck, cv, ca, out", purpose, places, weighed),
    )
    return "\n\n".join(functions_of)


HEADER = "import math\n\nfrom beamfem.kernels.compiling import routine\n\n\n"


def _pointwise(name: str, kinds: str, arguments: str, purpose: str, places: dict[Any, str], results: list[Any]) -> str:
    """Return a function of the numbers of one part; without fast-math, so that it gives the same digits in Python."""
    names = (symbol for symbol in sympy.numbered_symbols("x") if symbol not in places)
    common, results = sympy.cse(results, names, optimizations="basic")
    printer = Printer({"fully_qualified_modules": True, "strict": False})
    used = set().union(*(value.free_symbols for value in [*results, *(value for _, value in common)]))
    text = [f'@routine("{kinds}")', f"def {name}({arguments}):", f'    """Fill {purpose}."""']
    text += [f"    {symbol} = {place}" for symbol, place in places.items() if symbol in used]
    text += [f"    {symbol} = {printer.doprint(value)}" for symbol, value in common]
    text += [f"    out[{number}] = {printer.doprint(value)}" for number, value in enumerate(results)]
    return "\n".join(text) + "\n"
