"""Sections with layers of different materials."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.reprs import brief
from beamfem.section.outline import Part, RectangleOutline
from beamfem.section.protocol import Inertia, Rigidity
from beamfem.validation import convert, finite, items, positive, shown

_STRIPS = 6  # Gauss points over each layer


@dataclass(frozen=True)
class Layer:
    """A layer of a layered section.

    Raises InputError for an invalid value.

    Parameters
    ----------
    material : Material
        Material of the layer.
    thickness : float, [m]
        Thickness of the layer.

    Examples
    --------
    >>> bf.Layer(steel, 0.002).thickness
    0.002
    """

    material: Material
    thickness: float

    def __post_init__(self) -> None:
        if not isinstance(self.material, Material):
            raise InputError(f"material of a Layer must be a Material, got {self.material!r}")
        convert(self, positive, "thickness")


@dataclass(frozen=True)
class Layered:
    """Rectangular layers of one width, each with its own material.

    A beam with this section needs no material. A neutral axis that is not on the beam's axis couples stretch with
    curvature: E A = sum E A_i, C = -sum E S_i, E I = sum E I_i about the axis. Raises InputError for an invalid value.

    Parameters
    ----------
    layers : sequence of Layer
        The layers from the bottom (y < 0) to the top.
    width : float, [m]
        Width of all layers.
    axis : float, [m], optional
        Height of the beam's axis above the bottom, by default mid-height.
    shear_factor : float, [-], default 5/6
        Shear correction factor k_s.

    Examples
    --------
    >>> brass = bf.Material(youngs_modulus=1.0e11, poisson_ratio=0.34, density=8500.0)
    >>> bf.Layered([bf.Layer(steel, 0.001), bf.Layer(brass, 0.002)], width=0.02).height
    0.003
    """

    layers: Sequence[Layer]
    width: float
    axis: float | None = None
    shear_factor: float = 5 / 6

    __repr__ = brief

    def __post_init__(self) -> None:
        layers = tuple(items("layers of a Layered section", self.layers))
        if not layers or not all(isinstance(layer, Layer) for layer in layers):
            raise InputError(f"layers of a Layered section must be a list of Layer, got {shown(layers)}")
        object.__setattr__(self, "layers", layers)
        convert(self, positive, "width", "shear_factor")
        if self.axis is None:
            object.__setattr__(self, "axis", 0.5 * self.height)
        convert(self, finite, "axis")

    @property
    def height(self) -> float:
        """Total height [m] of the layers."""
        return float(sum(layer.thickness for layer in self.layers))

    @property
    def area(self) -> float:
        """Total area [m^2] of the layers."""
        return self.width * self.height

    @property
    def bounds(self) -> tuple[float, float]:
        """Heights y [m] of the lower and the upper face, from the axis."""
        return float(self._edges[0]), float(self._edges[-1])

    def rigidity(self, material: Material | None = None) -> Rigidity:
        """Return the stiffness of all layers about the axis of the beam; they need no material.

        The coupling is C = -sum E S_i, as a positive curvature compresses the side of positive y.

        >>> strip = bf.Layered([bf.Layer(steel, 0.001), bf.Layer(steel, 0.002)], width=0.02)
        >>> round(strip.rigidity().axial / 1e6, 3)  # MN
        12.6
        """
        parts = self.moments(material)
        axial, first, bending = (sum(m.youngs_modulus * moments[n] for m, moments in parts) for n in range(3))
        shear = self.shear_factor * sum(m.shear_modulus * moments[0] for m, moments in parts)
        return Rigidity(float(axial), float(shear), float(bending), -float(first))

    def inertia(self, material: Material | None = None) -> Inertia:
        """Return the inertia of all layers per length about the axis of the beam."""
        mass, first, rotary = (
            float(sum(m.density * moments[n] for m, moments in self.moments(material))) for n in range(3)
        )
        return Inertia(mass, first, rotary)

    def moments(self, material: Material | None = None) -> list[tuple[Material, np.ndarray]]:
        """Return the material of each layer with its area moments, see `CrossSection.moments`."""
        return [
            (own, self.width * np.array([(shape.high**n - shape.low**n) / n for n in range(1, 6)]))
            for own, shape in self._rectangles
        ]

    def materials_at(self, y: np.ndarray, material: Material | None = None) -> list[tuple[Material, np.ndarray]]:
        """Return the material of each layer with a mask of the heights y (n,) [m] in it.

        Heights beyond a face count as in the layer next to it; a face between two layers is in the upper one.
        """
        index = np.clip(np.searchsorted(self._edges, y, side="right") - 1, 0, len(self.layers) - 1)
        return [(layer.material, index == number) for number, layer in enumerate(self.layers)]

    def strips(self, material: Material | None = None) -> list[tuple[Material, np.ndarray, np.ndarray]]:
        """Return a Gauss rule over the height of each layer, see `CrossSection.strips`."""
        return [(own, *shape.quadrature(_STRIPS)) for own, shape in self._rectangles]

    def parts(self, material: Material | None = None) -> tuple[Part, ...]:
        """Return each layer as a rectangle with its Young's modulus [Pa], from the bottom up."""
        return tuple(Part(own.youngs_modulus, shape) for own, shape in self._rectangles)

    @property
    def _rectangles(self) -> list[tuple[Material, RectangleOutline]]:
        places = zip(self.layers, pairwise(self._edges), strict=True)
        return [(layer.material, RectangleOutline(self.width, low, high)) for layer, (low, high) in places]

    @property
    def _edges(self) -> np.ndarray:
        return np.concatenate([[0.0], np.cumsum([layer.thickness for layer in self.layers])]) - self.axis
