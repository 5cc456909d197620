"""A beam: an axis, a mesh, an element, a section and a material."""

from dataclasses import dataclass

import numpy as np

from beamfem.curves import Curve
from beamfem.element.element import Element
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section import Section
from beamfem.validation import count, finite


@dataclass(frozen=True, eq=False)
class Beam:
    """A prismatic beam along a curve.

    curve: stress-free axis; elements: number of equal elements; element: see `beamfem.element`.
    Raises InputError.
    """

    curve: Curve
    elements: int
    element: Element
    section: Section
    material: Material

    def __post_init__(self) -> None:
        count("elements", self.elements)
        for name, kind in (("element", Element), ("section", Section), ("material", Material)):
            if not isinstance(getattr(self, name), kind):
                raise InputError(f"{name} of a Beam must be a {kind.__name__}, got {getattr(self, name)!r}")
        if not hasattr(self.curve, "tangent"):
            raise InputError(f"curve of a Beam must be a curve such as Line, got {self.curve!r}")

    def at(self, fraction: float) -> "Point":
        """Return the point at a fraction in [0, 1] of the arc length."""
        share = finite("fraction", fraction)
        if not 0.0 <= share <= 1.0:
            raise InputError(f"the fraction along a beam lies between 0 and 1, got {share}")
        return Point(self, share)

    @property
    def start(self) -> "Point":
        return Point(self, 0.0)

    @property
    def end(self) -> "Point":
        return Point(self, 1.0)


@dataclass(frozen=True)
class Point:
    """A point of a beam's axis at a fraction of its arc length."""

    beam: Beam
    fraction: float

    @property
    def reference(self) -> np.ndarray:
        """Position in the reference (2,) [m]."""
        return self.beam.curve.position(np.array([self.fraction * self.beam.curve.length]))[0]

    def __str__(self) -> str:
        x, y = self.reference
        return f"({x:g}, {y:g}), fraction {self.fraction:g} of its beam"
