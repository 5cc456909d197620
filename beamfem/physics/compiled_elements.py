"""Compiled passes of strain measures and of nodes with an angle, derived from their definitions.

Each takes rows of numbers, one number for each point or node, several at a time: the first rows contain arguments.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import combinations_with_replacement
from typing import Any

from beamfem.kernels import point
from beamfem.kernels.compiling import Derived
from beamfem.kernels.model_record import CONVECT_PASS, ROW, ROWS_PASS
from beamfem.physics.kinematics import KINDS, MEASURES, Kinematics, Measure
from beamfem.physics.terms import Graph, Number, changes, gradient, source, sqrt, symbols

_FAST = {"contract", "reassoc", "nsz"}
_OPENING = "    for i in range(0, count, WIDTH):", "        own = at(x, i)"
# blocks rr, rd, re, dd, de, ee of the second derivative by q; of symmetric blocks, only the upper triangle
_ORDER = [(i, j) for a in (0, 2, 4) for b in range(a, 6, 2) for i in (a, a + 1) for j in (b, b + 1) if i <= j or a != b]


def _rows(graph: Graph, first: int, number: int) -> list[Any]:
    return symbols(graph, *(f"own[{row * ROW}]" for row in range(first, first + number)))


def _source(name: str, arguments: str, first: int, results: Iterable[Number]) -> str:
    to = {f"own[{row * ROW}]": result for row, result in enumerate(results, first)}
    return source(name, arguments, "results", _OPENING, to)


def _measure_source(measure: Measure, name: str) -> str:
    """Return the source of a pass of a strain measure.

    strains; forces: on q of stress resultants; rates: change of strains with a change of q, in its place; rate_changes:
    of strain rates with a change of q at constant q'; hessian: the second derivative of the energy by q.
    """
    graph: Graph = {}
    q, change, velocity = (_rows(graph, first, 6) for first in (point.AXIS, point.RATE, point.VELOCITY))
    strains = measure(*q, sqrt)
    count = range(len(strains))
    columns = [changes(strains, {x: 1.0}) for x in q]
    s = _rows(graph, point.RESULTANT, len(count))
    forces = gradient(sum(s[i] * strains[i] for i in count), q)
    along = dict(zip(q, change, strict=True))
    if name == "hessian":
        pairs = list(combinations_with_replacement(count, 2))
        law = dict(zip(pairs, _rows(graph, point.STIFFNESS, len(pairs)), strict=True))
        stressed = [[sum(law[min(i, j), max(i, j)] * column[j] for j in count) for i in count] for column in columns]
        geometric = [changes(forces, {x: 1.0}) for x in q]
        hessian = (sum((columns[k][i] * stressed[m][i] for i in count), geometric[m][k]) for k, m in _ORDER)
        return _source(name, "count, x", point.HESSIAN, hessian)
    first, results = {
        "strains": (point.STRAIN, strains),
        "forces": (point.FORCE, forces),
        "rates": (point.RATE, changes(strains, along)),
        "rate_changes": (point.RATE_CHANGE, changes(changes(strains, dict(zip(q, velocity, strict=True))), along)),
    }[name]
    return _source(name, "count, x", first, results)


def _node_source(kind: Kinematics, name: str) -> str:
    """Return the source of a pass of a kind of node; rows: u, u', u'', cosine and sine of the angle, |r_x|, f, results.

    place: w, w'' and B; convect: ck times the derivative of w'' by u plus cv times that by u'; curve: the derivative of
    B^T f by u, whose rows f the others do not have.
    """
    graph: Graph = {}
    size = len(kind.coordinates)
    u, v, a, (c, s, length) = (
        _rows(graph, first, 3 if first == 3 * size else size) for first in range(0, 4 * size, size)
    )
    first = 3 * size + 3

    def changed(terms: Sequence[Number], of_symbols: Mapping[Any, Number]) -> list[Any]:
        turning = of_symbols.get(u[-1], 0.0)
        return changes(terms, {**of_symbols, c: -s * turning, s: c * turning})

    vectors = kind.vectors(tuple(u), c, s, length)
    columns = [changed(vectors, {x: 1.0}) for x in u]
    second = changed(changed(vectors, dict(zip(u, v, strict=True))), dict(zip([*u, *v], [*v, *a], strict=True)))
    if name == "place":
        return _source(
            name, "count, x", first, [*vectors, *second, *(x for row in zip(*columns, strict=True) for x in row)]
        )
    if name == "convect":
        ck, cv = symbols(graph, "ck", "cv")
        rates = [
            [ck * x + cv * y for x, y in zip(changed(second, {by: 1.0}), changed(second, {rate: 1.0}), strict=True)]
            for by, rate in zip(u, v, strict=True)
        ]
        return _source(name, "count, ck, cv, x", first, [x for row in zip(*rates, strict=True) for x in row])
    f = _rows(graph, first, kind.size)
    turned: list[Any] = [sum(x * y for x, y in zip(column, f, strict=True)) for column in columns]
    curved = [changed(turned, {x: 1.0}) for x in u]
    return _source(name, "count, x", first + kind.size, [x for row in zip(*curved, strict=True) for x in row])


def _passes(of: Measure | Kinematics, derive: Callable[..., str], names: Iterable[str]) -> dict[str, Derived]:
    """Return passes by name, those of a strain measure or of a kind of node."""
    label = of.name if isinstance(of, Kinematics) else of.__name__
    return {
        name: Derived(
            f"{label}_{name}", CONVECT_PASS if name == "convect" else ROWS_PASS, partial(derive, of, name), _FAST
        )
        for name in names
    }


MEASURE_PASSES = [
    _passes(measure, _measure_source, ("strains", "forces", "rates", "rate_changes", "hessian")) for measure in MEASURES
]
NODE_PASSES = [_passes(kind, _node_source, ("place", "convect", "curve")) for kind in KINDS]
