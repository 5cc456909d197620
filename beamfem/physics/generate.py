"""Generate the compiled passes of strain measures and node kinematics from their definitions.

Run as python -m beamfem.physics.generate: sympy derives the expressions, and the modules are written to
`beamfem/kernels/generated`. They are committed, and a test compares them with the definitions.
"""

import subprocess
import sys
from collections.abc import Iterable, Sequence
from itertools import combinations_with_replacement
from pathlib import Path
from typing import Any

import sympy
from sympy.printing.pycode import PythonCodePrinter

from beamfem.kernels import point
from beamfem.kernels.record import ROW
from beamfem.physics.kinematics import KINDS, Kinematics
from beamfem.physics.measures import MEASURES, Measure

FOLDER = Path(__file__).parents[1] / "kernels" / "generated"
_AXIS = ("rx", "ry", "dx", "dy", "ex", "ey")
# blocks rr, rd, re, dd, de, ee of the second derivative by q; of symmetric blocks, only the upper triangle
_ORDER = [(i, j) for a in (0, 2, 4) for b in range(a, 6, 2) for i in (a, a + 1) for j in (b, b + 1) if i <= j or a != b]


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


def measure_source(measure: Measure) -> str:
    """Return the module of a strain measure as source: strains, forces, rates and their changes, second derivatives."""
    q = sympy.symbols(_AXIS, real=True)
    eps = [sympy.sympify(value) for value in measure(*q, sympy.sqrt)]
    count = len(eps)
    s, dq = sympy.symbols(f"s:{count}", real=True), sympy.symbols([f"{name}_" for name in _AXIS], real=True)
    qt, slopes = sympy.symbols([f"{name}t" for name in _AXIS], real=True), sympy.Matrix(eps).jacobian(q)
    rows = _rows(_AXIS, point.AXIS)
    resultants = _rows([str(symbol) for symbol in s], point.RESULTANT)
    functions = [
        _function("strains", "strains", rows, [], eps, point.STRAIN),
        _function(
            "forces",
            "forces on q of stress resultants",
            {**rows, **resultants},
            [],
            slopes.T * sympy.Matrix(s),
            point.FORCE,
        ),
        _function(
            "rates",
            "the change of strains with a change of q, in its place",
            {**rows, **_rows([str(symbol) for symbol in dq], point.RATE)},
            [],
            slopes * sympy.Matrix(dq),
            point.RATE,
        ),
        _function(
            "rate_changes",
            "the change of strain rates with a change of q at constant q'",
            {**rows, **_rows([str(symbol) for symbol in qt], point.VELOCITY)}
            | _rows([str(symbol) for symbol in dq], point.RATE),
            [],
            (slopes * sympy.Matrix(qt)).jacobian(q) * sympy.Matrix(dq),
            point.RATE_CHANGE,
        ),
        _second(q, eps, s, slopes, {**rows, **resultants}),
    ]
    return _module(f"Passes of the strain measure `beamfem.physics.measures.{measure.__name__}`.", functions)


def _second(q: Sequence[Any], eps: Sequence[Any], s: Sequence[Any], slopes: Any, rows: dict[str, int]) -> str:
    """Return the pass for grad^T C grad + sum s d2 eps; with grad and C grad as steps, sparse products stay sparse."""
    count = len(eps)
    pairs = list(combinations_with_replacement(range(count), 2))
    stiffness = {pair: sympy.Symbol(f"c{pair[0]}{pair[1]}") for pair in pairs}
    law = sympy.Matrix(count, count, lambda i, j: stiffness[min(i, j), max(i, j)])
    slope = {(i, k): sympy.Symbol(f"j{i}{k}") for i in range(count) for k in range(6) if slopes[i, k] != 0}
    named = sympy.Matrix(count, 6, lambda i, k: slope.get((i, k), 0))
    stressed = {(i, k): sympy.Symbol(f"u{i}{k}") for i in range(count) for k in range(6)}
    product = named.T * sympy.Matrix(count, 6, lambda i, k: stressed[i, k])
    geometric = sum((s[i] * sympy.hessian(eps[i], q) for i in range(count)), sympy.zeros(6, 6))
    results = [product[i, j] for i, j in _ORDER]
    needed = set().union(*(result.free_symbols for result in results))
    definitions = {symbol: (law * named)[key] for key, symbol in stressed.items() if symbol in needed}
    steps = [(slope[key], slopes[key]) for key in slope]
    common, reduced = sympy.cse(
        [value for _, value in steps] + [geometric[i, j] for i, j in _ORDER], optimizations="basic"
    )
    lines = [(name, value) for name, value in common]
    lines += [(name, value) for (name, _), value in zip(steps, reduced, strict=False)]
    lines += list(definitions.items())
    finals = [result + extra for result, extra in zip(results, reduced[len(steps) :], strict=True)]
    all_rows = {**rows, **{str(symbol): point.STIFFNESS + number for number, symbol in enumerate(stiffness.values())}}
    return _function(
        "hessian", "the second derivative of the energy by q", all_rows, lines, finals, point.HESSIAN, cse=False
    )


