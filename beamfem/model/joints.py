"""What connects beams."""

from dataclasses import dataclass

from beamfem.model.beam import Point


@dataclass(frozen=True, slots=True)
class Rigid:
    """Join two points so that they move and turn alike, at whatever angle the beams meet."""

    a: Point
    b: Point


@dataclass(frozen=True, slots=True)
class Hinge:
    """Join two points so that they move alike; each turns as it likes."""

    a: Point
    b: Point


Joint = Rigid | Hinge
