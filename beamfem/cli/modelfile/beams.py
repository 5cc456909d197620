"""Beams of a model file, called as their tables are."""

from collections.abc import Callable, Sequence
from typing import Any

from beamfem.curves import Curve
from beamfem.element.element import Element
from beamfem.material import Material
from beamfem.model.beam import Beam


def called(name: str) -> Callable[..., Beam]:
    """Return what makes the beam of a table [beams.NAME] of its keys."""

    def make(
        curve: Curve, elements: int | Sequence[float], element: Element, section: Any, material: Material | None = None
    ) -> Beam:
        return Beam(curve, elements, element, section, material, name)

    return make
