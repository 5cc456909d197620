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
    found: list[list[tuple[float, str]]] = [[] for _ in model.beams]
    places: list[tuple[object, Point]] = [(support, support.point) for support in model.point_supports]
    places += [(joint, point) for joint in model.joints for point in (joint.a, joint.b)]
    places += [(load, load.point) for load in model.point_loads]
    places += [(connector, point) for connector in model.connectors for point in connector.points]
    for part, point in places:
        found[model.number_of(point.beam)].append((point.fraction, type(part).__name__))
    for beam, own in zip(model.beams, found, strict=True):
        own += [(jump / beam.curve.length, "section") for jump in beam.jumps]
    lines: tuple[AlongBeam, ...] = (*model.line_loads, *(load for _, load in model.imposing))
    for line in lines:
        kinks = [kink for name in functions_along(line) for kink in kinks_along(line, name)]
        length, name = line.beam.curve.length, type(line).__name__
        found[model.number_of(line.beam)] += [(kink / length, name) for kink in kinks]
    return found
