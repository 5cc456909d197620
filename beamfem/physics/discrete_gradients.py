"""Forces between two states of a quadrature point, whose work is the change of its strain energy; compiled passes.

The strains are functions of scalar products and cross products of r', d and the third vector. Their change between two
states follows from that of the products by the product rule with mean values, and the products are quadratic, so that
their change is their derivative in the mean state times the change of the vectors: the forces turn with the vectors,
and have the mean of the resultants of both states (Simo and Tarnow 1992; Gonzalez 2000).
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from beamfem.kernels.compiling import Derived
from beamfem.kernels.conserving_step import BETWEEN
from beamfem.physics.kinematics import MEASURES
from beamfem.physics.terms import Graph, changes, source, sqrt, symbols

Numbers = Sequence[Any]


def _cross(a: Numbers, b: Numbers) -> Any:
    return a[0] * b[1] - a[1] * b[0]


def _dot(a: Numbers, b: Numbers) -> Any:
    return a[0] * b[0] + a[1] * b[1]


def _sum(*products: tuple[Any, Numbers]) -> tuple[Any, ...]:
    """Return the sum of vectors times factors."""
    return tuple(sum(factor * vector[axis] for factor, vector in products) for axis in (0, 1))


def _turned(vector: Numbers) -> tuple[Any, Any]:
    """Return a vector turned by a right angle, so that a x b = turned(a) . b."""
    return -vector[1], vector[0]


def _green_lagrange(start: Numbers, end: Numbers, mean: Numbers, resultants: Numbers) -> list[Any]:
    r, d, e = mean
    a, b, c, thickness, shear, shear_slope = resultants
    return [
        *_sum((a, r), (b, e), (shear, d)),
        *_sum((thickness, d), (shear, r), (shear_slope, e)),
        *_sum((b, r), (c, e), (shear_slope, d)),
    ]


def _structural(start: Numbers, end: Numbers, mean: Numbers, resultants: Numbers) -> list[Any]:
    """Return the forces for (r' x d) / |d| - 1, (r' . d) / |d|, (d x d') / |d|^2 and |d| - 1."""
    (normal, shear, moment, thickness), (r, d, e) = resultants, mean
    w0, w1 = (_dot(q[1], q[1]) for q in (start, end))
    s0, s1 = sqrt(w0), sqrt(w1)
    x, y = (product(*start[:2]) + product(*end[:2]) for product in (_cross, _dot))
    z = _cross(*start[1:]) + _cross(*end[1:])
    inverse, square = 0.5 * (1.0 / s0 + 1.0 / s1), 0.5 * (1.0 / w0 + 1.0 / w1)
    by_x, by_y, by_z = normal * inverse, shear * inverse, moment * square
    by_w = thickness / (s0 + s1) - 0.5 * (normal * x + shear * y) / (s0 * s1 * (s0 + s1)) - 0.5 * moment * z / (w0 * w1)
    return [
        *_sum((-by_x, _turned(d)), (by_y, d)),
        *_sum((by_x, _turned(r)), (by_y, r), (-by_z, _turned(e)), (2.0 * by_w, d)),
        *_sum((by_z, _turned(d))),
    ]


def _elastic_line(start: Numbers, end: Numbers, mean: Numbers, resultants: Numbers) -> list[Any]:
    """Return the forces for |r'| - 1, (r' x r'') / |r'|^2, r' . d and (d . d - 1) / 2."""
    (normal, moment, shear, thickness), (r, d, b) = resultants, mean
    w0, w1 = (_dot(q[0], q[0]) for q in (start, end))
    both = _cross(start[0], start[2]) + _cross(end[0], end[2])
    by_y = 0.5 * moment * (1.0 / w0 + 1.0 / w1)
    by_w = normal / (sqrt(w0) + sqrt(w1)) - 0.5 * moment * both / (w0 * w1)
    return [
        *_sum((2.0 * by_w, r), (-by_y, _turned(b)), (shear, d)),
        *_sum((shear, r), (thickness, d)),
        *_sum((by_y, _turned(r))),
    ]


_BETWEEN: tuple[Callable[..., list[Any]], ...] = (_green_lagrange, _structural, _elastic_line)


def _source(number: int) -> str:
    """Return the source of a pass of a strain measure; out: forces (6,) and their derivative (6, 6) by the end."""
    graph: Graph = {}
    start, end = (symbols(graph, *(f"{name}[{i}]" for i in range(6))) for name in ("start", "end"))
    (weight,) = symbols(graph, "weight")
    strains = [MEASURES[number](*q, sqrt) for q in (start, end)]
    count = range(len(strains[0]))
    reference = symbols(graph, *(f"reference[{i}]" for i in count))
    law = [symbols(graph, *(f"stiffness[{len(count) * min(i, j) + max(i, j)}]" for j in count)) for i in count]
    mean = [0.5 * (a + b) - c for a, b, c in zip(*strains, reference, strict=True)]
    resultants = [weight * sum(law[i][j] * mean[j] for j in count) for i in count]
    states = [[q[:2], q[2:4], q[4:]] for q in (start, end, [0.5 * (a + b) for a, b in zip(start, end, strict=True)])]
    forces = _BETWEEN[number](*states, resultants)
    slopes = [changes(forces, {x: 1.0}) for x in end]
    results = [*forces, *(slope[row] for row in range(6) for slope in slopes)]
    to = {f"out[{place}]": result for place, result in enumerate(results)}
    return source("between", "start, end, stiffness, reference, weight, out", "forces and their derivative", [], to)


DISCRETE_GRADIENTS = [
    Derived(f"{measure.__name__}_between", BETWEEN, partial(_source, number), {"contract"})
    for number, measure in enumerate(MEASURES)
]
