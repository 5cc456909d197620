"""Differentiation of functions that are given as code: what they do with terms in place of numbers is a graph.

It consists of sums, products, reciprocals and square roots. Equal terms are one object, and derivatives are further
terms (forward differentiation).
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

Number = Union["Term", float]
Graph = dict[tuple[Any, ...], "Term"]
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

    def __init__(self, graph: Graph, operation: str, parts: tuple[Any, ...]) -> None:
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
        root = x.parts[0] if x.operation == "1/" else x
        if x is y and root.operation == "sqrt":
            return a * b * (root.parts[0] if x is root else 1.0 / root.parts[0])
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
        result: Number = 1.0 if halves % 2 == 0 else sqrt(self)
        for _ in range(abs(int(halves)) // 2):
            result = self * result
        return result if exponent > 0 else 1.0 / result

    __radd__, __rmul__ = __add__, __mul__


def symbols(graph: Graph, *places: str) -> list[Any]:
    """Return terms for the numbers at some places, which are expressions of Python."""
    return [graph.setdefault((place,), Term(graph, "symbol", (place,))) for place in places]


def sqrt(x: Number) -> Number:
    """Return the square root."""
    return x.made("sqrt", x) if isinstance(x, Term) else math.sqrt(x)


def where_positive(x: Number, value: Number) -> Number:
    """Return a value where x > 0, and zero elsewhere, even if the value is not finite there."""
    if isinstance(x, Term):
        return 0.0 if value == 0 else x.made("if", x, value)
    return value if x > 0.0 else 0.0


def _through(terms: Iterable[Number]) -> list[Term]:
    """Return some terms and all those that they contain, each after its parts and near its first use."""
    found, waiting = dict[Term, None](), [term for term in terms if isinstance(term, Term)][::-1]
    while waiting:
        term = waiting[-1]
        parts = [part for part in term.parts if isinstance(part, Term) and part not in found]
        if parts and term not in found:
            waiting += parts[::-1]
        else:
            found[waiting.pop()] = None
    return list(found)


def _slopes(term: Term) -> list[tuple[Any, Number]]:
    """Return the parts of a term, other than a choice by a sign, with the derivatives by them."""
    a, *others = term.parts
    match term.operation:
        case "+":
            return [(a, 1.0), (others[0], 1.0)]
        case "*":
            return [(a, others[0]), (others[0], a)]
        case "1/":
            return [(a, -(term * term))]
        case "sqrt":
            return [(a, 0.5 / term)]
    return []


def changes(terms: Sequence[Number], of_symbols: Mapping[Any, Number]) -> list[Number]:
    """Return the derivatives of terms in the direction in which symbols change."""
    change: dict[Any, Number] = dict(of_symbols)
    for term in _through(terms):
        if term.operation == "if":
            change[term] = where_positive(term.parts[0], change.get(term.parts[1], 0.0))
        elif term.operation != "symbol":
            change[term] = sum((slope * change[part] for part, slope in _slopes(term) if part in change), 0.0)
    return [change.get(term, 0.0) for term in terms]


def gradient(term: Term, of: Sequence[Any]) -> list[Any]:
    """Return the derivatives of a term by symbols, in one pass backwards; it must not depend on signs."""
    by: dict[Any, Number] = {term: 1.0}
    for each in reversed(_through([term])):
        for part, slope in _slopes(each):
            by[part] = by.get(part, 0.0) + by[each] * slope
    return [by.get(symbol, 0.0) for symbol in of]


def source(name: str, arguments: str, purpose: str, opening: Sequence[str], results: Mapping[str, Number]) -> str:
    """Return a function that sets places to results, in statements indented as the last line of its `opening` is."""
    lines, indent = [f"def {name}({arguments}):", f'    """Fill {purpose}."""', *opening], "    "
    if opening:
        indent = " " * (len(opening[-1]) - len(opening[-1].lstrip()))

    def named(part: Any) -> str:
        if isinstance(part, Term | str):
            return part if isinstance(part, str) else f"x{part.number}"
        if not math.isfinite(part):
            raise ValueError(f"the constant {part} is not finite")
        return repr(float(part))

    for term in _through(results.values()):
        lines.append(f"{indent}{named(term)} = {_PRINTED[term.operation].format(*map(named, term.parts))}")
    return "\n".join([*lines, *(f"{indent}{place} = {named(value)}" for place, value in results.items())]) + "\n"
