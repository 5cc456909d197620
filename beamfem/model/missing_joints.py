"""Beam ends that touch another beam without a joint, the usual cause of a mechanism."""

from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from beamfem.curves import Curve, Line
from beamfem.curves.curve import GAP
from beamfem.model.beam import Point, beam_in_words, reference_positions
from beamfem.model.model import Model

_SAMPLES = 9  # of an element, of which the nearest is corrected
_CORRECTIONS = 8

Pair = tuple[Point, Point]


def unjoined_ends(model: Model) -> Iterator[Pair]:
    """Yield the ends of beams that lie on a beam, each with the point there, where no joint connects the two."""
    from scipy.spatial import cKDTree  # slow to import

    ends = [point for beam in model.beams for point in (beam.start, beam.end)]
    positions, joined = reference_positions(ends), _joined_beams(model)
    tree = cKDTree(positions)
    longest = max(beam.curve.length for beam in model.beams)
    found: set[tuple[int, int, float]] = set()  # at the common end of two elements there are two
    for number, mesh in enumerate(model.meshes):
        beam, low, high = model.beams[number], mesh.vertices[:-1], mesh.vertices[1:]
        middle = beam.curve.position(0.5 * (low + high))
        for element, near in enumerate(tree.query_ball_point(middle, 0.5 * (high - low) + GAP * longest)):
            for i in near:
                end, own = ends[i], i // 2
                if number in joined[own, end.fraction]:
                    continue
                begin, stop = low[element], high[element]
                if own == number:  # it meets itself where its curve comes back to the end, not around the end
                    around = 2.0 * GAP * beam.curve.length
                    begin, stop = (max(begin, around), stop) if i % 2 == 0 else (begin, min(stop, high[-1] - around))
                    if type(beam.curve) is Line or begin > stop:
                        continue
                arc, distance = _nearest(beam.curve, positions[i], begin, stop)
                fraction = round(arc / beam.curve.length, 5)  # as a user would write it
                meets = distance <= GAP * max(beam.curve.length, end.beam.curve.length)
                if meets and (i, number, fraction) not in found:
                    found.add((i, number, fraction))
                    yield end, beam.at(fraction)


def in_words(model: Model, pair: Pair) -> str:
    """Return a sentence that names two points at one place without a joint."""
    one, other = sorted(pair, key=lambda point: (model.number_of(point.beam), point.fraction))
    x, y = one.reference
    both = f"{_point_in_words(model, one)} and {_point_in_words(model, other)}"
    return f"{both[0].upper()}{both[1:]} are both at ({x:g}, {y:g}), but no joint connects them"


def _point_in_words(model: Model, point: Point) -> str:
    beam = beam_in_words(model.beams, model.number_of(point.beam))
    ends = {0.0: "the start", 1.0: "the end"}
    return f"{ends.get(point.fraction, f'fraction {point.fraction:g}')} of {beam}"


def _joined_beams(model: Model) -> dict[tuple[int, float], set[int]]:
    """Return the beams of the other points that joints or parts connect with a point, by its beam and fraction."""
    groups: dict[tuple[int, float], set[tuple[int, float]]] = {}
    pairs = [(joint.a, joint.b) for joint in model.shared_joints]
    pairs += [(part.points[0], part.points[1]) for part in model.at_points if len(part.points) > 1]
    for one, other in pairs:
        a, b = ((model.number_of(point.beam), point.fraction) for point in (one, other))
        together = groups.get(a, {a}) | groups.get(b, {b})
        for point in together:
            groups[point] = together
    joined: dict[tuple[int, float], set[int]] = defaultdict(set)
    joined.update({point: {number for number, _ in together - {point}} for point, together in groups.items()})
    return joined


def _nearest(curve: Curve, position: np.ndarray, low: float, high: float) -> tuple[float, float]:
    """Return the arc length between two others that is nearest to a position, and its distance [m]."""
    arcs = np.linspace(low, high, _SAMPLES)
    away = np.linalg.norm(curve.position(arcs) - position, axis=1)
    arc = arcs[[int(np.argmin(away))]]
    for _ in range(_CORRECTIONS):
        step = np.sum((position - curve.position(arc)) * curve.tangent(arc), axis=1)
        arc = np.clip(arc + step, low, high)
    return float(arc[0]), float(np.linalg.norm(curve.position(arc)[0] - position))