def kinematics_source(kind: Kinematics) -> str:
    """Return the source of the module of a kind of node.

    place: w, w'' and B from u, u', u''; convect: ck times the derivative of w'' by u plus cv times that by u'; curve:
    the derivative of B^T f by u.
    """
    size = len(kind.coordinates)
    u, v, a = (sympy.symbols([f"{letter}_{name}" for name in kind.coordinates], real=True) for letter in "uva")
    c, s, length = sympy.symbols("c s length", real=True)
    turned = sympy.Matrix(kind.vectors(tuple(u), sympy.cos(u[-1]), sympy.sin(u[-1]), length))
    speed = turned.jacobian(u)
    second = speed * sympy.Matrix(a) + sum(
        (speed.diff(u[k]) * v[k] * sympy.Matrix(v) for k in range(size)), sympy.zeros(len(turned), 1)
    )
    ck, cv = sympy.symbols("ck cv", real=True)
    extra = ck * second.jacobian(u) + cv * second.jacobian(v)
    f = sympy.symbols(f"f:{len(turned)}", real=True)
    curved = (speed.T * sympy.Matrix(f)).jacobian(u)
    plain = {sympy.cos(u[-1]): c, sympy.sin(u[-1]): s}
    rows = _rows([*map(str, (*u, *v, *a)), "c", "s", "length"], 0)
    first = len(rows)
    functions = [
        _function(
            "place", "w, w'' and B", rows, [], [*turned.subs(plain), *second.subs(plain), *speed.subs(plain)], first
        ),
        _function(
            "convect", "ck dw''/du + cv dw''/du'", rows, [], list(extra.subs(plain)), first, scalars=("ck", "cv")
        ),
        _function(
            "curve",
            "the derivative of B^T f",
            {**rows, **_rows([str(x) for x in f], first)},
            [],
            list(curved.subs(plain)),
            first + len(f),
        ),
    ]
    title = f"Passes of nodes of the kind `beamfem.physics.kinematics.{kind.name.upper()}`."
    title += f"\n\nRows: {', '.join(rows)}; then results."
    return _module(title, functions)


def _rows(names: Iterable[str], first: int) -> dict[str, int]:
    return {name: first + number for number, name in enumerate(names)}


def _function(
    name: str,
    purpose: str,
    rows: dict[str, int],
    lines: list[tuple[Any, Any]],
    results: Iterable[Any],
    to: int,
    scalars: tuple[str, ...] = (),
    cse: bool = True,
) -> str:
    results = [sympy.sympify(result) for result in results]
    if cse:
        common, results = sympy.cse(results, optimizations="basic")
        lines = [*lines, *common]
    printer = Printer({"fully_qualified_modules": True, "strict": False})
    used = set().union(*(value.free_symbols for value in [*results, *(value for _, value in lines)]))
    loads = [(symbol, row) for symbol, row in rows.items() if symbol in {str(each) for each in used}]
    arguments = ", ".join(("count", *scalars, "x"))
    text = [
        f'@routine("i{"d" * len(scalars)}v", fastmath=FAST)',
        f"def {name}({arguments}):",
        f'    """Fill {purpose}."""',
        "    for i in range(0, count, WIDTH):",
    ]
    text += ["        own = at(x, i)"]
    text += [f"        {symbol} = own[{row * ROW}]" for symbol, row in loads]
    text += [f"        {symbol} = {printer.doprint(value)}" for symbol, value in lines]
    text += [f"        own[{(to + number) * ROW}] = {printer.doprint(value)}" for number, value in enumerate(results)]
    return "\n".join(text) + "\n"


def _module(title: str, functions: Sequence[str]) -> str:
    body = "\n\n".join(functions)
    needs = "import math\n\n" if "math." in body else ""
    return (
        f'"""{title}\n\nA row has {ROW} numbers. Written by beamfem.physics.generate: do not edit.\n"""\n\n{needs}'
        "from beamfem.kernels.compiling import routine\nfrom beamfem.kernels.pointers import at\n"
        "from beamfem.kernels.simd import WIDTH\n\n"
        f'FAST = {{"contract", "reassoc", "nsz"}}\n\n\n{body}'
    )


def sources() -> dict[str, str]:
    """Return the formatted source of all generated modules by file name."""
    measures = {f"{measure.__name__}_pass.py": measure_source(measure) for measure in MEASURES}
    modules = measures | {f"{kind.name}_node.py": kinematics_source(kind) for kind in KINDS}
    return {name: _formatted(source) for name, source in modules.items()}


def _formatted(source: str) -> str:
    command = [sys.executable, "-m", "ruff", "format", "--line-length", "120", "-"]
    return subprocess.run(command, input=source, capture_output=True, text=True, check=True).stdout


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, source in sources().items():
        (FOLDER / name).write_text(source)
