"""An element as a user chooses it, and the named combinations of the paper."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from beamfem.element.coordinates import Gradients, Rotation
from beamfem.element.fields import Cubic, Field, Lagrange
from beamfem.element.forces import ContinuumMechanics, Forces, Structural
from beamfem.errors import InputError
from beamfem.validation import count

Integration = Literal["full", "reduced"]


@dataclass(frozen=True)
class Element:
    """A field, the nodal coordinates that carry it and the elastic forces that resist it.

    integration: "full" integrates the energy of a straight element exactly, "reduced" takes as many Gauss points as
    the order of the field (cubic: 2). Raises InputError for a name that is not known.
    """

    field: Field
    coordinates: Gradients | Rotation
    forces: Forces
    integration: Integration = "full"
    label: str | None = None

    def __post_init__(self) -> None:
        if self.integration not in ("full", "reduced"):
            raise InputError(f'integration must be "full" or "reduced", got {self.integration!r}')
        for name, kind in (("coordinates", Gradients | Rotation), ("forces", Forces)):
            if not isinstance(getattr(self, name), kind):
                raise InputError(f"{name} of an element must be one of {kind}, got {getattr(self, name)!r}")

        if (self.coordinates, self.forces, self.integration) == (Gradients(), Structural(), "reduced"):
            raise InputError(
                "structural forces with gradients need full integration: they see the unit vector of d only, so that "
                "with reduced integration the thickness can change without resistance"
            )

    @property
    def name(self) -> str:
        """Fit for a file name and a legend."""
        return self.label or f"{self.field.name}-{self.coordinates.name}"

    @property
    def coordinates_per_node(self) -> int:
        return len(self.coordinates.labels(self.field.vectors))

    def quadrature(self) -> tuple[np.ndarray, np.ndarray]:
        """Gauss points (nq,) and weights (nq,) on [0, 1]."""
        reduced = 2 if isinstance(self.field, Cubic) else self.field.degree
        full = self.forces.points(self.field.degree, self.field.director_degree)
        xi, weights = np.polynomial.legendre.leggauss(reduced if self.integration == "reduced" else full)
        return 0.5 * (xi + 1.0), 0.5 * weights


def ANCF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Cubic field carried by gradients, 6 coordinates a node; Omar and Shabana 2001."""
    return Element(Cubic(), Gradients(), forces or ContinuumMechanics(), integration, "ANCF")


def ANCFCRBF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Cubic field carried by rotations, 5 coordinates a node; paper, section 3."""
    return Element(Cubic(), Rotation(), forces or ContinuumMechanics(), integration, "ANCF-CRBF")


def BilinearANCF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Bilinear field carried by gradients, 4 coordinates a node; paper, eqs. (8) to (10)."""
    return Element(Lagrange(1), Gradients(), forces or ContinuumMechanics(), integration, "bilinear-ANCF")


def BilinearCRBF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Bilinear field carried by rotations, 3 coordinates a node; paper, section 4."""
    return Element(Lagrange(1), Rotation(), forces or ContinuumMechanics(), integration, "bilinear-CRBF")


def CRBF(order: int, forces: Forces | None = None, integration: Integration = "reduced") -> Element:
    """Field of any order in r and r_y carried by rotations, 3 coordinates a node; suggested in the paper, section 4.

    order: 1 to 8. Raises InputError.
    """
    if count("order", order) > 8:
        raise InputError(f"order must be at most 8, got {order}")
    return Element(Lagrange(order), Rotation(), forces or Structural(), integration, f"CRBF-{order}")
