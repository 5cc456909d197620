"""Force and tangent of a part at points as source, derived from its energies and conditions."""

import math
from collections.abc import Sequence
from typing import Any

from beamfem.physics.connections import Connection, Functions
from beamfem.physics.terms import Graph, Number, Term, changes, source, sqrt, symbols, where_positive


def connection_source(connection: Connection, what: str) -> str:
    """Return the source of the force of a part at points, of its tangent ck df/dq + cv df/dv + ca df/da by rows, or of
    what it remembers: of `what`.

    They have no fast-math, so that the force gives the same digits in Python.
    """
    size, points, k = connection.coordinates, connection.points, connection.multipliers
    graph: Graph = {}

    def entries(array: str, number: int) -> list[Any]:
        return symbols(graph, *(f"{array}[{i}]" for i in range(number)))

    q, v, a = (entries(array, connection.size) for array in "qva")
    own, turned = entries("own", k + connection.prescribed), entries("turned", 2 * points)
    data, gravity = entries("data", len(connection.data) + len(connection.memory)), entries("gravity", 2)
    angles = q[2 : points * size : 3] if size == 3 else []
    rotations = dict(zip(angles, zip(turned[::2], turned[1::2], strict=True), strict=False))

    def changed(terms: Sequence[Number], of_symbols: dict[Any, Number]) -> list[Any]:
        for angle, (c, s) in rotations.items():
            if rate := of_symbols.get(angle, 0.0):
                of_symbols |= {c: -s * rate, s: c * rate}
        return changes(terms, of_symbols)

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

    def rate(of: Number) -> Number:
        return changed([of], dict(zip(q, v, strict=True)))[0]

    f = Functions(sqrt, lambda x: cosine_sine(x)[0], lambda x: cosine_sine(x)[1], lambda x: where_positive(x, x), rate)
    at, rates = connection.split(q), connection.split(v)
    if what == "remember":
        assert connection.remember is not None
        known = connection.remember(at, rates, (*data, *own[:k]), f)
        if len(known) != len(connection.memory):
            raise ValueError(f"remember must return {len(connection.memory)} numbers")
        to = {f"out[{number}]": result for number, result in enumerate(known)}
        return source(what, "q, v, a, own, turned, data, gravity, out", "the history variables", [], to)
    kinetic = connection.kinetic(at, rates, data, f) if connection.kinetic else 0.0
    potential = connection.potential(at, data, gravity, f) if connection.potential else 0.0
    lost = connection.dissipation(at, rates, data, f) if connection.dissipation else 0.0
    given = connection.force(at, rates, (*data, *own[:k]), f) if connection.force else [0.0] * len(q)
    if connection.along is not None and connection.force is not None:
        measure = connection.along(at, data, f)
        given = [given * changed([measure], {x: 1.0})[0] for x in q]
    conditions = list[Any](connection.conditions(at, data, f) if connection.conditions else ())
    momentum = [changed([kinetic], {rate: 1.0})[0] for rate in v]
    force = changed(momentum, dict(zip([*q, *v], [*v, *a], strict=True)))
    for i, (x, rate, direct) in enumerate(zip(q, v, given, strict=True)):
        by_x, *slopes = changed([potential - kinetic, *conditions], {x: 1.0})
        held = sum(multiplier * slope for multiplier, slope in zip(own[:k], slopes, strict=True))
        force[i] += by_x + changed([lost], {rate: 1.0})[0] + direct + held
    for i, value in enumerate(own[k:]):
        conditions[i] -= value
    whole = [*force, *conditions, *(-x for x in own[: connection.prescribed])]
    listed, results = "q, v, a, own, turned, data, gravity", whole
    if what == "tangent":
        listed, results = f"{listed}, ck, cv, ca", [0.0] * len(whole) ** 2
        for weight, variables in zip(symbols(graph, "ck", "cv", "ca"), ([*q, *own], v, a), strict=True):
            for column, x in enumerate(variables):
                for row, change in enumerate(changed(whole, {x: 1.0})):
                    results[row * len(whole) + column] += weight * change
    to = {f"out[{number}]": result for number, result in enumerate(results)}
    return source(what, f"{listed}, out", f"the {what}", [], to)
