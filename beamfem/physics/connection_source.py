"""Force and tangent of a part at points as source, derived from its energies and conditions.

A definition is evaluated with terms in place of numbers, which leaves a graph of sums, products, reciprocals and square
roots. Equal terms are one object, and derivatives are further terms of the graph (forward differentiation).
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

from beamfem.physics.connections import Connection, Functions

Number = Union["Term", float]
_Graph = dict[tuple[Any, ...], "Term"]
_PRINTED = {
    "symbol": "{}",
    "+": "{} + {}",
    "*": "{} * {}",
    "1/": "1.0 / {}",
    "sqrt": "math.sqrt({})",
    "if": "({1} if {0} > 0.0 else 0.0)",
}


class Term:
    """A symbol, whose only part is its place, or an operation of the graph on its parts, which are terms or numbers."""

    __array_ufunc__ = None  # numbers of numpy leave operations to this class

    def __init__(self, graph: _Graph, operation: str, parts: tuple[Any, ...]) -> None:
        self.graph, self.number, self.operation, self.parts = graph, len(graph), operation, parts

    def made(self, operation: str, *parts: Any) -> "Term":
        """Return the term of an operation in the graph of this one."""
        return self.graph.setdefault((operation, *parts), Term(self.graph, operation, parts))

    @property
    def scaled(self) -> tuple[float, "Term"]:
        """The term as a factor and a term."""
        return self.parts if self.operation == "*" and isinstance(self.parts[0], float) else (1.0, self)

    def __add__(self, other: Any) -> Number:
        if not isinstance(other, Term):
            return self if other == 0 else self.made("+", self, float(other))
        (a, x), (b, y) = self.scaled, other.scaled
        if x is y:
            return (a + b) * x
        if a == b == -1.0:
            return -(x + y)
        return self.made("+", *sorted((self, other), key=lambda term: term.number))

    def __mul__(self, other: Any) -> Number:
        a, x = self.scaled
        if not isinstance(other, Term):
            factor = a * float(other)
            return 0.0 if factor == 0.0 else x if factor == 1.0 else self.made("*", factor, x)
        b, y = other.scaled
        return a * b * self.made("*", *sorted((x, y), key=lambda term: term.number))

    def __neg__(self) -> Number:
        return self * -1.0

    def __sub__(self, other: Any) -> Number:
        return self + -other

    def __rsub__(self, other: Any) -> Number:
        return -self + other

    def __truediv__(self, other: Any) -> Number:
        return self * (1.0 / other)

    def __rtruediv__(self, other: Any) -> Number:
        a, x = self.scaled
        return self.made("1/", x) * (other / a)

    def __pow__(self, exponent: Any) -> Number:
        halves = 2 * exponent
        if halves != int(halves):
            raise ValueError(f"no rule for the exponent {exponent}")
        result: Number = 1.0 if halves % 2 == 0 else _sqrt(self)
        for _ in range(abs(int(halves)) // 2):
            result = self * result
        return result if exponent > 0 else 1.0 / result

    __radd__, __rmul__ = __add__, __mul__


def _sqrt(x: Number) -> Number:
    return x.made("sqrt", x) if isinstance(x, Term) else math.sqrt(x)


def _where_positive(x: Number, value: Number) -> Number:
    """Return a value where x > 0, and zero elsewhere, even if the value is not finite there."""
    if isinstance(x, Term):
        return 0.0 if value == 0 else x.made("if", x, value)
    return value if x > 0.0 else 0.0


def _through(terms: Iterable[Number]) -> list[Term]:
    """Return some terms and all those that they contain, in the order in which they were made."""
    found, waiting = dict[int, Term](), [term for term in terms if isinstance(term, Term)]
    while waiting:
        if (term := waiting.pop()).number not in found:
            found[term.number] = term
            waiting += [part for part in term.parts if isinstance(part, Term)]
    return [found[number] for number in sorted(found)]


def _changes(terms: Sequence[Number], of_symbols: Mapping[Any, Number]) -> list[Number]:
    """Return the derivatives of terms in the direction in which symbols change."""
    change: dict[Any, Number] = {}
    for term in _through(terms):
        parts = term.parts
        a, b = ([change.get(part, 0.0) for part in parts] + [0.0])[:2]
        match term.operation:
            case "symbol":
                change[term] = of_symbols.get(term, 0.0)
            case "+":
                change[term] = a + b
            case "*":
                change[term] = parts[0] * b + parts[1] * a
            case "1/":
                change[term] = -(term * term * a)
            case "sqrt":
                change[term] = a * (0.5 / term)
            case "if":
                change[term] = _where_positive(parts[0], b)
    return [change.get(term, 0.0) for term in terms]


def connection_source(connection: Connection) -> str:
    """Return the source of two functions of a part at points: its force, and ck df/dq + cv df/dv + ca df/da."""
    size, points, k = connection.coordinates, connection.points, connection.multipliers
    graph: _Graph = {}

    def symbols(*places: str) -> list[Any]:
        return [graph.setdefault((place,), Term(graph, "symbol", (place,))) for place in places]

    def entries(array: str, number: int) -> list[Any]:
        return symbols(*(f"{array}[{i}]" for i in range(number)))

    q, v, a = (entries(array, points * size) for array in "qva")
    own, turned = entries("own", k + connection.prescribed), entries("turned", 2 * points)
    data, gravity = entries("data", len(connection.data) + len(connection.memory)), entries("gravity", 2)
    rotations = dict(zip(q[2::3], zip(turned[::2], turned[1::2], strict=True), strict=True)) if size == 3 else {}

    def changes(terms: Sequence[Number], of_symbols: dict[Any, Number]) -> list[Any]:
        for angle, (c, s) in rotations.items():
            if rate := of_symbols.get(angle, 0.0):
                of_symbols |= {c: -s * rate, s: c * rate}
        return _changes(terms, of_symbols)

    def cosine_sine(angle: Number) -> tuple[Number, Number]:
        if not isinstance(angle, Term):
            return math.cos(angle), math.sin(angle)
        if angle in rotations:
            return rotations[angle]
        factor, term = angle.scaled
        if angle.operation == "+":
            parts = [cosine_sine(part) for part in angle.parts]
        elif factor == int(factor) and term is not angle:
            once = cosine_sine(term)
            parts = [once if factor > 0.0 else (once[0], -once[1])] * abs(int(factor))
        else:
            raise ValueError("cosine and sine are known of sums of rotations only")
        (c, s), *others = parts
        for other_c, other_s in others:
            c, s = c * other_c - s * other_s, s * other_c + c * other_s
        return c, s

    f = Functions(_sqrt, lambda x: cosine_sine(x)[0], lambda x: cosine_sine(x)[1], lambda x: _where_positive(x, x))
    at, rates = ([tuple(x[size * i : size * (i + 1)]) for i in range(points)] for x in (q, v))
    kinetic = connection.kinetic(at, rates, data, f) if connection.kinetic else 0.0
    potential = connection.potential(at, data, gravity, f) if connection.potential else 0.0
    lost = connection.dissipation(at, rates, data, f) if connection.dissipation else 0.0
    given = connection.force(at, rates, (*data, *own[:k]), f) if connection.force else [0.0] * len(q)
    conditions = list[Any](connection.conditions(at, data, f) if connection.conditions else ())
    momentum = [changes([kinetic], {rate: 1.0})[0] for rate in v]
    force = changes(momentum, dict(zip([*q, *v], [*v, *a], strict=True)))
    for i, (x, rate, direct) in enumerate(zip(q, v, given, strict=True)):
        by_x, *slopes = changes([potential - kinetic, *conditions], {x: 1.0})
        held = sum(multiplier * slope for multiplier, slope in zip(own[:k], slopes, strict=True))
        force[i] += by_x + changes([lost], {rate: 1.0})[0] + direct + held
    for i, value in enumerate(own[k:]):
        conditions[i] -= value
    whole = [*force, *conditions, *(-x for x in own[: connection.prescribed])]
    tangent: list[Number] = [0.0] * len(whole) ** 2
    for weight, variables in zip(symbols("ck", "cv", "ca"), ([*q, *own], v, a), strict=True):
        for column, x in enumerate(variables):
            for row, change in enumerate(changes(whole, {x: 1.0})):
                tangent[row * len(whole) + column] += weight * change
    name, listed = connection.name, "q, v, a, own, turned, data, gravity"
    purpose = "ck df/dq + cv df/dv + ca df/da, row by row"
    force_source = _pointwise(f"{name}_force", "rrrrrrrr", f"{listed}, out", "the force", whole)
    return force_source + _pointwise(f"{name}_tangent", "rrrrrrrdddr", f"{listed}, ck, cv, ca, out", purpose, tangent)


HEADER = "import math\n\nfrom beamfem.kernels.compiling import routine\n"


def _pointwise(name: str, kinds: str, arguments: str, purpose: str, results: Sequence[Number]) -> str:
    """Return a function of the numbers of one part; without fast-math, so that it gives the same digits in Python."""
    text = ["", f'@routine("{kinds}")', f"def {name}({arguments}):", f'    """Fill {purpose}."""']

    def named(part: Any) -> str:
        return f"x{part.number}" if isinstance(part, Term) else part if isinstance(part, str) else repr(float(part))

    for term in _through(results):
        text.append(f"    {named(term)} = {_PRINTED[term.operation].format(*map(named, term.parts))}")
    text += [f"    out[{number}] = {named(value)}" for number, value in enumerate(results)]
    return "\n".join(text) + "\n"
