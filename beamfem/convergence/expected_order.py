"""The highest order that the elements of a study can have."""

from collections.abc import Mapping
from typing import Any

from beamfem.convergence.observed_order import HIGHEST_ORDER
from beamfem.element.element import Element


def highest_order(parameters: Mapping[str, Any]) -> float:
    """Return twice the highest degree of the fields among the parameters of a curve, 16 if there is none.

    Nodal values and energies of elements of degree k gain at most order 2 k; G. Strang and G. Fix, An Analysis of the
    Finite Element Method, 1973, sections 1.6 and 3.4.
    """
    degrees = [value.field.degree for value in parameters.values() if isinstance(value, Element)]
    return 2.0 * max(degrees) if degrees else HIGHEST_ORDER
