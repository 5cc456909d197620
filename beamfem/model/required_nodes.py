"""Where parts of a model ask for a node of a beam's mesh."""

from typing import TYPE_CHECKING

from beamfem.model.along_beam import AlongBeam, functions_along, kinks_along
from beamfem.model.beam import Point

if TYPE_CHECKING:
    from beamfem.model.model import Model


def nodes_asked(model: "Model") -> list[list[tuple[float, str]]]:
    """Return for each beam the fractions of its length [-] at which parts of the model need a node, with their names.

    Jumps of sections belong to the beam itself and have the name "section".
    """
    result: list[list[tuple[float, str]]] = [[] for _ in model.beams]
    points: list[tuple[object, Point]] = [(support, support.point) for support in model.point_supports]
    points += [(joint, point) for joint in model.joints for point in (joint.a, joint.b)]
    points += [(load, load.point) for load in model.point_loads]
    points += [(connector, point) for connector in model.connectors for point in connector.points]
    for part, point in points:
        result[model.number_of(point.beam)].append((point.fraction, type(part).__name__))
    for beam, nodes in zip(model.beams, result, strict=True):
        nodes += [(jump / beam.curve.length, "section") for jump in beam.jumps]
    lines: tuple[AlongBeam, ...] = (*model.line_loads, *(load for _, load in model.imposing))
    for line in lines:
        kinks = [kink for name in functions_along(line) for kink in kinks_along(line, name)]
        length, name = line.beam.curve.length, type(line).__name__
        result[model.number_of(line.beam)] += [(kink / length, name) for kink in kinks]
    return result
