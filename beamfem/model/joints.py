"""What connects beams."""

from dataclasses import dataclass

from beamfem.model.beam import Point, require_point
from beamfem.model.shapes import Ring


@dataclass(frozen=True, slots=True)
class Rigid:
    """Join two points so that they move and turn alike, at whatever angle the beams meet."""

    a: Point
    b: Point

    def __post_init__(self) -> None:
        require_point("Rigid", self.a, "a")
        require_point("Rigid", self.b, "b")

    def shapes(self) -> tuple[Ring, ...]:
        """Return what it looks like: nothing beside the beams."""
        return ()


@dataclass(frozen=True, slots=True)
class Hinge:
    """Join two points so that they move alike; each turns as it likes."""

    a: Point
    b: Point

    def __post_init__(self) -> None:
        require_point("Hinge", self.a, "a")
        require_point("Hinge", self.b, "b")

    def shapes(self) -> tuple[Ring, ...]:
        """Return what it looks like."""
        return (Ring(self.a),)


Joint = Rigid | Hinge
